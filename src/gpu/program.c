#include "gpu/program.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/shader_object.h"

static enum turner_result check_limits(const struct turner_program *program,
                                       const struct turner_gpu *gpu)
{
    const struct turner_gpu_info *info = &gpu->info;
    const uint32_t *size = program->local_size;
    bool fits = (uint64_t)size[0] * size[1] * size[2] <= info->max_workgroup_invocations;
    for (int i = 0; i < 3; i++)
        fits &= size[i] > 0 && size[i] <= info->max_workgroup_size[i];
    if (!fits)
        return turner_fail(TURNER_DEVICE,
                           "a workgroup of %u×%u×%u does not fit %s (at most %u×%u×%u, %u in all)",
                           size[0], size[1], size[2], info->name, info->max_workgroup_size[0],
                           info->max_workgroup_size[1], info->max_workgroup_size[2],
                           info->max_workgroup_invocations);
    if (program->push_size > info->max_push_constants)
        return turner_fail(TURNER_DEVICE, "%u bytes of push constants, %s takes %u",
                           program->push_size, info->name, info->max_push_constants);
    return TURNER_OK;
}

static enum turner_result create_set(struct turner_program *program, struct turner_gpu *gpu)
{
    VkDescriptorSetLayoutBinding bindings[TURNER_MAX_BINDINGS];
    VkDescriptorPoolSize sizes[TURNER_MAX_BINDINGS];
    for (uint32_t i = 0; i < program->binding_count; i++) {
        bindings[i] = (VkDescriptorSetLayoutBinding){
            .binding = program->bindings[i].binding,
            .descriptorType = program->bindings[i].type,
            .descriptorCount = 1,
            .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT,
        };
        sizes[i] = (VkDescriptorPoolSize){program->bindings[i].type, 1};
    }
    VkDescriptorSetLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
        .bindingCount = program->binding_count,
        .pBindings = bindings,
    };
    VK_TRY(vkCreateDescriptorSetLayout(gpu->device, &layout, NULL, &program->set_layout));
    VkDescriptorPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
        .maxSets = 1,
        .poolSizeCount = program->binding_count,
        .pPoolSizes = sizes,
    };
    VK_TRY(vkCreateDescriptorPool(gpu->device, &pool, NULL, &program->pool));
    VkDescriptorSetAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
        .descriptorPool = program->pool,
        .descriptorSetCount = 1,
        .pSetLayouts = &program->set_layout,
    };
    VK_TRY(vkAllocateDescriptorSets(gpu->device, &allocate, &program->set));
    return TURNER_OK;
}

static enum turner_result create_pipeline(struct turner_program *program, struct turner_gpu *gpu,
                                          const struct turner_spirv *spirv,
                                          const VkSpecializationInfo *specialisation, bool full)
{
    VkShaderModuleCreateInfo module = {
        .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO,
        .codeSize = spirv->count * sizeof *spirv->words,
        .pCode = spirv->words,
    };
    VK_TRY(vkCreateShaderModule(gpu->device, &module, NULL, &program->module));
    VkComputePipelineCreateInfo pipeline = {
        .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
        .stage = {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                  .flags = full ? VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT : 0,
                  .stage = VK_SHADER_STAGE_COMPUTE_BIT,
                  .module = program->module,
                  .pName = "main",
                  .pSpecializationInfo = specialisation},
        .layout = program->layout,
        .basePipelineIndex = -1,
    };
    VK_TRY(vkCreateComputePipelines(gpu->device, VK_NULL_HANDLE, 1, &pipeline, NULL,
                                    &program->pipeline));
    return TURNER_OK;
}

static enum turner_result create_kernel(struct turner_program *program, struct turner_gpu *gpu,
                                        const struct turner_spirv *spirv,
                                        const VkSpecializationInfo *specialisation, bool no_cache)
{
    VkPushConstantRange range = {VK_SHADER_STAGE_COMPUTE_BIT, 0, program->push_size};
    VkPipelineLayoutCreateInfo layout = {
        .sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
        .setLayoutCount = program->set_layout ? 1 : 0,
        .pSetLayouts = &program->set_layout,
        .pushConstantRangeCount = program->push_size ? 1 : 0,
        .pPushConstantRanges = &range,
    };
    VK_TRY(vkCreatePipelineLayout(gpu->device, &layout, NULL, &program->layout));
    bool full = gpu->info.packets && program->local_size[0] % gpu->info.subgroup_size == 0;
    if (!gpu->create_shaders)
        return create_pipeline(program, gpu, spirv, specialisation, full);
    VkShaderCreateInfoEXT shader = {
        .sType = VK_STRUCTURE_TYPE_SHADER_CREATE_INFO_EXT,
        .flags = full ? VK_SHADER_CREATE_REQUIRE_FULL_SUBGROUPS_BIT_EXT : 0,
        .stage = VK_SHADER_STAGE_COMPUTE_BIT,
        .codeType = VK_SHADER_CODE_TYPE_SPIRV_EXT,
        .codeSize = spirv->count * sizeof *spirv->words,
        .pCode = spirv->words,
        .pName = "main",
        .setLayoutCount = layout.setLayoutCount,
        .pSetLayouts = layout.pSetLayouts,
        .pushConstantRangeCount = layout.pushConstantRangeCount,
        .pPushConstantRanges = layout.pPushConstantRanges,
        .pSpecializationInfo = specialisation,
    };
    program->bind_shaders = gpu->cmd_bind_shaders;
    return turner_shader_object_create(&program->shader, gpu, &shader, no_cache,
                                       &program->cached);
}

enum turner_result turner_program_create(struct turner_program *program, struct turner_gpu *gpu,
                                         const struct turner_spirv *spirv,
                                         const struct turner_constant *constants, size_t count,
                                         bool no_cache)
{
    *program = (struct turner_program){0};
    struct turner_reflection reflection;
    VkSpecializationMapEntry *entries = turner_calloc(count, sizeof *entries);
    enum turner_result result = turner_reflect(&reflection, spirv);
    if (result != TURNER_OK)
        goto done;
    memcpy(program->bindings, reflection.bindings, sizeof program->bindings);
    program->binding_count = reflection.binding_count;
    program->push_size = reflection.push_size;
    memcpy(program->local_size, reflection.local_size, sizeof program->local_size);

    VkSpecializationInfo specialisation = {
        .pMapEntries = entries, .dataSize = count * sizeof *constants, .pData = constants};
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < reflection.constant_count; j++) {
            if (reflection.constant_ids[j] != constants[i].id)
                continue;
            entries[specialisation.mapEntryCount++] = (VkSpecializationMapEntry){
                .constantID = constants[i].id,
                .offset = (uint32_t)((const char *)&constants[i].value - (const char *)constants),
                .size = sizeof constants[i].value,
            };
            break; /* the same id may be there twice */
        }
        for (int axis = 0; axis < 3; axis++) {
            if (reflection.local_size_id[axis] == constants[i].id)
                program->local_size[axis] = constants[i].value;
        }
    }
    TURNER_TRY_DONE(check_limits(program, gpu));
    if (program->binding_count)
        TURNER_TRY_DONE(create_set(program, gpu));
    TURNER_TRY_DONE(create_kernel(program, gpu, spirv, &specialisation, no_cache));
done:
    turner_reflection_destroy(&reflection);
    free(entries);
    if (result != TURNER_OK)
        turner_program_destroy(gpu, program);
    return result;
}

void turner_program_destroy(struct turner_gpu *gpu, struct turner_program *program)
{
    if (gpu->device && !gpu->hung) {
        if (program->shader)
            gpu->destroy_shader(gpu->device, program->shader, NULL);
        vkDestroyPipeline(gpu->device, program->pipeline, NULL);
        vkDestroyShaderModule(gpu->device, program->module, NULL);
        vkDestroyPipelineLayout(gpu->device, program->layout, NULL);
        vkDestroyDescriptorPool(gpu->device, program->pool, NULL);
        vkDestroyDescriptorSetLayout(gpu->device, program->set_layout, NULL);
    }
    *program = (struct turner_program){0};
}

/* Whether the shader has the binding; TURNER_BAD_INPUT when it declares something else there. */
static enum turner_result find_binding(bool *found, const struct turner_program *program,
                                       uint32_t binding, VkDescriptorType type)
{
    *found = false;
    for (uint32_t i = 0; i < program->binding_count; i++) {
        if (program->bindings[i].binding != binding)
            continue;
        if (program->bindings[i].type != type)
            return turner_fail(TURNER_BAD_INPUT, "the shader's binding %u must be %s", binding,
                               type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER
                                   ? "a buffer"
                                   : "an accelerationStructureEXT");
        *found = true;
    }
    return TURNER_OK;
}

enum turner_result turner_program_bind_buffer(struct turner_program *program,
                                              struct turner_gpu *gpu, uint32_t binding,
                                              const struct turner_buffer *buffer)
{
    bool found;
    TURNER_TRY(find_binding(&found, program, binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
    if (!found)
        return TURNER_OK;
    if (buffer->size > gpu->info.max_storage_range)
        return turner_fail(TURNER_DEVICE,
                           "binding %u has %llu bytes, a descriptor of %s reaches %llu", binding,
                           (unsigned long long)buffer->size, gpu->info.name,
                           (unsigned long long)gpu->info.max_storage_range);
    VkDescriptorBufferInfo info = {buffer->buffer, 0, VK_WHOLE_SIZE};
    VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .dstSet = program->set,
        .dstBinding = binding,
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        .pBufferInfo = &info,
    };
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    return TURNER_OK;
}

enum turner_result turner_program_bind_acceleration(struct turner_program *program,
                                                    struct turner_gpu *gpu, uint32_t binding,
                                                    VkAccelerationStructureKHR acceleration)
{
    bool found;
    TURNER_TRY(
        find_binding(&found, program, binding, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR));
    if (!found)
        return TURNER_OK;
    VkWriteDescriptorSetAccelerationStructureKHR info = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET_ACCELERATION_STRUCTURE_KHR,
        .accelerationStructureCount = 1,
        .pAccelerationStructures = &acceleration,
    };
    VkWriteDescriptorSet write = {
        .sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
        .pNext = &info,
        .dstSet = program->set,
        .dstBinding = binding,
        .descriptorCount = 1,
        .descriptorType = VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR,
    };
    vkUpdateDescriptorSets(gpu->device, 1, &write, 0, NULL);
    return TURNER_OK;
}

void turner_program_dispatch(VkCommandBuffer commands, const struct turner_program *program,
                             const void *push, uint32_t x, uint32_t y, uint32_t z)
{
    static const VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT;
    if (program->shader)
        program->bind_shaders(commands, 1, &stage, &program->shader);
    else
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program->pipeline);
    if (program->set)
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, program->layout, 0, 1,
                                &program->set, 0, NULL);
    if (program->push_size)
        vkCmdPushConstants(commands, program->layout, VK_SHADER_STAGE_COMPUTE_BIT, 0,
                           program->push_size, push);
    vkCmdDispatch(commands, x, y, z);
}
