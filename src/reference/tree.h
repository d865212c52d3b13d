/* A tree of boxes: each node is halved at the median of its items' middles.
 *
 * Boxes only sort out what a ray cannot meet. They may thus be rough as long as they are never too
 * small: the tree keeps them in double, widened by more than double's rounding, which is several
 * times faster than extended precision. */
#ifndef TURNER_REFERENCE_TREE_H
#define TURNER_REFERENCE_TREE_H

#include <stddef.h>
#include <stdint.h>

#include "reference/geometry.h"

struct turner_box {
    turner_vector low, high;
};

#define TURNER_BOX_EMPTY                                                                           \
    ((struct turner_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

static inline void turner_box_include(struct turner_box *box, turner_vector p)
{
    box->low = vector(fminl(box->low.x, p.x), fminl(box->low.y, p.y), fminl(box->low.z, p.z));
    box->high = vector(fmaxl(box->high.x, p.x), fmaxl(box->high.y, p.y), fmaxl(box->high.z, p.z));
}

struct turner_tree_node {
    double bounds[2][3]; /* low and high corner */
    uint32_t first; /* leaf: of its items in `items`; else the two children: first, first + 1 */
    uint32_t count; /* of items; 0 in an inner node */
};

struct turner_tree {
    struct turner_tree_node *nodes; /* [0] is the root; NULL when there are no items */
    uint32_t *items;
    uint32_t node_count;
};

/* Builds the tree over `count` < 2³¹ boxes, which are only read here. */
void turner_tree_create(struct turner_tree *tree, const struct turner_box *boxes, uint32_t count);
void turner_tree_destroy(struct turner_tree *tree);

/* Bytes that turner_tree_create will take for `count` items. */
size_t turner_tree_bytes(size_t count);

/* Calls visit(user, item, &t_max) for every item whose box the ray meets at 0 ≤ t ≤ t_max, nearer
 * boxes first; `visit` may lower t_max, and ends the walk by returning false. */
typedef bool (*turner_tree_visit)(void *user, uint32_t item, turner_real *t_max);
void turner_tree_walk(const struct turner_tree *tree, const struct turner_ray *ray,
                      turner_real t_max, turner_tree_visit visit, void *user);

#endif
