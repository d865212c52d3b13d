/* A scene on the device: flat arrays, acceleration structures, the block the kernel starts from. */
#ifndef TURNER_RENDER_DEVICE_SCENE_H
#define TURNER_RENDER_DEVICE_SCENE_H

#include "bvh/flat.h"
#include "gpu/accel.h"
#include "gpu/memory.h"
#include "render/needs.h"

enum turner_array {
    TURNER_ARRAY_NODES,
    TURNER_ARRAY_PRIMITIVES,
    TURNER_ARRAY_INSTANCES,
    TURNER_ARRAY_PRIMITIVE_RESTS, /* these two with precision f64 only */
    TURNER_ARRAY_INSTANCE_RESTS,
    TURNER_ARRAY_PLANES,
    TURNER_ARRAY_CORNERS,
    TURNER_ARRAY_NORMALS,
    TURNER_ARRAY_UVS,
    TURNER_ARRAY_MATERIALS,
    TURNER_ARRAY_MEDIA,
    TURNER_ARRAY_TEXELS,
    TURNER_ARRAY_IMAGES,
    TURNER_ARRAY_LIGHTS,
    TURNER_ARRAY_SCENE,
    TURNER_ARRAYS
};

struct turner_device_scene {
    struct turner_buffer arrays[TURNER_ARRAYS];
    struct turner_accel *accels; /* ray_query: two a group, triangles and boxes */
    size_t accel_count;
    struct turner_accel top;     /* ray_query */
};

/* Uploads `flat` and all else of `scene`; with `ray_query` builds acceleration structures, too. */
enum turner_result turner_device_scene_create(struct turner_device_scene *device,
                                              struct turner_gpu *gpu,
                                              const struct turner_scene *scene,
                                              const struct turner_flat *flat,
                                              const struct turner_needs *needs, bool ray_query);
/* Uploads only what stands in the scene once: camera, background, ambient light, the settings. The
 * rest is that of the scene it was created with, `flat` and `needs`, too. */
enum turner_result turner_device_scene_look(struct turner_device_scene *device,
                                            struct turner_gpu *gpu,
                                            const struct turner_scene *scene,
                                            const struct turner_flat *flat,
                                            const struct turner_needs *needs, bool ray_query);
/* Uploads materials and lights, as many as there were, anew. */
enum turner_result turner_device_scene_paint(struct turner_device_scene *device,
                                             struct turner_gpu *gpu,
                                             const struct turner_scene *scene);
/* Uploads the instances and the top level, after turner_flat_move, or builds the device's own anew. */
enum turner_result turner_device_scene_move(struct turner_device_scene *device,
                                            struct turner_gpu *gpu,
                                            const struct turner_scene *scene,
                                            const struct turner_flat *flat, bool ray_query);
void turner_device_scene_destroy(struct turner_gpu *gpu, struct turner_device_scene *device);

/* The acceleration structures alone (acceleration.c). */
enum turner_result turner_device_scene_build(struct turner_device_scene *device,
                                             struct turner_gpu *gpu,
                                             const struct turner_flat *flat);
/* The one over the instances, in place of the one there was. */
enum turner_result turner_device_scene_build_top(struct turner_device_scene *device,
                                                 struct turner_gpu *gpu,
                                                 const struct turner_flat *flat);

#endif
