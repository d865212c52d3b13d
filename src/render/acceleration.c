/* The device's own acceleration structures over the flat scene. */
#include <stdlib.h>

#include "base/memory.h"
#include "render/device_scene.h"

/* Corners lie three vec3 apart in records of 48 bytes, which is four: vertex 4r + k. */
static enum turner_result build_triangles(struct turner_accel *accel, struct turner_gpu *gpu,
                                          const struct turner_buffer *primitives,
                                          const struct turner_flat_group *group)
{
    uint32_t(*indices)[3] = turner_calloc(group->triangle_count, sizeof *indices);
    for (uint32_t i = 0; i < group->triangle_count; i++) {
        for (uint32_t k = 0; k < 3; k++)
            indices[i][k] = 4 * i + k;
    }
    size_t bytes = group->triangle_count * sizeof *indices;
    struct turner_buffer buffer = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_buffer_create(&buffer, gpu, bytes, TURNER_ACCEL_INPUT,
                                         TURNER_MEMORY_DEVICE, "triangle indices"));
    TURNER_TRY_DONE(turner_buffer_upload(gpu, &buffer, 0, indices, bytes));
    VkDeviceAddress first =
        primitives->address + (uint64_t)group->triangles * sizeof(struct turner_gpu_primitive);
    TURNER_TRY_DONE(turner_accel_build_triangles(accel, gpu, first, 3 * sizeof(float),
                                                 4 * group->triangle_count, buffer.address,
                                                 group->triangle_count, 0));
done:
    turner_buffer_destroy(gpu, &buffer);
    free(indices);
    return result;
}

static enum turner_result build_boxes(struct turner_accel *accel, struct turner_gpu *gpu,
                                      const struct turner_flat *flat,
                                      const struct turner_flat_group *group)
{
    VkAabbPositionsKHR *boxes = turner_calloc(group->box_count, sizeof *boxes);
    for (uint32_t i = 0; i < group->box_count; i++) {
        float lo[3], hi[3];
        turner_primitive_bounds(lo, hi, &flat->primitives[group->boxes + i]);
        boxes[i] = (VkAabbPositionsKHR){lo[0], lo[1], lo[2], hi[0], hi[1], hi[2]};
    }
    size_t bytes = group->box_count * sizeof *boxes;
    struct turner_buffer buffer = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_buffer_create(&buffer, gpu, bytes, TURNER_ACCEL_INPUT,
                                         TURNER_MEMORY_DEVICE, "boxes"));
    TURNER_TRY_DONE(turner_buffer_upload(gpu, &buffer, 0, boxes, bytes));
    TURNER_TRY_DONE(turner_accel_build_boxes(accel, gpu, buffer.address, group->box_count, 0));
done:
    turner_buffer_destroy(gpu, &buffer);
    free(boxes);
    return result;
}

static VkAccelerationStructureInstanceKHR top_instance(const struct turner_flat *flat,
                                                       size_t instance, VkDeviceAddress group)
{
    VkAccelerationStructureInstanceKHR entry = {
        .instanceCustomIndex = (uint32_t)instance & 0xffffff,
        .mask = 0xff,
        .accelerationStructureReference = group,
    };
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++)
            entry.transform.matrix[row][column] =
                flat->instances[instance].to_world[4 * row + column];
    }
    return entry;
}

enum turner_result turner_device_scene_build(struct turner_device_scene *device,
                                             struct turner_gpu *gpu,
                                             const struct turner_flat *flat)
{
    uint32_t group_count = 0;
    for (size_t i = 0; i < flat->instance_count; i++) {
        if (flat->instance_groups[i] >= group_count)
            group_count = flat->instance_groups[i] + 1;
    }
    device->accel_count = 2 * (size_t)group_count;
    device->accels = turner_calloc(device->accel_count, sizeof *device->accels);
    for (uint32_t i = 0; i < group_count; i++) {
        const struct turner_flat_group *group = &flat->groups[i];
        if (group->triangle_count)
            TURNER_TRY(build_triangles(&device->accels[2 * i], gpu,
                                       &device->arrays[TURNER_ARRAY_PRIMITIVES], group));
        if (group->box_count)
            TURNER_TRY(build_boxes(&device->accels[2 * i + 1], gpu, flat, group));
    }
    return turner_device_scene_build_top(device, gpu, flat);
}

enum turner_result turner_device_scene_build_top(struct turner_device_scene *device,
                                                 struct turner_gpu *gpu,
                                                 const struct turner_flat *flat)
{
    turner_accel_destroy(gpu, &device->top);
    VkAccelerationStructureInstanceKHR *entries =
        turner_calloc(2 * flat->instance_count, sizeof *entries);
    uint32_t count = 0;
    for (size_t i = 0; i < flat->instance_count; i++) {
        for (int part = 0; part < 2; part++) {
            const struct turner_accel *accel =
                &device->accels[2 * flat->instance_groups[i] + (uint32_t)part];
            if (accel->handle)
                entries[count++] = top_instance(flat, i, accel->address);
        }
    }
    enum turner_result result =
        turner_accel_build_instances(&device->top, gpu, entries, count);
    free(entries);
    return result;
}
