/* Why a pixel of a float renderer may be off: what the reference itself does around it. */
#ifndef TURNER_TESTS_TRUTH_EXPLAIN_H
#define TURNER_TESTS_TRUTH_EXPLAIN_H

#include "reference/world.h"
#include "scene/scene.h"

enum cause {
    CAUSE_EDGE,      /* the camera ray is within EXPLAIN_RADIUS of another primitive */
    CAUSE_SHADOW,    /* a shadow's or a pattern's edge */
    CAUSE_HIGHLIGHT, /* the power in a highlight */
    CAUSE_AMPLIFIED, /* rounding amplified by mirrors and glass */
    CAUSE_NONE,      /* not explained: a mistake */
    CAUSES
};
extern const char *const cause_names[CAUSES];

/* In pixels: a float renderer's ray is off by about 1e-7 of its length, a few 1e-5 of a pixel here;
 * what it starts from after a hit by some ten times that. */
#define EXPLAIN_RADIUS 0.01

/* A pixel counts as off when a channel differs by more than both. */
struct tolerance {
    double absolute, relative;
};
bool is_off(const float *pixel, const float *truth, struct tolerance tolerance);

/* The camera ray through a point of the picture, in pixels; unit. */
struct turner_vec3 explain_direction(const struct turner_scene *scene, double x, double y);

/* The cause why pixel (x, y), one sample in its centre, may have the radiance `pixel`: the
 * reference takes values on both sides of it within EXPLAIN_RADIUS of the centre. `scene` is the
 * one that `world` was made of; it is changed and put back. */
enum cause explain(struct turner_scene *scene, const struct turner_world *world, int x, int y,
                   const float *pixel, struct tolerance tolerance);

#endif
