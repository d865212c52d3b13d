#include "bvh/flat.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "bvh/flatten.h"
#include "bvh/wide.h"

/* What is known before anything is taken. */
struct sizes {
    uint64_t primitives, largest_group, nodes, instances, corners, vertices;
};

static uint64_t most_nodes(uint64_t items)
{
    return items > 2 ? items - 1 : 1;
}

/* Whether an instance of each group brings a material with a pattern; the caller frees it. */
static bool *find_patterned(const struct turner_scene *scene)
{
    bool *patterned = turner_calloc(scene->group_count, sizeof *patterned);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        if (instance->material != TURNER_NONE &&
            scene->materials[instance->material].pattern != TURNER_PATTERN_NONE)
            patterned[instance->group] = true;
    }
    return patterned;
}

static struct sizes measure_scene(const struct turner_scene *scene, const bool *patterned)
{
    struct sizes sizes = {.instances = 1 + (uint64_t)scene->instance_count};
    sizes.nodes = most_nodes(sizes.instances);
    for (size_t g = 0; g < scene->group_count; g++) {
        const struct turner_group *group = &scene->groups[g];
        uint64_t count = turner_group_primitive_count(group);
        sizes.primitives += count;
        sizes.largest_group = count > sizes.largest_group ? count : sizes.largest_group;
        sizes.nodes += most_nodes(count);
        for (size_t i = 0; i < group->mesh_count; i++) {
            const struct turner_mesh *mesh = &group->meshes[i];
            if (mesh->normals || turner_flat_needs_uvs(scene, mesh, patterned[g])) {
                sizes.corners += mesh->triangle_count;
                sizes.vertices += mesh->vertex_count;
            }
        }
    }
    return sizes;
}

static enum turner_result check_sizes(const struct sizes *sizes, enum turner_order order)
{
    const struct turner_flat *flat = NULL; /* for sizeof only */
    uint64_t items =
        sizes->largest_group > sizes->instances ? sizes->largest_group : sizes->instances;
    uint64_t spare = sizes->instances; /* of items; groups find room among their primitives */
    uint64_t bytes = sizes->primitives * sizeof *flat->primitives +
                     sizes->instances * (sizeof *flat->instances + sizeof *flat->instance_groups +
                                         sizeof(struct turner_bvh_bounds)) +
                     sizes->corners * sizeof *flat->corners +
                     sizes->vertices * (sizeof *flat->normals + sizeof *flat->uvs) +
                     items * sizeof(struct turner_bvh_item);
    if (order != TURNER_ORDER_MEDIAN)
        bytes += sizes->nodes * sizeof *flat->nodes + spare * sizeof(struct turner_bvh_item);
    if (order == TURNER_ORDER_WIDE) /* no more nodes of four than of two children */
        bytes += sizes->nodes * sizeof *flat->wide;
    uint64_t available = turner_memory_available();
    if (bytes > available)
        return turner_fail(TURNER_DEVICE,
                           "the scene's %llu primitives and %llu instances need up to %.1f MiB of "
                           "memory to be laid out, and %.1f MiB are free; take a smaller scene or "
                           "close other programs",
                           (unsigned long long)sizes->primitives,
                           (unsigned long long)sizes->instances, (double)bytes / 1048576,
                           (double)available / 1048576);
    if (order == TURNER_ORDER_WIDE &&
        (sizes->primitives > TURNER_WIDE_FIRST || sizes->instances > TURNER_WIDE_FIRST))
        return turner_fail(TURNER_BAD_INPUT,
                           "the scene has %llu primitives and %llu instances, and %u of each are "
                           "the most; take a smaller scene, or --traversal bvh_lane",
                           (unsigned long long)sizes->primitives,
                           (unsigned long long)sizes->instances - 1, TURNER_WIDE_FIRST);
    if (sizes->vertices > UINT32_MAX)
        return turner_fail(TURNER_BAD_INPUT,
                           "the scene's meshes have %llu vertices with normals or texture "
                           "coordinates, and %lu are the most; take a smaller scene",
                           (unsigned long long)sizes->vertices, (unsigned long)UINT32_MAX);
    return TURNER_OK;
}

static enum turner_result flatten_groups(struct turner_flat *flat, const struct turner_scene *scene,
                                         enum turner_order order, const bool *patterned,
                                         struct turner_bvh_item *items, uint32_t *group_levels,
                                         uint32_t *group_nodes)
{
    for (size_t g = 0; g < scene->group_count; g++) {
        const struct turner_group *group = &scene->groups[g];
        struct turner_flat_group *out = &flat->groups[g];
        size_t first = flat->primitive_count;
        uint32_t count = (uint32_t)turner_group_primitive_count(group);
        uint32_t boxes = (uint32_t)(group->sphere_count + group->cone_count);
        struct turner_flat_source source;
        turner_flat_source_create(&source, flat, scene, g, patterned[g]);
        enum turner_result result =
            turner_flat_measure(items, out, &source, order == TURNER_ORDER_MEDIAN);
        if (result != TURNER_OK) {
            free(source.meshes);
            return result;
        }
        if (order != TURNER_ORDER_MEDIAN) {
            out->root = (uint32_t)flat->node_count;
            static_assert(sizeof *flat->primitives >= sizeof *items, "room for items");
            struct turner_bvh_item *spare = (void *)(flat->primitives + first);
            group_levels[g] = turner_bvh_build(flat->nodes, &flat->node_count, items, spare, count,
                                               TURNER_BVH_LEAF, (uint32_t)first);
            group_nodes[g] = (uint32_t)flat->node_count - out->root;
        } else {
            out->triangles = (uint32_t)first;
            out->triangle_count = count - boxes;
            out->boxes = (uint32_t)first + out->triangle_count;
            out->box_count = boxes;
            turner_bvh_median_order(items, out->triangle_count);
            turner_bvh_median_order(items + out->triangle_count, boxes);
        }
        turner_flat_place(flat->primitives + first, &source, items, count);
        free(source.meshes);
        flat->primitive_count += count;
    }
    return TURNER_OK;
}

uint32_t turner_flat_top(struct turner_flat *flat, struct turner_bvh_item *items, uint32_t count)
{
    size_t first = flat->node_count;
    struct turner_bvh_item *spare = turner_calloc(count, sizeof *spare);
    uint32_t levels = turner_bvh_build(flat->nodes, &flat->node_count, items, spare, count, 1, 0);
    free(spare);
    for (size_t i = first; i < flat->node_count; i++) {
        for (int side = 0; side < 2; side++) {
            if (flat->nodes[i].count[side])
                flat->nodes[i].child[side] = items[flat->nodes[i].child[side]].index;
        }
    }
    return levels;
}

static void build_top(struct turner_flat *flat, struct turner_bvh_item *items, uint32_t count,
                      const uint32_t *group_levels, const uint32_t *group_nodes, size_t group_count)
{
    size_t first = flat->node_count;
    flat->root = (uint32_t)first;
    uint32_t levels = turner_flat_top(flat, items, count), deepest = 0;
    for (size_t g = 0; g < group_count; g++)
        deepest = group_levels[g] > deepest ? group_levels[g] : deepest;
    flat->group_depth = deepest;
    flat->max_depth = levels + 1 + deepest;
    flat->max_visits = flat->node_count - first;
    for (size_t i = 0; i < flat->instance_count; i++)
        flat->max_visits += 1 + (uint64_t)group_nodes[flat->instance_groups[i]];
}

/* Puts four children into each node, and gives the binary tree back. */
static void widen(struct turner_flat *flat, size_t group_count, uint32_t *group_nodes)
{
    size_t count = 0;
    uint32_t waiting = 0;
    flat->wide = turner_calloc(flat->node_count, sizeof *flat->wide);
    for (size_t g = 0; g < group_count; g++) {
        uint32_t root = flat->groups[g].root;
        flat->groups[g].root = (uint32_t)count;
        uint32_t entries = turner_bvh_widen(flat->wide, &count, flat->nodes, root);
        waiting = entries > waiting ? entries : waiting;
        group_nodes[g] = (uint32_t)count - flat->groups[g].root;
    }
    size_t first = count;
    uint32_t entries = turner_bvh_widen(flat->wide, &count, flat->nodes, flat->root);
    turner_bvh_wide_boxes(flat->wide, count, flat->nodes);
    flat->root = (uint32_t)first;
    flat->group_depth = 0; /* one level or the other is walked */
    flat->max_depth = 1 + (entries > waiting ? entries : waiting);
    flat->max_visits = count - first;
    for (size_t i = 0; i < flat->instance_count; i++) {
        uint32_t group = flat->instance_groups[i];
        flat->instances[i].root = flat->groups[group].root;
        flat->max_visits += 1 + (uint64_t)group_nodes[group];
    }
    free(flat->nodes);
    flat->nodes = NULL;
    flat->node_count = count;
    flat->wide = turner_realloc(flat->wide, count, sizeof *flat->wide);
}

enum turner_result turner_flat_create(struct turner_flat *flat, const struct turner_scene *scene,
                                      enum turner_order order)
{
    *flat = (struct turner_flat){0};
    bool *patterned = find_patterned(scene);
    struct sizes sizes = measure_scene(scene, patterned);
    enum turner_result result = check_sizes(&sizes, order);
    if (result != TURNER_OK) {
        free(patterned);
        return result;
    }

    uint64_t most_items =
        sizes.largest_group > sizes.instances ? sizes.largest_group : sizes.instances;
    struct turner_bvh_item *items = turner_calloc(most_items, sizeof *items);
    uint32_t *group_levels = turner_calloc(scene->group_count, sizeof *group_levels);
    uint32_t *group_nodes = turner_calloc(scene->group_count, sizeof *group_nodes);
    flat->instance_count = sizes.instances;
    flat->primitives = turner_calloc(sizes.primitives, sizeof *flat->primitives);
    flat->instances = turner_calloc(sizes.instances, sizeof *flat->instances);
    flat->instance_groups = turner_calloc(sizes.instances, sizeof *flat->instance_groups);
    flat->groups = turner_calloc(scene->group_count, sizeof *flat->groups);
    flat->corners = turner_calloc(sizes.corners, sizeof *flat->corners);
    flat->normals = turner_calloc(sizes.vertices, sizeof *flat->normals);
    flat->uvs = turner_calloc(sizes.vertices, sizeof *flat->uvs);
    if (order != TURNER_ORDER_MEDIAN)
        flat->nodes = turner_calloc(sizes.nodes, sizeof *flat->nodes);

    uint32_t used;
    TURNER_TRY_DONE(
        flatten_groups(flat, scene, order, patterned, items, group_levels, group_nodes));
    TURNER_TRY_DONE(turner_flat_instances(flat, scene, items, &used));
    if (order != TURNER_ORDER_MEDIAN)
        build_top(flat, items, used, group_levels, group_nodes, scene->group_count);
    if (order == TURNER_ORDER_SAH)
        flat->nodes = turner_realloc(flat->nodes, flat->node_count, sizeof *flat->nodes);
    if (order == TURNER_ORDER_WIDE)
        widen(flat, scene->group_count, group_nodes);
    flat->order = order;
    flat->node_room = flat->node_count;
    if (scene->instance_count && order != TURNER_ORDER_MEDIAN)
        flat->node_room += (flat->node_count - flat->root) / 8 + 8;
done:
    free(patterned);
    free(items);
    free(group_levels);
    free(group_nodes);
    if (result != TURNER_OK)
        turner_flat_destroy(flat);
    return result;
}

void turner_flat_release(struct turner_flat *flat)
{
    free(flat->nodes);
    free(flat->wide);
    free(flat->primitives);
    free(flat->instances);
    free(flat->corners);
    free(flat->normals);
    free(flat->uvs);
    flat->nodes = NULL;
    flat->wide = NULL;
    flat->primitives = NULL;
    flat->instances = NULL;
    flat->corners = NULL;
    flat->normals = NULL;
    flat->uvs = NULL;
}

void turner_flat_destroy(struct turner_flat *flat)
{
    turner_flat_release(flat);
    free(flat->groups);
    free(flat->instance_groups);
    *flat = (struct turner_flat){0};
}
