/* Lists of rays through the traversal that draws pictures (shaders/rays.comp), to measure it. */
#ifndef TURNER_RENDER_RAYS_H
#define TURNER_RENDER_RAYS_H

#include "render/renderer.h"

#include "../shaders/shared.h"

/* Rays on the device, and what each met when they were last traced. */
struct turner_ray_list {
    struct turner_buffer rays, hits;
    size_t count;
};

/* `kernel` is rays.comp with TURNER_RAYS_SEND, by which `renderer` was made of a scene. Replaces
 * rays[0 … *count − 1] by those that are sent on from what they meet, in order, and *count by their
 * number, which may be 0. `what` is TURNER_SEND_…; TURNER_SEND_CAMERA only sets them, *count must
 * be turner_camera_ray_count. TURNER_SEND_SHADOW needs a light. */
enum turner_result turner_rays_send(struct turner_gpu_ray *rays, size_t *count, uint32_t what,
                                    struct turner_renderer *renderer);

/* Rays that TURNER_SEND_CAMERA has place for, of a picture of width × height. */
size_t turner_camera_ray_count(int width, int height);

/* Copies `count` > 0 rays to the device. */
enum turner_result turner_ray_list_create(struct turner_ray_list *list, struct turner_gpu *gpu,
                                          const struct turner_gpu_ray *rays, size_t count);
void turner_ray_list_destroy(struct turner_gpu *gpu, struct turner_ray_list *list);

/* Traces the whole list `passes` times, each after the other, in one submission, on a renderer
 * whose kernel is rays.comp without TURNER_RAYS_SEND. *seconds is the time from submission to the
 * end, by the clock on the wall. */
enum turner_result turner_ray_list_trace(double *seconds, struct turner_ray_list *list, int passes,
                                         struct turner_renderer *renderer);

/* What they met when traced last: hits[count]. */
enum turner_result turner_ray_list_hits(struct turner_gpu_hit *hits,
                                        const struct turner_ray_list *list,
                                        struct turner_gpu *gpu);

#endif
