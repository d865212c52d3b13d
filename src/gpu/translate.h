/* Drivers that compile for a CPU do so at a program's first dispatch, in the queue, which does
 * nothing else meanwhile. Here that is done beside it. */
#ifndef TURNER_GPU_TRANSLATE_H
#define TURNER_GPU_TRANSLATE_H

#include "gpu/program.h"

/* Has the driver compile a shader without bindings and constants for another device of the same
 * kind, in the caller's thread, so that its cache on disk has the code when `gpu` wants it: in a
 * tenth of the time. Nothing is done for a GPU, whose driver compiles when a pipeline is made. It may
 * fail, or there may be no cache: then `gpu` compiles it itself, sooner or later. */
void turner_gpu_translate(const struct turner_gpu *gpu, const struct turner_spirv *spirv);

#endif
