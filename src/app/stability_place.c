/* Where things are and how large: the same picture everywhere, and input at the edge of sense. */
#include <stdlib.h>
#include <string.h>

#include "app/stability.h"
#include "base/memory.h"

/* ---- a still life, moved and scaled ---- */

struct place {
    double scale;
    struct turner_vec3 offset;
};

static struct turner_vec3 put(struct place place, double x, double y, double z)
{
    return turner_vec3_add(place.offset,
                           turner_vec3_scale(turner_vec3_of(x, y, z), place.scale));
}

/* Glass, a mirror and a box on a checkered floor, under a lamp. */
static struct turner_scene *still_life(struct place place)
{
    double s = place.scale;
    struct turner_scene *scene =
        turner_stage_create(96, put(place, 0.5, 2, 7), put(place, 0, 0.8, 0), 0.6);
    scene->settings.depth = 6;
    uint32_t floor = turner_stage_material(
        scene, (struct turner_material){.k_d = TURNER_GREY(1),
                                        .pattern = TURNER_PATTERN_CHECKER,
                                        .checker = {TURNER_GREY(0.9), TURNER_GREY(0.1)},
                                        .uv_scale = {1 / s, 1 / s},
                                        .medium = TURNER_NONE});
    uint32_t matt = turner_stage_material(
        scene, (struct turner_material){.k_d = {0.8, 0.3, 0.2}, .medium = TURNER_NONE});
    uint32_t mirror = turner_stage_material(
        scene, (struct turner_material){.k_r = TURNER_GREY(0.9), .medium = TURNER_NONE});
    uint32_t glass = turner_stage_glass(scene, 1.5, 0, TURNER_GREY(0), TURNER_FRESNEL_EXACT);
    turner_stage_plane(scene, put(place, 0, 0, 0), turner_vec3_of(0, 1, 0), floor);
    turner_stage_sphere(scene, put(place, -1.3, 1, 0), s, mirror);
    turner_stage_sphere(scene, put(place, 1.2, 0.9, 0.8), 0.9 * s, glass);
    turner_group_add_box(&scene->groups[0], put(place, -0.3, 0, -2), put(place, 0.9, 1.6, -1),
                         matt);
    turner_stage_light(scene, (struct turner_light){.kind = TURNER_LIGHT_POINT,
                                                    .position = put(place, 3, 6, 5),
                                                    .power = TURNER_GREY(150 * s * s)});
    scene->background.color = TURNER_GREY(0.4);
    return scene;
}

static struct turner_scene *translated(double away, int variant)
{
    (void)variant;
    return still_life((struct place){1, {away, away, -away}});
}

static struct turner_scene *scaled(double scale, int variant)
{
    (void)variant;
    return still_life((struct place){scale, {0, 0, 0}});
}

/* ---- two media that overlap by a little ---- */
static struct turner_scene *overlapping(double overlap, int variant)
{
    (void)variant;
    struct turner_scene *scene = turner_stage_create(
        96, turner_vec3_of(0.6, 1, 6), turner_vec3_of(0, 0, 0), 0.7);
    scene->background = (struct turner_background){.kind = TURNER_BACKGROUND_GRADIENT,
                                                   .color = TURNER_GREY(0.1),
                                                   .top = TURNER_GREY(1),
                                                   .up = {0, 1, 0}};
    uint32_t water = turner_stage_glass(scene, 1.333, 0, turner_vec3_of(0.4, 0.1, 0.05),
                                        TURNER_FRESNEL_EXACT);
    uint32_t glass = turner_stage_glass(scene, 1.5, 1, turner_vec3_of(0.05, 0.05, 0.3),
                                        TURNER_FRESNEL_EXACT);
    turner_stage_sphere(scene, turner_vec3_of(-1 + overlap / 2, 0, 0), 1, water);
    turner_stage_sphere(scene, turner_vec3_of(1 - overlap / 2, 0, 0), 1, glass);
    return scene;
}

static double bound_share(double value, double limit)
{
    (void)value, (void)limit;
    return 0.01;
}

/* ---- input that makes no sense is refused ---- */

static const char *const refused_cases[] = {
    "radius 0", "radius −1", "radius not a number", "centre infinite", "corner not a number",
    "up along the view", "eye where it looks", "field of view 180°", "index 0",
    "transform that flattens", "exponent −1", "light not finite", NULL};

static void spoil(struct turner_scene *scene, int how)
{
    struct turner_group *world = &scene->groups[0];
    switch (how) {
    case 0: world->spheres[0].radius = 0; break;
    case 1: world->spheres[0].radius = -1; break;
    case 2: world->spheres[0].radius = NAN; break;
    case 3: world->spheres[0].center.x = INFINITY; break;
    case 4: world->meshes[0].positions[3].y = NAN; break;
    case 5: scene->camera.up = turner_vec3_sub(scene->camera.at, scene->camera.from); break;
    case 6: scene->camera.at = scene->camera.from; break;
    case 7: scene->camera.vfov = 3.141592653589793; break;
    case 8: scene->media[0].index = 0; break;
    case 9:
        *TURNER_PUSH(scene->groups, scene->group_count, scene->group_capacity) =
            (struct turner_group){0};
        *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) =
            (struct turner_instance){1, TURNER_NONE, {{{1, 0, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}}};
        break;
    case 10: scene->materials[0].exponent = -1; break;
    case 11: scene->lights[0].power.y = INFINITY; break;
    }
}

static enum turner_result measure_refused(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double how,
                                          const struct turner_sweep_method *method)
{
    (void)s, (void)sweep, (void)method;
    struct turner_scene *scene = still_life((struct place){1, {0, 0, 0}});
    bool good = turner_scene_validate(scene) == TURNER_OK;
    spoil(scene, (int)how);
    enum turner_result result = turner_scene_validate(scene);
    *error = good && result == TURNER_BAD_INPUT && *turner_message() ? 0 : 1;
    turner_scene_destroy(scene);
    return TURNER_OK;
}

/* ---- input that is odd and drawn ---- */

static const char *const odd_cases[] = {
    "picture of 1 × 1", "eye on a surface", "eye inside glass", "light 1 mm from a surface",
    "triangles without area", "the same triangles twice", "radiance of 1e30", NULL};

static void add_flat_triangles(struct turner_scene *scene)
{
    struct turner_mesh *box = &scene->groups[0].meshes[0];
    for (uint32_t i = 0; i < box->triangle_count; i += 2)
        box->triangles[i][2] = box->triangles[i][1];
}

static struct turner_scene *odd_scene(double how, int variant)
{
    (void)variant;
    struct turner_scene *scene = still_life((struct place){1, {0, 0, 0}});
    struct turner_vec3 glass = {1.2, 0.9, 0.8};
    switch ((int)how) {
    case 0: scene->settings.width = scene->settings.height = 1; break;
    case 1: scene->camera.from = turner_vec3_of(0.5, 0, 7); break;
    case 2:
        scene->camera.from = glass;
        scene->camera.inside[0] = 0;
        scene->camera.inside_count = 1;
        break;
    case 3: scene->lights[0].position = turner_vec3_of(0.5, 1e-3, 1); break;
    case 4: add_flat_triangles(scene); break;
    case 5:
        turner_group_add_box(&scene->groups[0], turner_vec3_of(-0.3, 0, -2),
                             turner_vec3_of(0.9, 1.6, -1), 1);
        break;
    case 6:
        scene->lights[0].power = TURNER_GREY(0);
        scene->background.color = TURNER_GREY(1e30);
        break;
    }
    return scene;
}

static double bound_none(double value, double limit)
{
    (void)value, (void)limit;
    return 0;
}

#define SECTION "6. Where things are, how large, and broken input"

static const char far_note[] =
    "so far out the floats themselves are too coarse for the scene (the dotted line is what "
    "rounding alone does): move the scene to the origin, or --method precision=f64";

static const struct turner_sweep sweeps[] = {
    {.name = "place-translate",
     .section = SECTION,
     .question = "A still life of a few metres, moved away from the origin: how many pixels are "
                 "wrong?",
     .parameter = "distance along each axis, m",
     .unit_of_error = "share of pixels wrong",
     .values = {1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS_TO_FAILS(1e3, 1e7), far_note},
                 {"offset=none", "offset=none", 0, TURNER_FAILS(100), NULL},
                 {"offset=tmin:1e-4", "offset=tmin:1e-4", 0, TURNER_FAILS(1e4), NULL},
                 {"sphere=textbook", "sphere=textbook", 0, TURNER_SHOWN, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {TURNER_POVRAY, NULL, 0, TURNER_SHOWN, NULL}},
     .measure = turner_stability_picture,
     .scene = translated,
     .tolerance = 0.01,
     .bound = bound_share,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {.name = "place-scale",
     .section = SECTION,
     .question = "A still life scaled up and down: how many pixels are wrong?",
     .parameter = "scale",
     .unit_of_error = "share of pixels wrong",
     .values = {1e-6, 1e-4, 1e-2, 1, 100, 1e4, 1e6, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"offset=none", "offset=none", 0, TURNER_FAILS(1), NULL},
                 {"offset=tmin:1e-3", "offset=tmin:1e-3", 0, TURNER_FAILS(1e-4), NULL},
                 {"offset=ulp", "offset=ulp", 0, TURNER_FAILS(1e-6), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL},
                 {TURNER_POVRAY, NULL, 0, TURNER_SHOWN, NULL}},
     .measure = turner_stability_picture,
     .scene = scaled,
     .tolerance = 0.01,
     .bound = bound_share,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {.name = "place-overlap",
     .section = SECTION,
     .question = "A ball of water and one of glass that overlap by a little: how many pixels are "
                 "wrong?",
     .parameter = "overlap / radius",
     .unit_of_error = "share of pixels wrong",
     .values = {1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, NAN},
     .methods = {{"error_bound (default)", NULL, 0, TURNER_HOLDS, NULL},
                 {"offset=none", "offset=none", 0, TURNER_FAILS(1e-1), NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = turner_stability_picture,
     .scene = overlapping,
     .tolerance = 0.01,
     .bound = bound_share,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {.name = "place-refused",
     .section = SECTION,
     .question = "Input that makes no sense: is it refused, with a message?",
     .parameter = "case",
     .unit_of_error = "1 where it was taken",
     .labels = refused_cases,
     .methods = {{"default", NULL, 0, TURNER_HOLDS, NULL}},
     .measure = measure_refused,
     .bound = bound_none,
     .bound_words = "each is refused"},
    {.name = "place-odd",
     .section = SECTION,
     .question = "Input that is odd but has a picture: how many pixels are wrong?",
     .parameter = "case",
     .unit_of_error = "share of pixels wrong",
     .labels = odd_cases,
     .methods = {{"default", NULL, 0, TURNER_HOLDS, NULL},
                 {"precision=f64", "precision=f64", 0, TURNER_HOLDS, NULL}},
     .measure = turner_stability_picture,
     .scene = odd_scene,
     .tolerance = 0.01,
     .bound = bound_share,
     .bound_words = "1 % of the pixels, each off by at most 0.01"},
    {0}};

const struct turner_sweep *const turner_sweeps_place = sweeps;
