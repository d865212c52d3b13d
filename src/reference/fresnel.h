/* How much of the radiance along the mirror and the refracted direction a surface passes on.
 * docs/model.md, Secondary rays. */
#ifndef TURNER_REFERENCE_FRESNEL_H
#define TURNER_REFERENCE_FRESNEL_H

#include "reference/vector.h"
#include "scene/scene.h"

struct turner_secondary {
    turner_vector reflected, refracted; /* the weights W_r and W_t */
    turner_vector fresnel;              /* share of the light that is reflected, */
    bool has_fresnel;                   /* if that is by a formula */
    bool total;                         /* total internal reflection */
};

/* cos²θ_t behind an interface; negative: total internal reflection. `c` is cos θ_i = N·V. The form
 * does not cancel for n1 near n2. */
turner_real turner_cosine2_refracted(turner_real n1, turner_real n2, turner_real c);

/* Share of unpolarised light that the interface reflects. `c` is clamped to [0,1] inside. */
turner_real turner_fresnel_exact(turner_real n1, turner_real n2, turner_real c);
turner_real turner_fresnel_schlick(turner_real n1, turner_real n2, turner_real c);

/* The same of a metal of complex index eta + i·k seen from vacuum (one channel). */
turner_real turner_fresnel_conductor(turner_real eta, turner_real k, turner_real c);

/* The weights of a hit on `material` with c = N·V, coming from index n1; n2 behind it counts only
 * where the material transmits. `fresnel` is turner_material_fresnel of it. */
struct turner_secondary turner_secondary_weights(const struct turner_material *material,
                                                 enum turner_fresnel fresnel, turner_real n1,
                                                 turner_real n2, turner_real c);

#endif
