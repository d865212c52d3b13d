/* Rays at a sphere far away. */
#include "app/stability.h"
#include "base/memory.h"

#include <stdlib.h>

#define RAYS 65536
#define EPSILON 0x1p-24 /* half the spacing of floats at 1 */

/* ---- a unit sphere `distance` away, rays all over a disc of 1.25 radii ---- */

static enum turner_result trace_far(struct turner_stability_hits *tally, struct turner_stability *s,
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
        result = turner_stability_count_hits(tally, s, scene, probes, RAYS, possible);
    turner_scene_destroy(scene);
    free(probes);
    return result;
}

static enum turner_result measure_wrong(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double value,
                                        const struct turner_sweep_method *method)
{
    struct turner_stability_hits tally;
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
    struct turner_stability_hits tally;
    bool possible;
    (void)sweep;
    TURNER_TRY(trace_far(&tally, s, value, method->assign, &possible));
    *error = possible ? tally.mean_t : TURNER_UNMEASURED;
    return TURNER_OK;
}

/* Two balls, one in the other's shadow, through a telescope. */
static struct turner_scene *far_scene(double distance, int variant)
{
    (void)variant;
    struct turner_vec3 eye = turner_vec3_normalize(turner_vec3_of(0.3, -0.2, 0.9));
    struct turner_scene *scene = turner_stage_create(
        96, turner_vec3_scale(eye, distance), TURNER_GREY(0), 2 * atan(1.4 / distance));
    uint32_t matt = turner_stage_material(
        scene, (struct turner_material){.k_d = TURNER_GREY(3), .medium = TURNER_NONE});
    turner_stage_sphere(scene, TURNER_GREY(0), 1, matt);
    turner_stage_sphere(scene, turner_vec3_of(0.8, 0.8, 0.8), 0.3, matt);
    turner_stage_light(scene, (struct turner_light){.kind = TURNER_LIGHT_DIRECTIONAL,
                                                    .direction = turner_vec3_normalize(
                                                        turner_vec3_of(-1, -1.2, -1)),
                                                    .power = TURNER_GREY(1)});
    return scene;
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

static double bound_picture(double radius, double limit)
{
    (void)radius, (void)limit;
    return 0.01;
}

static const char far_note[] =
    "pixels are closer together than the directions that floats can tell apart: go nearer and "
    "widen the angle, or use --method precision=f64";

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
    {.name = "sphere-distance-picture",
     .section = SECTION,
     .question = "Two balls through a telescope, ever further away: how many pixels are wrong?",
     .parameter = "distance / radius",
     .unit_of_error = "share of pixels wrong",
     .values = {10, 100, 1000, 1e4, 1e5, 1e6, NAN},
     .methods = {{"robust (default)", NULL, 0, TURNER_HOLDS_TO_FAILS(1e4, 1e6), far_note},
                 {"textbook", "sphere=textbook", 0, TURNER_FAILS(1e5), NULL},
                 {"sphere=f64", "sphere=f64", 0, TURNER_SHOWN, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {TURNER_POVRAY, NULL, 0, TURNER_SHOWN, NULL}},
     .measure = turner_stability_picture,
     .scene = far_scene,
     .tolerance = 0.01,
     .bound = bound_picture,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {0}};

const struct turner_sweep *const turner_sweeps_sphere = sweeps;
