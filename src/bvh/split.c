#include "bvh/split.h"

#include <math.h>

struct turner_grid turner_grid_of(const struct turner_range *range)
{
    const struct turner_box4 *centers = &range->centers;
    struct turner_grid grid = {.lo = centers->lo,
                               .bins = range->count < 32     ? 12
                                       : range->count < 1024 ? 16
                                                             : TURNER_BVH_BINS};
    for (int axis = 0; axis < 3; axis++) {
        float extent = centers->hi[axis] - centers->lo[axis];
        float scale = extent > 0 ? (float)grid.bins / extent : 0;
        grid.scale[axis] = isfinite(extent) && isfinite(scale) ? scale : 0;
    }
    return grid;
}

void turner_bins_clear(struct turner_bins *bins, const struct turner_grid *grid)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < grid->bins; i++) {
            bins->box[axis][i] = TURNER_BOX4_EMPTY;
            bins->count[axis][i] = 0;
        }
    }
}

static inline void add_item(struct turner_bins *bins, const struct turner_bvh_item *item,
                            const struct turner_grid *grid, turner_vec4 last)
{
    turner_vec4 lo = turner_vec4_load3(item->lo), hi = turner_vec4_load3(item->hi);
    /* not below 0, or NaN where ∞·0 */
    turner_vec4 place = turner_vec4_min((turner_center4(lo, hi) - grid->lo) * grid->scale, last);
    turner_ivec4 bin = __builtin_convertvector(place, turner_ivec4);
    for (int axis = 0; axis < 3; axis++) {
        turner_box4_grow(&bins->box[axis][bin[axis]], lo, hi);
        bins->count[axis][bin[axis]]++;
    }
}

/* Neighbours are often of one bin and would wait for each other: items from four places in turn. */
void turner_bins_add(struct turner_bins *bins, const struct turner_bvh_item *items, uint32_t count,
                     const struct turner_grid *grid)
{
    const turner_vec4 last = turner_vec4_of((float)(grid->bins - 1));
    const uint32_t quarter = count / 4;
    for (uint32_t i = 0; i < quarter; i++) {
        for (uint32_t k = 0; k < 4; k++)
            add_item(bins, &items[k * quarter + i], grid, last);
    }
    for (uint32_t i = 4 * quarter; i < count; i++)
        add_item(bins, &items[i], grid, last);
}

void turner_bins_join(struct turner_bins *bins, const struct turner_bins *more,
                      const struct turner_grid *grid)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int i = 0; i < grid->bins; i++) {
            turner_box4_grow(&bins->box[axis][i], more->box[axis][i].lo, more->box[axis][i].hi);
            bins->count[axis][i] += more->count[axis][i];
        }
    }
}

/* Lowers `best` where a plane between two bins of this axis is cheaper. */
static void try_axis(struct turner_split *best, const struct turner_box4 *box,
                     const uint32_t *counts, int bins, int axis)
{
    double right_cost[TURNER_BVH_BINS], cost = -1; /* of all bins from i on; −1 without items */
    struct turner_box4 right[TURNER_BVH_BINS], sum = TURNER_BOX4_EMPTY;
    uint32_t count = 0;
    for (int i = bins - 1; i > 0; i--) {
        if (counts[i]) {
            turner_box4_grow(&sum, box[i].lo, box[i].hi);
            count += counts[i];
            cost = turner_box4_area(&sum) * count;
        }
        right[i] = sum;
        right_cost[i] = cost;
    }
    sum = TURNER_BOX4_EMPTY;
    count = 0;
    for (int i = 1; i < bins; i++) {
        if (!counts[i - 1]) /* the same split as the one before, or none */
            continue;
        turner_box4_grow(&sum, box[i - 1].lo, box[i - 1].hi);
        count += counts[i - 1];
        if (right_cost[i] < 0)
            break;
        cost = turner_box4_area(&sum) * count + right_cost[i];
        if (best->axis < 0 || cost < best->cost)
            *best = (struct turner_split){
                .axis = axis, .bin = i, .left = count, .cost = cost, .box = {sum, right[i]}};
    }
}

struct turner_split turner_bins_split(const struct turner_bins *bins,
                                      const struct turner_grid *grid)
{
    struct turner_split best = {.axis = -1};
    for (int axis = 0; axis < 3; axis++) {
        if (grid->scale[axis] > 0)
            try_axis(&best, bins->box[axis], bins->count[axis], grid->bins, axis);
    }
    return best;
}

void turner_split_move(struct turner_bvh_item *left, struct turner_bvh_item *right,
                       struct turner_box4 centers[2], const struct turner_bvh_item *items,
                       uint32_t count, const struct turner_split *split,
                       const struct turner_grid *grid)
{
    const int axis = split->axis;
    const float grid_lo = grid->lo[axis], scale = grid->scale[axis], first = (float)split->bin;
    const turner_vec4 most = turner_vec4_of(FLT_MAX), limits[2] = {most, -most};
    struct turner_box4 left_centers = centers[0], right_centers = centers[1];
    for (uint32_t i = 0; i < count; i++) {
        turner_vec4 center =
            turner_center4(turner_vec4_load3(items[i].lo), turner_vec4_load3(items[i].hi));
        /* x < n just where the whole part of x is; false for NaN, which lies in the last bin */
        bool is_left = (turner_bvh_center(&items[i], axis) - grid_lo) * scale < first;
        struct turner_bvh_item *to = is_left ? left : right;
        *to = items[i];
        left += is_left;
        right += !is_left;
        /* without a branch, which would be guessed wrong half the time: the box that the item does
         * not belong to is given the ends of all floats, which change nothing */
        turner_vec4 low = limits[is_left], high = limits[!is_left];
        turner_box4_grow(&left_centers, turner_vec4_max(center, low),
                         turner_vec4_min(center, high));
        turner_box4_grow(&right_centers, turner_vec4_max(center, high),
                         turner_vec4_min(center, low));
    }
    centers[0] = left_centers;
    centers[1] = right_centers;
}

/* Sorts places by the centres along an axis; equal ones keep their order. */
static void sort_few(uint8_t places[TURNER_BVH_FEW], const turner_vec4 centers[TURNER_BVH_FEW],
                     uint32_t count, int axis)
{
    for (uint32_t i = 0; i < count; i++) {
        float center = centers[i][axis];
        uint32_t to = i;
        for (; to > 0 && centers[places[to - 1]][axis] > center; to--)
            places[to] = places[to - 1];
        places[to] = (uint8_t)i;
    }
}

/* Two are divided in one way, whatever the axis: half of all that are few. */
static struct turner_split split_two(uint8_t places[TURNER_BVH_FEW],
                                     const struct turner_box4 box[2], const turner_vec4 centers[2])
{
    int axis = 0;
    while (axis < 3 && centers[0][axis] == centers[1][axis])
        axis++;
    if (axis == 3)
        return (struct turner_split){.axis = -1};
    int first = centers[0][axis] > centers[1][axis];
    places[0] = (uint8_t)first;
    places[1] = (uint8_t)!first;
    return (struct turner_split){
        .axis = axis,
        .left = 1,
        .cost = turner_box4_area(&box[0]) + turner_box4_area(&box[1]),
        .box = {box[first], box[!first]},
    };
}

struct turner_split turner_split_few(uint8_t places[TURNER_BVH_FEW],
                                     const struct turner_bvh_item *items, uint32_t count)
{
    struct turner_split best = {.axis = -1};
    struct turner_box4 box[TURNER_BVH_FEW];
    turner_vec4 centers[TURNER_BVH_FEW];
    for (uint32_t i = 0; i < count; i++) {
        box[i] =
            (struct turner_box4){turner_vec4_load3(items[i].lo), turner_vec4_load3(items[i].hi)};
        centers[i] = turner_center4(box[i].lo, box[i].hi);
    }
    if (count == 2)
        return split_two(places, box, centers);
    for (int axis = 0; axis < 3; axis++) {
        uint8_t sorted[TURNER_BVH_FEW];
        sort_few(sorted, centers, count, axis);
        if (centers[sorted[0]][axis] == centers[sorted[count - 1]][axis])
            continue;
        struct turner_box4 right[TURNER_BVH_FEW], left = TURNER_BOX4_EMPTY;
        right[count - 1] = box[sorted[count - 1]];
        for (uint32_t i = count - 1; i > 1; i--) {
            right[i - 1] = right[i];
            turner_box4_grow(&right[i - 1], box[sorted[i - 1]].lo, box[sorted[i - 1]].hi);
        }
        for (uint32_t i = 1; i < count; i++) {
            turner_box4_grow(&left, box[sorted[i - 1]].lo, box[sorted[i - 1]].hi);
            double cost = turner_box4_area(&left) * i + turner_box4_area(&right[i]) * (count - i);
            if (best.axis >= 0 && cost >= best.cost)
                continue;
            best = (struct turner_split){
                .axis = axis, .left = i, .cost = cost, .box = {left, right[i]}};
            memcpy(places, sorted, count);
        }
    }
    return best;
}

void turner_range_measure(struct turner_range *range, const struct turner_bvh_item *items)
{
    range->box = range->centers = TURNER_BOX4_EMPTY;
    for (uint32_t i = 0; i < range->count; i++) {
        turner_vec4 lo = turner_vec4_load3(items[i].lo), hi = turner_vec4_load3(items[i].hi);
        turner_vec4 center = turner_center4(lo, hi);
        turner_box4_grow(&range->box, lo, hi);
        turner_box4_grow(&range->centers, center, center);
    }
}
