#include "render/probe.h"

#include <string.h>

enum turner_result turner_probe_trace(struct turner_gpu_probe *probes, size_t count,
                                      struct turner_renderer *renderer)
{
    struct turner_gpu *gpu = renderer->gpu;
    struct turner_buffer buffer;
    VkCommandBuffer commands;
    enum turner_result result;
    const uint32_t group = TURNER_WORKGROUP * TURNER_WORKGROUP;
    TURNER_TRY(turner_buffer_create(&buffer, gpu, count * sizeof *probes, 0, TURNER_MEMORY_HOST,
                                    "rays to probe"));
    memcpy(buffer.mapped, probes, count * sizeof *probes);
    struct turner_gpu_dispatch push = {
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = buffer.address,
        .params = renderer->params.buffer.address,
        .tile_width = (uint32_t)count,
    };
    TURNER_TRY_DONE(turner_gpu_begin(gpu, &commands));
    turner_program_dispatch(commands, &renderer->program, &push,
                            ((uint32_t)count + group - 1) / group, 1, 1);
    TURNER_TRY_DONE(turner_gpu_submit_wait(gpu, commands));
    memcpy(probes, buffer.mapped, count * sizeof *probes);
done:
    turner_buffer_destroy(gpu, &buffer);
    return result;
}
