/* The compiler and what specialises a shader, with their results kept on disk (gpu/cache.h). */
#ifndef TURNER_GPU_CACHED_H
#define TURNER_GPU_CACHED_H

#include "gpu/specialise.h"

/* turner_compile. *found (unless NULL) says whether the cache had it, or the program (gpu/prebuilt.h):
 * glslang then has not run, and is not initialised. What does not compile is not kept. */
enum turner_result turner_compile_cached(struct turner_spirv *out, bool *found,
                                         const struct turner_shader_source *source,
                                         const char *const *defines, size_t define_count);

/* A hash of what the result of turner_compile follows from. */
uint64_t turner_compile_key(const struct turner_shader_source *source, const char *const *defines,
                            size_t define_count);

/* turner_spirv_reduce, likewise. */
enum turner_result turner_spirv_reduce_cached(struct turner_spirv *out, bool *found,
                                              const struct turner_spirv *spirv,
                                              const struct turner_constant *constants,
                                              size_t count, bool soon);

#endif
