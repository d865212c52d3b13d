/* The truth: docs/model.md in extended precision on the CPU, in the plainest way. No Vulkan. */
#ifndef TURNER_REFERENCE_REFERENCE_H
#define TURNER_REFERENCE_REFERENCE_H

#include "base/result.h"
#include "scene/ray_tree.h"
#include "scene/scene.h"
#include "turner.h"

struct turner_reference_statistics {
    uint64_t camera_rays, reflected_rays, refracted_rays, shadow_rays;
    uint64_t tir_rays;       /* reflected rays that total internal reflection sent (in reflected) */
    uint64_t camera_hits;    /* camera rays that hit a surface (one that is none does not count) */
    int largest_depth;       /* of a ray that was followed */
};

/* Called from one thread with the share done in [0,1]; returning false stops the rendering
 * (TURNER_INTERRUPTED). May be NULL. */
typedef bool (*turner_progress)(double share, void *user);

/* Creates `image`, scene->settings.width × height, and renders into it; the fourth channel is
 * `pruned`. `threads` 0 means one per core; the result does not depend on it. `statistics` may be
 * NULL. After a failure there is no image. TURNER_DEVICE: not enough memory or threads;
 * TURNER_INTERRUPTED: `progress` said so. The caller destroys the image. */
enum turner_result turner_reference_render(struct turner_image *image,
                                           const struct turner_scene *scene, int threads,
                                           struct turner_reference_statistics *statistics,
                                           turner_progress progress, void *user);

/* The same with other sample positions: in each pixel the whole pattern is shifted, and what leaves
 * the pixel comes in on its other side, by an amount that `pattern` and the pixel decide (Cranley
 * and Patterson 1976). Pictures of different patterns are independent estimates of the same truth.
 * 0: not shifted. */
enum turner_result turner_reference_render_pattern(struct turner_image *image,
                                                   const struct turner_scene *scene,
                                                   uint32_t pattern, int threads,
                                                   struct turner_reference_statistics *statistics,
                                                   turner_progress progress, void *user);

/* As turner_reference_render, and fills what `layers` holds planes for (turner_layers in turner.h; its size is the
 * picture's): rays, recursion, and what the ray through each pixel's centre meets. `layers` may be
 * NULL. */
enum turner_result turner_reference_render_layers(struct turner_image *image,
                                                  struct turner_layers *layers,
                                                  const struct turner_scene *scene, int threads,
                                                  struct turner_reference_statistics *statistics,
                                                  turner_progress progress, void *user);

/* Radiance along one ray from `origin` (outside all media but camera.inside), in double: for
 * tests. `direction` need not be unit. */
enum turner_result turner_reference_radiance(struct turner_vec3 *radiance, double *pruned,
                                             const struct turner_scene *scene,
                                             struct turner_vec3 origin,
                                             struct turner_vec3 direction);

/* The rays behind the point (px, py) of the picture, in pixels from its top left corner. The caller
 * destroys the tree, also after a failure. */
enum turner_result turner_reference_explain(struct turner_ray_tree *tree,
                                            const struct turner_scene *scene, double px,
                                            double py);

#endif
