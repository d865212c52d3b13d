/* Vectors and affine maps in double: what scenes are described in. (cglm has floats only; scenes
 * keep the digits their author wrote, and the GPU's rounding counts as its error.) */
#ifndef TURNER_BASE_VEC_H
#define TURNER_BASE_VEC_H

#include <math.h>
#include <stdbool.h>

struct turner_vec3 {
    double x, y, z;
};

/* Rows of a 3×4 matrix: p ↦ linear part · p + last column. */
struct turner_affine {
    double m[3][4];
};

#define TURNER_AFFINE_IDENTITY                                                                     \
    ((struct turner_affine){{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}})

static inline struct turner_vec3 turner_vec3_of(double x, double y, double z)
{
    return (struct turner_vec3){x, y, z};
}

static inline struct turner_vec3 turner_vec3_add(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline struct turner_vec3 turner_vec3_sub(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline struct turner_vec3 turner_vec3_scale(struct turner_vec3 a, double s)
{
    return turner_vec3_of(a.x * s, a.y * s, a.z * s);
}

static inline double turner_vec3_dot(struct turner_vec3 a, struct turner_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct turner_vec3 turner_vec3_cross(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline double turner_vec3_length(struct turner_vec3 a)
{
    /* hypot twice: no overflow or underflow for any finite input */
    return hypot(hypot(a.x, a.y), a.z);
}

/* The unit vector along `a`; `a` itself if it is zero or not finite (callers validate first). */
static inline struct turner_vec3 turner_vec3_normalize(struct turner_vec3 a)
{
    double length = turner_vec3_length(a);
    return length > 0 && isfinite(length) ? turner_vec3_scale(a, 1 / length) : a;
}

static inline bool turner_vec3_finite(struct turner_vec3 a)
{
    return isfinite(a.x) && isfinite(a.y) && isfinite(a.z);
}

/* A unit vector perpendicular to `axis` (not zero): the cross product with the coordinate axis
 * along which `axis` is shortest, x before y before z. It starts the u coordinate of planes and
 * cones. */
struct turner_vec3 turner_vec3_perpendicular(struct turner_vec3 axis);

struct turner_vec3 turner_affine_point(const struct turner_affine *a, struct turner_vec3 p);
struct turner_vec3 turner_affine_vector(const struct turner_affine *a, struct turner_vec3 v);
/* first `b`, then `a` */
struct turner_affine turner_affine_multiply(const struct turner_affine *a,
                                            const struct turner_affine *b);
/* False, and `inverse` untouched, when `a` flattens space (determinant 0 or not finite). */
bool turner_affine_invert(struct turner_affine *inverse, const struct turner_affine *a);

#endif
