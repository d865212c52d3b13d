/* Adaptive samples: the picture is that of the rule as docs/model.md states it, told here again in
 * the plainest way over a scene whose radiance anyone can compute; tiles leave no trace. */
#include <math.h>
#include <stdlib.h>

#include "../render/render_test.h"
#include "render/cells.h"
#include "render/estimate.h"
#include "render/layers.h"

#define WIDTH 24
#define HEIGHT 18
#define MOST_CELLS 4096
#define SMALLEST (1.0 / 4096) /* edge of a square that is not divided */

static struct rig rig;

/* Two spheres that shine, before nothing. */
static const char scene_text[] =
    SCENE_HEAD ", \"materials\": {\"a\": {\"k_e\": 1}, \"b\": {\"k_e\": [0.4, 0.1, 0]}},"
    "\"background\": 0, \"primitives\": ["
    "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"a\"},"
    "{\"type\": \"sphere\", \"center\": [1.2, 0.3, -1], \"radius\": 0.8, \"material\": \"b\"}]}";

static bool meets(double dx, double dy, double cx, double cy, double cz, double radius)
{
    /* from (0, 0, 5) along (dx, dy, −1) */
    double a = dx * dx + dy * dy + 1, b = dx * cx + dy * cy - (cz - 5);
    double c = cx * cx + cy * cy + (cz - 5) * (cz - 5) - radius * radius;
    return b > 0 && b * b - a * c >= 0;
}

/* Red channel, in which the spheres differ most. */
static double radiance(const struct turner_scene *scene, double x, double y)
{
    double unit = 2 * tan(scene->camera.vfov / 2) / HEIGHT;
    double dx = (x - WIDTH / 2.0) * unit, dy = (HEIGHT / 2.0 - y) * unit;
    return meets(dx, dy, 0, 0, 0, 1) ? 1 : meets(dx, dy, 1.2, 0.3, -1, 0.8) ? 0.4 : 0;
}

struct square {
    double x, y, edge, spread, value;
};

static struct square square_of(const struct turner_scene *scene, double x, double y, double edge)
{
    double center = radiance(scene, x + edge / 2, y + edge / 2), sum = 0;
    double low = center, high = center;
    for (int i = 0; i < 4; i++) {
        double corner = radiance(scene, x + (i & 1) * edge, y + (i >> 1) * edge);
        sum += corner;
        low = fmin(low, corner);
        high = fmax(high, corner);
    }
    return (struct square){x, y, edge, high - low, 0.5 * center + 0.125 * sum};
}

/* The square that differs most, of those as large as any in the round; −1 when none may go on. */
static int widest(const struct square *squares, const bool *fresh, int count, double threshold)
{
    int best = -1;
    for (int i = 0; i < count; i++) {
        if (!fresh[i] && squares[i].spread > threshold && squares[i].edge > SMALLEST &&
            (best < 0 || squares[i].spread > squares[best].spread))
            best = i;
    }
    return best;
}

/* The pixel by the rule; squares divided in one round are looked at again in the next. */
static double pixel_by_rule(const struct turner_scene *scene, int x, int y, int *samples)
{
    static struct square squares[MOST_CELLS];
    static bool fresh[MOST_CELLS];
    int count = 1;
    *samples = 5;
    squares[0] = square_of(scene, x, y, 1);
    for (bool divided = true; divided;) {
        divided = false;
        memset(fresh, 0, sizeof fresh);
        int at;
        while (*samples + 8 <= scene->settings.spp &&
               (at = widest(squares, fresh, count, scene->settings.aa_threshold)) >= 0) {
            struct square s = squares[at];
            double half = s.edge / 2;
            memmove(squares + at + 4, squares + at + 1,
                    (size_t)(count - at - 1) * sizeof *squares);
            memmove(fresh + at + 4, fresh + at + 1, (size_t)(count - at - 1) * sizeof *fresh);
            for (int i = 0; i < 4; i++) {
                squares[at + i] =
                    square_of(scene, s.x + (i & 1) * half, s.y + (i >> 1) * half, half);
                fresh[at + i] = true;
            }
            count += 3;
            *samples += 8;
            divided = true;
        }
    }
    double sum = 0;
    for (int i = 0; i < count; i++)
        sum += squares[i].value * squares[i].edge * squares[i].edge;
    return sum;
}

static void follows_rule(double threshold, int most)
{
    struct turner_scene *scene = scene_of(scene_text);
    scene->settings.width = WIDTH;
    scene->settings.height = HEIGHT;
    scene->settings.aa_threshold = threshold;
    scene->settings.spp = most;
    struct turner_image image;
    struct turner_statistics statistics = {0};
    draw(&rig, &image, scene, BVH, NULL, &statistics);
    int off = 0, samples_max = 0;
    double samples = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        int count;
        double value = pixel_by_rule(scene, i % WIDTH, i / WIDTH, &count);
        off += fabs((double)image.rgba[4 * i] - value) > 1e-5;
        samples += count;
        samples_max = count > samples_max ? count : samples_max;
    }
    printf("threshold %g, at most %d: %.2f samples a pixel, %d at most, %d pixels off\n", threshold,
           most, samples / (WIDTH * HEIGHT), samples_max, off);
    assert_true(off <= 1); /* a sample on the silhouette may go either way in float */
    assert_true(samples_max <= most);
    if (off == 0) {
        assert_int_equal(statistics.samples_max, samples_max);
        assert_true(fabs(statistics.samples_mean - samples / (WIDTH * HEIGHT)) < 1e-9);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

static void is_whitteds_rule(void **state)
{
    (void)state;
    follows_rule(0.05, 5);    /* no division */
    follows_rule(0.05, 30);   /* the most is reached: the largest differences come first */
    follows_rule(0.05, 1000);
    follows_rule(0.5, 1000);  /* between the darker sphere and nothing there is no edge */
}

static void same_in_tiles(const char *path, double threshold, double error)
{
    struct turner_scene *scene;
    assert_ok(turner_scene_load(&scene, path));
    scene->settings.width = 64;
    scene->settings.height = 48;
    scene->settings.aa_threshold = threshold;
    scene->settings.error = error;
    scene->settings.spp = 64;
    unsigned wanted = error > 0 ? 1u << TURNER_LAYER_ERROR : 0;
    struct turner_layers layers = {.wanted = wanted};
    const struct turner_render_options options = {.layers = &layers};
    struct turner_image whole;
    assert_ok(turner_layers_create(&layers, scene));
    draw(&rig, &whole, scene, BVH, &options, NULL);
    for (int tile = 5; tile <= 32; tile += 27) {
        struct turner_layers tiled_layers = {.wanted = wanted};
        const struct turner_render_options tiles = {.tile = tile, .layers = &tiled_layers};
        struct turner_image tiled;
        assert_ok(turner_layers_create(&tiled_layers, scene));
        draw(&rig, &tiled, scene, BVH, &tiles, NULL);
        assert_same_picture(&whole, &tiled, "tiles");
        if (wanted)
            assert_memory_equal(layers.real[TURNER_LAYER_ERROR],
                                tiled_layers.real[TURNER_LAYER_ERROR], 64 * 48 * sizeof(float));
        turner_layers_destroy(&tiled_layers);
        turner_image_destroy(&tiled);
    }
    turner_layers_destroy(&layers);
    turner_image_destroy(&whole);
    turner_scene_destroy(scene);
}

static void tiles_leave_no_trace(void **state)
{
    (void)state;
    same_in_tiles(TURNER_SOURCE_DIR "/scenes/whitted1980.json", 0.05, 0);
    same_in_tiles(TURNER_SOURCE_DIR "/scenes/metals.json", 0, 1.0 / 64);
}

/* However a pixel is divided, and wherever its edges are, its cells fill it, and what is linear has
 * its true mean and no bend. */
static void cells_are_exact_for_what_is_linear(void **state)
{
    (void)state;
    struct turner_lattice lattice;
    struct turner_cells cells = {.lattice = &lattice, .jittered = true};
    uint32_t random = 1;
    turner_lattice_create(&lattice, 13);
    turner_cells_begin(&cells, 5, 3);
    struct turner_patch patch = cells.patches[0];
    for (int round = 0; round < 7; round++) {
        for (size_t i = 0; i < cells.cell_count; i++) {
            random = random * 1664525 + 1013904223;
            cells.cells[i].split = i == 0 || random >> 31;
        }
        turner_cells_divide(&cells);
        patch = cells.patches[0];
    }
    for (size_t i = 0; i < lattice.count; i++) {
        for (int c = 0; c < 4; c++)
            lattice.values[i][c] = (float)c + 2 * lattice.positions[i][0] - lattice.positions[i][1];
    }
    double area = 0;
    for (size_t i = 0; i < cells.cell_count; i++) {
        const struct turner_cell *cell = &cells.cells[i];
        float corners = 0;
        for (int k = 0; k < 4; k++)
            corners += cell->weight[k] * lattice.values[cell->corner[k]][1];
        assert_true(fabsf(corners - lattice.values[cell->center][1]) < 1e-5f);
        assert_true(cell->area > 0);
        area += (double)cell->area;
    }
    float value[4];
    turner_cells_value(value, &cells, &patch);
    printf("%zu cells, area %.9f, mean %.7f\n", cells.cell_count, area, (double)value[1]);
    assert_true(cells.cell_count > 300);
    assert_true(fabs(area - 1) < 1e-6);
    assert_true(fabsf(value[1] - (1 + 2 * 5.5f - 3.5f)) < 1e-5f);
    turner_cells_destroy(&cells);
    turner_lattice_destroy(&lattice);
}

/* A pixel's estimate is at least what two of those beside it share, be it in a corner or not; what
 * one alone has stays there. */
static void two_neighbours_raise_a_pixel(void **state)
{
    (void)state;
    const float errors[9] = {1, 1, 1, 1, 1, 1, 1, 1, 9};
    const float shared[9] = {0, 7, 0, 0, 5, 3, 0, 0, 0};
    const float expected[9] = {5, 3, 5, 5, 3, 5, 1, 3, 9};
    float pooled[9], lone[2];
    turner_estimate_pool(pooled, errors, shared, 3, 3);
    for (int i = 0; i < 9; i++)
        assert_true(pooled[i] == expected[i]);
    turner_estimate_pool(lone, errors, shared, 1, 2);
    assert_true(lone[0] == 1 && lone[1] == 1);
    struct turner_estimate smooth = {.sampling = 1}, edge = {.sampling = 1, .edges = 1};
    assert_true(turner_estimate_shared(&smooth, true) == 0);
    assert_true(turner_estimate_shared(&edge, true) > turner_estimate_shared(&edge, false));
}

/* Lists are traced in pieces whose size follows the time they take, and stays within the buffers. */
static void pieces_fit_their_buffers(void **state)
{
    (void)state;
    enum { COUNT = 4 * TURNER_LIST_MAX };
    struct turner_scene *scene = scene_of(SCENE_HEAD ", \"background\": 0.5}");
    scene->settings.aa_threshold = 0.05;
    const struct turner_render_options options = {0};
    struct turner_statistics statistics = {0};
    struct turner_renderer renderer;
    assert_ok(turner_renderer_create(&renderer, &rig.gpu, &rig.kernels[BVH], scene, &options,
                                     &statistics));
    float(*positions)[2] = calloc(COUNT, sizeof *positions);
    float(*results)[4] = calloc(COUNT, sizeof *results);
    assert_ok(turner_renderer_trace(&renderer, 8, 0, (const float(*)[2])positions, COUNT, results));
    for (size_t i = 0; i < COUNT; i++)
        assert_true(results[i][0] == 0.5f);
    free(positions);
    free(results);
    turner_renderer_destroy(&renderer);
    turner_scene_destroy(scene);
}

int main(void)
{
    rig_open(&rig);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(is_whitteds_rule),
        cmocka_unit_test(tiles_leave_no_trace),
        cmocka_unit_test(cells_are_exact_for_what_is_linear),
        cmocka_unit_test(two_neighbours_raise_a_pixel),
        cmocka_unit_test(pieces_fit_their_buffers),
    };
    return rig_close(&rig, cmocka_run_group_tests(tests, NULL, NULL));
}
