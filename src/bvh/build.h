/* Trees and orders over boxes; only src/bvh includes this. */
#ifndef TURNER_BVH_BUILD_H
#define TURNER_BVH_BUILD_H

#include <float.h>

#include "bvh/flat.h"

#define TURNER_BVH_LEAF 4        /* primitives in a leaf, at most */
#define TURNER_BVH_MAX_LEVELS 48 /* nodes from root to leaf, at most; 2^28 items need 28 */

/* What is put into a tree: its bounds, and its index before the items were moved. 32 bytes. */
struct turner_bvh_item {
    float lo[3];
    uint32_t index;
    float hi[3];
    uint32_t pad;
};

static inline float turner_bvh_center(const struct turner_bvh_item *item, int axis)
{
    return 0.5f * item->lo[axis] + 0.5f * item->hi[axis]; /* halves first: no overflow */
}

struct turner_bvh_bounds {
    float lo[3], hi[3];
};

#define TURNER_BVH_EMPTY \
    ((struct turner_bvh_bounds){{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}})

/* Bounds of the items, and of their centres. */
void turner_bvh_measure(struct turner_bvh_bounds *bounds, struct turner_bvh_bounds *centers,
                        const struct turner_bvh_item *items, uint32_t count);

/* The axis (0, 1, 2) along which the bounds are longest; the first of equals. */
int turner_bvh_widest(const struct turner_bvh_bounds *bounds);

/* The float next to `x` that is not above, or not below it. */
float turner_round_down(double x);
float turner_round_up(double x);

/* Appends a binned-SAH tree over the items to `nodes` and moves the items into leaf order; a leaf's
 * child is `first` + the place of its first item. The root is the first node appended; at least 1
 * and at most max(1, count − 1) nodes are. Returns the levels of nodes, at most
 * TURNER_BVH_MAX_LEVELS. `spare` has room for as many items, with any contents. All cores work on
 * it, and the tree is the same for any number of them. Method: Wald, "On fast construction of
 * SAH-based bounding volume hierarchies", 2007; bins for large ranges, every plane for small
 * ones. */
uint32_t turner_bvh_build(struct turner_gpu_node *nodes, size_t *node_count,
                          struct turner_bvh_item *items, struct turner_bvh_item *spare,
                          uint32_t count, uint32_t leaf, uint32_t first);

/* Moves the items so that no centre before place `k` lies above one from `k` on along the axis.
 * Expected linear time whatever the input (Hoare's selection with pivots drawn by a fixed
 * generator, so two runs do the same). */
void turner_bvh_select(struct turner_bvh_item *items, uint32_t count, uint32_t k, int axis);

/* Moves the items into the order in which halving the range again and again (the first half takes
 * the odd one, as in lavapipe's builder) gives median splits along the widest axis. */
void turner_bvh_median_order(struct turner_bvh_item *items, uint32_t count);

#endif
