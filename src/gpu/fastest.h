/* Which traversal was measured to be the fastest on a device (render/measure.h): kept on disk, for
 * as long as device, driver, what it can do, and turner's shaders are the same. */
#ifndef TURNER_GPU_FASTEST_H
#define TURNER_GPU_FASTEST_H

#include "gpu/device.h"

/* TURNER_TRAVERSAL_AUTO: nothing was measured, or nothing is kept (gpu/cache.h). */
enum turner_traversal turner_fastest_load(const struct turner_gpu_info *info);
void turner_fastest_store(const struct turner_gpu_info *info, enum turner_traversal fastest);

#endif
