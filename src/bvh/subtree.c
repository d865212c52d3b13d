#include "bvh/subtree.h"

#include <assert.h>

#define VISIT_COST 0.5 /* of a node (two boxes), in units of one primitive's test */

void turner_node_set(struct turner_gpu_node *node, int side, const struct turner_box4 *box,
                     uint32_t child, uint32_t count)
{
    memcpy(side ? node->lo1 : node->lo0, &box->lo, sizeof node->lo0);
    memcpy(side ? node->hi1 : node->hi0, &box->hi, sizeof node->hi0);
    node->child[side] = child;
    node->count[side] = count;
}

static uint32_t levels_when_halved(uint32_t count)
{
    uint32_t levels = 0;
    while (levels < 32 && (UINT64_C(1) << levels) < count)
        levels++;
    return levels;
}

bool turner_subtree_may_split(uint32_t count, uint32_t level)
{
    return level + 1 + levels_when_halved(count) <= TURNER_BVH_MAX_LEVELS;
}

void turner_subtree_halve(const struct turner_builder *b, struct turner_range children[2],
                          const struct turner_range *range, uint32_t level)
{
    struct turner_bvh_item *items = b->buffer[~level & 1] + range->begin;
    memcpy(items, b->buffer[level & 1] + range->begin, range->count * sizeof *items);
    struct turner_bvh_bounds centers;
    memcpy(centers.lo, &range->centers.lo, sizeof centers.lo);
    memcpy(centers.hi, &range->centers.hi, sizeof centers.hi);
    uint32_t left = range->count - range->count / 2;
    turner_bvh_select(items, range->count, left, turner_bvh_widest(&centers));
    children[0].begin = range->begin;
    children[0].count = left;
    children[1].begin = range->begin + left;
    children[1].count = range->count - left;
    turner_range_measure(&children[0], items);
    turner_range_measure(&children[1], items + left);
}

static struct turner_split find_split(uint8_t places[TURNER_BVH_FEW], struct turner_grid *grid,
                                      const struct turner_bvh_item *items,
                                      const struct turner_range *range)
{
    if (range->count <= 1)
        return (struct turner_split){.axis = -1};
    if (range->count <= TURNER_BVH_FEW)
        return turner_split_few(places, items, range->count);
    struct turner_bins bins;
    *grid = turner_grid_of(range);
    turner_bins_clear(&bins, grid);
    turner_bins_add(&bins, items, range->count, grid);
    return turner_bins_split(&bins, grid);
}

static void divide(const struct turner_builder *b, struct turner_range children[2],
                   const struct turner_range *range, uint32_t level,
                   const struct turner_split *split, const uint8_t *places,
                   const struct turner_grid *grid)
{
    const struct turner_bvh_item *from = b->buffer[level & 1] + range->begin;
    struct turner_bvh_item *to = b->buffer[~level & 1] + range->begin;
    struct turner_box4 centers[2] = {TURNER_BOX4_EMPTY, TURNER_BOX4_EMPTY};
    if (range->count <= TURNER_BVH_FEW) { /* whose children do not need the centres' bounds */
        for (uint32_t i = 0; i < range->count; i++)
            to[i] = from[places[i]];
    } else {
        turner_split_move(to, to + split->left, centers, from, range->count, split, grid);
    }
    for (int side = 0; side < 2; side++) {
        children[side].box = split->box[side];
        children[side].centers = centers[side];
        children[side].begin = range->begin + (side ? split->left : 0);
        children[side].count = side ? range->count - split->left : split->left;
    }
}

/* The items of a leaf where they are to end. */
static void keep(const struct turner_builder *b, const struct turner_range *range, uint32_t level)
{
    if (level & 1)
        memcpy(b->buffer[0] + range->begin, b->buffer[1] + range->begin,
               range->count * sizeof *b->buffer[0]);
}

struct turner_subtree turner_subtree_build(const struct turner_builder *b,
                                           const struct turner_range *range, uint32_t level,
                                           size_t place)
{
    uint8_t places[TURNER_BVH_FEW];
    struct turner_grid grid;
    const uint32_t count = range->count;
    struct turner_split split =
        find_split(places, &grid, b->buffer[level & 1] + range->begin, range);
    double whole = turner_box4_area(&range->box);
    bool cheap = split.axis < 0 || whole * count <= VISIT_COST * whole + split.cost;
    if (count <= b->leaf && (count <= 1 || cheap)) {
        keep(b, range, level);
        if (level > 0)
            return (struct turner_subtree){.is_leaf = true};
        turner_node_set(&b->nodes[place], 0, &range->box, count ? b->first : 0, count);
        turner_node_set(&b->nodes[place], 1, &TURNER_BOX4_EMPTY, 0, 0);
        return (struct turner_subtree){.nodes = 1, .levels = 1};
    }

    struct turner_range children[2];
    if (split.axis >= 0 && turner_subtree_may_split(count, level))
        divide(b, children, range, level, &split, places, &grid);
    else
        turner_subtree_halve(b, children, range, level);
    assert(children[0].count > 0 && children[1].count > 0);
    struct turner_subtree tree = {.nodes = 1};
    for (int side = 0; side < 2; side++) {
        const struct turner_range *child = &children[side];
        size_t next = place + tree.nodes;
        struct turner_subtree below = turner_subtree_build(b, child, level + 1, next);
        turner_node_set(&b->nodes[place], side, &child->box,
                        below.is_leaf ? b->first + child->begin : (uint32_t)next,
                        below.is_leaf ? child->count : 0);
        tree.nodes += below.nodes;
        tree.levels = below.levels > tree.levels ? below.levels : tree.levels;
    }
    tree.levels++;
    return tree;
}
