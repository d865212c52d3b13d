/* Where the recursion stops, and whether what it cuts is all that is lost. */
#include "app/stability.h"
#include "base/memory.h"

/* ---- two mirrors that face each other and glow so that their light adds up to 1 ---- */

static struct turner_scene *facing_mirrors(double reflectance)
{
    struct turner_scene *scene = turner_stage_create(
        8, turner_vec3_of(0, 0, 0), turner_vec3_of(0, 0, -1), 0.5);
    uint32_t mirror = turner_stage_material(
        scene, (struct turner_material){.k_r = TURNER_GREY(reflectance),
                                        .k_e = TURNER_GREY(1 - reflectance),
                                        .medium = TURNER_NONE});
    turner_stage_plane(scene, turner_vec3_of(0, 0, -1), turner_vec3_of(0, 0, 1), mirror);
    turner_stage_plane(scene, turner_vec3_of(0, 0, 1), turner_vec3_of(0, 0, -1), mirror);
    return scene;
}

static enum turner_result light_between(double *light, struct turner_stability *s,
                                        struct turner_scene *scene)
{
    bool possible = false;
    struct turner_gpu_probe probe =
        turner_stage_probe(TURNER_GREY(0), turner_vec3_normalize(turner_vec3_of(0.1, 0.05, -1)));
    enum turner_result result =
        turner_stability_probe(&probe, 1, s, scene, TURNER_PROBE_RADIANCE, &possible);
    *light = possible ? (double)probe.radiance[0] : TURNER_UNMEASURED;
    return result;
}

static enum turner_result measure_lost(double *error, struct turner_stability *s,
                                       const struct turner_sweep *sweep, double reflectance,
                                       const struct turner_sweep_method *method)
{
    (void)sweep;
    struct turner_scene *scene = facing_mirrors(reflectance);
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = light_between(error, s, scene);
    *error = fabs(1 - *error);
    turner_scene_destroy(scene);
    return result;
}

static double bound_step(double value, double limit)
{
    (void)value, (void)limit;
    return 1 / 255.0;
}

/* variant: the reflectance in per cent */
static enum turner_result measure_theory(double *error, struct turner_stability *s,
                                         const struct turner_sweep *sweep, double depth,
                                         const struct turner_sweep_method *method)
{
    (void)sweep;
    double reflectance = method->variant / 100.0, light;
    struct turner_scene *scene = facing_mirrors(reflectance);
    scene->settings.depth = (int)depth;
    enum turner_result result = light_between(&light, s, scene);
    *error = fabs(1 - pow(reflectance, depth + 1) - light);
    turner_scene_destroy(scene);
    return result;
}

static double limit_theory(double depth)
{
    (void)depth;
    return 0x1p-24;
}

static double bound_theory(double depth, double limit)
{
    return (depth + 4) * limit; /* one rounding a reflection */
}

/* ---- the tree of rays where each surface reflects R and lets 1 − R through ---- */

static double nodes_below(double weight, double r, double cutoff, int depth)
{
    if (depth > 15 || weight < cutoff)
        return 0;
    return 1 + nodes_below(weight * r, r, cutoff, depth + 1) +
           nodes_below(weight * (1 - r), r, cutoff, depth + 1);
}

static enum turner_result measure_nodes(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double reflectance,
                                        const struct turner_sweep_method *method)
{
    enum { slabs = 40 };
    (void)sweep;
    struct turner_scene *scene = turner_stage_create(
        1, turner_vec3_of(slabs + 0.5, 0.1, 0.2), turner_vec3_of(0, 0.11, 0.21), 0.01);
    scene->settings.depth = 15;
    uint32_t glass =
        turner_stage_glass(scene, 1, 0, TURNER_GREY(0), TURNER_FRESNEL_NONE);
    scene->materials[glass].k_r = TURNER_GREY(reflectance);
    scene->materials[glass].k_t = TURNER_GREY(1 - reflectance);
    for (int i = 0; i < slabs; i++)
        turner_group_add_box(&scene->groups[0], turner_vec3_of(2 * i + 1, -9, -9),
                             turner_vec3_of(2 * i + 2, 9, 9), glass);
    struct turner_image image = {0};
    struct turner_statistics counts = {0};
    bool possible = false;
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_draw(&image, s, scene, &counts, &possible);
    double nodes = (double)(counts.camera_rays + counts.reflected_rays + counts.refracted_rays);
    double truth = nodes_below(1, reflectance, scene->settings.cutoff, 0);
    *error = possible ? fabs(nodes - truth) : TURNER_UNMEASURED;
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
    return result;
}

static double bound_none(double value, double limit)
{
    (void)value, (void)limit;
    return 0;
}

/* ---- lossless glass and a mirror in front of a background of 1 ---- */
static enum turner_result measure_furnace(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double excess,
                                          const struct turner_sweep_method *method)
{
    enum { size = 64 };
    (void)sweep;
    struct turner_scene *scene = turner_stage_create(
        size, turner_vec3_of(0, 1, 7), turner_vec3_of(0, 0, 0), 0.6);
    scene->settings.depth = 12;
    scene->settings.cutoff = 1 / 512.0;
    scene->background.color = TURNER_GREY(1);
    uint32_t glass =
        turner_stage_glass(scene, 1 + excess, 0, TURNER_GREY(0), TURNER_FRESNEL_EXACT);
    uint32_t mirror = turner_stage_material(
        scene, (struct turner_material){.k_r = TURNER_GREY(1), .medium = TURNER_NONE});
    turner_stage_sphere(scene, turner_vec3_of(-0.8, 0, 0), 1, glass);
    turner_stage_sphere(scene, turner_vec3_of(1.2, 0.3, 0.2), 0.9, mirror);
    turner_group_add_box(&scene->groups[0], turner_vec3_of(-0.4, -1.2, 1),
                         turner_vec3_of(0.6, -0.3, 2), glass);
    struct turner_image image = {0};
    bool possible = false;
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_draw(&image, s, scene, NULL, &possible);
    double worst = 0;
    for (int i = 0; possible && result == TURNER_OK && i < size * size; i++) {
        double off = fabs((double)image.rgba[4 * i] + (double)image.rgba[4 * i + 3] - 1);
        worst = off > worst || isnan(off) ? off : worst;
    }
    *error = possible ? worst : TURNER_UNMEASURED;
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
    return result;
}

static double bound_furnace(double excess, double limit)
{
    (void)excess, (void)limit;
    return 1e-5;
}

#define SECTION "7. Recursion"
#define DEPTH_NOTE                                                                                 \
    "the light of the reflections that are not followed: ρ^(depth + 1) of it; raise --depth and "  \
    "lower --cutoff"

static const struct turner_sweep sweeps[] = {
    {.name = "mirrors-lost",
     .section = SECTION,
     .question = "Two facing mirrors: how much of the light is lost where the recursion stops?",
     .parameter = "reflectance ρ",
     .unit_of_error = "share of the light lost",
     .values = {0.5, 0.8, 0.9, 0.99, NAN},
     .methods = {{"depth 8, cutoff 1/512 (default)", "depth=8 cutoff=0.001953125", 0,
                  TURNER_HOLDS_TO_FAILS(0.5, 0.9), DEPTH_NOTE},
                 {"depth=25", "depth=25 cutoff=0", 0, TURNER_HOLDS_TO_FAILS(0.8, 0.9), NULL},
                 {"depth=53", "depth=53 cutoff=0", 0, TURNER_HOLDS_TO_FAILS(0.9, 0.99), NULL},
                 {"depth=552", "depth=552 cutoff=0", 0, TURNER_HOLDS, NULL}},
     .measure = measure_lost,
     .bound = bound_step,
     .bound_words = "1/255",
     .published = "Depths needed for 1/255: 8, 25, 53, 552 for ρ = .5, .8, .9, .99."},
    {.name = "mirrors-theory",
     .section = SECTION,
     .question = "Two facing mirrors of reflectance ρ: is exactly ρ^(depth + 1) lost?",
     .parameter = "depth",
     .unit_of_error = "difference from 1 − ρ^(depth + 1)",
     .values = {1, 2, 5, 15, 50, 200, 1000, NAN},
     .methods = {{"ρ = .9", NULL, 90, TURNER_HOLDS, NULL},
                 {"ρ = .5", NULL, 50, TURNER_HOLDS, NULL},
                 {"ρ = .99", NULL, 99, TURNER_HOLDS, NULL}},
     .measure = measure_theory,
     .limit = limit_theory,
     .bound = bound_theory,
     .bound_words = "a rounding error for each reflection",
     .published = ".53 at depth 5, .185 at 15 for ρ = .9."},
    {.name = "tree-nodes",
     .section = SECTION,
     .question = "Panes that reflect R and let 1 − R through, depth 15: are all rays followed that "
                 "should be, and no others?",
     .parameter = "R",
     .unit_of_error = "rays too many or too few",
     .values = {0.04, 0.1, 0.5, NAN},
     .methods = {{"cutoff 1/512 (default)", "cutoff=0.001953125", 0, TURNER_HOLDS, NULL},
                 {"cutoff=1/255", "cutoff=0.00392156862745098", 0, TURNER_HOLDS, NULL},
                 {"cutoff=0", "cutoff=0", 0, TURNER_HOLDS, NULL}},
     .measure = measure_nodes,
     .bound = bound_none,
     .bound_words = "not one",
     .published = "65535 rays with cutoff 0; 136, 301, 255 with 1/255."},
    {.name = "furnace",
     .section = SECTION,
     .question = "Lossless glass and a mirror in a white furnace: is each pixel 1 minus its pruned "
                 "weight?",
     .parameter = "n − 1",
     .unit_of_error = "largest error of a pixel",
     .values = {1e-4, 1e-3, 1e-2, 0.1, 0.5, 1, 2, NAN},
     .methods = {{"default", NULL, 0, TURNER_HOLDS, NULL},
                 {"naive cosine", "fresnel_cosine=naive", 0, TURNER_SHOWN, NULL},
                 {"schlick", "fresnel=schlick", 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = measure_furnace,
     .bound = bound_furnace,
     .bound_words = "1e-5"},
    {0}};

const struct turner_sweep *const turner_sweeps_recursion = sweeps;
