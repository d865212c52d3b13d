#include <math.h>
#include <string.h>

#include "bvh/flatten.h"

/* Rows of 3×4 in floats; false when one of them is not finite. */
static bool round_affine(float out[12], const struct turner_affine *affine)
{
    bool finite = true;
    for (int i = 0; i < 12; i++) {
        out[i] = (float)affine->m[i / 4][i % 4];
        finite = finite && isfinite(out[i]);
    }
    return finite;
}

/* Magnitude of the numbers that are summed in row `row` for a point of size `size`. */
static double row_magnitude(const struct turner_affine *affine, int row, const double size[3])
{
    double sum = fabs(affine->m[row][3]);
    for (int j = 0; j < 3; j++)
        sum += fabs(affine->m[row][j]) * size[j];
    return sum;
}

/* World bounds of the box's 8 corners, row by row: each row takes the end of every axis that makes
 * it least, and the one that makes it greatest. */
static void transform_box(double lo[3], double hi[3], const struct turner_affine *affine,
                          const struct turner_bvh_bounds *box)
{
    for (int row = 0; row < 3; row++) {
        lo[row] = hi[row] = affine->m[row][3];
        for (int j = 0; j < 3; j++) {
            double a = affine->m[row][j] * (double)box->lo[j];
            double b = affine->m[row][j] * (double)box->hi[j];
            lo[row] += fmin(a, b);
            hi[row] += fmax(a, b);
        }
    }
}

bool turner_flat_instance(struct turner_gpu_instance *instance, struct turner_bvh_bounds *world,
                          const struct turner_affine *to_world, const struct turner_bvh_bounds *box)
{
    *world = *box;
    struct turner_affine to_group;
    if (!turner_affine_invert(&to_group, to_world))
        return false;
    if (!round_affine(instance->to_world, to_world) || !round_affine(instance->to_group, &to_group))
        return false;
    instance->spawn_scale = 0;
    const struct turner_affine identity = TURNER_AFFINE_IDENTITY;
    if (memcmp(to_world, &identity, sizeof identity) == 0)
        return true; /* exact in floats too */

    bool empty = box->lo[0] > box->hi[0];
    double size[3], world_size[3], group_size[3], spawn_scale = 0;
    for (int j = 0; j < 3; j++)
        size[j] = empty ? 0 : fmax(fabs((double)box->lo[j]), fabs((double)box->hi[j]));
    for (int row = 0; row < 3; row++)
        world_size[row] = row_magnitude(to_world, row, size);
    for (int row = 0; row < 3; row++) {
        group_size[row] = row_magnitude(&to_group, row, world_size);
        spawn_scale = fmax(spawn_scale, group_size[row]);
    }
    instance->spawn_scale = turner_round_up(spawn_scale);
    if (!isfinite(instance->spawn_scale))
        return false;
    if (empty)
        return true;

    double lo[3], hi[3];
    transform_box(lo, hi, to_world, box);
    for (int row = 0; row < 3; row++) {
        /* A point goes to the world with an error of a few ulps of world_size; a ray comes to the
         * group with one of a few ulps of group_size, which is that much of the world. */
        double pad = world_size[row];
        for (int j = 0; j < 3; j++)
            pad += fabs(to_world->m[row][j]) * group_size[j];
        pad = 4 * (double)FLT_EPSILON * pad + (double)FLT_MIN;
        world->lo[row] = turner_round_down(lo[row] - pad);
        world->hi[row] = turner_round_up(hi[row] + pad);
        if (!isfinite(world->lo[row]) || !isfinite(world->hi[row]))
            return false;
    }
    return true;
}
