#include "render/needs.h"

#include <string.h>

#include "../shaders/shared.h"
#include "render/usage.h"

static bool any(struct turner_vec3 v)
{
    return v.x != 0 || v.y != 0 || v.z != 0;
}

struct collector {
    uint32_t bits;
    struct turner_why *why; /* TURNER_NEEDS_COUNT */
};

/* `count` things of that kind, the first of which has that place, ask for the features `bits`. The
 * first kind to ask is the one that is named and counted. */
static void ask(struct collector *needs, uint32_t bits, struct turner_why asker)
{
    needs->bits |= bits;
    for (uint32_t i = 0; i < TURNER_NEEDS_COUNT; i++) {
        struct turner_why *why = &needs->why[i];
        if (!(bits >> i & 1))
            continue;
        if (why->count == 0)
            *why = asker;
        else if (why->asker == asker.asker)
            why->count += asker.count;
    }
}

static struct turner_why one(enum turner_asker asker, size_t index)
{
    return (struct turner_why){asker, 0, (uint32_t)index, 1};
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

static void ask_of_group(struct collector *needs, const struct turner_scene *scene, size_t index)
{
    const struct turner_group *group = &scene->groups[index];
    uint32_t g = (uint32_t)index;
    ask(needs, group->sphere_count ? TURNER_NEEDS_SPHERES : 0,
        (struct turner_why){TURNER_ASKER_SPHERE, g, 0, group->sphere_count});
    ask(needs, group->cone_count ? TURNER_NEEDS_CONES : 0,
        (struct turner_why){TURNER_ASKER_CONE, g, 0, group->cone_count});
    for (size_t i = 0; i < group->mesh_count; i++)
        ask(needs, TURNER_NEEDS_TRIANGLES | (group->meshes[i].normals ? TURNER_NEEDS_SMOOTH : 0),
            (struct turner_why){TURNER_ASKER_MESH, g, (uint32_t)i, 1});
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

/* Everything but materials and media. */
static void ask_of_scene(struct collector *needs, const struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->light_count; i++)
        ask(needs, needs_of_light(&scene->lights[i]), one(TURNER_ASKER_LIGHT, i));
    ask(needs, scene->plane_count ? TURNER_NEEDS_PLANES : 0,
        (struct turner_why){TURNER_ASKER_PLANE, 0, 0, scene->plane_count});
    ask(needs, scene->instance_count ? TURNER_NEEDS_INSTANCES : 0,
        (struct turner_why){TURNER_ASKER_INSTANCE, 0, 0, scene->instance_count});
    ask(needs, scene->settings.shading == TURNER_SHADING_PHONG ? TURNER_NEEDS_PHONG
                                                               : TURNER_NEEDS_CONSERVING,
        one(TURNER_ASKER_SHADING, 0));
    if (scene->background.kind == TURNER_BACKGROUND_GRADIENT)
        ask(needs, TURNER_NEEDS_GRADIENT, one(TURNER_ASKER_BACKGROUND, 0));
    if (scene->background.kind == TURNER_BACKGROUND_ENVIRONMENT)
        ask(needs, TURNER_NEEDS_ENVIRONMENT, one(TURNER_ASKER_BACKGROUND, 0));
}

static uint32_t method_bits(const struct turner_methods *methods)
{
    static const uint32_t offsets[] = {
        [TURNER_OFFSET_NONE] = TURNER_METHOD_OFFSET_NONE,
        [TURNER_OFFSET_TMIN] = TURNER_METHOD_OFFSET_TMIN,
        [TURNER_OFFSET_ULP] = TURNER_METHOD_OFFSET_ULP,
    };
    uint32_t bits = 0;
    if (methods->sphere == TURNER_SPHERE_TEXTBOOK)
        bits |= TURNER_METHOD_SPHERE_TEXTBOOK;
    if (methods->triangle == TURNER_TRIANGLE_MOLLER_TRUMBORE)
        bits |= TURNER_METHOD_MOLLER_TRUMBORE;
    if (methods->offset != TURNER_OFFSET_ERROR_BOUND)
        bits |= offsets[methods->offset];
    if (methods->fresnel_cosine == TURNER_COSINE_NAIVE)
        bits |= TURNER_METHOD_COSINE_NAIVE;
    if (methods->schlick_side == TURNER_SCHLICK_INCIDENT)
        bits |= TURNER_METHOD_SCHLICK_INCIDENT;
    return bits;
}

struct turner_needs turner_needs_explain(struct turner_why why[TURNER_NEEDS_COUNT],
                                         const struct turner_scene *scene)
{
    memset(why, 0, TURNER_NEEDS_COUNT * sizeof *why);
    struct collector collected = {.why = why};
    struct turner_usage usage;
    turner_usage_create(&usage, scene);
    for (size_t i = 0; i < scene->group_count; i++) {
        if (usage.groups[i])
            ask_of_group(&collected, scene, i);
    }
    for (size_t i = 0; i < scene->material_count; i++) {
        if (usage.materials[i])
            ask(&collected, needs_of_material(&scene->materials[i], &scene->settings),
                one(TURNER_ASKER_MATERIAL, i));
    }
    if (scene->camera.inside_count)
        ask(&collected, TURNER_NEEDS_MEDIA, one(TURNER_ASKER_CAMERA, 0));
    for (size_t i = 0; i < scene->media_count; i++) {
        if (usage.media[i] && any(scene->media[i].absorption))
            ask(&collected, TURNER_NEEDS_ABSORPTION, one(TURNER_ASKER_MEDIUM, i));
    }
    ask_of_scene(&collected, scene);
    turner_usage_destroy(&usage);

    struct turner_needs needs = {.bits = collected.bits,
                                 .methods = method_bits(&scene->settings.methods)};
    bound_loops(&needs, scene);
    return needs;
}

void turner_needs_add(struct turner_needs *needs, uint32_t bits, const struct turner_scene *scene)
{
    needs->bits |= bits;
    bound_loops(needs, scene);
}

struct turner_needs turner_needs_of(const struct turner_scene *scene)
{
    struct turner_why why[TURNER_NEEDS_COUNT];
    return turner_needs_explain(why, scene);
}
