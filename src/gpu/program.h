/* A compute shader ready to run. What it binds comes from the SPIR-V, nothing is typed twice. */
#ifndef TURNER_GPU_PROGRAM_H
#define TURNER_GPU_PROGRAM_H

#include "gpu/compiler.h"
#include "gpu/device.h"
#include "gpu/memory.h"

#define TURNER_MAX_BINDINGS 16

struct turner_constant {
    uint32_t id;    /* constant_id in the shader */
    uint32_t value; /* bits of a bool (0, 1), int, uint or float */
};

struct turner_binding {
    uint32_t binding;
    VkDescriptorType type; /* storage buffer or acceleration structure */
};

/* What a shader declares. */
struct turner_reflection {
    struct turner_binding bindings[TURNER_MAX_BINDINGS]; /* of set 0 */
    uint32_t binding_count;
    uint32_t push_size;        /* bytes of the push constant block; 0 without */
    uint32_t local_size[3];    /* defaults, where a constant gives it */
    uint32_t local_size_id[3]; /* that constant's id; UINT32_MAX when fixed */
    uint32_t *constant_ids;    /* specialisation constants the shader has; may repeat */
    size_t constant_count;
};

struct turner_program {
    VkShaderModule module; /* with a pipeline; both null with a shader */
    VkPipeline pipeline;
    VkShaderEXT shader;
    PFN_vkCmdBindShadersEXT bind_shaders;
    bool cached; /* the shader came from the cache */
    VkDescriptorSetLayout set_layout; /* null when the shader binds nothing */
    VkPipelineLayout layout;
    VkDescriptorPool pool;
    VkDescriptorSet set;
    struct turner_binding bindings[TURNER_MAX_BINDINGS];
    uint32_t binding_count;
    uint32_t push_size;     /* bytes */
    uint32_t local_size[3]; /* with the constants applied */
};

/* Reads what a compute shader declares. TURNER_BAD_INPUT for SPIR-V that is not a compute shader,
 * or binds what turner has no use for (other sets, images, arrays of descriptors). */
enum turner_result turner_reflect(struct turner_reflection *reflection,
                                  const struct turner_spirv *spirv);
void turner_reflection_destroy(struct turner_reflection *reflection);

/* Builds the kernel. Constants whose id the shader lacks are ignored (what no scene needs may be
 * absent), so are those it has and that are not given (they keep their default). What the driver
 * makes of it may be kept on disk (gpu/shader_object.h), unless no_cache. TURNER_DEVICE when the
 * device cannot (local size, push constants). */
enum turner_result turner_program_create(struct turner_program *program, struct turner_gpu *gpu,
                                         const struct turner_spirv *spirv,
                                         const struct turner_constant *constants, size_t count,
                                         bool no_cache);
void turner_program_destroy(struct turner_gpu *gpu, struct turner_program *program);

/* Whether it was made, and not destroyed. */
static inline bool turner_program_exists(const struct turner_program *program)
{
    return program->layout != VK_NULL_HANDLE;
}

/* Binds one resource, not while a dispatch runs. A binding that the shader does not have is
 * ignored. TURNER_BAD_INPUT when it declares something else there, TURNER_DEVICE when `buffer` is
 * larger than a descriptor reaches. */
enum turner_result turner_program_bind_buffer(struct turner_program *program,
                                              struct turner_gpu *gpu, uint32_t binding,
                                              const struct turner_buffer *buffer);
enum turner_result turner_program_bind_acceleration(struct turner_program *program,
                                                    struct turner_gpu *gpu, uint32_t binding,
                                                    VkAccelerationStructureKHR acceleration);

/* Records pipeline, descriptors, push constants (push_size bytes at `push`, NULL when 0) and a
 * dispatch of x × y × z workgroups. */
void turner_program_dispatch(VkCommandBuffer commands, const struct turner_program *program,
                             const void *push, uint32_t x, uint32_t y, uint32_t z);

/* For tests of the structs shared between C and GLSL: calls `member` for each member of the struct
 * `name` as laid out in buffers, in order, then sets *stride to the distance of two in an array (0
 * when the shader has no array of them). TURNER_BAD_INPUT when the shader has no such struct. */
typedef void (*turner_member)(void *user, const char *name, uint32_t offset, uint32_t size);
enum turner_result turner_reflect_struct(const struct turner_spirv *spirv, const char *name,
                                         turner_member member, void *user, uint32_t *stride);

#endif
