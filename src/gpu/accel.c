#include "gpu/accel.h"

#include <assert.h>

static enum turner_result refuse_count(const struct turner_gpu *gpu, const char *what,
                                       uint32_t count, uint64_t most)
{
    return turner_fail(TURNER_DEVICE,
                       "%u %s, an acceleration structure of %s takes at most %llu; split the mesh "
                       "or use --traversal bvh",
                       count, what, gpu->info.name, (unsigned long long)most);
}

/* Size, memory, scratch, build, wait: the same for every kind. */
static enum turner_result build(struct turner_accel *accel, struct turner_gpu *gpu,
                                VkAccelerationStructureTypeKHR type,
                                const VkAccelerationStructureGeometryKHR *geometry, uint32_t count)
{
    VkAccelerationStructureBuildGeometryInfoKHR info = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_GEOMETRY_INFO_KHR,
        .type = type,
        .flags = VK_BUILD_ACCELERATION_STRUCTURE_PREFER_FAST_TRACE_BIT_KHR,
        .mode = VK_BUILD_ACCELERATION_STRUCTURE_MODE_BUILD_KHR,
        .geometryCount = 1,
        .pGeometries = geometry,
    };
    VkAccelerationStructureBuildSizesInfoKHR sizes = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_BUILD_SIZES_INFO_KHR};
    gpu->get_acceleration_sizes(gpu->device, VK_ACCELERATION_STRUCTURE_BUILD_TYPE_DEVICE_KHR, &info,
                                &count, &sizes);

    struct turner_buffer scratch = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_buffer_create(&accel->buffer, gpu, sizes.accelerationStructureSize,
                                         VK_BUFFER_USAGE_ACCELERATION_STRUCTURE_STORAGE_BIT_KHR,
                                         TURNER_MEMORY_DEVICE, "acceleration structure"));
    VkDeviceSize alignment = gpu->info.scratch_alignment;
    TURNER_TRY_DONE(turner_buffer_create(&scratch, gpu, sizes.buildScratchSize + alignment, 0,
                                         TURNER_MEMORY_DEVICE,
                                         "scratch for an acceleration structure"));
    VkAccelerationStructureCreateInfoKHR create = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_CREATE_INFO_KHR,
        .buffer = accel->buffer.buffer,
        .size = sizes.accelerationStructureSize,
        .type = type,
    };
    VK_TRY_DONE(gpu->create_acceleration(gpu->device, &create, NULL, &accel->handle));

    info.dstAccelerationStructure = accel->handle;
    info.scratchData.deviceAddress = (scratch.address + alignment - 1) / alignment * alignment;
    VkAccelerationStructureBuildRangeInfoKHR range = {.primitiveCount = count};
    const VkAccelerationStructureBuildRangeInfoKHR *ranges = &range;
    VkCommandBuffer commands;
    TURNER_TRY_DONE(turner_gpu_begin(gpu, &commands));
    gpu->cmd_build_accelerations(commands, 1, &info, &ranges);
    turner_gpu_barrier(commands);
    TURNER_TRY_DONE(turner_gpu_submit_wait(gpu, commands));

    VkAccelerationStructureDeviceAddressInfoKHR address = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_DEVICE_ADDRESS_INFO_KHR,
        .accelerationStructure = accel->handle,
    };
    accel->address = gpu->get_acceleration_address(gpu->device, &address);
done:
    turner_buffer_destroy(gpu, &scratch);
    if (result != TURNER_OK)
        turner_accel_destroy(gpu, accel);
    return result;
}

enum turner_result turner_accel_build_triangles(struct turner_accel *accel, struct turner_gpu *gpu,
                                                VkDeviceAddress vertices, uint32_t stride,
                                                uint32_t vertex_count, VkDeviceAddress indices,
                                                uint32_t triangle_count, VkGeometryFlagsKHR flags)
{
    assert(gpu->info.ray_query);
    *accel = (struct turner_accel){0};
    if (triangle_count > gpu->info.max_primitives)
        return refuse_count(gpu, "triangles", triangle_count, gpu->info.max_primitives);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_TRIANGLES_KHR,
        .geometry.triangles =
            {
                .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_TRIANGLES_DATA_KHR,
                .vertexFormat = VK_FORMAT_R32G32B32_SFLOAT,
                .vertexData.deviceAddress = vertices,
                .vertexStride = stride,
                .maxVertex = vertex_count ? vertex_count - 1 : 0,
                .indexType = indices ? VK_INDEX_TYPE_UINT32 : VK_INDEX_TYPE_NONE_KHR,
                .indexData.deviceAddress = indices,
            },
        .flags = flags,
    };
    return build(accel, gpu, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, &geometry,
                 triangle_count);
}

enum turner_result turner_accel_build_boxes(struct turner_accel *accel, struct turner_gpu *gpu,
                                            VkDeviceAddress boxes, uint32_t count,
                                            VkGeometryFlagsKHR flags)
{
    assert(gpu->info.ray_query && boxes % 8 == 0);
    *accel = (struct turner_accel){0};
    if (count > gpu->info.max_primitives)
        return refuse_count(gpu, "primitives", count, gpu->info.max_primitives);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_AABBS_KHR,
        .geometry.aabbs =
            {
                .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_AABBS_DATA_KHR,
                .data.deviceAddress = boxes,
                .stride = sizeof(VkAabbPositionsKHR),
            },
        .flags = flags,
    };
    return build(accel, gpu, VK_ACCELERATION_STRUCTURE_TYPE_BOTTOM_LEVEL_KHR, &geometry, count);
}

enum turner_result turner_accel_build_instances(struct turner_accel *accel, struct turner_gpu *gpu,
                                                const VkAccelerationStructureInstanceKHR *instances,
                                                uint32_t count)
{
    assert(gpu->info.ray_query);
    *accel = (struct turner_accel){0};
    if (count > gpu->info.max_instances)
        return refuse_count(gpu, "instances", count, gpu->info.max_instances);
    struct turner_buffer buffer;
    VkDeviceSize size = (VkDeviceSize)count * sizeof *instances;
    TURNER_TRY(turner_buffer_create(&buffer, gpu, size, TURNER_ACCEL_INPUT, TURNER_MEMORY_DEVICE,
                                    "instances"));
    enum turner_result result = turner_buffer_upload(gpu, &buffer, 0, instances, size);
    VkAccelerationStructureGeometryKHR geometry = {
        .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_KHR,
        .geometryType = VK_GEOMETRY_TYPE_INSTANCES_KHR,
        .geometry.instances =
            {
                .sType = VK_STRUCTURE_TYPE_ACCELERATION_STRUCTURE_GEOMETRY_INSTANCES_DATA_KHR,
                .data.deviceAddress = buffer.address,
            },
    };
    if (result == TURNER_OK)
        result = build(accel, gpu, VK_ACCELERATION_STRUCTURE_TYPE_TOP_LEVEL_KHR, &geometry, count);
    turner_buffer_destroy(gpu, &buffer);
    return result;
}

void turner_accel_destroy(struct turner_gpu *gpu, struct turner_accel *accel)
{
    if (accel->handle && !gpu->hung)
        gpu->destroy_acceleration(gpu->device, accel->handle, NULL);
    turner_buffer_destroy(gpu, &accel->buffer);
    *accel = (struct turner_accel){0};
}
