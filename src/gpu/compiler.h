/* GLSL to SPIR-V with glslang. */
#ifndef TURNER_GPU_COMPILER_H
#define TURNER_GPU_COMPILER_H

#include "base/result.h"
#include "gpu/include.h"

struct turner_spirv {
    uint32_t *words;
    size_t count; /* words */
};

/* Compiles a compute shader for Vulkan 1.3 (SPIR-V 1.6). `defines` are "NAME" or "NAME=value".
 * Thread-safe: one at a time is compiled. TURNER_BAD_INPUT with one "file:line:column: message" a line, the
 * line of source below the first. Builds with assertions, and TURNER_VALIDATION=1, also validate
 * the result with spirv-val. Free with turner_spirv_destroy. */
enum turner_result turner_compile(struct turner_spirv *out,
                                  const struct turner_shader_source *source,
                                  const char *const *defines, size_t define_count);
void turner_spirv_destroy(struct turner_spirv *spirv);

/* Has glslang read what GLSL has built in, which the first turner_compile of a process waits for. */
void turner_compiler_warm(void);

/* TURNER_BAD_INPUT with the validator's message unless `spirv` is valid for Vulkan 1.3 with scalar
 * block layout. */
enum turner_result turner_spirv_validate(const struct turner_spirv *spirv);

/* Builds with assertions, and TURNER_VALIDATION=1, do. */
bool turner_spirv_wants_validation(void);

/* Name and version of the libraries that compile and specialise. */
void turner_compiler_libraries(char text[256]);

#endif
