/* How deep a scene's rays can go before none of them counts.
 *
 * A ray's weight is a product of the W_r and W_t of the surfaces it met (docs/model.md, "Secondary
 * rays") and of absorption, which is at most 1. With W the largest channel of any W_r or W_t that a
 * material in use can have, at any angle and between any two media it can part, a ray of depth d
 * weighs at most W^d, and it is followed only if that is not below the cutoff. So
 *     useful depth = the largest d for which W^d ≥ cutoff,
 * and a deeper setting gives the same picture. Where W ≥ 1 or the cutoff is 0 there is no bound.
 *
 * The range of Fresnel's F: 1 at grazing incidence and beyond the critical angle. Between indices of
 * ratio n > 1 the exact F is least at normal incidence, ((n−1)/(n+1))², if n ≤ 2 + √3; above that
 * where cosθ_t/cosθ_i = m, m + 1/m = (n⁴ − 6n² + 1)/(n³ + n), the other zero of dF/dm. Schlick's is
 * least at normal incidence. Equal indices give 0 in the exact formula.
 * What each float product may round up is allowed for: W is taken 1e-6 larger. */
#ifndef TURNER_RENDER_DEPTH_H
#define TURNER_RENDER_DEPTH_H

#include "render/usage.h"

#define TURNER_DEPTH_UNBOUNDED INT32_MAX

struct turner_depth {
    int useful;        /* TURNER_DEPTH_UNBOUNDED where W^d stays above the cutoff up to
                          TURNER_MAX_DEPTH */
    double weight;     /* W; 0 where nothing reflects or transmits */
    uint32_t material; /* the first that has it; TURNER_NONE when weight is 0 */
};

struct turner_depth turner_depth_of(const struct turner_scene *scene);

/* What a material can send on at most, per channel. */
struct turner_weights {
    struct turner_vec3 reflected, transmitted; /* W_r, W_t */
    bool flat; /* transmissive, and all media it can part have the same index: nothing bends */
};

struct turner_weights turner_weights_of(const struct turner_scene *scene,
                                        const struct turner_usage *usage,
                                        const struct turner_material *material);

/* The least share that the exact, unpolarised Fresnel formula reflects at any angle between
 * indices n1 and n2 > 0. */
double turner_least_fresnel(double n1, double n2);

#endif
