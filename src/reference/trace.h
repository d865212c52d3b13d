/* Whitted's recursion. docs/model.md. */
#ifndef TURNER_REFERENCE_TRACE_H
#define TURNER_REFERENCE_TRACE_H

#include "reference/media.h"
#include "reference/reference.h"
#include "reference/world.h"
#include "scene/ray_tree.h"

/* One thread's state while it traces. */
struct turner_tracer {
    const struct turner_world *world;
    struct turner_reference_statistics statistics;
    turner_real pruned; /* largest channels of the weights cut so far */
    struct turner_ray_tree *tree; /* where rays are noted down (record.h), or NULL */
};

/* Radiance that a camera ray brings. Its direction is unit. */
turner_vector turner_trace_camera(struct turner_tracer *tracer, turner_vector origin,
                                  turner_vector direction);

/* What a camera ray meets first. */
struct turner_first_hit {
    turner_real depth; /* along the ray */
    turner_vector position, normal, albedo; /* normal: shading normal on the ray's side */
    struct turner_place place;
};

/* False when it meets nothing. Does not count as a ray. */
bool turner_trace_first_hit(struct turner_first_hit *first, const struct turner_world *world,
                            turner_vector origin, turner_vector direction);

#endif
