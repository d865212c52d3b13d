/* Four floats at once, of which boxes use three; only src/bvh includes this. */
#ifndef TURNER_BVH_VEC4_H
#define TURNER_BVH_VEC4_H

#include <float.h>
#include <stdint.h>
#include <string.h>

#ifdef __SSE__
#include <xmmintrin.h> /* compilers do not see a minimum in four */
#endif

typedef float turner_vec4 __attribute__((vector_size(16)));
typedef int32_t turner_ivec4 __attribute__((vector_size(16)));

static inline turner_vec4 turner_vec4_of(float x)
{
    return (turner_vec4){x, x, x, x};
}

/* a where the mask is −1, b where it is 0. */
static inline turner_vec4 turner_vec4_select(turner_ivec4 mask, turner_vec4 a, turner_vec4 b)
{
    return (turner_vec4)(((turner_ivec4)a & mask) | ((turner_ivec4)b & ~mask));
}

/* a < b ? a : b and a > b ? a : b: b where one of the two is NaN. */
static inline turner_vec4 turner_vec4_min(turner_vec4 a, turner_vec4 b)
{
#ifdef __SSE__
    return _mm_min_ps(a, b);
#else
    return turner_vec4_select(a < b, a, b);
#endif
}

static inline turner_vec4 turner_vec4_max(turner_vec4 a, turner_vec4 b)
{
#ifdef __SSE__
    return _mm_max_ps(a, b);
#else
    return turner_vec4_select(a > b, a, b);
#endif
}

/* Three floats, with four bytes behind them that may be anything, and 0. */
static inline turner_vec4 turner_vec4_load3(const void *from)
{
    turner_ivec4 bits;
    memcpy(&bits, from, sizeof bits);
    return (turner_vec4)(bits & (turner_ivec4){-1, -1, -1, 0});
}

/* A box that holds nothing, or what was added to it. */
struct turner_box4 {
    turner_vec4 lo, hi;
};

#define TURNER_BOX4_EMPTY                                       \
    ((struct turner_box4){{FLT_MAX, FLT_MAX, FLT_MAX, FLT_MAX}, \
                          {-FLT_MAX, -FLT_MAX, -FLT_MAX, -FLT_MAX}})

static inline void turner_box4_grow(struct turner_box4 *box, turner_vec4 lo, turner_vec4 hi)
{
    box->lo = turner_vec4_min(lo, box->lo);
    box->hi = turner_vec4_max(hi, box->hi);
}

/* Half the surface. In double: the square of a float's range overflows a float. */
static inline double turner_box4_area(const struct turner_box4 *box)
{
    turner_vec4 edges = box->hi - box->lo;
    double x = (double)edges[0], y = (double)edges[1], z = (double)edges[2];
    return x * (y + z) + y * z;
}

#endif
