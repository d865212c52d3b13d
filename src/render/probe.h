/* Single rays through the shaders that draw pictures, to measure what becomes of a ray that is
 * known exactly. */
#ifndef TURNER_RENDER_PROBE_H
#define TURNER_RENDER_PROBE_H

#include "render/renderer.h"

#include "../shaders/shared.h"

/* Traces `count` rays in place, on a renderer whose kernel is probe.comp, of kind
 * TURNER_PROBE_HITS or TURNER_PROBE_RADIANCE, which says what is filled in. */
enum turner_result turner_probe_trace(struct turner_gpu_probe *probes, size_t count,
                                      struct turner_renderer *renderer);

#endif
