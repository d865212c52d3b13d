#include "reference/world.h"

#include <stdlib.h>

#include "base/memory.h"

/* ---- primitives of a group by number ---- */

/* The mesh that holds triangle `primitive`; *index becomes its number in the mesh. */
static const struct turner_mesh *find_mesh(const struct turner_world_group *group,
                                           uint32_t primitive, uint32_t *index)
{
    size_t low = 0, high = group->group->mesh_count;
    while (high - low > 1) {
        size_t half = (low + high) / 2;
        if (group->meshes[half].first <= primitive)
            low = half;
        else
            high = half;
    }
    *index = primitive - group->meshes[low].first;
    return group->meshes[low].mesh;
}

static bool intersect_primitive(struct turner_hit *hit, const struct turner_world_group *group,
                                uint32_t primitive, const struct turner_ray *ray,
                                const struct turner_departure *self)
{
    const struct turner_group *g = group->group;
    if (primitive < g->sphere_count)
        return turner_sphere_intersect(hit, &g->spheres[primitive], ray, self);
    if (primitive < g->sphere_count + g->cone_count)
        return turner_cone_intersect(hit, &g->cones[primitive - g->sphere_count], ray, self);
    uint32_t index;
    const struct turner_mesh *mesh = find_mesh(group, primitive, &index);
    return turner_triangle_intersect(hit, mesh, index, ray, self);
}

static struct turner_box box_of_ball(turner_vector center, turner_vector reach)
{
    return (struct turner_box){sub(center, reach), add(center, reach)};
}

static struct turner_box box_of_primitive(const struct turner_world_group *group,
                                          uint32_t primitive)
{
    const struct turner_group *g = group->group;
    struct turner_box box = TURNER_BOX_EMPTY;
    if (primitive < g->sphere_count) {
        const struct turner_sphere *sphere = &g->spheres[primitive];
        box = box_of_ball(widen(sphere->center), grey(sphere->radius));
    } else if (primitive < g->sphere_count + g->cone_count) {
        const struct turner_cone *cone = &g->cones[primitive - g->sphere_count];
        turner_vector a = normalize(sub(widen(cone->apex), widen(cone->base)));
        /* a disc reaches r·√(1 − a²) along each coordinate axis */
        turner_vector reach = vector(sqrtl(fmaxl(0, 1 - a.x * a.x)), sqrtl(fmaxl(0, 1 - a.y * a.y)),
                                     sqrtl(fmaxl(0, 1 - a.z * a.z)));
        box = box_of_ball(widen(cone->base), scale(reach, cone->base_radius));
        struct turner_box end = box_of_ball(widen(cone->apex), scale(reach, cone->apex_radius));
        turner_box_include(&box, end.low);
        turner_box_include(&box, end.high);
    } else {
        uint32_t index;
        const struct turner_mesh *mesh = find_mesh(group, primitive, &index);
        for (int i = 0; i < 3; i++)
            turner_box_include(&box, widen(mesh->positions[mesh->triangles[index][i]]));
    }
    return box;
}

/* ---- making ready ---- */

static void create_group(struct turner_world_group *group, const struct turner_group *g)
{
    group->group = g;
    group->meshes = turner_calloc(g->mesh_count, sizeof *group->meshes);
    uint32_t count = (uint32_t)(g->sphere_count + g->cone_count);
    for (size_t i = 0; i < g->mesh_count; i++) {
        group->meshes[i] = (struct turner_world_mesh){&g->meshes[i], count};
        count += g->meshes[i].triangle_count;
    }
    struct turner_box *boxes = turner_calloc(count, sizeof *boxes);
    for (uint32_t i = 0; i < count; i++)
        boxes[i] = box_of_primitive(group, i);
    turner_tree_create(&group->tree, boxes, count);
    free(boxes);
}

/* By cofactors. False when there is no inverse. */
static bool invert(struct turner_map *inverse, const struct turner_map *map)
{
    turner_vector r[3];
    for (int i = 0; i < 3; i++)
        r[i] = vector(map->m[i][0], map->m[i][1], map->m[i][2]);
    turner_real determinant = dot(r[0], cross(r[1], r[2]));
    if (determinant == 0 || !isfinite(1 / determinant))
        return false;
    turner_vector columns[3] = {cross(r[1], r[2]), cross(r[2], r[0]), cross(r[0], r[1])};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            inverse->m[row][column] = coordinate(columns[column], row) / determinant;
        inverse->m[row][3] = 0;
    }
    turner_vector moved =
        map_vector(inverse, vector(map->m[0][3], map->m[1][3], map->m[2][3]));
    inverse->m[0][3] = -moved.x;
    inverse->m[1][3] = -moved.y;
    inverse->m[2][3] = -moved.z;
    return true;
}

static struct turner_box box_of_instance(const struct turner_world *world,
                                         const struct turner_world_instance *instance)
{
    const struct turner_tree *tree = &world->groups[instance->group].tree;
    struct turner_box box = TURNER_BOX_EMPTY;
    if (!tree->nodes) /* an empty group: a box that no ray meets */
        return box_of_ball(grey(0), grey(-1));
    const double(*bounds)[3] = tree->nodes[0].bounds;
    turner_real size = 0;
    for (int corner = 0; corner < 8; corner++) {
        turner_vector p =
            vector(bounds[corner & 1][0], bounds[corner >> 1 & 1][1], bounds[corner >> 2][2]);
        turner_box_include(&box, map_point(&instance->to_world, p));
        size = fmaxl(size, magnitude(p));
    }
    turner_vector pad = grey(64 * LDBL_EPSILON * map_magnitude(&instance->to_world, size));
    return (struct turner_box){sub(box.low, pad), add(box.high, pad)};
}

static enum turner_result create_instances(struct turner_world *world)
{
    const struct turner_scene *scene = world->scene;
    uint32_t count = (uint32_t)scene->instance_count;
    world->instances = turner_calloc(count, sizeof *world->instances);
    for (uint32_t i = 0; i < count; i++) {
        const struct turner_instance *from = &scene->instances[i];
        struct turner_world_instance *instance = &world->instances[i];
        instance->group = from->group;
        instance->material = from->material;
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 4; column++)
                instance->to_world.m[row][column] = from->transform.m[row][column];
        }
        if (!invert(&instance->to_group, &instance->to_world)) {
            return turner_fail(TURNER_BAD_INPUT,
                               "instance %u: its transform flattens space; scale by no 0", i);
        }
    }
    struct turner_box *boxes = turner_calloc(count, sizeof *boxes);
    for (uint32_t i = 0; i < count; i++)
        boxes[i] = box_of_instance(world, &world->instances[i]);
    turner_tree_create(&world->tree, boxes, count);
    free(boxes);
    return TURNER_OK;
}

static enum turner_result check_memory(const struct turner_scene *scene)
{
    size_t bytes = scene->instance_count *
                       (sizeof(struct turner_world_instance) + sizeof(struct turner_box)) +
                   turner_tree_bytes(scene->instance_count);
    size_t largest_boxes = 0; /* of one group at a time */
    for (size_t i = 0; i < scene->group_count; i++) {
        size_t count = turner_group_primitive_count(&scene->groups[i]);
        size_t boxes = count * sizeof(struct turner_box);
        bytes += turner_tree_bytes(count);
        largest_boxes = boxes > largest_boxes ? boxes : largest_boxes;
    }
    bytes += largest_boxes;
    uint64_t available = turner_memory_available();
    if (bytes <= available)
        return TURNER_OK;
    return turner_fail(TURNER_DEVICE,
                       "the reference tracer needs %zu MiB for this scene, %llu MiB are free; use "
                       "a smaller scene or a machine with more memory",
                       bytes >> 20, (unsigned long long)(available >> 20));
}

enum turner_result turner_world_create(struct turner_world *world,
                                       const struct turner_scene *scene)
{
    *world = (struct turner_world){.scene = scene};
    TURNER_TRY(check_memory(scene));
    world->groups = turner_calloc(scene->group_count, sizeof *world->groups);
    for (size_t i = 0; i < scene->group_count; i++)
        create_group(&world->groups[i], &scene->groups[i]);
    return create_instances(world);
}

void turner_world_destroy(struct turner_world *world)
{
    for (size_t i = 0; world->groups && i < world->scene->group_count; i++) {
        free(world->groups[i].meshes);
        turner_tree_destroy(&world->groups[i].tree);
    }
    free(world->groups);
    free(world->instances);
    turner_tree_destroy(&world->tree);
    *world = (struct turner_world){0};
}

/* ---- intersecting ---- */

/* A walk through a world, or through one group of it. */
struct walk {
    const struct turner_world *world;
    const struct turner_world_group *group; /* the one being walked, */
    int64_t instance;                       /* as this instance, */
    const struct turner_ray *ray;           /* with the ray in its space */
    struct turner_hit best;                 /* best.t starts as t_max */
    bool found, any;                        /* any: the first hit ends the walk */
};

static bool lower(const struct turner_place *a, const struct turner_place *b)
{
    return a->instance != b->instance ? a->instance < b->instance : a->primitive < b->primitive;
}

static const struct turner_departure *departure_from(const struct turner_ray *ray,
                                                     int64_t instance, uint32_t primitive)
{
    const struct turner_departure *leaves = &ray->leaves;
    bool same = leaves->from_surface && leaves->place.instance == instance &&
                leaves->place.primitive == primitive;
    return same ? leaves : NULL;
}

static void keep(struct walk *walk, struct turner_hit hit, int64_t instance, uint32_t primitive)
{
    hit.place.instance = instance;
    hit.place.primitive = primitive;
    if (hit.t < walk->best.t ||
        (walk->found && hit.t == walk->best.t && lower(&hit.place, &walk->best.place))) {
        walk->best = hit;
        walk->found = true;
    }
}

static bool visit_primitive(void *user, uint32_t primitive, turner_real *t_max)
{
    struct walk *walk = user;
    struct turner_hit hit = {0};
    const struct turner_departure *self = departure_from(walk->ray, walk->instance, primitive);
    if (intersect_primitive(&hit, walk->group, primitive, walk->ray, self))
        keep(walk, hit, walk->instance, primitive);
    *t_max = walk->best.t;
    return !(walk->found && walk->any);
}

static bool visit_instance(void *user, uint32_t index, turner_real *t_max)
{
    struct walk *walk = user;
    const struct turner_world_instance *instance = &walk->world->instances[index];
    const struct turner_ray *world_ray = walk->ray;
    struct turner_ray group_ray = {.origin = map_point(&instance->to_group, world_ray->origin),
                                   .direction =
                                       map_vector(&instance->to_group, world_ray->direction),
                                   .leaves = world_ray->leaves};
    walk->group = &walk->world->groups[instance->group];
    walk->instance = (int64_t)index + 1;
    walk->ray = &group_ray;
    turner_tree_walk(&walk->group->tree, &group_ray, walk->best.t, visit_primitive, walk);
    walk->ray = world_ray;
    *t_max = walk->best.t;
    return !(walk->found && walk->any);
}

static struct walk walk_world(const struct turner_world *world, const struct turner_ray *ray,
                              turner_real t_max, bool any)
{
    const struct turner_scene *scene = world->scene;
    struct walk walk = {.world = world, .ray = ray, .any = any, .best.t = t_max};
    for (uint32_t i = 0; i < scene->plane_count; i++) {
        struct turner_hit hit = {0};
        const struct turner_departure *self = departure_from(ray, TURNER_INSTANCE_PLANES, i);
        if (turner_plane_intersect(&hit, &scene->planes[i], ray, self))
            keep(&walk, hit, TURNER_INSTANCE_PLANES, i);
    }
    walk.group = &world->groups[0];
    walk.instance = TURNER_INSTANCE_WORLD;
    if (!(walk.found && any))
        turner_tree_walk(&walk.group->tree, ray, walk.best.t, visit_primitive, &walk);
    if (!(walk.found && any))
        turner_tree_walk(&world->tree, ray, walk.best.t, visit_instance, &walk);
    return walk;
}

bool turner_world_intersect(struct turner_hit *hit, const struct turner_world *world,
                            const struct turner_ray *ray, turner_real t_max)
{
    struct walk walk = walk_world(world, ray, t_max, false);
    *hit = walk.best;
    return walk.found;
}

bool turner_world_occluded(const struct turner_world *world, const struct turner_ray *ray,
                           turner_real t_max)
{
    return walk_world(world, ray, t_max, true).found;
}

/* ---- surfaces ---- */

static void group_surface(struct turner_surface *surface, const struct turner_world_group *group,
                          const struct turner_ray *ray, const struct turner_hit *hit)
{
    const struct turner_group *g = group->group;
    uint32_t primitive = hit->place.primitive, index;
    if (primitive < g->sphere_count) {
        turner_sphere_surface(surface, &g->spheres[primitive], ray, hit);
        surface->material = g->spheres[primitive].material;
    } else if (primitive < g->sphere_count + g->cone_count) {
        const struct turner_cone *cone = &g->cones[primitive - g->sphere_count];
        turner_cone_surface(surface, cone, ray, hit);
        surface->material = cone->material;
    } else {
        const struct turner_mesh *mesh = find_mesh(group, primitive, &index);
        turner_triangle_surface(surface, mesh, index, ray, hit);
        surface->material = mesh->material;
    }
}

void turner_world_surface(struct turner_surface *surface, const struct turner_world *world,
                          const struct turner_ray *ray, const struct turner_hit *hit)
{
    *surface = (struct turner_surface){.place = hit->place};
    if (hit->place.instance == TURNER_INSTANCE_PLANES) {
        const struct turner_plane *plane = &world->scene->planes[hit->place.primitive];
        turner_plane_surface(surface, plane, ray, hit);
        surface->material = plane->material;
        return;
    }
    if (hit->place.instance == TURNER_INSTANCE_WORLD) {
        group_surface(surface, &world->groups[0], ray, hit);
        return;
    }
    const struct turner_world_instance *instance = &world->instances[hit->place.instance - 1];
    struct turner_ray group_ray = {.origin = map_point(&instance->to_group, ray->origin),
                                   .direction = map_vector(&instance->to_group, ray->direction)};
    group_surface(surface, &world->groups[instance->group], &group_ray, hit);
    surface->magnitude = map_magnitude(&instance->to_world, surface->magnitude);
    surface->p = map_point(&instance->to_world, surface->p);
    surface->ng = normalize(map_transposed(&instance->to_group, surface->ng));
    surface->ns = normalize(map_transposed(&instance->to_group, surface->ns));
    if (instance->material != TURNER_NONE)
        surface->material = instance->material;
}

struct turner_ray turner_surface_leave(const struct turner_surface *surface,
                                       turner_vector direction, bool outward)
{
    const turner_real ulps = 256;
    turner_real offset = ulps * LDBL_EPSILON * surface->magnitude;
    return (struct turner_ray){
        .origin = add(surface->p, scale(surface->ng, outward ? offset : -offset)),
        .direction = direction,
        .leaves = {.from_surface = true, .place = surface->place, .outward = outward}};
}
