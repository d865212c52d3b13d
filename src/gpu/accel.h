/* Acceleration structures of VK_KHR_acceleration_structure: sizes, scratch, build, wait. Only with
 * info.ray_query; built for fast tracing, not updated. */
#ifndef TURNER_GPU_ACCEL_H
#define TURNER_GPU_ACCEL_H

#include "gpu/memory.h"

/* Usage flags (turner_buffer_create's `extra`) of buffers that builds read. */
#define TURNER_ACCEL_INPUT VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_BUILD_INPUT_READ_ONLY_BIT_KHR

struct turner_accel {
    VkAccelerationStructureKHR handle;
    struct turner_buffer buffer;
    VkDeviceAddress address; /* for instances */
};

/* Bottom level of triangles. `vertices`: float xyz every `stride` bytes; `indices`: three uint32 a
 * triangle, or 0 when the vertices come in threes. `flags` 0 makes every hit a candidate that the
 * shader must confirm. All build functions return when the build is done and need their input no
 * longer. TURNER_DEVICE with the figure for more primitives than the device takes, or too little
 * memory. No primitive at all is fine: nothing is ever hit. */
enum turner_result turner_accel_build_triangles(struct turner_accel *accel, struct turner_gpu *gpu,
                                                VkDeviceAddress vertices, uint32_t stride,
                                                uint32_t vertex_count, VkDeviceAddress indices,
                                                uint32_t triangle_count, VkGeometryFlagsKHR flags);
/* Bottom level of boxes: VkAabbPositionsKHR, 24 bytes each, at an address divisible by 8. */
enum turner_result turner_accel_build_boxes(struct turner_accel *accel, struct turner_gpu *gpu,
                                            VkDeviceAddress boxes, uint32_t count,
                                            VkGeometryFlagsKHR flags);
/* Top level; `instances` is host memory. */
enum turner_result turner_accel_build_instances(struct turner_accel *accel, struct turner_gpu *gpu,
                                                const VkAccelerationStructureInstanceKHR *instances,
                                                uint32_t count);
void turner_accel_destroy(struct turner_gpu *gpu, struct turner_accel *accel);

#endif
