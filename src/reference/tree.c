#include "reference/tree.h"

#include <stdlib.h>

#include "base/memory.h"

#define LEAF_ITEMS 3
#define DEPTH_MAX 40 /* halving 2³¹ items ends before */

/* ---- building ---- */

struct builder {
    struct turner_tree *tree;
    const struct turner_box *boxes;
};

static turner_real middle(const struct builder *builder, uint32_t item, int axis)
{
    const struct turner_box *box = &builder->boxes[item];
    return coordinate(box->low, axis) + coordinate(box->high, axis);
}

/* Hoare's selection: puts the items with the `half` lowest middles first. */
static void select_half(const struct builder *builder, uint32_t *items, uint32_t count,
                        uint32_t half, int axis)
{
    int64_t left = 0, right = (int64_t)count - 1;
    while (left < right) {
        turner_real pivot = middle(builder, items[left + (right - left) / 2], axis);
        int64_t i = left, j = right;
        while (i <= j) {
            while (middle(builder, items[i], axis) < pivot)
                i++;
            while (middle(builder, items[j], axis) > pivot)
                j--;
            if (i <= j) {
                uint32_t item = items[i];
                items[i++] = items[j];
                items[j--] = item;
            }
        }
        if ((int64_t)half <= j)
            right = j;
        else if ((int64_t)half >= i)
            left = i;
        else
            return;
    }
}

static void set_box(struct turner_tree_node *node, const struct turner_box *box)
{
    double pad = 16 * DBL_EPSILON * (double)fmaxl(magnitude(box->low), magnitude(box->high));
    for (int axis = 0; axis < 3; axis++) {
        node->bounds[0][axis] = (double)coordinate(box->low, axis) - pad;
        node->bounds[1][axis] = (double)coordinate(box->high, axis) + pad;
    }
}

static void build(const struct builder *builder, uint32_t index, uint32_t first, uint32_t count)
{
    struct turner_tree *tree = builder->tree;
    uint32_t *items = tree->items + first;
    struct turner_box box = TURNER_BOX_EMPTY, middles = TURNER_BOX_EMPTY;
    for (uint32_t i = 0; i < count; i++) {
        const struct turner_box *item = &builder->boxes[items[i]];
        turner_box_include(&box, item->low);
        turner_box_include(&box, item->high);
        turner_box_include(&middles, add(item->low, item->high));
    }
    set_box(&tree->nodes[index], &box);
    tree->nodes[index].first = first;
    tree->nodes[index].count = count;
    if (count <= LEAF_ITEMS)
        return;

    turner_vector extent = sub(middles.high, middles.low);
    int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    uint32_t half = count / 2, children = tree->node_count;
    tree->node_count += 2;
    select_half(builder, items, count, half, axis);
    build(builder, children, first, half);
    build(builder, children + 1, first + half, count - half);
    tree->nodes[index].first = children;
    tree->nodes[index].count = 0;
}

/* A leaf made by halving holds two items or more. */
static size_t node_limit(size_t count)
{
    return count < 2 ? 1 : count;
}

size_t turner_tree_bytes(size_t count)
{
    return node_limit(count) * sizeof(struct turner_tree_node) + count * sizeof(uint32_t);
}

void turner_tree_create(struct turner_tree *tree, const struct turner_box *boxes, uint32_t count)
{
    *tree = (struct turner_tree){0};
    if (count == 0)
        return;
    tree->nodes = turner_calloc(node_limit(count), sizeof *tree->nodes);
    tree->items = turner_calloc(count, sizeof *tree->items);
    for (uint32_t i = 0; i < count; i++)
        tree->items[i] = i;
    tree->node_count = 1;
    struct builder builder = {tree, boxes};
    build(&builder, 0, 0, count);
}

void turner_tree_destroy(struct turner_tree *tree)
{
    free(tree->nodes);
    free(tree->items);
    *tree = (struct turner_tree){0};
}

/* ---- walking ---- */

/* A ray in double. */
struct rough_ray {
    double origin[3], direction[3], inverse[3];
};

static struct rough_ray rough(const struct turner_ray *ray)
{
    struct rough_ray rough;
    for (int axis = 0; axis < 3; axis++) {
        double d = (double)coordinate(ray->direction, axis);
        rough.origin[axis] = (double)coordinate(ray->origin, axis);
        rough.direction[axis] = fabs(d) > DBL_MIN * 16 ? d : 0; /* what has a finite inverse */
        rough.inverse[axis] = 1 / d;
    }
    return rough;
}

/* Where the ray enters the box, if it meets it within [0, t_max]. The interval is widened by more
 * than the rounding of this test: a box never hides what it holds. */
static bool meets(const struct turner_tree_node *box, const struct rough_ray *ray, double t_max,
                  double *entry)
{
    const double wider = 1 + 16 * DBL_EPSILON;
    double near = 0, far = t_max;
    for (int axis = 0; axis < 3; axis++) {
        double o = ray->origin[axis], d = ray->direction[axis];
        if (d == 0) { /* 0·∞ is not a number: decide apart */
            if (o < box->bounds[0][axis] || o > box->bounds[1][axis])
                return false;
            continue;
        }
        double enter = (box->bounds[d < 0][axis] - o) * ray->inverse[axis];
        double leave = (box->bounds[d > 0][axis] - o) * ray->inverse[axis];
        near = enter > near ? enter : near;
        far = leave < far ? leave : far;
    }
    *entry = near / wider;
    return *entry <= far * wider;
}

void turner_tree_walk(const struct turner_tree *tree, const struct turner_ray *ray,
                      turner_real t_max, turner_tree_visit visit, void *user)
{
    struct {
        uint32_t node;
        double entry;
    } stack[DEPTH_MAX + 1];
    int height = 0;
    struct rough_ray rough_ray = rough(ray);
    double entry;

    if (!tree->nodes || !meets(&tree->nodes[0], &rough_ray, (double)t_max, &entry))
        return;
    stack[height].entry = entry;
    stack[height++].node = 0;
    while (height > 0) {
        height--;
        if (stack[height].entry > t_max)
            continue;
        const struct turner_tree_node *node = &tree->nodes[stack[height].node];
        for (uint32_t i = 0; i < node->count; i++) {
            if (!visit(user, tree->items[node->first + i], &t_max))
                return;
        }
        if (node->count > 0)
            continue;
        double entries[2];
        bool met[2];
        for (uint32_t i = 0; i < 2; i++)
            met[i] = meets(&tree->nodes[node->first + i], &rough_ray, (double)t_max, &entries[i]);
        uint32_t later = met[0] && met[1] && entries[1] < entries[0] ? 0 : 1; /* the farther one */
        for (uint32_t i = 0; i < 2; i++) {
            uint32_t child = i == 0 ? later : 1 - later;
            if (met[child]) {
                stack[height].entry = entries[child];
                stack[height++].node = node->first + child;
            }
        }
    }
}
