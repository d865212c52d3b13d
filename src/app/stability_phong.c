/* Highlights, lights at the horizon, many lights. */
#include "app/stability.h"
#include "base/memory.h"

#include <stdlib.h>

#include "reference/trace.h"

#define EPSILON 0x1p-24
#define PI 3.141592653589793

enum { PHONG, CONSERVING };

/* A plane through the origin, seen from above, without lights. */
static struct turner_scene *floor_scene(double k_d, double k_s, double exponent, int shading)
{
    struct turner_scene *scene = turner_stage_create(
        8, turner_vec3_of(0, 2, 0), turner_vec3_of(0.1, 0, 0), 0.5);
    scene->settings.shading =
        shading == PHONG ? TURNER_SHADING_PHONG : TURNER_SHADING_ENERGY_CONSERVING;
    uint32_t material = turner_stage_material(scene,
                                              (struct turner_material){.k_d = TURNER_GREY(k_d),
                                                                       .k_s = TURNER_GREY(k_s),
                                                                       .exponent = exponent,
                                                                       .medium = TURNER_NONE});
    turner_stage_plane(scene, TURNER_GREY(0), turner_vec3_of(0, 1, 0), material);
    return scene;
}

static void add_sun(struct turner_scene *scene, struct turner_vec3 towards, double irradiance)
{
    turner_stage_light(scene, (struct turner_light){
                                  .kind = TURNER_LIGHT_DIRECTIONAL,
                                  .direction = turner_vec3_scale(turner_vec3_normalize(towards),
                                                                 -1),
                                  .power = TURNER_GREY(irradiance)});
}

/* A ray that meets the floor at the origin, coming from where the vector points to. */
static struct turner_gpu_probe ray_from(struct turner_vec3 v)
{
    v = turner_vec3_normalize(v);
    return turner_stage_probe(v, turner_vec3_scale(v, -1));
}

/* The largest difference in radiance from the reference's for the same rays. Frees the scene. */
static enum turner_result compare(double *error, struct turner_stability *s,
                                  struct turner_scene *scene, struct turner_gpu_probe *probes,
                                  size_t count, const char *assign)
{
    struct turner_world world = {0};
    bool possible = false;
    enum turner_result result;
    double worst = 0;
    TURNER_TRY_DONE(turner_world_create(&world, scene));
    struct turner_methods methods = scene->settings.methods;
    TURNER_TRY_DONE(turner_stability_assign(scene, assign));
    TURNER_TRY_DONE(turner_stability_probe(probes, count, s, scene, TURNER_PROBE_RADIANCE,
                                           &possible));
    scene->settings.methods = methods;
    for (size_t i = 0; possible && i < count; i++) {
        struct turner_tracer tracer = {.world = &world};
        struct turner_ray ray = turner_stage_ray(&probes[i]);
        turner_vector d = ray.direction;
        turner_real length = sqrtl(d.x * d.x + d.y * d.y + d.z * d.z);
        d = (turner_vector){d.x / length, d.y / length, d.z / length};
        turner_vector truth = turner_trace_camera(&tracer, ray.origin, d);
        double off = fabs((double)probes[i].radiance[0] - (double)truth.x);
        worst = off > worst || isnan(off) ? off : worst;
    }
done:
    *error = !possible ? TURNER_UNMEASURED : isnan(worst) ? (double)INFINITY : worst;
    turner_world_destroy(&world);
    turner_scene_destroy(scene);
    return result;
}

/* ---- the highlight itself ---- */
static enum turner_result measure_exponent(double *error, struct turner_stability *s,
                                           const struct turner_sweep *sweep, double exponent,
                                           const struct turner_sweep_method *method)
{
    enum { count = 4096 };
    static struct turner_gpu_probe probes[count];
    (void)sweep;
    struct turner_scene *scene = floor_scene(0, 1, exponent, PHONG);
    add_sun(scene, turner_vec3_of(1, 1.3, 0.4), 1);
    struct turner_vec3 d = scene->lights[0].direction, mirror = {d.x, -d.y, d.z};
    uint64_t random = 1;
    for (int i = 0; i < count; i++) { /* out to where the highlight ends */
        double reach = 3 * turner_stage_random(&random) / sqrt(exponent + 1);
        probes[i] = ray_from(turner_vec3_add(
            mirror, turner_vec3_scale(turner_stage_direction(&random), 0.5 * reach)));
    }
    return compare(error, s, scene, probes, count, method->assign);
}

static double limit_exponent(double exponent)
{
    return fmin(1, exponent * EPSILON); /* cosⁿ with a cosine that is off by ε */
}

static double bound_hundredth(double value, double limit)
{
    (void)value, (void)limit;
    return 0.01;
}

/* ---- the light at the horizon and just below ---- */
static enum turner_result measure_horizon(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double elevation,
                                          const struct turner_sweep_method *method)
{
    enum { count = 256 };
    static struct turner_gpu_probe probes[count];
    (void)sweep;
    *error = 0;
    for (int sign = -1; sign <= 1; sign++) {
        struct turner_scene *scene = floor_scene(1, 1, 10, PHONG);
        double e = (double)(float)(sign * elevation), part;
        add_sun(scene, turner_vec3_of(-1, e, 0), 1);
        for (int i = 0; i < count; i++)
            probes[i] = ray_from(turner_vec3_of(1, 0.001 + 0.01 * i, 0));
        TURNER_TRY(compare(&part, s, scene, probes, count, method->assign));
        *error = part > *error || isnan(part) ? part : *error;
    }
    return TURNER_OK;
}

static double bound_horizon(double elevation, double limit)
{
    (void)elevation, (void)limit;
    return 1e-5;
}

/* ---- what share of the light is sent back: seen from above, lit from everywhere ---- */
static enum turner_result measure_albedo(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double exponent,
                                         const struct turner_sweep_method *method)
{
    enum { lights = 1024 };
    (void)sweep;
    bool possible = false;
    struct turner_scene *scene = floor_scene(0, 1, exponent, method->variant);
    for (int i = 0; i < lights; i++) { /* midpoints in the cosine, once round */
        double c = (i + 0.5) / lights, r = sqrt(1 - c * c), turn = 2.399963 * i;
        add_sun(scene, turner_vec3_of(r * cos(turn), c, r * sin(turn)), 2 * PI / lights);
    }
    struct turner_gpu_probe probe = ray_from(turner_vec3_of(0, 1, 0));
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_probe(&probe, 1, s, scene, TURNER_PROBE_RADIANCE, &possible);
    *error = possible ? (double)probe.radiance[0] : TURNER_UNMEASURED;
    turner_scene_destroy(scene);
    return result;
}

static double bound_albedo(double exponent, double limit)
{
    (void)exponent, (void)limit;
    return 1.001;
}

/* ---- the sum over many lights ---- */
static enum turner_result measure_lights(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double lights,
                                         const struct turner_sweep_method *method)
{
    enum { count = 256 };
    static struct turner_gpu_probe probes[count];
    (void)sweep;
    struct turner_scene *scene = floor_scene(1, 0, 1, PHONG);
    uint64_t random = 1;
    for (int i = 0; i < (int)lights; i++) {
        struct turner_vec3 d = turner_stage_direction(&random);
        add_sun(scene, turner_vec3_of(d.x, 0.1 + fabs(d.y), d.z), 1 / lights);
    }
    for (int i = 0; i < count; i++) {
        struct turner_vec3 d = turner_stage_direction(&random);
        probes[i] = ray_from(turner_vec3_of(d.x, 0.2 + fabs(d.y), d.z));
    }
    return compare(error, s, scene, probes, count, method->assign);
}

static double limit_lights(double lights)
{
    (void)lights;
    return EPSILON;
}

static double bound_lights(double lights, double limit)
{
    (void)lights;
    return 16 * limit;
}

#define SECTION "5. Phong"

static const struct turner_sweep sweeps[] = {
    {.name = "phong-exponent",
     .section = SECTION,
     .question = "A highlight of peak 1: how far off at the worst place?",
     .parameter = "exponent n",
     .unit_of_error = "largest error of the highlight",
     .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, NAN},
     .methods = {{"f32 (default)", NULL, 0, TURNER_HOLDS_TO_FAILS(1e4, 1e7),
                  "few float cosines lie inside so narrow a highlight (12 at n = 1e6): it shows "
                  "rings; stay below n = 1e4, or use a lamp's mirror image"},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS_TO(1e4), NULL}},
     .measure = measure_exponent,
     .limit = limit_exponent,
     .bound = bound_hundredth,
     .bound_words = "a hundredth of the peak",
     .published = "Without a clamp of R·V to 1, 1.43 at 1e6 and 35.7 at 1e7 in place of 1."},
    {.name = "phong-horizon",
     .section = SECTION,
     .question = "A light at the horizon, and this far above and below it",
     .parameter = "elevation, rad",
     .unit_of_error = "largest error of the radiance",
     .values = {1e-8, 1e-6, 1e-4, 1e-2, 1e-1, NAN},
     .methods = {{"f32 (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_horizon,
     .bound = bound_horizon,
     .bound_words = "1e-5 of a lit surface"},
    {.name = "phong-albedo",
     .section = SECTION,
     .question = "k_s = 1, seen from above: what share of the light is sent back?",
     .parameter = "exponent n",
     .unit_of_error = "albedo",
     .values = {1, 2, 5, 10, 100, NAN},
     .methods = {{"energy_conserving (default)", NULL, CONSERVING, TURNER_HOLDS, NULL},
                 {"phong", NULL, PHONG, TURNER_HOLDS_FROM_FAILS(10, 1),
                  "Phong's own form sends back more than it gets below n = 5.28; use shading "
                  "energy_conserving"}},
     .measure = measure_albedo,
     .bound = bound_albedo,
     .bound_words = "1, and a thousandth for the quadrature",
     .published = "Phong 2π/(n + 1): 3.14 at 1, 1.047 at 5, .571 at 10, .0622 at 100."},
    {.name = "phong-lights",
     .section = SECTION,
     .question = "The sum over many lights: how far off?",
     .parameter = "lights",
     .unit_of_error = "relative error of the sum",
     .values = {1, 10, 100, 1000, 4096, NAN},
     .methods = {{"f32 (default)", NULL, 0, TURNER_HOLDS, NULL}},
     .measure = measure_lights,
     .limit = limit_lights,
     .bound = bound_lights,
     .bound_words = "16 rounding errors"},
    {0}};

const struct turner_sweep *const turner_sweeps_phong = sweeps;
