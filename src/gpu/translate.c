#include "gpu/translate.h"

static enum turner_result translate(struct turner_gpu *gpu, const struct turner_spirv *spirv)
{
    struct turner_program program;
    VkCommandBuffer commands;
    char push[256] = {0}; /* read by no group: there is none */
    TURNER_TRY(turner_program_create(&program, gpu, spirv, NULL, 0, false));
    enum turner_result result = TURNER_OK;
    if (program.binding_count == 0 && program.push_size <= sizeof push) {
        result = turner_gpu_begin(gpu, &commands);
        if (result == TURNER_OK) {
            turner_program_dispatch(commands, &program, push, 0, 0, 0);
            result = turner_gpu_submit_wait(gpu, commands);
        }
    }
    turner_program_destroy(gpu, &program);
    return result;
}

void turner_gpu_translate(const struct turner_gpu *gpu, const struct turner_spirv *spirv)
{
    struct turner_gpu other;
    if (!gpu->info.software || turner_gpu_create(&other, gpu->info.name, false) != TURNER_OK)
        return;
    translate(&other, spirv);
    turner_gpu_destroy(&other); /* the cache is on disk then */
}
