/* A changed hook, seen soon: what is seen directly is lit anew by a small kernel (shaders/
 * deferred.comp), which a driver has long before that of the picture. What one pixel of the picture
 * meets, and which lights reach it, is remembered while the picture rests (shaders/visibility.comp);
 * mirror images, what is seen through glass, and the shadows of lights that a hook moved follow with
 * the picture itself. */
#ifndef TURNER_RENDER_PREVIEW_H
#define TURNER_RENDER_PREVIEW_H

#include "render/renderer.h"

/* deferred.comp with the hooks of one moment. */
struct turner_lighting {
    struct turner_kernel kernel;
    struct turner_program program; /* no pipeline: there is none */
};

struct turner_preview {
    struct turner_program visibility; /* no pipeline: not made yet */
    struct turner_buffer visible;     /* turner_gpu_visible, for each pixel of `before` */
    struct turner_image before;       /* by the hooks of the picture */
    bool recorded;                    /* both are of the picture that is shown */
};

/* In any thread: one of the two kernels, of source that has been read, for a renderer with these
 * needs, on its device. Results as of turner_kernel_compile, or TURNER_DEVICE. */
enum turner_result turner_lighting_create(struct turner_lighting *lighting, struct turner_gpu *gpu,
                                          struct turner_shader_source *source, unsigned kind,
                                          const struct turner_needs *needs,
                                          const struct turner_scene *scene, bool no_cache);
void turner_lighting_destroy(struct turner_gpu *gpu, struct turner_lighting *lighting);
enum turner_result turner_visibility_create(struct turner_program *program, struct turner_gpu *gpu,
                                            struct turner_shader_source *source, unsigned kind,
                                            const struct turner_needs *needs, uint32_t bvh_depth,
                                            const struct turner_scene *scene, bool no_cache);

/* Remembers what is visible in the picture of `scene`, which `renderer` shows, lit by `lighting`.
 * TURNER_INTERRUPTED when options->progress says so. */
enum turner_result turner_preview_record(struct turner_preview *preview,
                                         struct turner_renderer *renderer,
                                         struct turner_lighting *lighting,
                                         const struct turner_scene *scene,
                                         const struct turner_render_options *options);

/* Changes `image`, the picture that was recorded, by what `lighting` makes of what is visible. */
enum turner_result turner_preview_light(const struct turner_preview *preview,
                                        struct turner_image *image,
                                        struct turner_renderer *renderer,
                                        struct turner_lighting *lighting,
                                        const struct turner_scene *scene);
void turner_preview_destroy(struct turner_gpu *gpu, struct turner_preview *preview);

#endif
