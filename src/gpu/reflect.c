#include <spirv_cross_c.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/program.h"

static enum turner_result fail_reflection(spvc_context context)
{
    return turner_fail(TURNER_BAD_INPUT, "SPIR-V reflection: %s",
                       spvc_context_get_last_error_string(context));
}

#define SPVC_TRY(call)                       \
    do {                                     \
        if ((call) != SPVC_SUCCESS)          \
            return fail_reflection(context); \
    } while (0)

/* On success and on failure the caller destroys *context, which owns all the rest. */
static enum turner_result open_spirv(spvc_context *out, spvc_compiler *compiler,
                                     const struct turner_spirv *spirv)
{
    spvc_parsed_ir ir;
    if (spvc_context_create(out) != SPVC_SUCCESS) {
        *out = NULL;
        return turner_fail(TURNER_DEVICE, "SPIRV-Cross cannot be initialised");
    }
    spvc_context context = *out;
    SPVC_TRY(spvc_context_parse_spirv(context, spirv->words, spirv->count, &ir));
    SPVC_TRY(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir,
                                          SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, compiler));
    return TURNER_OK;
}

static enum turner_result add_bindings(struct turner_reflection *reflection, spvc_context context,
                                       spvc_compiler compiler, spvc_resources resources,
                                       spvc_resource_type from, VkDescriptorType type)
{
    const spvc_reflected_resource *list;
    size_t count;
    SPVC_TRY(spvc_resources_get_resource_list_for_type(resources, from, &list, &count));
    for (size_t i = 0; i < count; i++) {
        const char *name = spvc_compiler_get_name(compiler, list[i].id);
        if (!name || !*name)
            name = list[i].name;
        unsigned set =
            spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationDescriptorSet);
        spvc_type handle = spvc_compiler_get_type_handle(compiler, list[i].type_id);
        if (set != 0 || spvc_type_get_num_array_dimensions(handle) != 0)
            return turner_fail(TURNER_BAD_INPUT, "%s: only set 0 and single resources can be bound",
                               name);
        if (reflection->binding_count == TURNER_MAX_BINDINGS)
            return turner_fail(TURNER_BAD_INPUT, "%s: more than %d bindings", name,
                               TURNER_MAX_BINDINGS);
        uint32_t binding = spvc_compiler_get_decoration(compiler, list[i].id, SpvDecorationBinding);
        for (uint32_t j = 0; j < reflection->binding_count; j++) {
            if (reflection->bindings[j].binding == binding)
                return turner_fail(TURNER_BAD_INPUT, "%s: binding %u is declared twice", name,
                                   binding);
        }
        reflection->bindings[reflection->binding_count++] = (struct turner_binding){binding, type};
    }
    return TURNER_OK;
}

static enum turner_result reflect_resources(struct turner_reflection *reflection,
                                            spvc_context context, spvc_compiler compiler)
{
    static const spvc_resource_type refused[] = {
        SPVC_RESOURCE_TYPE_UNIFORM_BUFFER,    SPVC_RESOURCE_TYPE_STORAGE_IMAGE,
        SPVC_RESOURCE_TYPE_SAMPLED_IMAGE,     SPVC_RESOURCE_TYPE_SEPARATE_IMAGE,
        SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS,
    };
    spvc_resources resources;
    const spvc_reflected_resource *list;
    size_t count;
    SPVC_TRY(spvc_compiler_create_shader_resources(compiler, &resources));
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        SPVC_TRY(spvc_resources_get_resource_list_for_type(resources, refused[i], &list, &count));
        if (count)
            return turner_fail(TURNER_BAD_INPUT,
                               "%s: only buffers and acceleration structures can be bound",
                               list[0].name);
    }
    TURNER_TRY(add_bindings(reflection, context, compiler, resources,
                            SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER));
    TURNER_TRY(add_bindings(reflection, context, compiler, resources,
                            SPVC_RESOURCE_TYPE_ACCELERATION_STRUCTURE,
                            VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR));
    SPVC_TRY(spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT,
                                                       &list, &count));
    if (count) {
        size_t size;
        SPVC_TRY(spvc_compiler_get_declared_struct_size(
            compiler, spvc_compiler_get_type_handle(compiler, list[0].base_type_id), &size));
        reflection->push_size = (uint32_t)(size + 3) / 4 * 4;
    }
    return TURNER_OK;
}

static enum turner_result reflect_constants(struct turner_reflection *reflection,
                                            spvc_context context, spvc_compiler compiler)
{
    const spvc_specialization_constant *constants;
    SPVC_TRY(spvc_compiler_get_specialization_constants(compiler, &constants,
                                                        &reflection->constant_count));
    reflection->constant_ids =
        turner_calloc(reflection->constant_count, sizeof *reflection->constant_ids);
    for (size_t i = 0; i < reflection->constant_count; i++)
        reflection->constant_ids[i] = constants[i].constant_id;

    spvc_specialization_constant sizes[3];
    spvc_compiler_get_work_group_size_specialization_constants(compiler, &sizes[0], &sizes[1],
                                                               &sizes[2]);
    for (unsigned i = 0; i < 3; i++) {
        reflection->local_size_id[i] = UINT32_MAX;
        reflection->local_size[i] = spvc_compiler_get_execution_mode_argument_by_index(
            compiler, SpvExecutionModeLocalSize, i);
        if (sizes[i].id) {
            reflection->local_size_id[i] = sizes[i].constant_id;
            reflection->local_size[i] = spvc_constant_get_scalar_u32(
                spvc_compiler_get_constant_handle(compiler, sizes[i].id), 0, 0);
        }
    }
    return TURNER_OK;
}

enum turner_result turner_reflect(struct turner_reflection *reflection,
                                  const struct turner_spirv *spirv)
{
    *reflection = (struct turner_reflection){0};
    spvc_context context;
    spvc_compiler compiler;
    enum turner_result result = open_spirv(&context, &compiler, spirv);
    if (result == TURNER_OK &&
        spvc_compiler_get_execution_model(compiler) != SpvExecutionModelGLCompute)
        result = turner_fail(TURNER_BAD_INPUT, "not a compute shader");
    if (result == TURNER_OK)
        result = reflect_resources(reflection, context, compiler);
    if (result == TURNER_OK)
        result = reflect_constants(reflection, context, compiler);
    if (context)
        spvc_context_destroy(context);
    return result;
}

void turner_reflection_destroy(struct turner_reflection *reflection)
{
    free(reflection->constant_ids);
    *reflection = (struct turner_reflection){0};
}

/* The type called `name` whose members have offsets: glslang declares a struct once as it lies in
 * buffers and, where the shader also has variables of it, once more without. */
static spvc_type find_struct(spvc_compiler compiler, const char *name, SpvId *id)
{
    SpvId bound = spvc_compiler_get_current_id_bound(compiler);
    for (*id = 1; *id < bound; ++*id) {
        const char *other = spvc_compiler_get_name(compiler, *id);
        if (other && strcmp(other, name) == 0 &&
            spvc_compiler_has_member_decoration(compiler, *id, 0, SpvDecorationOffset))
            return spvc_compiler_get_type_handle(compiler, *id);
    }
    return NULL;
}

static uint32_t find_stride(spvc_compiler compiler, SpvId struct_id)
{
    SpvId bound = spvc_compiler_get_current_id_bound(compiler);
    for (SpvId id = 1; id < bound; id++) {
        if (!spvc_compiler_has_decoration(compiler, id, SpvDecorationArrayStride))
            continue;
        spvc_type type = spvc_compiler_get_type_handle(compiler, id);
        if (type && spvc_type_get_base_type_id(type) == struct_id &&
            spvc_type_get_num_array_dimensions(type) == 1)
            return spvc_compiler_get_decoration(compiler, id, SpvDecorationArrayStride);
    }
    return 0;
}

enum turner_result turner_reflect_struct(const struct turner_spirv *spirv, const char *name,
                                         turner_member member, void *user, uint32_t *stride)
{
    *stride = 0;
    spvc_context context;
    spvc_compiler compiler;
    enum turner_result result = open_spirv(&context, &compiler, spirv);
    SpvId id;
    spvc_type type = result == TURNER_OK ? find_struct(compiler, name, &id) : NULL;
    if (result == TURNER_OK && !type)
        result = turner_fail(TURNER_BAD_INPUT, "the shader has no struct %s in a buffer", name);
    for (unsigned i = 0; type && i < spvc_type_get_num_member_types(type); i++) {
        unsigned offset = spvc_compiler_get_member_decoration(compiler, id, i, SpvDecorationOffset);
        size_t size = 0;
        if (spvc_compiler_get_declared_struct_member_size(compiler, type, i, &size) !=
            SPVC_SUCCESS) {
            result = fail_reflection(context);
            break;
        }
        member(user, spvc_compiler_get_member_name(compiler, id, i), offset, (uint32_t)size);
    }
    if (type && result == TURNER_OK)
        *stride = find_stride(compiler, id);
    if (context)
        spvc_context_destroy(context);
    return result;
}
