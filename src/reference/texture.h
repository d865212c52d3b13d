/* Patterns on surfaces, and the background. docs/model.md, Surfaces and Background. */
#ifndef TURNER_REFERENCE_TEXTURE_H
#define TURNER_REFERENCE_TEXTURE_H

#include "reference/vector.h"
#include "scene/scene.h"

/* The colour that multiplies k_d and k_a at (u, v); white without a pattern. */
turner_vector turner_pattern_color(const struct turner_scene *scene,
                                   const struct turner_material *material, turner_real u,
                                   turner_real v);

/* Radiance that comes from direction `d` (unit, pointing away from the viewer). */
turner_vector turner_background_radiance(const struct turner_scene *scene, turner_vector d);

#endif
