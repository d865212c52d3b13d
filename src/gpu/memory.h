/* Buffers on the device, each with its own allocation. */
#ifndef TURNER_GPU_MEMORY_H
#define TURNER_GPU_MEMORY_H

#include "gpu/device.h"

enum turner_memory {
    TURNER_MEMORY_DEVICE, /* fast for shaders; mapped too where the device shares its memory */
    TURNER_MEMORY_HOST    /* always mapped and coherent, cached where possible */
};

struct turner_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    VkDeviceSize size;       /* bytes, as asked for, at least 16 */
    VkDeviceSize allocated;  /* bytes taken from the heap */
    VkDeviceAddress address; /* for buffer_reference; a multiple of 16 */
    void *mapped;            /* NULL when the host cannot reach it */
};

/* A buffer of `size` bytes (0 makes 16), contents undefined, for storage, addresses and copies, and
 * for `extra`. `what` names it in messages ("triangles"). TURNER_DEVICE with the bytes wanted and
 * available when it is larger than one buffer may be or than the memory that is left; nothing is
 * allocated then. */
enum turner_result turner_buffer_create(struct turner_buffer *buffer, struct turner_gpu *gpu,
                                        VkDeviceSize size, VkBufferUsageFlags extra,
                                        enum turner_memory memory, const char *what);
void turner_buffer_destroy(struct turner_gpu *gpu, struct turner_buffer *buffer);

/* Copies `size` bytes to or from `buffer` at `offset` and returns when it is done: directly where
 * it is mapped, else by way of a staging buffer of at most 64 MiB. The range must lie inside. */
enum turner_result turner_buffer_upload(struct turner_gpu *gpu, const struct turner_buffer *buffer,
                                        VkDeviceSize offset, const void *data, VkDeviceSize size);
enum turner_result turner_buffer_download(struct turner_gpu *gpu,
                                          const struct turner_buffer *buffer, VkDeviceSize offset,
                                          void *data, VkDeviceSize size);

/* Bytes that may still be allocated from the heap such buffers come from: what the driver's budget
 * or the heap's size leaves, and on a device that shares the host's memory no more than that has.
 */
uint64_t turner_gpu_memory_available(const struct turner_gpu *gpu, enum turner_memory memory);

#endif
