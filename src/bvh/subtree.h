/* The two halves of turner_bvh_build; only src/bvh includes this. */
#ifndef TURNER_BVH_SUBTREE_H
#define TURNER_BVH_SUBTREE_H

#include "bvh/split.h"

/* Items that are divided lie in buffer[level & 1], level counting the nodes above them, and go to
 * the other; those of a leaf end in buffer[0]. */
struct turner_builder {
    struct turner_gpu_node *nodes;
    struct turner_bvh_item *buffer[2];
    uint32_t leaf, first;
};

/* What became of a range. */
struct turner_subtree {
    bool is_leaf;
    uint32_t nodes, levels;
};

/* Makes a tree of the range at nodes[place…], numbered in depth-first order. At level 0 there is
 * always a node. The recursion is as deep as the tree. */
struct turner_subtree turner_subtree_build(const struct turner_builder *b,
                                           const struct turner_range *range, uint32_t level,
                                           size_t place);

/* Whether a range at this level may be divided as the heuristic says and still end within
 * TURNER_BVH_MAX_LEVELS; halving always does. */
bool turner_subtree_may_split(uint32_t count, uint32_t level);

/* Divides the range at the median, into the other buffer. */
void turner_subtree_halve(const struct turner_builder *b, struct turner_range children[2],
                          const struct turner_range *range, uint32_t level);

void turner_node_set(struct turner_gpu_node *node, int side, const struct turner_box4 *box,
                     uint32_t child, uint32_t count);

#endif
