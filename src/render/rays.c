#include "render/rays.h"

static const uint32_t group = TURNER_WORKGROUP * TURNER_WORKGROUP;

size_t turner_camera_ray_count(int width, int height)
{
    size_t columns = ((size_t)width + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP;
    size_t rows = ((size_t)height + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP;
    return columns * rows * group;
}

static void dispatch(VkCommandBuffer commands, const struct turner_renderer *renderer,
                     const struct turner_gpu_dispatch *push)
{
    turner_renderer_dispatch(commands, renderer, *push, (push->count - 1) / group + 1);
}

enum turner_result turner_ray_list_create(struct turner_ray_list *list, struct turner_gpu *gpu,
                                          const struct turner_gpu_ray *rays, size_t count)
{
    *list = (struct turner_ray_list){.count = count};
    enum turner_result result;
    TURNER_TRY_DONE(turner_buffer_create(&list->rays, gpu, count * sizeof *rays, 0,
                                         TURNER_MEMORY_DEVICE, "a list of rays"));
    TURNER_TRY_DONE(turner_buffer_create(&list->hits, gpu, count * sizeof(struct turner_gpu_hit),
                                         0, TURNER_MEMORY_DEVICE, "what rays meet"));
    TURNER_TRY_DONE(turner_buffer_upload(gpu, &list->rays, 0, rays, count * sizeof *rays));
done:
    if (result != TURNER_OK)
        turner_ray_list_destroy(gpu, list);
    return result;
}

void turner_ray_list_destroy(struct turner_gpu *gpu, struct turner_ray_list *list)
{
    turner_buffer_destroy(gpu, &list->rays);
    turner_buffer_destroy(gpu, &list->hits);
    *list = (struct turner_ray_list){0};
}

enum turner_result turner_ray_list_trace(double *seconds, struct turner_ray_list *list, int passes,
                                         struct turner_renderer *renderer)
{
    struct turner_gpu_dispatch push = {
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = list->rays.address,
        .params = renderer->params.buffer.address,
        .hits = list->hits.address,
        .count = (uint32_t)list->count,
    };
    VkCommandBuffer commands;
    TURNER_TRY(turner_gpu_begin(renderer->gpu, &commands));
    for (int pass = 0; pass < passes; pass++) {
        if (pass > 0)
            turner_gpu_barrier(commands);
        dispatch(commands, renderer, &push);
    }
    double start = turner_seconds();
    TURNER_TRY(turner_gpu_submit_wait(renderer->gpu, commands));
    *seconds = turner_seconds() - start;
    return TURNER_OK;
}

enum turner_result turner_ray_list_hits(struct turner_gpu_hit *hits,
                                        const struct turner_ray_list *list, struct turner_gpu *gpu)
{
    return turner_buffer_download(gpu, &list->hits, 0, hits, list->count * sizeof *hits);
}

enum turner_result turner_rays_send(struct turner_gpu_ray *rays, size_t *count, uint32_t what,
                                    struct turner_renderer *renderer)
{
    struct turner_ray_list list;
    VkCommandBuffer commands;
    enum turner_result result;
    if (!*count)
        return TURNER_OK;
    TURNER_TRY(turner_ray_list_create(&list, renderer->gpu, rays, *count));
    struct turner_gpu_dispatch push = {
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = list.rays.address,
        .params = renderer->params.buffer.address,
        .count = (uint32_t)list.count,
        .tile_width = (uint32_t)renderer->settings.width,
        .tile_height = (uint32_t)renderer->settings.height,
        .first = what,
    };
    TURNER_TRY_DONE(turner_gpu_begin(renderer->gpu, &commands));
    dispatch(commands, renderer, &push);
    TURNER_TRY_DONE(turner_gpu_submit_wait(renderer->gpu, commands));
    TURNER_TRY_DONE(turner_buffer_download(renderer->gpu, &list.rays, 0, rays,
                                           list.count * sizeof *rays));
    *count = 0;
    for (size_t i = 0; i < list.count; i++) {
        if (rays[i].kind != TURNER_RAY_NONE)
            rays[(*count)++] = rays[i];
    }
done:
    turner_ray_list_destroy(renderer->gpu, &list);
    return result;
}
