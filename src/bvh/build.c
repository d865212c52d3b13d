#include <assert.h>
#include <math.h>

#include "bvh/build.h"

#define BINS 16
#define VISIT_COST 1.0 /* of a node (two boxes), in units of one primitive's test */

struct builder {
    struct turner_gpu_node *nodes;
    size_t node_count;
    struct turner_bvh_item *items;
    uint32_t leaf, first;
};

/* Bins are numbered by (centre − lo)·scale. */
struct split {
    int axis; /* −1: no plane between bins has items on both sides */
    int bin;  /* the first one on the right */
    float lo, scale;
    double cost; /* Σ area · items of both sides */
};

struct bin {
    struct turner_bvh_bounds bounds;
    uint32_t count;
};

static int bin_of(const struct turner_bvh_item *item, int axis, float lo, float scale)
{
    float position = (turner_bvh_center(item, axis) - lo) * scale; /* ≥ 0, or NaN where ∞·0 */
    return position < (float)BINS ? (int)position : BINS - 1;
}

static void grow(struct turner_bvh_bounds *bounds, const float lo[3], const float hi[3])
{
    for (int axis = 0; axis < 3; axis++) {
        bounds->lo[axis] = lo[axis] < bounds->lo[axis] ? lo[axis] : bounds->lo[axis];
        bounds->hi[axis] = hi[axis] > bounds->hi[axis] ? hi[axis] : bounds->hi[axis];
    }
}

/* Half the surface. In double: the square of a float's range overflows a float. */
static double area(const struct turner_bvh_bounds *bounds)
{
    double x = (double)bounds->hi[0] - (double)bounds->lo[0];
    double y = (double)bounds->hi[1] - (double)bounds->lo[1];
    double z = (double)bounds->hi[2] - (double)bounds->lo[2];
    return x * y + y * z + z * x;
}

/* Lowers `best` where a plane between two bins of this axis is cheaper. */
static void try_axis(struct split *best, const struct bin bins[BINS], int axis, float lo,
                     float scale)
{
    double right_cost[BINS], cost = -1; /* of bins i … BINS − 1 together; −1 without items */
    uint32_t right_count = 0, left_count = 0;
    struct turner_bvh_bounds right = TURNER_BVH_EMPTY, left = TURNER_BVH_EMPTY;
    for (int i = BINS - 1; i > 0; i--) {
        if (bins[i].count) {
            grow(&right, bins[i].bounds.lo, bins[i].bounds.hi);
            right_count += bins[i].count;
            cost = area(&right) * right_count;
        }
        right_cost[i] = cost;
    }
    for (int i = 1; i < BINS; i++) {
        if (!bins[i - 1].count) /* the same split as the one before, or none */
            continue;
        grow(&left, bins[i - 1].bounds.lo, bins[i - 1].bounds.hi);
        left_count += bins[i - 1].count;
        if (right_cost[i] < 0)
            break;
        cost = area(&left) * left_count + right_cost[i];
        if (best->axis < 0 || cost < best->cost)
            *best = (struct split){.axis = axis, .bin = i, .lo = lo, .scale = scale, .cost = cost};
    }
}

static struct split find_split(const struct turner_bvh_item *items, uint32_t count,
                               const struct turner_bvh_bounds *centers)
{
    struct bin bins[3][BINS];
    float scale[3];
    for (int axis = 0; axis < 3; axis++) {
        float extent = centers->hi[axis] - centers->lo[axis];
        scale[axis] = extent > 0 ? (float)BINS / extent : 0;
        /* too thin or too wide to be divided into bins: everything falls into the first */
        if (!(isfinite(extent) && isfinite(scale[axis])))
            scale[axis] = 0;
        for (int i = 0; i < BINS; i++)
            bins[axis][i] = (struct bin){.bounds = TURNER_BVH_EMPTY};
    }
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++) {
            struct bin *bin = &bins[axis][bin_of(&items[i], axis, centers->lo[axis], scale[axis])];
            grow(&bin->bounds, items[i].lo, items[i].hi);
            bin->count++;
        }
    }
    struct split best = {.axis = -1};
    for (int axis = 0; axis < 3; axis++) {
        if (scale[axis] > 0)
            try_axis(&best, bins[axis], axis, centers->lo[axis], scale[axis]);
    }
    return best;
}

static uint32_t partition(struct turner_bvh_item *items, uint32_t count, const struct split *split)
{
    uint32_t left = 0, right = count;
    while (left < right) {
        if (bin_of(&items[left], split->axis, split->lo, split->scale) < split->bin) {
            left++;
        } else {
            struct turner_bvh_item item = items[left];
            items[left] = items[--right];
            items[right] = item;
        }
    }
    return left;
}

static uint32_t levels_when_halved(uint32_t count)
{
    uint32_t levels = 0;
    while (levels < 32 && (UINT64_C(1) << levels) < count)
        levels++;
    return levels;
}

static void set_child(struct turner_gpu_node *node, int side,
                      const struct turner_bvh_bounds *bounds, uint32_t child, uint32_t count)
{
    float *lo = side ? node->lo1 : node->lo0, *hi = side ? node->hi1 : node->hi0;
    for (int axis = 0; axis < 3; axis++) {
        lo[axis] = bounds->lo[axis];
        hi[axis] = bounds->hi[axis];
    }
    node->child[side] = child;
    node->count[side] = count;
}

/* Makes a tree of items begin…end−1 and returns its levels of nodes. With `level` nodes above it,
 * it becomes a child of nodes[parent], or a leaf of it; at level 0 there is no parent, and a node
 * is always made. The recursion is as deep as the tree. */
static uint32_t build_range(struct builder *b, uint32_t begin, uint32_t end, uint32_t level,
                            size_t parent, int side)
{
    bool is_root = level == 0;
    uint32_t count = end - begin;
    struct turner_bvh_item *items = b->items + begin;
    struct turner_bvh_bounds bounds, centers;
    turner_bvh_measure(&bounds, &centers, items, count);
    struct split split = {.axis = -1};
    if (count > 1)
        split = find_split(items, count, &centers);
    double whole = area(&bounds);
    bool cheap = split.axis < 0 || whole * count <= VISIT_COST * whole + split.cost;
    bool is_leaf = count <= b->leaf && (count <= 1 || cheap);
    if (is_leaf && !is_root) {
        set_child(&b->nodes[parent], side, &bounds, b->first + begin, count);
        return 0;
    }

    size_t node = b->node_count++;
    if (!is_root)
        set_child(&b->nodes[parent], side, &bounds, (uint32_t)node, 0);
    if (is_leaf) {
        set_child(&b->nodes[node], 0, &bounds, count ? b->first + begin : 0, count);
        set_child(&b->nodes[node], 1, &TURNER_BVH_EMPTY, 0, 0);
        return 1;
    }
    uint32_t left;
    /* halving always ends within the levels left: what follows an SAH split must still do */
    if (split.axis >= 0 && level + 1 + levels_when_halved(count) <= TURNER_BVH_MAX_LEVELS) {
        left = partition(items, count, &split);
    } else {
        left = count - count / 2;
        turner_bvh_select(items, count, left, turner_bvh_widest(&centers));
    }
    assert(left > 0 && left < count);
    uint32_t below = build_range(b, begin, begin + left, level + 1, node, 0);
    uint32_t below_right = build_range(b, begin + left, end, level + 1, node, 1);
    return 1 + (below > below_right ? below : below_right);
}

uint32_t turner_bvh_build(struct turner_gpu_node *nodes, size_t *node_count,
                          struct turner_bvh_item *items, uint32_t count, uint32_t leaf,
                          uint32_t first)
{
    struct builder b = {
        .nodes = nodes, .node_count = *node_count, .items = items, .leaf = leaf, .first = first};
    uint32_t levels = build_range(&b, 0, count, 0, 0, 0);
    *node_count = b.node_count;
    return levels;
}
