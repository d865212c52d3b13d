/* Where POV-Ray goes in and out of media. It has no media priorities and no Fresnel formula for a
 * solid in another one (version 3.7 compares its index with itself on the way out), and the surface
 * of an object toggles: so every transmissive object must be closed and stand alone. Boxes around
 * things decide, which may refuse a scene that would have worked, never the other way round. A hole
 * is told as a surface of the same object: crossing it toggles that object's inside. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/pov_parts.h"

struct solid {
    struct turner_vec3 lo, hi; /* box around it, world */
    uint32_t material;
    bool holds_eye, may_hold_eye;
    const struct turner_sphere *sphere; /* what it is, where it may be a hole or have one */
    const struct turner_mesh *mesh;
};

struct solids {
    struct solid *list;
    size_t count, capacity;
};

static double component(struct turner_vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

static bool boxes_meet(const struct solid *a, const struct solid *b)
{
    for (int axis = 0; axis < 3; axis++) {
        if (component(a->hi, axis) < component(b->lo, axis) ||
            component(b->hi, axis) < component(a->lo, axis))
            return false;
    }
    return true;
}

static struct turner_vec3 lower(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
}

static struct turner_vec3 upper(struct turner_vec3 a, struct turner_vec3 b)
{
    return turner_vec3_of(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
}

static struct solid *add_solid(struct solids *solids, const struct turner_scene *scene,
                               const struct turner_affine *transform, struct turner_vec3 lo,
                               struct turner_vec3 hi, uint32_t material, bool holds_eye)
{
    struct solid s = {.material = material, .holds_eye = holds_eye};
    for (int corner = 0; corner < 8; corner++) {
        struct turner_vec3 p = turner_affine_point(
            transform, turner_vec3_of(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y,
                                      corner & 4 ? hi.z : lo.z));
        s.lo = corner ? lower(s.lo, p) : p;
        s.hi = corner ? upper(s.hi, p) : p;
    }
    struct solid eye = {.lo = scene->camera.from, .hi = scene->camera.from};
    s.may_hold_eye = holds_eye || boxes_meet(&s, &eye);
    struct solid *added = TURNER_PUSH(solids->list, solids->count, solids->capacity);
    *added = s;
    return added;
}

static int compare_points(const void *a, const void *b)
{
    const struct turner_vec3 *p = a, *q = b;
    for (int axis = 0; axis < 3; axis++) {
        double x = component(*p, axis), y = component(*q, axis);
        if (x != y)
            return x < y ? -1 : 1;
    }
    return 0;
}

struct edge {
    struct turner_vec3 ends[2]; /* in order */
    int way;                    /* +1: the triangle runs along it, −1: against it */
};

static int compare_edges(const void *a, const void *b)
{
    const struct edge *e = a, *f = b;
    int first = compare_points(&e->ends[0], &f->ends[0]);
    return first ? first : compare_points(&e->ends[1], &f->ends[1]);
}

/* Whether triangles run along every edge as often as against it. */
static bool is_closed(const struct turner_mesh *mesh)
{
    size_t count = (size_t)mesh->triangle_count * 3;
    struct edge *edges = turner_calloc(count, sizeof *edges);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *t = mesh->triangles[i / 3];
        struct turner_vec3 a = mesh->positions[t[i % 3]], b = mesh->positions[t[(i + 1) % 3]];
        int way = compare_points(&a, &b) <= 0 ? 1 : -1;
        edges[i] = (struct edge){{way > 0 ? a : b, way > 0 ? b : a}, way};
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    bool closed = true;
    for (size_t i = 0; i < count && closed;) {
        int sum = 0;
        size_t from = i;
        for (; i < count && compare_edges(&edges[from], &edges[i]) == 0; i++)
            sum += edges[i].way;
        closed = sum == 0 || compare_points(&edges[from].ends[0], &edges[from].ends[1]) == 0;
    }
    free(edges);
    return closed;
}

static enum turner_result open_solid(const struct turner_scene *scene, uint32_t material,
                                     const char *what)
{
    return turner_fail(TURNER_BAD_INPUT, "%s is on %s that is open: POV-Ray cannot tell its inside "
                                         "from its outside, close it",
                       turner_pov_material_name(scene, material), what);
}

static bool transmits(const struct turner_scene *scene, uint32_t material)
{
    return !turner_pov_zero(scene->materials[material].k_t);
}

static enum turner_result add_mesh(struct solids *solids, const struct turner_scene *scene,
                                   const struct turner_affine *transform,
                                   const struct turner_mesh *mesh, uint32_t material)
{
    if (!mesh->triangle_count)
        return TURNER_OK;
    if (!is_closed(mesh))
        return open_solid(scene, material, "a mesh");
    struct turner_vec3 lo = mesh->positions[0], hi = lo;
    for (uint32_t i = 1; i < mesh->vertex_count; i++) {
        lo = lower(lo, mesh->positions[i]);
        hi = upper(hi, mesh->positions[i]);
    }
    add_solid(solids, scene, transform, lo, hi, material, false)->mesh = mesh;
    return TURNER_OK;
}

static enum turner_result add_group(struct solids *solids, const struct turner_scene *scene,
                                    const struct turner_group *group,
                                    const struct turner_affine *transform, uint32_t override)
{
    struct turner_affine inverse = TURNER_AFFINE_IDENTITY;
    turner_affine_invert(&inverse, transform);
    struct turner_vec3 eye = turner_affine_point(&inverse, scene->camera.from);
    for (size_t i = 0; i < group->sphere_count; i++) {
        const struct turner_sphere *s = &group->spheres[i];
        uint32_t m = override != TURNER_NONE ? override : s->material;
        struct turner_vec3 r = turner_vec3_of(s->radius, s->radius, s->radius);
        if (transmits(scene, m))
            add_solid(solids, scene, transform, turner_vec3_sub(s->center, r),
                      turner_vec3_add(s->center, r), m,
                      turner_vec3_length(turner_vec3_sub(eye, s->center)) <= s->radius)
                ->sphere = s;
    }
    for (size_t i = 0; i < group->cone_count; i++) {
        const struct turner_cone *c = &group->cones[i];
        uint32_t m = override != TURNER_NONE ? override : c->material;
        if (!transmits(scene, m))
            continue;
        if (!c->capped)
            return open_solid(scene, m, "a cone or cylinder");
        struct turner_vec3 b = turner_vec3_of(c->base_radius, c->base_radius, c->base_radius);
        struct turner_vec3 a = turner_vec3_of(c->apex_radius, c->apex_radius, c->apex_radius);
        add_solid(solids, scene, transform,
                  lower(turner_vec3_sub(c->base, b), turner_vec3_sub(c->apex, a)),
                  upper(turner_vec3_add(c->base, b), turner_vec3_add(c->apex, a)), m, false);
    }
    for (size_t i = 0; i < group->mesh_count; i++) {
        uint32_t m = override != TURNER_NONE ? override : group->meshes[i].material;
        if (transmits(scene, m))
            TURNER_TRY(add_mesh(solids, scene, transform, &group->meshes[i], m));
    }
    return TURNER_OK;
}

/* A half space meets whatever is not wholly before its plane. */
static enum turner_result check_plane(const struct turner_scene *scene,
                                      const struct turner_plane *plane,
                                      const struct solids *solids)
{
    if (!turner_pov_zero(scene->media[scene->materials[plane->material].medium].absorption))
        return turner_fail(TURNER_BAD_INPUT, "%s is on a plane: in POV-Ray a half space does not "
                           "absorb what never leaves it, use a box",
                           turner_pov_material_name(scene, plane->material));
    for (size_t i = 0; i < solids->count; i++) {
        const struct solid *s = &solids->list[i];
        for (int corner = 0; corner < 8; corner++) {
            struct turner_vec3 p = turner_vec3_of(corner & 1 ? s->hi.x : s->lo.x,
                                                  corner & 2 ? s->hi.y : s->lo.y,
                                                  corner & 4 ? s->hi.z : s->lo.z);
            if (turner_vec3_dot(turner_vec3_sub(p, plane->point), plane->normal) <= 0)
                return turner_fail(TURNER_BAD_INPUT, "POV-Ray has no media priorities: %s is in or "
                                   "at the half space of a transmissive plane, keep them apart",
                                   turner_pov_material_name(scene, s->material));
        }
    }
    return TURNER_OK;
}

static int compare_solids(const void *a, const void *b)
{
    const struct solid *s = a, *t = b;
    return (s->lo.x > t->lo.x) - (s->lo.x < t->lo.x);
}

static bool spheres_apart(const struct turner_sphere *a, const struct turner_sphere *b)
{
    return a && b &&
           turner_vec3_length(turner_vec3_sub(a->center, b->center)) > a->radius + b->radius;
}

static bool sphere_within(const struct turner_sphere *sphere, const struct solid *container)
{
    if (container->sphere) {
        struct turner_vec3 way = turner_vec3_sub(sphere->center, container->sphere->center);
        return turner_vec3_length(way) + sphere->radius < container->sphere->radius;
    }
    const struct turner_mesh *mesh = container->mesh; /* closed: behind all its faces is inside */
    for (uint32_t i = 0; mesh && i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        struct turner_vec3 p = mesh->positions[t[0]];
        struct turner_vec3 n = turner_vec3_cross(turner_vec3_sub(mesh->positions[t[1]], p),
                                                 turner_vec3_sub(mesh->positions[t[2]], p));
        if (turner_vec3_dot(turner_vec3_sub(sphere->center, p), n) >=
            -sphere->radius * turner_vec3_length(n))
            return false;
    }
    return mesh != NULL;
}

/* Whether `inner` is air in `outer`, and all else is as it must be for that. */
static enum turner_result check_hole(bool *is_hole, const struct turner_scene *scene,
                                     const struct solid *inner, const struct solid *outer)
{
    uint32_t air = scene->materials[inner->material].medium;
    uint32_t glass = scene->materials[outer->material].medium;
    *is_hole = inner->sphere && air > glass && scene->media[air].index == 1 &&
               turner_pov_zero(scene->media[air].absorption) &&
               sphere_within(inner->sphere, outer);
    if (!*is_hole)
        return TURNER_OK;
    if (inner->may_hold_eye || outer->may_hold_eye)
        return turner_fail(TURNER_BAD_INPUT, "the camera is in or near a hollow solid of %s: "
                           "POV-Ray does not know what it is in there, move it away",
                           turner_pov_material_name(scene, outer->material));
    return turner_pov_check_secondary(scene, inner->material, 1 / scene->media[glass].index);
}

static enum turner_result check_apart(struct turner_pov_holes *holes,
                                      const struct turner_scene *scene, struct solids *solids)
{
    if (solids->count)
        qsort(solids->list, solids->count, sizeof *solids->list, compare_solids);
    for (size_t i = 0; i < solids->count; i++) {
        for (size_t k = i + 1; k < solids->count; k++) {
            const struct solid *a = &solids->list[i], *b = &solids->list[k];
            if (b->lo.x > a->hi.x)
                break;
            if (!boxes_meet(a, b) || spheres_apart(a->sphere, b->sphere))
                continue;
            bool b_in_a = false, a_in_b = false;
            TURNER_TRY(check_hole(&b_in_a, scene, b, a));
            TURNER_TRY(check_hole(&a_in_b, scene, a, b));
            if (a_in_b || b_in_a) {
                const struct solid *in = b_in_a ? b : a, *around = b_in_a ? a : b;
                *TURNER_PUSH(holes->list, holes->count, holes->capacity) = (struct turner_pov_hole){
                    in->sphere, around->sphere ? (const void *)around->sphere : around->mesh};
                continue;
            }
            char first[256];
            snprintf(first, sizeof first, "%s", turner_pov_material_name(scene, a->material));
            return turner_fail(TURNER_BAD_INPUT, "POV-Ray has no media priorities: solids of %s "
                               "and %s overlap, or the boxes around them do; move them apart", first,
                               turner_pov_material_name(scene, b->material));
        }
    }
    return TURNER_OK;
}

static enum turner_result check_eye(const struct turner_scene *scene, const struct solids *solids)
{
    const struct turner_camera *camera = &scene->camera;
    uint32_t found = 0;
    bool same = true;
    for (size_t i = 0; i < solids->count; i++) {
        const struct solid *s = &solids->list[i];
        if (s->may_hold_eye && !s->holds_eye)
            return turner_fail(TURNER_BAD_INPUT, "the camera is in or near a solid of %s: POV-Ray "
                               "knows it inside of spheres and half spaces only, move it away",
                               turner_pov_material_name(scene, s->material));
        if (s->holds_eye) {
            found++;
            same = same && camera->inside_count == 1 &&
                   camera->inside[0] == scene->materials[s->material].medium;
        }
    }
    for (size_t i = 0; i < scene->plane_count; i++) {
        const struct turner_plane *p = &scene->planes[i];
        if (transmits(scene, p->material) &&
            turner_vec3_dot(turner_vec3_sub(camera->from, p->point), p->normal) <= 0) {
            found++;
            same = same && camera->inside_count == 1 &&
                   camera->inside[0] == scene->materials[p->material].medium;
        }
    }
    if (found != camera->inside_count || !same)
        return turner_fail(TURNER_BAD_INPUT, "POV-Ray finds the camera inside of %u media by where "
                           "it stands, the scene says %u: mend the camera's \"inside\", or move it",
                           (unsigned)found, (unsigned)camera->inside_count);
    return TURNER_OK;
}

/* Light from a lamp inside of an absorbing solid is not absorbed by POV-Ray. */
static enum turner_result check_lamps(const struct turner_scene *scene, const struct solids *solids)
{
    if (scene->settings.shadows == TURNER_SHADOWS_OPAQUE)
        return TURNER_OK;
    for (size_t i = 0; i < scene->light_count; i++) {
        const struct turner_light *light = &scene->lights[i];
        struct solid lamp = {.lo = light->position, .hi = light->position};
        for (size_t k = 0; k < solids->count && light->kind != TURNER_LIGHT_DIRECTIONAL; k++) {
            const struct solid *s = &solids->list[k];
            if (boxes_meet(&lamp, s) &&
                !turner_pov_zero(scene->media[scene->materials[s->material].medium].absorption))
                return turner_fail(TURNER_BAD_INPUT, "light %zu is in or near an absorbing solid "
                                   "of %s: POV-Ray does not absorb its light, move it away", i,
                                   turner_pov_material_name(scene, s->material));
        }
    }
    return TURNER_OK;
}

enum turner_result turner_pov_check_solids(struct turner_pov_holes *holes,
                                           const struct turner_scene *scene)
{
    struct solids solids = {0};
    struct turner_affine identity = TURNER_AFFINE_IDENTITY;
    size_t half_spaces = 0;
    enum turner_result result;
    TURNER_TRY_DONE(add_group(&solids, scene, &scene->groups[0], &identity, TURNER_NONE));
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        size_t before = solids.count;
        TURNER_TRY_DONE(add_group(&solids, scene, &scene->groups[instance->group],
                                  &instance->transform, instance->material));
        for (size_t k = before; k < solids.count; k++) /* holes are looked for in the world alone */
            solids.list[k].sphere = NULL, solids.list[k].mesh = NULL;
    }
    for (size_t i = 0; i < scene->plane_count; i++) {
        if (!transmits(scene, scene->planes[i].material))
            continue;
        TURNER_TRY_DONE(check_plane(scene, &scene->planes[i], &solids));
        if (half_spaces++) {
            result = turner_fail(TURNER_BAD_INPUT, "POV-Ray has no media priorities: two "
                                 "transmissive planes overlap, use one");
            goto done;
        }
    }
    TURNER_TRY_DONE(check_apart(holes, scene, &solids));
    TURNER_TRY_DONE(check_eye(scene, &solids));
    TURNER_TRY_DONE(check_lamps(scene, &solids));
done:
    free(solids.list);
    return result;
}
