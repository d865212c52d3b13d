#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/parallel.h"
#include "bvh/flatten.h"

#define PIECE 8192 /* instances that one thread takes at once */

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

/* The transforms and spawn_scale of an instance, and the bounds in the world of what has the bounds
 * `box` in the group. False when something does not fit a float. */
static bool flatten(struct turner_gpu_instance *instance, struct turner_bvh_bounds *world,
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

struct flattening {
    struct turner_flat *flat;
    const struct turner_scene *scene;
    struct turner_bvh_item *items; /* of all instances: lo > hi where they are empty */
    atomic_uint broken;            /* the first one that does not fit */
};

static void flatten_piece(void *user, uint32_t piece)
{
    struct flattening *f = user;
    const struct turner_flat *flat = f->flat;
    const struct turner_instance world = {.material = TURNER_NONE,
                                          .transform = TURNER_AFFINE_IDENTITY};
    uint32_t end = turner_piece_end((uint32_t)flat->instance_count, PIECE, piece);
    for (uint32_t i = piece * PIECE; i < end; i++) {
        const struct turner_instance *instance = i ? &f->scene->instances[i - 1] : &world;
        const struct turner_flat_group *group = &flat->groups[instance->group];
        struct turner_gpu_instance *out = &flat->instances[i];
        struct turner_bvh_bounds bounds, box;
        memcpy(box.lo, group->lo, sizeof box.lo);
        memcpy(box.hi, group->hi, sizeof box.hi);
        if (!flatten(out, &bounds, &instance->transform, &box)) {
            unsigned first = atomic_load(&f->broken);
            while (i < first && !atomic_compare_exchange_weak(&f->broken, &first, i))
                continue;
        }
        out->root = group->root;
        out->triangles = group->triangles;
        out->boxes = group->boxes;
        out->material = turner_flat_material(f->scene, instance->material);
        flat->instance_groups[i] = instance->group;
        f->items[i] = (struct turner_bvh_item){.index = i};
        memcpy(f->items[i].lo, bounds.lo, sizeof bounds.lo);
        memcpy(f->items[i].hi, bounds.hi, sizeof bounds.hi);
    }
}

enum turner_result turner_flat_instances(struct turner_flat *flat, const struct turner_scene *scene,
                                         struct turner_bvh_item *items, uint32_t *used)
{
    struct flattening flattening = {flat, scene, items, UINT32_MAX};
    uint32_t count = (uint32_t)flat->instance_count;
    turner_parallel_for(turner_pieces(count, PIECE), flatten_piece, &flattening);
    if (flattening.broken < UINT32_MAX)
        return turner_fail(TURNER_BAD_INPUT,
                           "instance %u: its transform, the inverse or what it shows does not fit "
                           "single precision; scale it less",
                           flattening.broken - 1);
    *used = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (items[i].lo[0] <= items[i].hi[0])
            items[(*used)++] = items[i];
    }
    return TURNER_OK;
}
