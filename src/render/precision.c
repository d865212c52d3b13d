#include "render/precision.h"

#include <stdlib.h>

#include "base/memory.h"
#include "render/depth.h"

#define ROUNDINGS 8
#define UNIT 0x1p-24

/* A box around something, in the world. */
struct box {
    struct turner_vec3 lo, hi;
};

static const struct box nothing = {{INFINITY, INFINITY, INFINITY},
                                   {-INFINITY, -INFINITY, -INFINITY}};

static void box_add(struct box *box, struct turner_vec3 p, double radius)
{
    box->lo = turner_vec3_of(fmin(box->lo.x, p.x - radius), fmin(box->lo.y, p.y - radius),
                             fmin(box->lo.z, p.z - radius));
    box->hi = turner_vec3_of(fmax(box->hi.x, p.x + radius), fmax(box->hi.y, p.y + radius),
                             fmax(box->hi.z, p.z + radius));
}

static struct box box_of_mesh(const struct turner_mesh *mesh)
{
    struct box box = nothing;
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        box_add(&box, mesh->positions[i], 0);
    return box;
}

static struct box box_of_cone(const struct turner_cone *cone)
{
    struct box box = nothing;
    box_add(&box, cone->base, cone->base_radius);
    box_add(&box, cone->apex, cone->apex_radius);
    return box;
}

static struct box box_of_group(const struct turner_group *group)
{
    struct box box = nothing;
    for (size_t i = 0; i < group->sphere_count; i++)
        box_add(&box, group->spheres[i].center, group->spheres[i].radius);
    for (size_t i = 0; i < group->cone_count; i++) {
        struct box cone = box_of_cone(&group->cones[i]);
        box_add(&box, cone.lo, 0);
        box_add(&box, cone.hi, 0);
    }
    for (size_t i = 0; i < group->mesh_count; i++) {
        struct box mesh = box_of_mesh(&group->meshes[i]);
        box_add(&box, mesh.lo, 0);
        box_add(&box, mesh.hi, 0);
    }
    return box;
}

static struct box transformed(const struct turner_affine *map, const struct box *box)
{
    struct box out = nothing;
    for (int corner = 0; corner < 8; corner++) {
        struct turner_vec3 p = turner_vec3_of(corner & 1 ? box->hi.x : box->lo.x,
                                              corner & 2 ? box->hi.y : box->lo.y,
                                              corner & 4 ? box->hi.z : box->lo.z);
        box_add(&out, turner_affine_point(map, p), 0);
    }
    return out;
}

static double extent(struct turner_vec3 p)
{
    return fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
}

struct survey {
    struct turner_f32_error worst;
    struct turner_vec3 eye;
    double pixel; /* its size at distance 1 */
};

/* An object of that radius at that distance, with coordinates up to `size`. */
static void consider(struct survey *survey, enum turner_asker kind, size_t group, size_t index,
                     double size, double distance, double radius)
{
    double delta = ROUNDINGS * UNIT * fmax(size, extent(survey->eye));
    double pixels = delta / (distance * survey->pixel), shape = delta / radius;
    struct turner_f32_error *worst = &survey->worst;
    if (!(fmax(pixels, shape) > fmax(worst->pixels, worst->shape)))
        return;
    worst->pixels = pixels;
    worst->shape = shape;
    worst->object = (struct turner_why){kind, (uint32_t)group, (uint32_t)index, 1};
}

/* The distance to a box that the eye is inside of is taken to be half its diagonal. */
static void consider_box(struct survey *survey, enum turner_asker kind, size_t group, size_t index,
                         const struct box *box)
{
    struct turner_vec3 eye = survey->eye;
    double dx = fmax(0, fmax(box->lo.x - eye.x, eye.x - box->hi.x));
    double dy = fmax(0, fmax(box->lo.y - eye.y, eye.y - box->hi.y));
    double dz = fmax(0, fmax(box->lo.z - eye.z, eye.z - box->hi.z));
    double distance = hypot(hypot(dx, dy), dz);
    double radius = 0.5 * turner_vec3_length(turner_vec3_sub(box->hi, box->lo));
    if (box->lo.x > box->hi.x)
        return; /* nothing in it */
    consider(survey, kind, group, index, fmax(extent(box->lo), extent(box->hi)),
             distance > 0 ? distance : radius, radius);
}

static void survey_world(struct survey *survey, const struct turner_scene *scene)
{
    const struct turner_group *world = &scene->groups[0];
    for (size_t i = 0; i < world->sphere_count; i++) {
        const struct turner_sphere *s = &world->spheres[i];
        double away = turner_vec3_length(turner_vec3_sub(s->center, survey->eye));
        consider(survey, TURNER_ASKER_SPHERE, 0, i, extent(s->center) + s->radius,
                 fabs(away - s->radius), s->radius);
    }
    for (size_t i = 0; i < world->cone_count; i++) {
        struct box box = box_of_cone(&world->cones[i]);
        consider_box(survey, TURNER_ASKER_CONE, 0, i, &box);
    }
    for (size_t i = 0; i < world->mesh_count; i++) {
        struct box box = box_of_mesh(&world->meshes[i]);
        consider_box(survey, TURNER_ASKER_MESH, 0, i, &box);
    }
}

struct turner_f32_error turner_f32_error_of(const struct turner_scene *scene)
{
    const struct turner_camera *camera = &scene->camera;
    struct survey survey = {
        .eye = camera->from,
        .pixel = 2 * tan(camera->vfov / 2) / scene->settings.height,
    };
    survey_world(&survey, scene);
    for (size_t i = 0; i < scene->plane_count; i++) {
        const struct turner_plane *plane = &scene->planes[i];
        double height =
            fabs(turner_vec3_dot(turner_vec3_sub(camera->from, plane->point), plane->normal));
        if (height > 0) /* else it is seen edge on */
            consider(&survey, TURNER_ASKER_PLANE, 0, i, extent(plane->point), height, INFINITY);
    }
    struct box *boxes = turner_calloc(scene->group_count, sizeof *boxes);
    for (size_t i = 1; i < scene->group_count; i++)
        boxes[i] = box_of_group(&scene->groups[i]);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        struct box box = transformed(&instance->transform, &boxes[instance->group]);
        if (boxes[instance->group].lo.x <= boxes[instance->group].hi.x)
            consider_box(&survey, TURNER_ASKER_INSTANCE, 0, i, &box);
    }
    free(boxes);
    return survey.worst;
}

double turner_half_step(int bits)
{
    return bits == 32 ? 0.5 * UNIT : 0.5 / ((1 << bits) - 1);
}

bool turner_f64_can_show(const struct turner_scene *scene, int bits)
{
    if (turner_depth_of(scene).weight > 0 && scene->settings.depth > 0)
        return true;
    struct turner_f32_error error = turner_f32_error_of(scene);
    return !(fmax(error.pixels, error.shape) < turner_half_step(bits));
}
