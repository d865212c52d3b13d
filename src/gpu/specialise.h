/* What is left of a shader once its constants are known, without a device: SPIRV-Tools does what a
 * driver's compiler does first. */
#ifndef TURNER_GPU_SPECIALISE_H
#define TURNER_GPU_SPECIALISE_H

#include "gpu/program.h"

/* Writes to `out` (turner_spirv_destroy) the shader with the constants folded in, what cannot run
 * then taken out, and the rest optimised for speed (spirv-opt -O). As with turner_program_create,
 * constants the shader lacks are ignored, and those not given keep their default.
 * TURNER_BAD_INPUT when SPIRV-Tools cannot. */
enum turner_result turner_spirv_specialise(struct turner_spirv *out,
                                           const struct turner_spirv *spirv,
                                           const struct turner_constant *constants, size_t count);

/* The same, but what is left computes as it did, to the last bit: constants are folded in, functions
 * put where they are called, and what cannot run or is not used is taken out, no more. A driver has
 * less than half of the work with it. (The pass of SPIRV-Tools 2023.1 that takes out what is not used
 * crashes on some functions that are called: all must be put in place.) With `soon` constants are
 * folded, what cannot run is taken out, and the rest is left to the driver: that takes a quarter of
 * the time here, and saves more than it costs the driver. */
enum turner_result turner_spirv_reduce(struct turner_spirv *out, const struct turner_spirv *spirv,
                                       const struct turner_constant *constants, size_t count,
                                       bool soon);

#endif
