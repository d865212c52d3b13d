#include "render/needs.h"

#include "../shaders/shared.h"

static bool any(struct turner_vec3 v)
{
    return v.x != 0 || v.y != 0 || v.z != 0;
}

static uint32_t needs_of_material(const struct turner_material *m,
                                  const struct turner_settings *settings)
{
    uint32_t bits = 0;
    bool reflects = any(m->k_r), transmits = any(m->k_t);
    if (any(m->k_s))
        bits |= TURNER_NEEDS_SPECULAR;
    if (reflects)
        bits |= TURNER_NEEDS_REFLECTION;
    if (transmits)
        bits |= TURNER_NEEDS_TRANSMISSION | TURNER_NEEDS_MEDIA;
    if (transmits && settings->shadows == TURNER_SHADOWS_TINTED)
        bits |= TURNER_NEEDS_TINTED;
    if (transmits && (reflects || settings->spd_rays))
        bits |= TURNER_NEEDS_BRANCHING;
    enum turner_fresnel fresnel = turner_material_fresnel(settings, m);
    if (fresnel == TURNER_FRESNEL_SCHLICK && (reflects || transmits))
        bits |= TURNER_NEEDS_SCHLICK;
    if (fresnel == TURNER_FRESNEL_EXACT && transmits)
        bits |= TURNER_NEEDS_EXACT;
    if (m->conductor && reflects)
        bits |= TURNER_NEEDS_CONDUCTOR;
    if (m->pattern == TURNER_PATTERN_CHECKER)
        bits |= TURNER_NEEDS_CHECKER;
    if (m->pattern == TURNER_PATTERN_IMAGE)
        bits |= TURNER_NEEDS_IMAGES;
    return bits;
}

static uint32_t needs_of_group(const struct turner_group *group)
{
    uint32_t bits = 0;
    if (group->sphere_count)
        bits |= TURNER_NEEDS_SPHERES;
    if (group->cone_count)
        bits |= TURNER_NEEDS_CONES;
    for (size_t i = 0; i < group->mesh_count; i++) {
        bits |= TURNER_NEEDS_TRIANGLES;
        if (group->meshes[i].normals)
            bits |= TURNER_NEEDS_SMOOTH;
    }
    return bits;
}

static uint32_t needs_of_light(const struct turner_light *light)
{
    switch (light->kind) {
    case TURNER_LIGHT_DIRECTIONAL: return TURNER_NEEDS_DIRECTIONAL;
    case TURNER_LIGHT_POINT: return TURNER_NEEDS_POINT;
    case TURNER_LIGHT_SPOT: return TURNER_NEEDS_POINT | TURNER_NEEDS_SPOT;
    }
    return 0;
}

/* Surfaces that a straight line can cross: two of a sphere, four of a capped cone. */
static double surfaces_of_group(const struct turner_group *group)
{
    double surfaces = 2.0 * (double)group->sphere_count + 4.0 * (double)group->cone_count;
    for (size_t i = 0; i < group->mesh_count; i++)
        surfaces += group->meshes[i].triangle_count;
    return surfaces;
}

static void bound_loops(struct turner_needs *needs, const struct turner_scene *scene)
{
    double surfaces = (double)scene->plane_count + surfaces_of_group(&scene->groups[0]);
    for (size_t i = 0; i < scene->instance_count; i++)
        surfaces += surfaces_of_group(&scene->groups[scene->instances[i].group]);
    double crossings = needs->bits & TURNER_NEEDS_MEDIA ? fmin(surfaces, 1 << 20) : 0;

    double depth = scene->settings.depth;
    double nodes = needs->bits & TURNER_NEEDS_BRANCHING ? exp2(depth + 1) - 1 : depth + 1;
    double rays = nodes * (1 + (double)scene->light_count) * (1 + crossings);
    needs->max_crossings = (uint32_t)crossings;
    needs->max_steps = (uint32_t)fmin(rays, 2147483647.0);
    needs->stack = needs->bits & TURNER_NEEDS_BRANCHING && depth > 1 ? (uint32_t)depth : 1;
}

struct turner_needs turner_needs_of(const struct turner_scene *scene)
{
    struct turner_needs needs = {0};
    for (size_t i = 0; i < scene->material_count; i++)
        needs.bits |= needs_of_material(&scene->materials[i], &scene->settings);
    for (size_t i = 0; i < scene->group_count; i++)
        needs.bits |= needs_of_group(&scene->groups[i]);
    for (size_t i = 0; i < scene->light_count; i++)
        needs.bits |= needs_of_light(&scene->lights[i]);
    if (scene->plane_count)
        needs.bits |= TURNER_NEEDS_PLANES;
    if (scene->instance_count)
        needs.bits |= TURNER_NEEDS_INSTANCES;
    if (scene->camera.inside_count)
        needs.bits |= TURNER_NEEDS_MEDIA;
    for (size_t i = 0; i < scene->media_count && needs.bits & TURNER_NEEDS_MEDIA; i++)
        needs.bits |= any(scene->media[i].absorption) ? TURNER_NEEDS_ABSORPTION : 0;
    needs.bits |= scene->settings.shading == TURNER_SHADING_PHONG ? TURNER_NEEDS_PHONG
                                                                  : TURNER_NEEDS_CONSERVING;
    if (scene->background.kind == TURNER_BACKGROUND_GRADIENT)
        needs.bits |= TURNER_NEEDS_GRADIENT;
    if (scene->background.kind == TURNER_BACKGROUND_ENVIRONMENT)
        needs.bits |= TURNER_NEEDS_ENVIRONMENT;
    bound_loops(&needs, scene);
    return needs;
}

const char *turner_needs_name(uint32_t bit)
{
    switch (bit) {
    case TURNER_NEEDS_SPHERES: return "spheres";
    case TURNER_NEEDS_CONES: return "cones";
    case TURNER_NEEDS_TRIANGLES: return "triangles";
    case TURNER_NEEDS_PLANES: return "planes";
    case TURNER_NEEDS_INSTANCES: return "instances";
    case TURNER_NEEDS_SMOOTH: return "smooth normals";
    case TURNER_NEEDS_CHECKER: return "checker pattern";
    case TURNER_NEEDS_IMAGES: return "image textures";
    case TURNER_NEEDS_DIRECTIONAL: return "directional lights";
    case TURNER_NEEDS_POINT: return "point lights";
    case TURNER_NEEDS_SPOT: return "spot lights";
    case TURNER_NEEDS_PHONG: return "classic Phong";
    case TURNER_NEEDS_CONSERVING: return "energy-conserving Phong";
    case TURNER_NEEDS_SPECULAR: return "highlights";
    case TURNER_NEEDS_REFLECTION: return "reflection";
    case TURNER_NEEDS_TRANSMISSION: return "transmission";
    case TURNER_NEEDS_BRANCHING: return "branching rays";
    case TURNER_NEEDS_SCHLICK: return "Schlick's Fresnel";
    case TURNER_NEEDS_EXACT: return "exact Fresnel";
    case TURNER_NEEDS_CONDUCTOR: return "metals";
    case TURNER_NEEDS_MEDIA: return "media";
    case TURNER_NEEDS_ABSORPTION: return "absorption";
    case TURNER_NEEDS_TINTED: return "tinted shadows";
    case TURNER_NEEDS_GRADIENT: return "gradient background";
    case TURNER_NEEDS_ENVIRONMENT: return "environment picture";
    }
    return "unknown";
}
