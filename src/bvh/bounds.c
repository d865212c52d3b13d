#include <math.h>

#include "bvh/build.h"

float turner_round_down(double x)
{
    float rounded = (float)x;
    return (double)rounded > x ? nextafterf(rounded, -INFINITY) : rounded;
}

float turner_round_up(double x)
{
    float rounded = (float)x;
    return (double)rounded < x ? nextafterf(rounded, INFINITY) : rounded;
}

static void cone_bounds(double lo[3], double hi[3], const struct turner_gpu_primitive *cone)
{
    double axis[3], square[3], sum = 0;
    for (int i = 0; i < 3; i++) {
        axis[i] = (double)cone->b[i] - (double)cone->a[i];
        square[i] = axis[i] * axis[i];
        sum += square[i];
    }
    for (int i = 0; i < 3; i++) {
        /* 1 − n_i² as the sum of the other two: no cancellation; all of it where a and b, apart in
         * the scene, are the same in floats */
        double reach = sum > 0 ? sqrt((square[(i + 1) % 3] + square[(i + 2) % 3]) / sum) : 1;
        double base = (double)cone->c[0] * reach, apex = (double)cone->c[1] * reach;
        lo[i] = fmin((double)cone->a[i] - base, (double)cone->b[i] - apex);
        hi[i] = fmax((double)cone->a[i] + base, (double)cone->b[i] + apex);
    }
}

void turner_primitive_bounds(float lo[3], float hi[3], const struct turner_gpu_primitive *primitive)
{
    double low[3], high[3];
    switch (primitive->id >> TURNER_KIND_SHIFT) {
    case TURNER_KIND_SPHERE:
        for (int i = 0; i < 3; i++) {
            low[i] = (double)primitive->a[i] - (double)primitive->b[0];
            high[i] = (double)primitive->a[i] + (double)primitive->b[0];
        }
        break;
    case TURNER_KIND_CONE:
        cone_bounds(low, high, primitive);
        break;
    default:
        for (int i = 0; i < 3; i++) {
            float a = primitive->a[i], b = primitive->b[i], c = primitive->c[i];
            float least = a < b ? a : b, most = a < b ? b : a;
            low[i] = (double)(c < least ? c : least);
            high[i] = (double)(c > most ? c : most);
        }
    }
    double largest = 0;
    for (int i = 0; i < 3; i++) {
        largest = -low[i] > largest ? -low[i] : largest;
        largest = high[i] > largest ? high[i] : largest;
    }
    double pad = 2 * (double)FLT_EPSILON * largest + (double)FLT_MIN; /* FLT_MIN: near 0 */
    for (int i = 0; i < 3; i++) {
        lo[i] = turner_round_down(low[i] - pad);
        hi[i] = turner_round_up(high[i] + pad);
    }
}

void turner_bvh_measure(struct turner_bvh_bounds *bounds, struct turner_bvh_bounds *centers,
                        const struct turner_bvh_item *items, uint32_t count)
{
    struct turner_bvh_bounds box = TURNER_BVH_EMPTY, center_box = TURNER_BVH_EMPTY;
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            float lo = items[i].lo[axis], hi = items[i].hi[axis];
            float center = turner_bvh_center(&items[i], axis);
            box.lo[axis] = lo < box.lo[axis] ? lo : box.lo[axis];
            box.hi[axis] = hi > box.hi[axis] ? hi : box.hi[axis];
            center_box.lo[axis] = center < center_box.lo[axis] ? center : center_box.lo[axis];
            center_box.hi[axis] = center > center_box.hi[axis] ? center : center_box.hi[axis];
        }
    }
    *bounds = box;
    *centers = center_box;
}

int turner_bvh_widest(const struct turner_bvh_bounds *bounds)
{
    int widest = 0;
    for (int axis = 1; axis < 3; axis++) {
        if (bounds->hi[axis] - bounds->lo[axis] > bounds->hi[widest] - bounds->lo[widest])
            widest = axis;
    }
    return widest;
}
