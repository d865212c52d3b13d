/* Rays that leave a surface must not meet it again, and must meet what lies close above it. */
#include "app/stability.h"
#include "base/memory.h"

#include <stdlib.h>

#define RAYS 32768

/* A ray from `eye` that meets the unit sphere about the origin somewhere, scaled and moved. */
static struct turner_gpu_probe aim(uint64_t *random, double radius, struct turner_vec3 center)
{
    struct turner_vec3 out = turner_stage_direction(random), side = turner_stage_direction(random);
    struct turner_vec3 eye = turner_vec3_scale(out, 3 * radius);
    struct turner_vec3 target = turner_vec3_scale(side, 0.8 * radius);
    return turner_stage_probe(turner_vec3_add(center, eye),
                              turner_vec3_normalize(turner_vec3_sub(target, eye)));
}

/* The share of rays that leave the sphere outward, in any direction, and meet it again; those that
 * pass it in the first place count, too. */
static enum turner_result count_again(double *share, struct turner_stability *s,
                                      struct turner_scene *scene, double radius,
                                      struct turner_vec3 center, const char *assign)
{
    struct turner_gpu_probe *probes = turner_calloc(RAYS, sizeof *probes);
    struct turner_world world = {0};
    bool possible;
    enum turner_result result;
    uint64_t random = 7;
    size_t sent = 0, wrong = 0;
    TURNER_TRY_DONE(turner_stability_assign(scene, assign));
    TURNER_TRY_DONE(turner_world_create(&world, scene));
    for (size_t i = 0; i < RAYS; i++) {
        probes[i] = aim(&random, radius, center);
        struct turner_ray ray = turner_stage_ray(&probes[i]);
        struct turner_hit hit;
        struct turner_surface surface;
        struct turner_vec3 d = turner_stage_direction(&random);
        if (!turner_world_intersect(&hit, &world, &ray, (turner_real)INFINITY))
            continue;
        turner_world_surface(&surface, &world, &ray, &hit);
        turner_real rise = surface.ng.x * d.x + surface.ng.y * d.y + surface.ng.z * d.z;
        double sign = rise < 0 ? -1 : 1;
        if (fabsl(rise) < 1e-3L) /* what is outward must not depend on a rounded normal */
            continue;
        probes[i].leaving[0] = (float)(sign * d.x);
        probes[i].leaving[1] = (float)(sign * d.y);
        probes[i].leaving[2] = (float)(sign * d.z);
    }
    TURNER_TRY_DONE(turner_stability_probe(probes, RAYS, s, scene, TURNER_PROBE_HITS, &possible));
    for (size_t i = 0; possible && i < RAYS; i++) {
        bool leaves = probes[i].leaving[0] != 0;
        sent += leaves;
        wrong += leaves && (isinf(probes[i].t[0]) || !isinf(probes[i].t[1]));
    }
    *share = possible ? (double)wrong / (double)sent : TURNER_UNMEASURED;
done:
    turner_world_destroy(&world);
    free(probes);
    return result;
}

static struct turner_scene *one_sphere(double radius, struct turner_vec3 center)
{
    struct turner_scene *scene = turner_stage_create(
        8, turner_vec3_add(center, turner_vec3_of(0, 0, 3 * radius)), center, 0.5);
    turner_stage_sphere(scene, center, radius, turner_stage_lamp(scene, 1));
    turner_stage_round(scene);
    return scene;
}

static enum turner_result measure_radius(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double radius,
                                         const struct turner_sweep_method *method)
{
    (void)sweep;
    struct turner_vec3 center = {0};
    struct turner_scene *scene = one_sphere(radius, center);
    enum turner_result result = count_again(error, s, scene, radius, center, method->assign);
    turner_scene_destroy(scene);
    return result;
}

static enum turner_result measure_away(double *error, struct turner_stability *s,
                                       const struct turner_sweep *sweep, double away,
                                       const struct turner_sweep_method *method)
{
    (void)sweep;
    struct turner_vec3 center = {away, -away, away};
    struct turner_scene *scene = one_sphere(1, center);
    enum turner_result result = count_again(error, s, scene, 1, center, method->assign);
    turner_scene_destroy(scene);
    return result;
}

/* A unit sphere as an instance: in its group it is `scale` times smaller and 1000 of its radii from
 * the group's origin, in the world it stands at the origin. */
static enum turner_result measure_instance(double *error, struct turner_stability *s,
                                           const struct turner_sweep *sweep, double scale,
                                           const struct turner_sweep_method *method)
{
    (void)sweep;
    struct turner_vec3 center = {0};
    struct turner_scene *scene = turner_stage_create(8, turner_vec3_of(0, 0, 3), center, 0.5);
    uint32_t lamp = turner_stage_lamp(scene, 1);
    struct turner_group *group =
        TURNER_PUSH(scene->groups, scene->group_count, scene->group_capacity);
    *group = (struct turner_group){0};
    double r = (double)(float)(1 / scale), at = (double)(float)(1000 * r);
    *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
        (struct turner_sphere){{at, 0, 0}, r, lamp};
    *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) =
        (struct turner_instance){
            1, TURNER_NONE, {{{scale, 0, 0, -scale * at}, {0, scale, 0, 0}, {0, 0, scale, 0}}}};
    enum turner_result result = count_again(error, s, scene, 1, center, method->assign);
    turner_scene_destroy(scene);
    return result;
}

/* ---- two spheres, one close inside the other: a ray through the outer one meets the inner ---- */
static enum turner_result measure_shell(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double gap,
                                        const struct turner_sweep_method *method)
{
    struct turner_gpu_probe *probes = turner_calloc(RAYS, sizeof *probes);
    struct turner_scene *scene = one_sphere(1, TURNER_GREY(0));
    struct turner_world inner = {0};
    struct turner_scene *core = one_sphere(1, TURNER_GREY(0));
    bool possible;
    uint64_t random = 3;
    size_t count = 0, wrong = 0;
    enum turner_result result;
    (void)sweep;
    turner_stage_sphere(scene, TURNER_GREY(0), (double)(float)(1 + gap), 0);
    TURNER_TRY_DONE(turner_stability_assign(scene, method->assign));
    TURNER_TRY_DONE(turner_world_create(&inner, core));
    for (size_t i = 0; i < RAYS; i++) {
        probes[i] = aim(&random, 1, TURNER_GREY(0));
        for (int k = 0; k < 3; k++)
            probes[i].leaving[k] = probes[i].direction[k];
    }
    TURNER_TRY_DONE(turner_stability_probe(probes, RAYS, s, scene, TURNER_PROBE_HITS, &possible));
    for (size_t i = 0; possible && i < RAYS; i++) {
        struct turner_ray ray = turner_stage_ray(&probes[i]);
        struct turner_hit hit;
        if (!turner_world_intersect(&hit, &inner, &ray, (turner_real)INFINITY))
            continue;
        count++;
        /* the outer sphere is the second, the inner one the first of the group */
        wrong += probes[i].id[0] != 1 || probes[i].id[1] != 0 || isinf(probes[i].t[1]) ||
                 probes[i].t[1] > 0.5f;
    }
    *error = possible ? (double)wrong / (double)count : TURNER_UNMEASURED;
done:
    turner_world_destroy(&inner);
    turner_scene_destroy(core);
    turner_scene_destroy(scene);
    free(probes);
    return result;
}

/* A lamp with a black core in a clear shell that is `gap` above it: all pixels on it are 1. */
static struct turner_scene *shell_scene(double gap, int variant)
{
    (void)variant;
    struct turner_scene *scene = turner_stage_create(
        96, turner_vec3_of(1, 2, 4), TURNER_GREY(0), 0.5);
    scene->settings.depth = 3;
    uint32_t clear = turner_stage_glass(scene, 1, 0, TURNER_GREY(0), TURNER_FRESNEL_NONE);
    scene->materials[clear].k_r = TURNER_GREY(0);
    turner_stage_sphere(scene, TURNER_GREY(0), 1, turner_stage_lamp(scene, 1));
    turner_stage_sphere(scene, TURNER_GREY(0), 1 + gap, clear);
    turner_stage_sphere(scene, TURNER_GREY(0), 0.9, turner_stage_lamp(scene, 0));
    return scene;
}

static double bound_picture(double gap, double limit)
{
    (void)gap, (void)limit;
    return 0.01;
}

static double bound_none(double value, double limit)
{
    (void)value, (void)limit;
    return 0;
}

static double bound_shell(double gap, double limit)
{
    (void)gap, (void)limit;
    return 1e-3; /* rays that all but touch the silhouette are anybody's */
}

static const char shell_note[] =
    "closer than a few float spacings the two surfaces are one: draw a coating as a material, or "
    "use --method precision=f64";

#define SECTION "2. Rays that leave a surface"

static const struct turner_sweep sweeps[] = {
    {.name = "leave-radius",
     .section = SECTION,
     .question = "How many rays that leave a sphere outward meet it again, or never met it?",
     .parameter = "radius, m (centre at the origin)",
     .unit_of_error = "share of rays wrong",
     .values = {1e-6, 1e-4, 1e-2, 1, 100, 1e4, 1e6, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"none", "offset=none", 0, TURNER_FAILS(1), NULL},
                 {"tmin:1e-4", "offset=tmin:1e-4", 0, TURNER_FAILS(100), NULL},
                 {"tmin:1e-3", "offset=tmin:1e-3", 0, TURNER_FAILS(1e4), NULL},
                 {"ulp", "offset=ulp", 0, TURNER_HOLDS_FROM(1), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_radius,
     .bound = bound_none,
     .bound_words = "not one",
     .published = "None 46 % at 1, 44 % at 100, 45 % at 1e4; tmin 1e-4 .03 %, 7.2 %, 45 %; "
                  "tmin 1e-3 0, .7 %, 40 %; ulp 0."},
    {.name = "leave-away",
     .section = SECTION,
     .question = "How many rays that leave a sphere far from the origin meet it again?",
     .parameter = "distance of the centre along each axis, radii",
     .unit_of_error = "share of rays wrong",
     .values = {1, 10, 100, 1e3, 1e4, 1e5, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"none", "offset=none", 0, TURNER_FAILS(1e3), NULL},
                 {"tmin:1e-4", "offset=tmin:1e-4", 0, TURNER_FAILS(1e3), NULL},
                 {"tmin:1e-3", "offset=tmin:1e-3", 0, TURNER_FAILS(1e5), NULL},
                 {"ulp", "offset=ulp", 0, TURNER_SHOWN, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_away,
     .bound = bound_none,
     .bound_words = "not one",
     .published = "None 50 % at 1e3, 49 % at 1e5; tmin 1e-4 6.1 %, 48 %; tmin 1e-3 .55 %, 40 %; "
                  "ulp 0."},
    {.name = "leave-instance",
     .section = SECTION,
     .question = "How many rays that leave an instance, small and off the origin in its own "
                 "coordinates, meet it again?",
     .parameter = "scale of the instance",
     .unit_of_error = "share of rays wrong",
     .values = {0.01, 1, 100, 1e4, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"none", "offset=none", 0, TURNER_FAILS(100), NULL},
                 {"ulp", "offset=ulp", 0, TURNER_FAILS(100), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_instance,
     .bound = bound_none,
     .bound_words = "not one"},
    {.name = "leave-shell",
     .section = SECTION,
     .question = "A sphere inside another: how many rays that pass the outer one miss the inner?",
     .parameter = "gap / radius",
     .unit_of_error = "share of rays that miss it",
     .values = {1e-6, 4e-6, 4e-5, 4e-4, 4e-3, 4e-2, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS_FROM(4e-5), shell_note},
                 {"none", "offset=none", 0, TURNER_SHOWN, NULL},
                 {"tmin:1e-4", "offset=tmin:1e-4", 0, TURNER_FAILS(4e-5), NULL},
                 {"tmin:1e-3", "offset=tmin:1e-3", 0, TURNER_FAILS(4e-5), NULL},
                 {"ulp", "offset=ulp", 0, TURNER_HOLDS_FROM(4e-4), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_shell,
     .bound = bound_shell,
     .bound_words = "one in a thousand",
     .published = "A shell of 4e-5 must be seen."},
    {.name = "leave-shell-picture",
     .section = SECTION,
     .question = "A lamp in a clear shell: how many pixels are wrong?",
     .parameter = "gap / radius",
     .unit_of_error = "share of pixels wrong",
     .values = {1e-6, 4e-6, 4e-5, 4e-4, 4e-3, 4e-2, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS_FROM(4e-5), shell_note},
                 {"tmin:1e-4", "offset=tmin:1e-4", 0, TURNER_FAILS(4e-5), NULL},
                 {"tmin:1e-3", "offset=tmin:1e-3", 0, TURNER_FAILS(4e-4), NULL},
                 {"ulp", "offset=ulp", 0, TURNER_HOLDS_FROM(4e-4), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {TURNER_POVRAY, NULL, 0, TURNER_SHOWN, NULL}},
     .measure = turner_stability_picture,
     .scene = shell_scene,
     .tolerance = 0.01,
     .bound = bound_picture,
     .bound_words = "1 % of the pixels"},
    {0}};

const struct turner_sweep *const turner_sweeps_leave = sweeps;
