/* What a device does for one sample of a pixel, ray by ray: the renderer's own kernel, compiled so
 * that it notes down what it does (shaders/record.glsl). */
#ifndef TURNER_RENDER_EXPLAIN_H
#define TURNER_RENDER_EXPLAIN_H

#include "render/renderer.h"
#include "scene/ray_tree.h"

struct turner_recorder {
    struct turner_gpu gpu; /* its info says which device */
    unsigned kind;         /* of kernel, but for TURNER_RECORD */
    const struct turner_scene *scene; /* not owned */
    struct turner_kernel kernel;
    struct turner_renderer renderer;
    struct turner_buffer buffer;
};

/* Opens the device; results as of turner_render. To be destroyed also after a failure, and not to be
 * moved. */
enum turner_result turner_recorder_create(struct turner_recorder *recorder,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options);
void turner_recorder_destroy(struct turner_recorder *recorder);

/* The rays behind the point (sample_x, sample_y) in [0,1)² of pixel (x, y). TURNER_BAD_INPUT when
 * the shaders note nothing down, TURNER_DEVICE when the device fails. The caller destroys the tree,
 * also after a failure. */
enum turner_result turner_recorder_trace(struct turner_ray_tree *tree,
                                         struct turner_recorder *recorder, int x, int y,
                                         double sample_x, double sample_y);

#endif
