/* How much is reflected where a ray goes from one index to another. */
#include "app/stability.h"

#include <stdlib.h>

#include "reference/fresnel.h"

#define EPSILON 0x1p-24
#define PI 3.141592653589793

/* A plane between index n1, where the rays are, and n2. What is reflected comes as red. */
static struct turner_scene *interface(double n1, double n2)
{
    struct turner_scene *scene = turner_stage_create(
        8, turner_vec3_of(0, 2, 0), turner_vec3_of(0.1, 0, 0), 0.5);
    scene->settings.depth = 1;
    scene->background.color = TURNER_GREY(1);
    turner_stage_glass(scene, n1, 0, TURNER_GREY(0), TURNER_FRESNEL_EXACT);
    uint32_t surface =
        turner_stage_glass(scene, n2, 1, TURNER_GREY(0), TURNER_FRESNEL_EXACT);
    scene->materials[surface].k_r = turner_vec3_of(1, 0, 0);
    scene->materials[surface].k_t = turner_vec3_of(0, 1, 0);
    turner_stage_plane(scene, TURNER_GREY(0), turner_vec3_of(0, 1, 0), surface);
    scene->camera.inside[0] = 0;
    scene->camera.inside_count = 1;
    return scene;
}

static struct turner_gpu_probe ray_at(double angle, double turn)
{
    struct turner_vec3 d = {sin(angle) * cos(turn), -cos(angle), sin(angle) * sin(turn)};
    return turner_stage_probe(turner_vec3_of(0, 1, 0), d);
}

/* The cosine of incidence of the ray as its floats are. */
static turner_real cosine_of(const struct turner_gpu_probe *probe)
{
    struct turner_ray ray = turner_stage_ray(probe);
    turner_vector d = ray.direction;
    return -d.y / sqrtl(d.x * d.x + d.y * d.y + d.z * d.z);
}

/* The largest difference of the share reflected from the truth. */
static enum turner_result compare(double *error, struct turner_stability *s, double n1, double n2,
                                  struct turner_gpu_probe *probes, size_t count,
                                  const char *assign)
{
    bool possible = false;
    n1 = (double)(float)n1;
    n2 = (double)(float)n2;
    struct turner_scene *scene = interface(n1, n2);
    enum turner_result result = turner_stability_assign(scene, assign);
    if (result == TURNER_OK)
        result = turner_stability_probe(probes, count, s, scene, TURNER_PROBE_RADIANCE, &possible);
    double worst = 0;
    for (size_t i = 0; i < count; i++) {
        double truth = (double)turner_fresnel_exact(n1, n2, cosine_of(&probes[i]));
        double off = fabs((double)probes[i].radiance[0] - truth);
        worst = off > worst || isnan(off) ? off : worst;
    }
    *error = !possible ? TURNER_UNMEASURED : isnan(worst) ? (double)INFINITY : worst;
    turner_scene_destroy(scene);
    return result;
}

enum { RAYS = 8192 };
static struct turner_gpu_probe rays[RAYS];

/* Half of them evenly from 0 to 90°, the others ever closer to the critical angle (or 90°). */
static void all_angles(double n1, double n2)
{
    double critical = n1 > n2 ? asin(n2 / n1) : 0.5 * PI;
    for (int i = 0; i < RAYS; i++) {
        double share = (i + 0.5) / RAYS, away = critical * pow(10, -7 * share);
        double angle = i % 2 ? 0.5 * PI * share : i % 4 ? critical - away : critical + away;
        rays[i] = ray_at(fmin(angle, 0.4999 * PI), 2.399963 * i);
    }
}

static enum turner_result measure_index(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double excess,
                                        const struct turner_sweep_method *method)
{
    (void)sweep;
    all_angles(1 + excess, 1);
    return compare(error, s, 1 + excess, 1, rays, RAYS, method->assign);
}

static enum turner_result measure_outside(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double index,
                                          const struct turner_sweep_method *method)
{
    (void)sweep;
    all_angles(1, index);
    return compare(error, s, 1, index, rays, RAYS, method->assign);
}

static enum turner_result measure_inside(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double index,
                                         const struct turner_sweep_method *method)
{
    (void)sweep;
    /* up to just below the critical angle, where every formula has to end at 1 */
    for (int i = 0; i < RAYS; i++) {
        double share = (i + 0.5) / RAYS;
        rays[i] = ray_at(asin(1 / index) * (i % 2 ? share : 1 - pow(10, -5 * share)),
                         2.399963 * i);
    }
    return compare(error, s, index, 1, rays, RAYS, method->assign);
}

static enum turner_result measure_critical(double *error, struct turner_stability *s,
                                           const struct turner_sweep *sweep, double below,
                                           const struct turner_sweep_method *method)
{
    (void)sweep;
    for (int i = 0; i < 256; i++)
        rays[i] = ray_at(asin(1 / 1.5) - below, 2.399963 * i);
    return compare(error, s, 1.5, 1, rays, 256, method->assign);
}

static enum turner_result measure_equal(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double degrees,
                                        const struct turner_sweep_method *method)
{
    (void)sweep;
    for (int i = 0; i < 64; i++)
        rays[i] = ray_at(degrees * PI / 180, 2.399963 * i);
    return compare(error, s, 1.5, 1.5, rays, 64, method->assign);
}

/* A cosine off by ε moves R by this much just below the critical angle of 1.5. */
static double limit_critical(double below)
{
    return fmin(1, 3.75 / sqrt(below) * EPSILON);
}

static double bound_critical(double below, double limit)
{
    (void)below;
    return 8 * limit + 1e-6;
}

static double bound_index(double excess, double limit)
{
    (void)excess, (void)limit;
    return 2e-3;
}

static double bound_formula(double index, double limit)
{
    (void)index, (void)limit;
    return 2e-3;
}

static double bound_equal(double degrees, double limit)
{
    (void)degrees, (void)limit;
    return 1e-6;
}

#define SECTION "4. Fresnel and refraction"
#define SCHLICK_NOTE "the formula is an approximation; use --method fresnel=exact"

static const struct turner_sweep sweeps[] = {
    {.name = "fresnel-index",
     .section = SECTION,
     .question = "From index n to 1, at all angles: how far off is the share reflected?",
     .parameter = "n − 1",
     .unit_of_error = "largest error of R",
     .values = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, NAN},
     .methods = {{"stable (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"naive", "fresnel_cosine=naive", 0, TURNER_FAILS(1e-4), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_index,
     .bound = bound_index,
     .bound_words = "2e-3: at the critical angle dR/dθ is infinite, and an error ε of the cosine "
                    "makes one of about 4√ε",
     .published = "Naive .043 at 1.0001, 1.5e-3 at 1.01, 4.5e-4 at 1.5; stable 6e-6, 6e-5, "
                  "7.5e-4."},
    {.name = "fresnel-critical",
     .section = SECTION,
     .question = "Just below the critical angle of 1.5 → 1: how far off is the share reflected?",
     .parameter = "angle below the critical one, rad",
     .unit_of_error = "largest error of R",
     .values = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, NAN},
     .methods = {{"stable (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"naive", "fresnel_cosine=naive", 0, TURNER_SHOWN, NULL},
                 {"schlick", "fresnel=schlick", 0, TURNER_FAILS(1e-1), SCHLICK_NOTE},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_critical,
     .limit = limit_critical,
     .bound = bound_critical,
     .bound_words = "8 times what a rounding error of the cosine makes there, and 1e-6",
     .published = "The truth: R = .7636, .9172, .9729, .99135 at 1e-3, 1e-4, 1e-5, 1e-6 rad."},
    {.name = "schlick-outside",
     .section = SECTION,
     .question = "Schlick's formula from air into index n: how far off, at the worst angle?",
     .parameter = "index",
     .unit_of_error = "largest error of R",
     .values = {1.05, 1.1, 1.2, 1.333, 1.5, 1.6, 2, 2.417, 3, NAN},
     .methods = {{"exact (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"schlick", "fresnel=schlick", 0, TURNER_FAILS(1.5), SCHLICK_NOTE}},
     .measure = measure_outside,
     .bound = bound_formula,
     .bound_words = "2e-3",
     .published = ".317 at 1.05, .210 at 1.1, .113 at 1.2, .059 at 1.333, .0357 at 1.5, .0319 at "
                  "1.6, .044 at 2, .075 at 2.417, .125 at 3."},
    {.name = "schlick-inside",
     .section = SECTION,
     .question = "Schlick's formula from index n into air: how far off, below the critical "
                 "angle?",
     .parameter = "index",
     .unit_of_error = "largest error of R",
     .values = {1.05, 1.1, 1.2, 1.333, 1.5, 1.6, 2, 2.417, 3, NAN},
     .methods = {{"exact (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"schlick, transmitted", "fresnel=schlick", 0, TURNER_FAILS(1.5), SCHLICK_NOTE},
                 {"schlick, incident", "fresnel=schlick schlick_side=incident", 0,
                  TURNER_FAILS(1.5), SCHLICK_NOTE}},
     .measure = measure_inside,
     .bound = bound_formula,
     .bound_words = "2e-3",
     .published = "Incident .951 at 1.333, .936 at 1.5, .802 at 2.417; transmitted as from "
                  "outside."},
    {.name = "fresnel-equal",
     .section = SECTION,
     .question = "Equal indices: how much is reflected where there is nothing to reflect?",
     .parameter = "angle of incidence, °",
     .unit_of_error = "R",
     .values = {1, 20, 40, 60, 80, 89, 89.99, NAN},
     .methods = {{"exact (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"naive", "fresnel_cosine=naive", 0, TURNER_SHOWN, NULL},
                 {"schlick", "fresnel=schlick", 0, TURNER_FAILS(80), SCHLICK_NOTE}},
     .measure = measure_equal,
     .bound = bound_equal,
     .bound_words = "1e-6",
     .published = "Schlick .031 at 60°, .385 at 80°."},
    {0}};

const struct turner_sweep *const turner_sweeps_fresnel = sweeps;
