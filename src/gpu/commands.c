#include <string.h>

#include "gpu/device.h"

#define WAIT_SECONDS 600

enum turner_result turner_gpu_begin(struct turner_gpu *gpu, VkCommandBuffer *commands)
{
    *commands = VK_NULL_HANDLE;
    VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = gpu->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1,
    };
    VK_TRY(vkAllocateCommandBuffers(gpu->device, &allocate, commands));
    VkCommandBufferBeginInfo begin = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
        .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT,
    };
    enum turner_result result = TURNER_OK;
    VK_TRY_DONE(vkBeginCommandBuffer(*commands, &begin));
    return TURNER_OK;
done:
    vkFreeCommandBuffers(gpu->device, gpu->pool, 1, commands);
    *commands = VK_NULL_HANDLE;
    return result;
}

/* In steps of a second: some drivers notice a lost device only when asked again. */
static enum turner_result wait_for_fence(struct turner_gpu *gpu)
{
    for (int second = 0; second < WAIT_SECONDS; second++) {
        VkResult wait = vkWaitForFences(gpu->device, 1, &gpu->fence, VK_TRUE, 1000000000u);
        if (wait == VK_SUCCESS)
            return TURNER_OK;
        if (wait != VK_TIMEOUT)
            return turner_vk_fail(wait, "vkWaitForFences", __FILE__, __LINE__);
    }
    gpu->hung = true;
    return turner_fail(TURNER_DEVICE,
                       "%s has not finished in %d seconds; use smaller tiles or another device",
                       gpu->info.name, WAIT_SECONDS);
}

enum turner_result turner_gpu_submit_wait(struct turner_gpu *gpu, VkCommandBuffer commands)
{
    enum turner_result result = TURNER_OK;
    VkMemoryBarrier to_host = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_HOST_READ_BIT,
    };
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                         0, 1, &to_host, 0, NULL, 0, NULL);
    VkSubmitInfo submit = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .commandBufferCount = 1,
        .pCommandBuffers = &commands,
    };
    VK_TRY_DONE(vkEndCommandBuffer(commands));
    VK_TRY_DONE(vkResetFences(gpu->device, 1, &gpu->fence));
    VK_TRY_DONE(vkQueueSubmit(gpu->queue, 1, &submit, gpu->fence));
    result = wait_for_fence(gpu);
done:
    if (!gpu->hung)
        vkFreeCommandBuffers(gpu->device, gpu->pool, 1, &commands);
    return result;
}

void turner_gpu_barrier(VkCommandBuffer commands)
{
    VkMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
    };
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, NULL, 0, NULL);
}

const char *turner_vk_result_name(VkResult result)
{
    static const struct {
        VkResult result;
        const char *name;
    } names[] = {
#define NAME(result) {result, #result}
        NAME(VK_SUCCESS),
        NAME(VK_NOT_READY),
        NAME(VK_TIMEOUT),
        NAME(VK_EVENT_SET),
        NAME(VK_EVENT_RESET),
        NAME(VK_INCOMPLETE),
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY),
        NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY),
        NAME(VK_ERROR_INITIALIZATION_FAILED),
        NAME(VK_ERROR_DEVICE_LOST),
        NAME(VK_ERROR_MEMORY_MAP_FAILED),
        NAME(VK_ERROR_LAYER_NOT_PRESENT),
        NAME(VK_ERROR_EXTENSION_NOT_PRESENT),
        NAME(VK_ERROR_FEATURE_NOT_PRESENT),
        NAME(VK_ERROR_INCOMPATIBLE_DRIVER),
        NAME(VK_ERROR_TOO_MANY_OBJECTS),
        NAME(VK_ERROR_FORMAT_NOT_SUPPORTED),
        NAME(VK_ERROR_FRAGMENTED_POOL),
        NAME(VK_ERROR_UNKNOWN),
        NAME(VK_ERROR_OUT_OF_POOL_MEMORY),
        NAME(VK_ERROR_INVALID_EXTERNAL_HANDLE),
        NAME(VK_ERROR_FRAGMENTATION),
        NAME(VK_ERROR_INVALID_OPAQUE_CAPTURE_ADDRESS),
        NAME(VK_PIPELINE_COMPILE_REQUIRED),
        NAME(VK_ERROR_SURFACE_LOST_KHR),
        NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR),
        NAME(VK_SUBOPTIMAL_KHR),
        NAME(VK_ERROR_OUT_OF_DATE_KHR),
        NAME(VK_ERROR_VALIDATION_FAILED_EXT),
        NAME(VK_ERROR_INVALID_SHADER_NV),
        NAME(VK_ERROR_NOT_PERMITTED_KHR),
        NAME(VK_ERROR_COMPRESSION_EXHAUSTED_EXT),
#undef NAME
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].result == result)
            return names[i].name;
    }
    return "an unknown VkResult";
}

enum turner_result turner_vk_fail(VkResult result, const char *call, const char *file, int line)
{
    const char *what_to_do = "";
    if (result == VK_ERROR_DEVICE_LOST)
        what_to_do = "; the device is lost: try again, with smaller tiles, or take another device";
    else if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        what_to_do = "; render a smaller picture or scene, or close other programs";
    const char *slash = strrchr(file, '/');
    return turner_fail(TURNER_DEVICE, "%.*s: %s (%s:%d)%s", (int)strcspn(call, "("), call,
                       turner_vk_result_name(result), slash ? slash + 1 : file, line, what_to_do);
}
