/* Lights, and the Phong forms. docs/model.md, Local illumination. */
#ifndef TURNER_REFERENCE_LIGHT_H
#define TURNER_REFERENCE_LIGHT_H

#include "reference/vector.h"
#include "scene/scene.h"

struct turner_illumination {
    turner_vector direction;  /* L: unit, towards the light */
    turner_real distance;     /* infinite for a directional light */
    turner_vector irradiance; /* E on a surface that faces the light; 0: it does not reach x */
};

struct turner_illumination turner_light_arrive(const struct turner_light *light, turner_vector x);

/* f(V, L) with N·L > 0. `color` is the pattern's. */
turner_vector turner_phong(const struct turner_material *material, enum turner_shading shading,
                           turner_vector color, turner_vector n, turner_vector v, turner_vector l);

#endif
