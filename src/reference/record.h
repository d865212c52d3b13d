/* What the tracer notes down of its rays when it is asked to explain them. Nothing here changes
 * what is traced; without a tree nothing is done. A ray is an index into the tree, or TURNER_NONE. */
#ifndef TURNER_REFERENCE_RECORD_H
#define TURNER_REFERENCE_RECORD_H

#include "reference/fresnel.h"
#include "reference/light.h"
#include "reference/trace.h"

/* A ray that is about to be traced; CUT until more is known of it. */
uint32_t turner_record_ray(struct turner_tracer *tracer, enum turner_ray_kind kind, int depth,
                           const struct turner_ray *ray, const struct turner_media *media,
                           turner_vector weight);

/* It goes straight through a surface, `way` after its start. */
void turner_record_crossing(struct turner_tracer *tracer, uint32_t ray,
                            const struct turner_surface *surface, turner_real way, bool real);

/* It leaves the scene. */
void turner_record_background(struct turner_tracer *tracer, uint32_t ray, turner_vector through,
                              turner_vector radiance);

/* It meets a surface that is shaded. `ng` and `ns` are on the side of `v`. */
void turner_record_surface(struct turner_tracer *tracer, uint32_t ray,
                           const struct turner_surface *surface, turner_vector v, turner_vector ng,
                           turner_vector ns, turner_real way, turner_vector through);
/* What that surface sends by itself: k_e + k_a·I_a. */
void turner_record_radiance(struct turner_tracer *tracer, uint32_t ray, turner_vector radiance);
/* How it reflects and refracts. */
void turner_record_secondary(struct turner_tracer *tracer, uint32_t ray,
                             const struct turner_material *material, turner_real n1,
                             turner_real n2, const struct turner_secondary *weights);

/* A light as seen from the surface that `ray` met: a new shadow ray. */
uint32_t turner_record_light(struct turner_tracer *tracer, uint32_t ray, uint32_t light,
                             const struct turner_illumination *arriving, turner_vector n,
                             turner_vector v);
/* The shadow ray starts, */
void turner_record_shadow(struct turner_tracer *tracer, uint32_t shadow,
                          const struct turner_ray *ray, const struct turner_media *media);
/* ends on the way, BLOCKED or GIVEN_UP, */
void turner_record_blocked(struct turner_tracer *tracer, uint32_t shadow,
                           enum turner_ray_end end, const struct turner_surface *surface,
                           turner_real way);
/* or not: S of the light comes through and is reflected as `material` has it. */
void turner_record_lit(struct turner_tracer *tracer, uint32_t shadow, turner_vector s,
                       const struct turner_illumination *arriving,
                       const struct turner_material *material, turner_vector color,
                       turner_vector n, turner_vector v);

#endif
