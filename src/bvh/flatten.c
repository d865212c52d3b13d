#include "bvh/flatten.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"

#define PIECE 16384 /* items that one thread takes at once */

uint32_t turner_flat_material(const struct turner_scene *scene, uint32_t material)
{
    if (material == TURNER_NONE)
        return TURNER_NO_INDEX;
    const struct turner_vec3 *k_t = &scene->materials[material].k_t;
    bool transmissive = k_t->x > 0 || k_t->y > 0 || k_t->z > 0;
    return material | (transmissive ? TURNER_MATERIAL_TRANSMISSIVE : 0);
}

bool turner_flat_needs_uvs(const struct turner_scene *scene, const struct turner_mesh *mesh,
                           bool patterned)
{
    return mesh->uvs &&
           (patterned || scene->materials[mesh->material].pattern != TURNER_PATTERN_NONE);
}

static void round_point(float out[3], struct turner_vec3 point)
{
    out[0] = (float)point.x;
    out[1] = (float)point.y;
    out[2] = (float)point.z;
}

/* The mesh's normals, uvs and corners; returns the attributes of its first triangle. */
static uint32_t append_attributes(struct turner_flat *flat, const struct turner_mesh *mesh,
                                  bool needs_uvs)
{
    if (!mesh->normals && !needs_uvs)
        return TURNER_NO_INDEX;
    uint32_t attributes = (uint32_t)flat->corner_count |
                          (mesh->normals ? TURNER_ATTRIBUTES_NORMALS : 0) |
                          (needs_uvs ? TURNER_ATTRIBUTES_UVS : 0);
    uint32_t first_vertex = (uint32_t)flat->vertex_count;
    if (mesh->normals)
        memcpy(flat->normals + first_vertex, mesh->normals,
               mesh->vertex_count * sizeof *mesh->normals);
    if (needs_uvs)
        memcpy(flat->uvs + first_vertex, mesh->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int corner = 0; corner < 3; corner++)
            flat->corners[flat->corner_count + i].vertex[corner] =
                first_vertex + mesh->triangles[i][corner];
    }
    flat->vertex_count += mesh->vertex_count;
    flat->corner_count += mesh->triangle_count;
    return attributes;
}

void turner_flat_source_create(struct turner_flat_source *source, struct turner_flat *flat,
                               const struct turner_scene *scene, size_t index, bool patterned)
{
    const struct turner_group *group = &scene->groups[index];
    *source = (struct turner_flat_source){
        .group = group,
        .scene = scene,
        .meshes = turner_calloc(group->mesh_count, sizeof *source->meshes),
    };
    uint32_t first = 0;
    for (size_t i = 0; i < group->mesh_count; i++) {
        const struct turner_mesh *mesh = &group->meshes[i];
        source->meshes[i] = (struct turner_flat_mesh){
            .first = first,
            .material = turner_flat_material(scene, mesh->material),
            .attributes =
                append_attributes(flat, mesh, turner_flat_needs_uvs(scene, mesh, patterned)),
        };
        first += mesh->triangle_count;
    }
}

static struct turner_gpu_primitive triangle_of(const struct turner_flat_source *source,
                                               uint32_t index)
{
    size_t low = 0, high = source->group->mesh_count; /* the last mesh that begins by then */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (source->meshes[middle].first <= index)
            low = middle;
        else
            high = middle;
    }
    const struct turner_flat_mesh *flat_mesh = &source->meshes[low];
    const struct turner_mesh *mesh = &source->group->meshes[low];
    uint32_t local = index - flat_mesh->first;
    const uint32_t *corners = mesh->triangles[local];
    struct turner_gpu_primitive out;
    round_point(out.a, mesh->positions[corners[0]]);
    round_point(out.b, mesh->positions[corners[1]]);
    round_point(out.c, mesh->positions[corners[2]]);
    out.id = TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT | index;
    out.material = flat_mesh->material;
    out.attributes = flat_mesh->attributes;
    if (out.attributes != TURNER_NO_INDEX)
        out.attributes += local;
    return out;
}

struct turner_gpu_primitive turner_flat_primitive(const struct turner_flat_source *source,
                                                  uint32_t index)
{
    const struct turner_group *group = source->group;
    const struct turner_scene *scene = source->scene;
    struct turner_gpu_primitive out;
    if (index < group->sphere_count) {
        const struct turner_sphere *sphere = &group->spheres[index];
        out = (struct turner_gpu_primitive){
            .b = {(float)sphere->radius},
            .id = TURNER_KIND_SPHERE << TURNER_KIND_SHIFT | index,
            .material = turner_flat_material(scene, sphere->material),
            .attributes = TURNER_NO_INDEX,
        };
        round_point(out.a, sphere->center);
        return out;
    }
    index -= (uint32_t)group->sphere_count;
    if (index >= group->cone_count)
        return triangle_of(source, index - (uint32_t)group->cone_count);
    const struct turner_cone *cone = &group->cones[index];
    out = (struct turner_gpu_primitive){
        .c = {(float)cone->base_radius, (float)cone->apex_radius, cone->capped ? 1.0f : 0.0f},
        .id = TURNER_KIND_CONE << TURNER_KIND_SHIFT | index,
        .material = turner_flat_material(scene, cone->material),
        .attributes = TURNER_NO_INDEX,
    };
    round_point(out.a, cone->base);
    round_point(out.b, cone->apex);
    return out;
}

struct measuring {
    struct turner_bvh_item *items;
    const struct turner_flat_source *source;
    uint32_t count, boxes; /* boxes: spheres and cones */
    bool triangles_first;
    struct turner_bvh_bounds *bounds; /* of each piece */
    atomic_uint broken;               /* the first primitive that does not fit a float */
};

static void measure_piece(void *user, uint32_t piece)
{
    struct measuring *m = user;
    struct turner_bvh_bounds bounds = TURNER_BVH_EMPTY;
    for (uint32_t i = piece * PIECE; i < turner_piece_end(m->count, PIECE, piece); i++) {
        uint32_t place = !m->triangles_first ? i
                         : i < m->boxes      ? i + (m->count - m->boxes)
                                             : i - m->boxes;
        struct turner_bvh_item *item = &m->items[place];
        struct turner_gpu_primitive primitive = turner_flat_primitive(m->source, i);
        bool fits = true;
        item->index = i;
        item->pad = 0;
        turner_primitive_bounds(item->lo, item->hi, &primitive);
        for (int axis = 0; axis < 3; axis++) {
            fits = fits && isfinite(item->lo[axis]) && isfinite(item->hi[axis]);
            bounds.lo[axis] = fminf(bounds.lo[axis], item->lo[axis]);
            bounds.hi[axis] = fmaxf(bounds.hi[axis], item->hi[axis]);
        }
        unsigned first = fits ? 0 : atomic_load(&m->broken);
        while (!fits && i < first && !atomic_compare_exchange_weak(&m->broken, &first, i))
            continue;
    }
    m->bounds[piece] = bounds;
}

static enum turner_result fail_size(const struct turner_flat_source *source, uint32_t index)
{
    static const char *const kinds[] = {"sphere", "cone", "triangle"};
    uint32_t id = turner_flat_primitive(source, index).id;
    const char *name = source->group->name;
    return turner_fail(TURNER_BAD_INPUT,
                       "%s %u of %s%s%s does not fit single precision (its numbers must stay below "
                       "3e38); make the scene smaller",
                       kinds[id >> TURNER_KIND_SHIFT], id & ((1u << TURNER_KIND_SHIFT) - 1),
                       name ? "group \"" : "the world", name ? name : "", name ? "\"" : "");
}

enum turner_result turner_flat_measure(struct turner_bvh_item *items,
                                       struct turner_flat_group *flat_group,
                                       const struct turner_flat_source *source,
                                       bool triangles_first)
{
    uint32_t count = (uint32_t)turner_group_primitive_count(source->group);
    uint32_t pieces = turner_pieces(count, PIECE);
    struct measuring m = {
        .items = items,
        .source = source,
        .count = count,
        .boxes = (uint32_t)(source->group->sphere_count + source->group->cone_count),
        .triangles_first = triangles_first,
        .bounds = turner_calloc(pieces, sizeof *m.bounds),
        .broken = UINT32_MAX,
    };
    turner_parallel_for(pieces, measure_piece, &m);
    struct turner_bvh_bounds bounds = TURNER_BVH_EMPTY;
    for (uint32_t i = 0; i < pieces; i++) {
        for (int axis = 0; axis < 3; axis++) {
            bounds.lo[axis] = fminf(bounds.lo[axis], m.bounds[i].lo[axis]);
            bounds.hi[axis] = fmaxf(bounds.hi[axis], m.bounds[i].hi[axis]);
        }
    }
    free(m.bounds);
    memcpy(flat_group->lo, bounds.lo, sizeof bounds.lo);
    memcpy(flat_group->hi, bounds.hi, sizeof bounds.hi);
    return m.broken < UINT32_MAX ? fail_size(source, m.broken) : TURNER_OK;
}

struct placing {
    struct turner_gpu_primitive *primitives;
    const struct turner_flat_source *source;
    const struct turner_bvh_item *items;
    uint32_t count;
};

static void place_piece(void *user, uint32_t piece)
{
    const struct placing *p = user;
    for (uint32_t i = piece * PIECE; i < turner_piece_end(p->count, PIECE, piece); i++)
        p->primitives[i] = turner_flat_primitive(p->source, p->items[i].index);
}

void turner_flat_place(struct turner_gpu_primitive *primitives,
                       const struct turner_flat_source *source, const struct turner_bvh_item *items,
                       uint32_t count)
{
    struct placing placing = {primitives, source, items, count};
    turner_parallel_for(turner_pieces(count, PIECE), place_piece, &placing);
}
