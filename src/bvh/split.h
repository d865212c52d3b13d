/* How build.c divides a range of items in two; only src/bvh includes this. */
#ifndef TURNER_BVH_SPLIT_H
#define TURNER_BVH_SPLIT_H

#include <stdbool.h>

#include "bvh/build.h"
#include "bvh/vec4.h"

#define TURNER_BVH_BINS 32 /* at most */
#define TURNER_BVH_FEW 8   /* as many items are divided without bins */

/* What is known of a range before it is divided: its items' bounds, and those of their centres. */
struct turner_range {
    struct turner_box4 box, centers;
    uint32_t begin, count;
};

/* Items lie in bin (centre − lo)·scale of an axis, the last one below `bins`. A scale of 0: the
 * axis is too thin or too wide to be divided. */
struct turner_grid {
    int bins;
    turner_vec4 lo, scale;
};

struct turner_bins {
    struct turner_box4 box[3][TURNER_BVH_BINS];
    uint32_t count[3][TURNER_BVH_BINS];
};

struct turner_split {
    int axis;      /* −1: nothing divides the range */
    int bin;       /* the first one on the right */
    uint32_t left; /* items */
    double cost;   /* Σ area · items of both sides */
    struct turner_box4 box[2];
};

/* Fewer items get fewer bins: the tree is hardly worse, and there are many small ranges. */
struct turner_grid turner_grid_of(const struct turner_range *range);
void turner_bins_clear(struct turner_bins *bins, const struct turner_grid *grid);
void turner_bins_add(struct turner_bins *bins, const struct turner_bvh_item *items, uint32_t count,
                     const struct turner_grid *grid);
void turner_bins_join(struct turner_bins *bins, const struct turner_bins *more,
                      const struct turner_grid *grid);

/* The cheapest plane between bins. */
struct turner_split turner_bins_split(const struct turner_bins *bins,
                                      const struct turner_grid *grid);

/* Copies items to left and right, in their order, and grows centers[0] and [1] by theirs. */
void turner_split_move(struct turner_bvh_item *left, struct turner_bvh_item *right,
                       struct turner_box4 centers[2], const struct turner_bvh_item *items,
                       uint32_t count, const struct turner_split *split,
                       const struct turner_grid *grid);

/* The cheapest way to divide at most TURNER_BVH_FEW items in the order of their centres along an
 * axis, and that order in places[]. `bin` is not set. */
struct turner_split turner_split_few(uint8_t places[TURNER_BVH_FEW],
                                     const struct turner_bvh_item *items, uint32_t count);

/* Sets box and centers of a range whose first item is items[0]. */
void turner_range_measure(struct turner_range *range, const struct turner_bvh_item *items);

static inline turner_vec4 turner_center4(turner_vec4 lo, turner_vec4 hi)
{
    return turner_vec4_of(0.5f) * lo + turner_vec4_of(0.5f) * hi; /* as turner_bvh_center */
}

#endif
