/* The SPIR-V of the kernel that most pictures are drawn with where there is no GPU, compiled when turner
 * is built (tools/prebuild.c): nobody waits for glslang but those who change shaders. */
#ifndef TURNER_GPU_PREBUILT_H
#define TURNER_GPU_PREBUILT_H

#include <stddef.h>
#include <stdint.h>

struct turner_prebuilt {
    uint64_t key; /* turner_compile_key */
    size_t count; /* words */
    const uint32_t *words;
};

/* Absent, at address 0, from programs that are linked without it. */
extern const struct turner_prebuilt turner_prebuilt __attribute__((weak));

#endif
