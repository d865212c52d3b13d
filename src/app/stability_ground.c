/* A sphere so huge that it looks flat, as the ground. */
#include "app/stability.h"

#define EPSILON 0x1p-24 /* half the spacing of floats at 1 */

enum ground { GROUND_SPHERE, GROUND_PLANE };

static void add_ground(struct turner_scene *scene, double radius, int kind, uint32_t material)
{
    if (kind == GROUND_PLANE)
        turner_stage_plane(scene, TURNER_GREY(0), turner_vec3_of(0, 1, 0), material);
    else
        turner_stage_sphere(scene, turner_vec3_of(0, -radius, 0), radius, material);
}

static enum turner_result measure_ground(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double radius,
                                         const struct turner_sweep_method *method)
{
    enum { rays = 1024 };
    static struct turner_gpu_probe probes[rays];
    struct turner_stability_hits tally = {0};
    bool possible = false;
    (void)sweep;
    const double down = 0.17453292519943295;
    uint64_t random = 1;
    struct turner_scene *scene =
        turner_stage_create(8, turner_vec3_of(0, 1, 0), turner_vec3_of(0, 0, -5), 0.5);
    add_ground(scene, radius, method->variant, turner_stage_lamp(scene, 1));
    for (int i = 0; i < rays; i++) { /* eyes from 1 to 2 above it: round heights would flatter */
        struct turner_vec3 eye = {0, 1 + turner_stage_random(&random), 0};
        double turn = 6.283185307179586 * (i + 0.5) / rays;
        probes[i] = turner_stage_probe(eye, turner_vec3_of(cos(down) * cos(turn), -sin(down),
                                                           cos(down) * sin(turn)));
    }
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_count_hits(&tally, s, scene, probes, rays, &possible);
    turner_scene_destroy(scene);
    /* relative to the mean distance; rays that miss are wrong by all of it */
    *error = possible ? tally.mean_t * sin(down) / 1.5 + tally.wrong : TURNER_UNMEASURED;
    return result;
}

/* The difference of eye and centre, rounded to a float. */
static double limit_ground(double radius)
{
    return EPSILON / 2 * radius / 1.5;
}

static double bound_ground(double radius, double limit)
{
    (void)radius, (void)limit;
    return 1e-3;
}

/* A ball casts its shadow on the ground. */
static struct turner_scene *ground_scene(double radius, int kind)
{
    struct turner_scene *scene = turner_stage_create(
        96, turner_vec3_of(0, 1.5, 6), turner_vec3_of(0, 0.4, 0), 0.7);
    uint32_t matt = turner_stage_material(
        scene, (struct turner_material){.k_d = TURNER_GREY(0.8), .medium = TURNER_NONE});
    add_ground(scene, radius, kind, matt);
    turner_stage_sphere(scene, turner_vec3_of(0, 0.8, 0), 0.7, matt);
    turner_stage_light(scene, (struct turner_light){.kind = TURNER_LIGHT_POINT,
                                                    .position = {3, 4, 2},
                                                    .power = TURNER_GREY(60)});
    scene->background.color = TURNER_GREY(0.3);
    return scene;
}

static double bound_picture(double radius, double limit)
{
    (void)radius, (void)limit;
    return 0.01;
}

static const char ground_note[] =
    "next to the radius the float's digits do not reach down to the eye's height, nor to where on "
    "the sphere a point lies: use a plane, or --method precision=f64";

#define SECTION "1. Rays and spheres"

static const struct turner_sweep sweeps[] = {
    {.name = "sphere-ground",
     .section = SECTION,
     .question = "A huge sphere as ground, seen from 1 to 2 above it, 10° down: how wrong is "
                 "the distance?",
     .parameter = "radius / height of the eye",
     .unit_of_error = "relative error of t",
     .values = {10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, NAN},
     .methods = {{"robust (default)", NULL, 0, TURNER_HOLDS_TO_FAILS(1e3, 1e7), ground_note},
                 {"textbook", "sphere=textbook", 0, TURNER_FAILS(1e6), NULL},
                 {"sphere=f64", "sphere=f64", 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {"a plane instead", NULL, GROUND_PLANE, TURNER_HOLDS, NULL}},
     .measure = measure_ground,
     .limit = limit_ground,
     .bound = bound_ground,
     .bound_words = "a thousandth of the distance",
     .published = "Robust 1.2e-5 at 1e3, 1.6e-3 at 1e5, 1.3e-2 at 1e6, .17 at 1e7."},
    {.name = "sphere-ground-picture",
     .section = SECTION,
     .question = "A ball and its shadow on a huge sphere: how many pixels are wrong?",
     .parameter = "radius of the ground, m",
     .unit_of_error = "share of pixels wrong",
     .values = {100, 1e3, 1e4, 1e5, 1e6, 1e7, NAN},
     .methods = {{"robust (default)", NULL, 0, TURNER_HOLDS_TO_FAILS(1e4, 1e7), ground_note},
                 {"textbook", "sphere=textbook", 0, TURNER_FAILS(1e7), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {"a plane instead", NULL, GROUND_PLANE, TURNER_HOLDS, NULL},
                 {TURNER_POVRAY, NULL, 0, TURNER_SHOWN, NULL}},
     .measure = turner_stability_picture,
     .scene = ground_scene,
     .tolerance = 0.01,
     .bound = bound_picture,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {0}};

const struct turner_sweep *const turner_sweeps_ground = sweeps;
