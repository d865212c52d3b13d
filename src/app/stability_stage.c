/* What scenes of sweeps are built of. */
#include "app/stability.h"
#include "base/memory.h"

struct turner_scene *turner_stage_create(int size, struct turner_vec3 from, struct turner_vec3 at,
                                         double vfov)
{
    struct turner_scene *scene = turner_scene_create();
    scene->settings.width = scene->settings.height = size;
    scene->settings.cutoff = 0;
    scene->camera.from = from;
    scene->camera.at = at;
    scene->camera.vfov = vfov;
    return scene;
}

uint32_t turner_stage_material(struct turner_scene *scene, struct turner_material material)
{
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = material;
    return (uint32_t)scene->material_count - 1;
}

uint32_t turner_stage_lamp(struct turner_scene *scene, double k_e)
{
    return turner_stage_material(
        scene, (struct turner_material){.k_e = TURNER_GREY(k_e), .medium = TURNER_NONE});
}

uint32_t turner_stage_glass(struct turner_scene *scene, double index, int priority,
                            struct turner_vec3 absorption, enum turner_fresnel fresnel)
{
    uint32_t medium = (uint32_t)scene->media_count;
    *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
        (struct turner_medium){.index = index, .absorption = absorption, .priority = priority};
    return turner_stage_material(scene, (struct turner_material){.k_r = TURNER_GREY(1),
                                                                 .k_t = TURNER_GREY(1),
                                                                 .fresnel = fresnel,
                                                                 .medium = medium});
}

void turner_stage_sphere(struct turner_scene *scene, struct turner_vec3 center, double radius,
                         uint32_t material)
{
    struct turner_group *world = &scene->groups[0];
    *TURNER_PUSH(world->spheres, world->sphere_count, world->sphere_capacity) =
        (struct turner_sphere){center, radius, material};
}

void turner_stage_plane(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, uint32_t material)
{
    *TURNER_PUSH(scene->planes, scene->plane_count, scene->plane_capacity) =
        (struct turner_plane){point, normal, turner_vec3_perpendicular(normal), material};
}

struct turner_mesh *turner_stage_mesh(struct turner_scene *scene, uint32_t vertices,
                                      uint32_t triangles, uint32_t material)
{
    struct turner_group *world = &scene->groups[0];
    struct turner_mesh *mesh = TURNER_PUSH(world->meshes, world->mesh_count, world->mesh_capacity);
    *mesh = (struct turner_mesh){
        .vertex_count = vertices, .triangle_count = triangles, .material = material};
    mesh->positions = turner_calloc(vertices, sizeof *mesh->positions);
    mesh->triangles = turner_calloc(triangles, sizeof *mesh->triangles);
    return mesh;
}

void turner_stage_light(struct turner_scene *scene, struct turner_light light)
{
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = light;
}

static void round_vector(struct turner_vec3 *v)
{
    *v = turner_vec3_of((double)(float)v->x, (double)(float)v->y, (double)(float)v->z);
}

static void round_group(struct turner_group *group)
{
    for (size_t i = 0; i < group->sphere_count; i++) {
        round_vector(&group->spheres[i].center);
        group->spheres[i].radius = (double)(float)group->spheres[i].radius;
    }
    for (size_t i = 0; i < group->cone_count; i++) {
        round_vector(&group->cones[i].base);
        round_vector(&group->cones[i].apex);
    }
    for (size_t i = 0; i < group->mesh_count; i++) {
        for (uint32_t k = 0; k < group->meshes[i].vertex_count; k++)
            round_vector(&group->meshes[i].positions[k]);
    }
}

void turner_stage_round(struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->group_count; i++)
        round_group(&scene->groups[i]);
    for (size_t i = 0; i < scene->plane_count; i++)
        round_vector(&scene->planes[i].point);
    for (size_t i = 0; i < scene->light_count; i++)
        round_vector(&scene->lights[i].position);
    /* the eye is rounded, the direction in which it looks stays */
    struct turner_vec3 gaze = turner_vec3_sub(scene->camera.at, scene->camera.from);
    round_vector(&scene->camera.from);
    scene->camera.at = turner_vec3_add(scene->camera.from, gaze);
}

double turner_stage_random(uint64_t *state)
{
    /* Knuth's MMIX generator; the high bits are the good ones */
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) / 9007199254740992.0;
}

struct turner_vec3 turner_stage_direction(uint64_t *state)
{
    double z = 2 * turner_stage_random(state) - 1, r = sqrt(1 - z * z);
    double angle = 6.283185307179586 * turner_stage_random(state);
    return turner_vec3_of(r * cos(angle), r * sin(angle), z);
}

struct turner_gpu_probe turner_stage_probe(struct turner_vec3 origin,
                                           struct turner_vec3 direction)
{
    return (struct turner_gpu_probe){
        .origin = {(float)origin.x, (float)origin.y, (float)origin.z},
        .direction = {(float)direction.x, (float)direction.y, (float)direction.z}};
}

struct turner_ray turner_stage_ray(const struct turner_gpu_probe *probe)
{
    const float *o = probe->origin, *d = probe->direction;
    return (struct turner_ray){
        .origin = {(turner_real)o[0], (turner_real)o[1], (turner_real)o[2]},
        .direction = {(turner_real)d[0], (turner_real)d[1], (turner_real)d[2]}};
}

double turner_stage_t(const struct turner_gpu_probe *probe, int turn)
{
    return (double)probe->t[turn] + (isinf(probe->t[turn]) ? 0 : (double)probe->t_rest[turn]);
}
