#include "gpu/memory.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define SMALLEST_BUFFER 16
#define STAGING_BYTES ((VkDeviceSize)64 << 20)
#define HOST_FLAGS (VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT)

/* Whether host and device share one memory. */
static bool is_unified(const struct turner_gpu *gpu)
{
    return gpu->info.software || strcmp(gpu->info.type, "integrated GPU") == 0;
}

/* The first memory type among `bits` with the flags of the first wish that any has. */
static uint32_t find_type(const struct turner_gpu *gpu, uint32_t bits, enum turner_memory memory)
{
    const VkMemoryPropertyFlags host[] = {HOST_FLAGS | VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                                          HOST_FLAGS};
    const VkMemoryPropertyFlags device[] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT | HOST_FLAGS |
                                                VK_MEMORY_PROPERTY_HOST_CACHED_BIT,
                                            VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT};
    const VkMemoryPropertyFlags *wishes = memory == TURNER_MEMORY_HOST ? host : device;
    for (int wish = memory == TURNER_MEMORY_DEVICE && !is_unified(gpu); wish < 2; wish++) {
        for (uint32_t i = 0; i < gpu->memory.memoryTypeCount; i++) {
            if ((bits & (1u << i)) &&
                (gpu->memory.memoryTypes[i].propertyFlags & wishes[wish]) == wishes[wish])
                return i;
        }
    }
    return UINT32_MAX;
}

static uint64_t heap_available(const struct turner_gpu *gpu, uint32_t heap)
{
    VkPhysicalDeviceMemoryBudgetPropertiesEXT budget = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT};
    VkPhysicalDeviceMemoryProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MEMORY_PROPERTIES_2,
        .pNext = gpu->memory_budget ? &budget : NULL};
    vkGetPhysicalDeviceMemoryProperties2(gpu->physical, &properties);
    uint64_t total = gpu->memory.memoryHeaps[heap].size, used = gpu->memory_used;
    if (gpu->memory_budget) {
        total = budget.heapBudget[heap];
        used = budget.heapUsage[heap];
    }
    uint64_t available = total > used ? total - used : 0;
    uint64_t host = is_unified(gpu) ? turner_memory_available() : UINT64_MAX;
    return available < host ? available : host;
}

uint64_t turner_gpu_memory_available(const struct turner_gpu *gpu, enum turner_memory memory)
{
    uint32_t type = find_type(gpu, UINT32_MAX, memory);
    return type == UINT32_MAX ? 0 : heap_available(gpu, gpu->memory.memoryTypes[type].heapIndex);
}

static enum turner_result refuse(const struct turner_gpu *gpu, const char *what, uint64_t wanted,
                                 const char *limit, uint64_t available)
{
    return turner_fail(TURNER_DEVICE,
                       "%s: %llu bytes (%.2f GiB) wanted, but %s %llu bytes (%.2f GiB) on %s; "
                       "render a smaller picture or scene",
                       what, (unsigned long long)wanted, (double)wanted / (1 << 30), limit,
                       (unsigned long long)available, (double)available / (1 << 30),
                       gpu->info.name);
}

static enum turner_result allocate(struct turner_buffer *buffer, struct turner_gpu *gpu,
                                   enum turner_memory memory, const char *what)
{
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(gpu->device, buffer->buffer, &needs);
    uint32_t type = find_type(gpu, needs.memoryTypeBits, memory);
    if (type == UINT32_MAX)
        return turner_fail(TURNER_DEVICE, "%s: %s has no memory that fits", what, gpu->info.name);
    if (needs.size > gpu->info.max_allocation)
        return refuse(gpu, what, needs.size, "one allocation may have", gpu->info.max_allocation);
    uint64_t available = heap_available(gpu, gpu->memory.memoryTypes[type].heapIndex);
    if (needs.size > available)
        return refuse(gpu, what, needs.size, "there are", available);

    VkMemoryAllocateFlagsInfo flags = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO,
        .flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT,
    };
    VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .pNext = &flags,
        .allocationSize = needs.size,
        .memoryTypeIndex = type,
    };
    VkResult allocated = vkAllocateMemory(gpu->device, &info, NULL, &buffer->memory);
    if (allocated == VK_ERROR_OUT_OF_DEVICE_MEMORY || allocated == VK_ERROR_OUT_OF_HOST_MEMORY)
        return refuse(gpu, what, needs.size, "the driver gave none of its", available);
    VK_TRY(allocated);
    buffer->allocated = needs.size;
    gpu->memory_used += needs.size;
    if (gpu->memory_used > gpu->memory_peak)
        gpu->memory_peak = gpu->memory_used;
    VK_TRY(vkBindBufferMemory(gpu->device, buffer->buffer, buffer->memory, 0));
    VkMemoryPropertyFlags properties = gpu->memory.memoryTypes[type].propertyFlags;
    if ((properties & HOST_FLAGS) == HOST_FLAGS)
        VK_TRY(vkMapMemory(gpu->device, buffer->memory, 0, VK_WHOLE_SIZE, 0, &buffer->mapped));
    return TURNER_OK;
}

enum turner_result turner_buffer_create(struct turner_buffer *buffer, struct turner_gpu *gpu,
                                        VkDeviceSize size, VkBufferUsageFlags extra,
                                        enum turner_memory memory, const char *what)
{
    *buffer = (struct turner_buffer){0};
    if (size < SMALLEST_BUFFER)
        size = SMALLEST_BUFFER;
    if (size > gpu->info.max_buffer)
        return refuse(gpu, what, size, "one buffer may have", gpu->info.max_buffer);
    buffer->size = size;

    enum turner_result result = TURNER_OK;
    VkBufferCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
                 VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT | extra,
    };
    VK_TRY_DONE(vkCreateBuffer(gpu->device, &create, NULL, &buffer->buffer));
    TURNER_TRY_DONE(allocate(buffer, gpu, memory, what));
    VkBufferDeviceAddressInfo address = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO,
        .buffer = buffer->buffer,
    };
    buffer->address = vkGetBufferDeviceAddress(gpu->device, &address);
    return TURNER_OK;
done:
    turner_buffer_destroy(gpu, buffer);
    return result;
}

void turner_buffer_destroy(struct turner_gpu *gpu, struct turner_buffer *buffer)
{
    if (gpu->device && !gpu->hung) {
        vkDestroyBuffer(gpu->device, buffer->buffer, NULL);
        vkFreeMemory(gpu->device, buffer->memory, NULL);
    }
    gpu->memory_used -= buffer->allocated;
    *buffer = (struct turner_buffer){0};
}

/* Copies by way of a staging buffer, from `data` to the device or, if `back`, the other way. */
static enum turner_result copy_staged(struct turner_gpu *gpu, const struct turner_buffer *buffer,
                                      VkDeviceSize offset, char *data, VkDeviceSize size, bool back)
{
    struct turner_buffer staging;
    VkDeviceSize piece = size < STAGING_BYTES ? size : STAGING_BYTES;
    TURNER_TRY(turner_buffer_create(&staging, gpu, piece, 0, TURNER_MEMORY_HOST, "staging"));
    enum turner_result result = TURNER_OK;
    for (VkDeviceSize done = 0; done < size && result == TURNER_OK; done += piece) {
        VkDeviceSize length = size - done < piece ? size - done : piece;
        VkBufferCopy region = {.srcOffset = back ? offset + done : 0,
                               .dstOffset = back ? 0 : offset + done,
                               .size = length};
        if (!back)
            memcpy(staging.mapped, data + done, length);
        VkCommandBuffer commands;
        TURNER_TRY_DONE(turner_gpu_begin(gpu, &commands));
        vkCmdCopyBuffer(commands, back ? buffer->buffer : staging.buffer,
                        back ? staging.buffer : buffer->buffer, 1, &region);
        TURNER_TRY_DONE(turner_gpu_submit_wait(gpu, commands));
        if (back)
            memcpy(data + done, staging.mapped, length);
    }
done:
    turner_buffer_destroy(gpu, &staging);
    return result;
}

enum turner_result turner_buffer_upload(struct turner_gpu *gpu, const struct turner_buffer *buffer,
                                        VkDeviceSize offset, const void *data, VkDeviceSize size)
{
    assert(offset <= buffer->size && size <= buffer->size - offset);
    if (size == 0)
        return TURNER_OK;
    if (!buffer->mapped)
        return copy_staged(gpu, buffer, offset, (char *)data, size, false);
    memcpy((char *)buffer->mapped + offset, data, size);
    return TURNER_OK;
}

enum turner_result turner_buffer_download(struct turner_gpu *gpu,
                                          const struct turner_buffer *buffer, VkDeviceSize offset,
                                          void *data, VkDeviceSize size)
{
    assert(offset <= buffer->size && size <= buffer->size - offset);
    if (size == 0)
        return TURNER_OK;
    if (!buffer->mapped)
        return copy_staged(gpu, buffer, offset, data, size, true);
    memcpy(data, (const char *)buffer->mapped + offset, size);
    return TURNER_OK;
}
