/* Rays and spheres: far from them, and on one so large that it looks flat. */
#include "app/stability.h"
#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

#define RAYS 65536
#define EPSILON 0x1p-24 /* half the spacing of floats at 1 */

struct tally {
    double wrong;  /* share of rays with a hit for a miss or a miss for a hit */
    double mean_t; /* mean |t − truth| of the others that hit */
};

static enum turner_result trace(struct tally *tally, struct turner_stability *s,
                                const struct turner_scene *scene, struct turner_gpu_probe *probes,
                                size_t count, bool *possible)
{
    struct turner_world world;
    TURNER_TRY(turner_stability_probe(probes, count, s, scene, TURNER_PROBE_HITS, possible));
    if (!*possible)
        return TURNER_OK;
    TURNER_TRY(turner_world_create(&world, scene));
    size_t wrong = 0, both = 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        struct turner_ray ray = turner_stage_ray(&probes[i]);
        struct turner_hit hit;
        bool truth = turner_world_intersect(&hit, &world, &ray, (turner_real)INFINITY);
        double t = turner_stage_t(&probes[i], 0);
        if (truth != !isinf(t)) {
            wrong++;
        } else if (truth) {
            sum += fabs(t - (double)hit.t);
            both++;
        }
    }
    turner_world_destroy(&world);
    *tally = (struct tally){(double)wrong / (double)count, both ? sum / (double)both : 0};
    return TURNER_OK;
}

/* ---- a unit sphere `distance` away, rays all over a disc of 1.25 radii ---- */

static enum turner_result trace_far(struct tally *tally, struct turner_stability *s,
                                    double distance, const char *assign, bool *possible)
{
    struct turner_gpu_probe *probes = turner_calloc(RAYS, sizeof *probes);
    struct turner_vec3 origin = {0.3 * distance, -0.2 * distance, 0.9 * distance};
    origin = turner_vec3_scale(origin, distance / turner_vec3_length(origin));
    struct turner_scene *scene = turner_stage_create(8, origin, TURNER_GREY(0), 0.5);
    turner_stage_sphere(scene, TURNER_GREY(0), 1, turner_stage_lamp(scene, 1));
    uint64_t random = 1;
    for (size_t i = 0; i < RAYS; i++) {
        struct turner_vec3 target;
        do {
            target = turner_vec3_scale(turner_stage_direction(&random),
                                       1.25 * sqrt(turner_stage_random(&random)));
            target = turner_vec3_sub(
                target, turner_vec3_scale(origin, turner_vec3_dot(target, origin) /
                                                      (distance * distance)));
        } while (turner_vec3_length(target) > 1.25);
        probes[i] = turner_stage_probe(
            origin, turner_vec3_normalize(turner_vec3_sub(target, origin)));
    }
    enum turner_result result = turner_stability_assign(scene, assign);
    if (result == TURNER_OK)
        result = trace(tally, s, scene, probes, RAYS, possible);
    turner_scene_destroy(scene);
    free(probes);
    return result;
}

static enum turner_result measure_wrong(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double value,
                                        const struct turner_sweep_method *method)
{
    struct tally tally;
    bool possible;
    (void)sweep;
    TURNER_TRY(trace_far(&tally, s, value, method->assign, &possible));
    *error = possible ? tally.wrong : TURNER_UNMEASURED;
    return TURNER_OK;
}

static enum turner_result measure_t(double *error, struct turner_stability *s,
                                    const struct turner_sweep *sweep, double value,
                                    const struct turner_sweep_method *method)
{
    struct tally tally;
    bool possible;
    (void)sweep;
    TURNER_TRY(trace_far(&tally, s, value, method->assign, &possible));
    *error = possible ? tally.mean_t : TURNER_UNMEASURED;
    return TURNER_OK;
}

/* The ray's nearest point to the centre, rounded to floats the size of the distance, moves by ε/8
 * of it across the silhouette on average: the ring of that width, of the disc. */
static double limit_wrong(double distance)
{
    return 2 * EPSILON / 8 * distance / (1.25 * 1.25);
}

static double bound_wrong(double distance, double limit)
{
    (void)distance;
    return 4 * limit + 2.0 / RAYS;
}

static double limit_t(double distance)
{
    return EPSILON * distance / 2;
}

static double bound_t(double distance, double limit)
{
    (void)distance;
    return 4 * limit;
}

/* ---- a huge sphere as the ground ---- */

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
    struct tally tally = {0};
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
        result = trace(&tally, s, scene, probes, rays, &possible);
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
    {.name = "sphere-distance-wrong",
     .section = SECTION,
     .question = "How many rays at a far sphere are taken for misses when they hit, or for hits "
                 "when they miss?",
     .parameter = "distance / radius",
     .unit_of_error = "share of rays wrong",
     .values = {10, 100, 1000, 4100, 8000, 1e5, 1e6, NAN},
     .methods = {{"robust (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"textbook", "sphere=textbook", 0, TURNER_FAILS(1000), NULL},
                 {"sphere=f64", "sphere=f64", 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_wrong,
     .limit = limit_wrong,
     .bound = bound_wrong,
     .bound_words = "4 times the share that rounding one point to floats takes across the "
                    "silhouette, and two rays",
     .published = "Textbook 0.057 % at 100, 4.5 % at 1000, 32 % at 4100, 41 % at 8000 and 1e5; "
                  "robust 0.0003 %, 0.001 %, 0.0035 %, 0.012 %, 0.11 %."},
    {.name = "sphere-distance-t",
     .section = SECTION,
     .question = "How far off is the point where a ray meets a far sphere?",
     .parameter = "distance / radius",
     .unit_of_error = "mean |Δt| / radius",
     .values = {10, 100, 1000, 4100, 8000, 1e5, 1e6, NAN},
     .methods = {{"robust (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"textbook", "sphere=textbook", 0, TURNER_FAILS(1000), NULL},
                 {"sphere=f64", "sphere=f64", 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_t,
     .limit = limit_t,
     .bound = bound_t,
     .bound_words = "4 times the mean error of rounding t to a float",
     .published = "Textbook 7.5e-4 at 100, .059 at 1000, .72 at 4100, 1.08 at 8000, 17 at 1e5; "
                  "robust 5e-6, 4e-5, 2.4e-4, 3e-4, 4.7e-3."},
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

const struct turner_sweep *const turner_sweeps_sphere = sweeps;
