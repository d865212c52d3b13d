/* Which traversal is the fastest on a device, by drawing a small picture with each. */
#ifndef TURNER_RENDER_MEASURE_H
#define TURNER_RENDER_MEASURE_H

#include "gpu/device.h"
#include "turner.h"

#define TURNER_TRAVERSALS_MEASURED 3

struct turner_traversal_rate {
    enum turner_traversal traversal; /* BVH_LANE, BVH_PACKET or RAY_QUERY */
    double rays_per_second;
};

/* Measures those that the device can do, *count of them, the fastest first: camera, shadow and
 * mirrored rays among 1,000 spheres above a mesh of 20,000 triangles, the best of at least three
 * pictures of each. Takes a second or two where shaders must be compiled. The fastest is what auto
 * takes from then on: it goes to gpu->info, and to the cache unless options->no_cache. */
enum turner_result turner_measure_traversals(
    struct turner_traversal_rate rates[TURNER_TRAVERSALS_MEASURED], size_t *count,
    struct turner_gpu *gpu, const struct turner_render_options *options);

#endif
