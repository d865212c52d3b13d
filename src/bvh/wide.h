/* From trees of two children a node to trees of four, for packets; only src/bvh includes this. */
#ifndef TURNER_BVH_WIDE_H
#define TURNER_BVH_WIDE_H

#include "bvh/flat.h"

/* Appends the binary tree under nodes[root] to wide[*count…], the root first, with no more nodes
 * than it has, but for their boxes, and returns the most entries that a walk keeps waiting which puts all children it
 * meets on its stack and takes one: 0 for a tree without children. A leaf has at most 8 primitives,
 * below TURNER_WIDE_FIRST + 1. The recursion is as deep as the tree.
 * Method: Dammertz, Hanika and Keller, "Shallow bounding volume hierarchies for fast SIMD ray
 * tracing of incoherent rays", 2008. */
uint32_t turner_bvh_widen(struct turner_gpu_wide_node *wide, size_t *count,
                          const struct turner_gpu_node *nodes, uint32_t root);

/* The boxes of all `count` nodes that were made of `nodes`, on all cores, once.
 * Boxes grow by less than a spacing of their node's grid (shaders/shared.h) and never shrink.
 * Method: Ylitie, Karras and Laine, "Efficient incoherent ray traversal on GPUs through compressed
 * wide BVHs", 2017. */
void turner_bvh_wide_boxes(struct turner_gpu_wide_node *wide, size_t count,
                           const struct turner_gpu_node *nodes);

/* Side (0 lower, 1 upper) of a child's box along an axis, as the shaders read it. */
float turner_bvh_wide_plane(const struct turner_gpu_wide_node *node, int child, int axis, int side);

#endif
