/* A compute shader as an object (VK_EXT_shader_object) in the place of a pipeline, on devices of
 * software. Mesa's turns SPIR-V into a form of its own each time a pipeline is made, and keeps nothing
 * in a VkPipelineCache; but it gives that form out, and takes it back in a tenth of the time. */
#ifndef TURNER_GPU_SHADER_OBJECT_H
#define TURNER_GPU_SHADER_OBJECT_H

#include "gpu/device.h"

/* Makes a shader of `create`, which is SPIR-V, on a device that has create_shaders. The driver's form
 * comes from the cache, as *cached says, or is kept there, unless no_cache. TURNER_DEVICE when the
 * device fails. */
enum turner_result turner_shader_object_create(VkShaderEXT *shader, struct turner_gpu *gpu,
                                               const VkShaderCreateInfoEXT *create, bool no_cache,
                                               bool *cached);

#endif
