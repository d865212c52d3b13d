/* Instances that moved: the top level again, over groups that stay. */
#include <stdlib.h>

#include "base/memory.h"
#include "bvh/flat.h"
#include "bvh/flatten.h"
#include "bvh/wide.h"

/* The top level from flat->root on, as if the groups stood before it. Returns the entries of a
 * traversal's stack that it takes, at most. */
static uint32_t build_top(struct turner_flat *flat, struct turner_bvh_item *items, uint32_t count)
{
    size_t first = flat->root, most = flat->instance_count;
    flat->node_count = first;
    flat->nodes = turner_calloc(first + most, sizeof *flat->nodes);
    uint32_t levels = turner_flat_top(flat, items, count);
    if (flat->order == TURNER_ORDER_SAH)
        return levels + 1;
    size_t wide = first;
    flat->wide = turner_calloc(first + most, sizeof *flat->wide);
    uint32_t entries = turner_bvh_widen(flat->wide, &wide, flat->nodes, (uint32_t)first);
    turner_bvh_wide_boxes(flat->wide + first, wide - first, flat->nodes);
    free(flat->nodes);
    flat->nodes = NULL;
    flat->node_count = wide;
    return 1 + entries;
}

static bool same_groups(const struct turner_flat *flat, const struct turner_scene *scene)
{
    bool same = flat->instance_count == 1 + scene->instance_count;
    for (size_t i = 0; i < scene->instance_count && same; i++)
        same = flat->instance_groups[1 + i] == scene->instances[i].group;
    return same;
}

enum turner_result turner_flat_move(struct turner_flat *flat, const struct turner_scene *scene,
                                    bool *fits)
{
    uint32_t used, entries = 0;
    size_t before = flat->node_count;
    *fits = same_groups(flat, scene);
    if (!*fits)
        return TURNER_OK;
    struct turner_bvh_item *items = turner_calloc(flat->instance_count, sizeof *items);
    turner_flat_release(flat);
    flat->instances = turner_calloc(flat->instance_count, sizeof *flat->instances);
    enum turner_result result = turner_flat_instances(flat, scene, items, &used);
    if (result == TURNER_OK && flat->order != TURNER_ORDER_MEDIAN) {
        entries = build_top(flat, items, used);
        *fits = flat->node_count <= flat->node_room &&
                entries + flat->group_depth <= flat->max_depth;
        flat->max_visits = flat->max_visits - before + flat->node_count;
    }
    free(items);
    return result;
}
