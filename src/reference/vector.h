/* Numbers, vectors and affine maps of the reference tracer: extended precision throughout (64 bits
 * of mantissa on x86; where `long double` is no wider than `double` the tracer still works, with
 * the digits that leaves). Vectors also hold linear RGB, x = red. */
#ifndef TURNER_REFERENCE_VECTOR_H
#define TURNER_REFERENCE_VECTOR_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "base/vec.h"

typedef long double turner_real;

typedef struct {
    turner_real x, y, z;
} turner_vector;

/* p ↦ rows · p + last column */
struct turner_map {
    turner_real m[3][4];
};

#define TURNER_REAL_PI 3.14159265358979323846264338327950288L

static inline turner_vector vector(turner_real x, turner_real y, turner_real z)
{
    return (turner_vector){x, y, z};
}

static inline turner_vector grey(turner_real v)
{
    return vector(v, v, v);
}

static inline turner_vector widen(struct turner_vec3 a)
{
    return vector(a.x, a.y, a.z);
}

static inline turner_vector add(turner_vector a, turner_vector b)
{
    return vector(a.x + b.x, a.y + b.y, a.z + b.z);
}

static inline turner_vector sub(turner_vector a, turner_vector b)
{
    return vector(a.x - b.x, a.y - b.y, a.z - b.z);
}

static inline turner_vector scale(turner_vector a, turner_real s)
{
    return vector(a.x * s, a.y * s, a.z * s);
}

/* channel by channel */
static inline turner_vector mul(turner_vector a, turner_vector b)
{
    return vector(a.x * b.x, a.y * b.y, a.z * b.z);
}

static inline turner_vector negate(turner_vector a)
{
    return vector(-a.x, -a.y, -a.z);
}

static inline turner_real dot(turner_vector a, turner_vector b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline turner_vector cross(turner_vector a, turner_vector b)
{
    return vector(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline turner_real length(turner_vector a)
{
    return sqrtl(dot(a, a)); /* the exponent of long double leaves room for any squared double */
}

/* The unit vector along `a`; zero stays zero. */
static inline turner_vector normalize(turner_vector a)
{
    turner_real l = length(a);
    return l > 0 ? scale(a, 1 / l) : a;
}

static inline turner_real largest(turner_vector a)
{
    return fmaxl(a.x, fmaxl(a.y, a.z));
}

static inline turner_real clamp(turner_real x, turner_real low, turner_real high)
{
    return x < low ? low : x > high ? high : x;
}

static inline turner_vector mix(turner_vector a, turner_vector b, turner_real s)
{
    return add(scale(a, 1 - s), scale(b, s));
}

/* axis 0, 1, 2 is x, y, z */
static inline turner_real coordinate(turner_vector a, int axis)
{
    return axis == 0 ? a.x : axis == 1 ? a.y : a.z;
}

static inline turner_vector map_vector(const struct turner_map *a, turner_vector v)
{
    return vector(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                  a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                  a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}

static inline turner_vector map_point(const struct turner_map *a, turner_vector p)
{
    return add(map_vector(a, p), vector(a->m[0][3], a->m[1][3], a->m[2][3]));
}

/* The transposed linear part: with the inverse of a map this carries normals along the map. */
static inline turner_vector map_transposed(const struct turner_map *a, turner_vector v)
{
    return vector(a->m[0][0] * v.x + a->m[1][0] * v.y + a->m[2][0] * v.z,
                  a->m[0][1] * v.x + a->m[1][1] * v.y + a->m[2][1] * v.z,
                  a->m[0][2] * v.x + a->m[1][2] * v.y + a->m[2][2] * v.z);
}

/* The largest coordinate in size. */
static inline turner_real magnitude(turner_vector a)
{
    return fmaxl(fabsl(a.x), fmaxl(fabsl(a.y), fabsl(a.z)));
}

/* A bound of the terms that make up map_point(a, p) for any p of magnitude up to `size`: what the
 * rounding error of the result is relative to. */
static inline turner_real map_magnitude(const struct turner_map *a, turner_real size)
{
    turner_real bound = 0;
    for (int row = 0; row < 3; row++) {
        bound = fmaxl(bound, (fabsl(a->m[row][0]) + fabsl(a->m[row][1]) + fabsl(a->m[row][2])) *
                                     size +
                                 fabsl(a->m[row][3]));
    }
    return bound;
}

#endif
