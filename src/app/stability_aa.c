/* What lies between samples: small balls, thin lines, a checkerboard to the horizon. */
#include "app/stability.h"
#include "base/memory.h"
#include "reference/reference.h"

#define SIZE 128
#define AWAY 1000.0  /* metres: so far that all of the picture is seen under the same angle */
#define PIXEL 0.0625 /* metres there */

static struct turner_scene *far_stage(void)
{
    return turner_stage_create(SIZE, turner_vec3_of(0, 0, AWAY), TURNER_GREY(0),
                               2 * atan(SIZE * PIXEL / 2 / AWAY));
}

/* The place at (x, y) pixels from the picture's top left corner. */
static struct turner_vec3 at_pixel(double x, double y)
{
    return turner_vec3_of((x - SIZE / 2) * PIXEL, (SIZE / 2 - y) * PIXEL, 0);
}

static enum turner_result draw(struct turner_image *image, struct turner_stability *s,
                               struct turner_scene *scene,
                               const struct turner_sweep_method *method, bool *possible)
{
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_draw(image, s, scene, NULL, possible);
    turner_scene_destroy(scene);
    return result;
}

static double sum_of(const struct turner_image *image, int x, int y, int width, int height)
{
    double sum = 0;
    for (int j = y; j < y + height; j++) {
        for (int i = x; i < x + width; i++)
            sum += (double)image->rgba[4 * (j * SIZE + i)];
    }
    return sum;
}

/* One ball in each cell of 8 by 8 pixels, anywhere in its middle. */
static enum turner_result measure_balls(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double radius,
                                        const struct turner_sweep_method *method)
{
    enum { cell = 8 };
    (void)sweep;
    struct turner_scene *scene = far_stage();
    struct turner_image image = {0};
    bool possible = false;
    uint64_t random = 1;
    uint32_t lamp = turner_stage_lamp(scene, 1);
    for (int y = 0; y < SIZE; y += cell) {
        for (int x = 0; x < SIZE; x += cell) {
            double right = turner_stage_random(&random), down = turner_stage_random(&random);
            turner_stage_sphere(scene, at_pixel(x + 3.5 + right, y + 3.5 + down), radius * PIXEL,
                                lamp);
        }
    }
    TURNER_TRY(draw(&image, s, scene, method, &possible));
    double area = 3.141592653589793 * radius * radius, sum = 0;
    for (int y = 0; possible && y < SIZE; y += cell) {
        for (int x = 0; x < SIZE; x += cell)
            sum += fabs(sum_of(&image, x, y, cell, cell) / area - 1);
    }
    *error = possible ? sum / (SIZE / cell * (SIZE / cell)) : TURNER_UNMEASURED;
    turner_image_destroy(&image);
    return TURNER_OK;
}

/* A wire across the picture, 10° from upright; each row of pixels has as much of it. */
static enum turner_result measure_line(double *error, struct turner_stability *s,
                                       const struct turner_sweep *sweep, double width,
                                       const struct turner_sweep_method *method)
{
    (void)sweep;
    const double lean = 0.17453292519943295, reach = SIZE * PIXEL;
    struct turner_scene *scene = far_stage();
    struct turner_image image = {0};
    bool possible = false;
    struct turner_group *world = &scene->groups[0];
    struct turner_vec3 half = {sin(lean) * reach, cos(lean) * reach, 0};
    double radius = width * PIXEL / 2;
    *TURNER_PUSH(world->cones, world->cone_count, world->cone_capacity) =
        (struct turner_cone){turner_vec3_scale(half, -1), half, radius, radius, true,
                             turner_stage_lamp(scene, 1)};
    TURNER_TRY(draw(&image, s, scene, method, &possible));
    double sum = 0, length = width / cos(lean);
    for (int y = 0; possible && y < SIZE; y++)
        sum += fabs(sum_of(&image, 0, y, SIZE, 1) / length - 1);
    *error = possible ? sum / SIZE : TURNER_UNMEASURED;
    turner_image_destroy(&image);
    return TURNER_OK;
}

/* A checkered floor, the horizon at the top edge of the picture. */
static struct turner_scene *checkered(void)
{
    enum { size = 64 };
    struct turner_scene *scene = turner_stage_create(
        size, turner_vec3_of(0, 1, 0), turner_vec3_of(0.05, 1 - tan(0.4), -1), 0.8);
    scene->ambient = TURNER_GREY(1);
    uint32_t floor = turner_stage_material(
        scene, (struct turner_material){.k_a = TURNER_GREY(1),
                                        .pattern = TURNER_PATTERN_CHECKER,
                                        .checker = {TURNER_GREY(1), TURNER_GREY(0)},
                                        .uv_scale = {2, 2},
                                        .medium = TURNER_NONE});
    turner_stage_plane(scene, TURNER_GREY(0), turner_vec3_of(0, 1, 0), floor);
    return scene;
}

static enum turner_result measure_checker(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double row,
                                          const struct turner_sweep_method *method)
{
    struct turner_scene *scene = checkered();
    struct turner_image image = {0};
    bool possible = false;
    int size = scene->settings.width;
    if (s->truth_sweep != sweep) {
        turner_image_destroy(&s->truth);
        s->truth_sweep = NULL;
        scene->settings.spp = 256;
        TURNER_TRY(turner_reference_render(&s->truth, scene, 0, NULL, NULL, NULL));
        scene->settings.spp = 1;
        s->truth_sweep = sweep;
    }
    TURNER_TRY(draw(&image, s, scene, method, &possible));
    double sum = 0;
    int first = 4 * size * (int)row;
    for (int i = first; possible && i < first + 4 * size; i += 4) {
        double off = (double)image.rgba[i] - (double)s->truth.rgba[i];
        sum += off * off;
    }
    *error = possible ? sqrt(sum / size) : TURNER_UNMEASURED;
    turner_image_destroy(&image);
    return TURNER_OK;
}

static double bound_quarter(double value, double limit)
{
    (void)value, (void)limit;
    return 0.25;
}

static double bound_tenth(double value, double limit)
{
    (void)value, (void)limit;
    return 0.1;
}

#define SECTION "8. Anti-aliasing"
#define AA_NOTE                                                                                    \
    "what is smaller than the distance of the samples is hit or missed whole: more samples, "      \
    "--method aa=64"

#define ADAPTIVE_NOTE                                                                              \
    "corners and centre of a pixel see nothing of what lies between them, and then no more "       \
    "samples are taken: --method aa=64 where thin things matter"

static const struct turner_sweep sweeps[] = {
    {.name = "aa-balls",
     .section = SECTION,
     .question = "Small balls: how far off is the light of each from π r²?",
     .parameter = "projected radius, pixels",
     .unit_of_error = "mean relative error of a ball",
     .values = {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, NAN},
     .methods = {{"aa=1 (default)", "aa=1", 0, TURNER_HOLDS_FROM_FAILS(1, 0.1), AA_NOTE},
                 {"aa=16", "aa=16", 0, TURNER_HOLDS_FROM_FAILS(0.5, 0.05), NULL},
                 {"aa=64", "aa=64", 0, TURNER_HOLDS_FROM_FAILS(0.2, 0.02), NULL},
                 {"aa=256", "aa=256", 0, TURNER_HOLDS_FROM(0.1), NULL},
                 {"adaptive", "aa=adaptive:0.05,64", 0, TURNER_HOLDS_FROM_FAILS(1, 0.1),
                  ADAPTIVE_NOTE}},
     .measure = measure_balls,
     .bound = bound_quarter,
     .bound_words = "a quarter of its light"},
    {.name = "aa-line",
     .section = SECTION,
     .question = "A thin line: how far off is its light in each row of pixels?",
     .parameter = "width, pixels",
     .unit_of_error = "mean relative error of a row",
     .values = {0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, NAN},
     .methods = {{"aa=1 (default)", "aa=1", 0, TURNER_HOLDS_FROM_FAILS(2, 0.05), AA_NOTE},
                 {"aa=16", "aa=16", 0, TURNER_HOLDS_FROM_FAILS(0.5, 0.02), NULL},
                 {"aa=64", "aa=64", 0, TURNER_HOLDS_FROM(0.1), NULL},
                 {"adaptive", "aa=adaptive:0.05,64", 0, TURNER_HOLDS_FROM_FAILS(2, 0.05),
                  ADAPTIVE_NOTE}},
     .measure = measure_line,
     .bound = bound_quarter,
     .bound_words = "a quarter of its light"},
    {.name = "aa-checker",
     .section = SECTION,
     .question = "A checkerboard to the horizon: how far off is a row of pixels from the mean over "
                 "their areas?",
     .parameter = "rows below the horizon",
     .unit_of_error = "root mean square error",
     .values = {0, 1, 2, 4, 8, 16, 32, NAN},
     .methods = {{"aa=1 (default)", "aa=1", 0, TURNER_FAILS(2), AA_NOTE},
                 {"aa=16", "aa=16", 0, TURNER_SHOWN, NULL},
                 {"aa=64", "aa=64", 0, TURNER_HOLDS_FROM(4), NULL},
                 {"adaptive", "aa=adaptive:0.05,64", 0, TURNER_HOLDS_FROM(16), ADAPTIVE_NOTE}},
     .measure = measure_checker,
     .bound = bound_tenth,
     .bound_words = "a tenth"},
    {0}};

const struct turner_sweep *const turner_sweeps_aa = sweeps;
