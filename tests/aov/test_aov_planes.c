/* Layers without a device: names, ids, memory, and what an EXR file holds of them. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "../image/folder.h"
#include "base/memory.h"
#include "reference/reference.h"
#include "render/contrast.h"
#include "render/layers.h"
#include "scene/ids.h"
#include "scene/readers.h"

#define assert_ok(call)                                  \
    do {                                                 \
        if ((call) != TURNER_OK)                         \
            fail_msg("%s: %s", #call, turner_message()); \
    } while (0)

static void assert_near(double found, double expected, double tolerance)
{
    if (!(fabs(found - expected) <= tolerance))
        fail_msg("%g is not %g within %g", found, expected, tolerance);
}

static uint32_t bit(enum turner_layer layer)
{
    return 1u << layer;
}

static void names(void **state)
{
    (void)state;
    uint32_t wanted = 0;
    assert_ok(turner_layers_parse(&wanted, "depth"));
    assert_ok(turner_layers_parse(&wanted, "id,normal,id"));
    assert_int_equal(wanted, bit(TURNER_LAYER_DEPTH) | bit(TURNER_LAYER_ID) |
                                 bit(TURNER_LAYER_NORMAL));
    for (int i = 0; i < TURNER_LAYERS; i++) {
        wanted = 0;
        assert_ok(turner_layers_parse(&wanted, turner_layer_name((enum turner_layer)i)));
        assert_int_equal(wanted, 1u << i);
    }
    wanted = 0;
    assert_ok(turner_layers_parse(&wanted, "all"));
    assert_int_equal(wanted, (1u << TURNER_LAYERS) - 1);

    static const char *const wrong[][2] = {
        {"normals", "did you mean \"normal\"?"},
        {"depth,albdo", "did you mean \"albedo\"?"},
        {"", "no layer \"\""},
        {"depth,", "no layer \"\""},
        {"xyzzy", "--help lists them"},
        {"Normal", "did you mean \"normal\"?"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(turner_layers_parse(&wanted, wrong[i][0]), TURNER_USAGE);
        if (!strstr(turner_message(), wrong[i][1]))
            fail_msg("\"%s\": %s", wrong[i][0], turner_message());
    }
}

static struct turner_scene *scene_of(const char *text)
{
    struct turner_scene *scene;
    assert_ok(turner_scene_parse(&scene, text, strlen(text), "test.json"));
    return scene;
}

/* A row of things, each filling some pixels of a 70×1 picture whose pixels are 0.1 wide at z = 0. */
static const char row[] =
    "{\"version\": 1, \"camera\": {\"from\": [0, 0, 100], \"at\": [0, 0, 0], \"vfov\": "
    "0.05729577485, \"inside\": [\"haze\"]}, \"media\": {\"haze\": {\"index\": 1}}, "
    "\"settings\": {\"size\": [70, 1]}, \"materials\": {\"red\": {\"k_d\": [0.5, 0.25, 0.125]}, "
    "\"same\": {\"k_t\": 1, \"medium\": \"haze\"}},"
    "\"groups\": {\"pair\": ["
    "  {\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 0.4, \"material\": \"red\"},"
    "  {\"type\": \"box\", \"min\": [0.5, -1, -1], \"max\": [0.7, 1, 1], \"material\": \"red\"},"
    "  {\"type\": \"box\", \"min\": [0.8, -1, -1], \"max\": [0.99, 1, 1], \"material\": \"red\"}]},"
    "\"primitives\": ["
    "  {\"type\": \"sphere\", \"center\": [-3, 0, 0], \"radius\": 0.4, \"material\": \"red\"},"
    "  {\"type\": \"sphere\", \"center\": [-2, 0, 0], \"radius\": 0.4, \"material\": \"red\"},"
    "  {\"type\": \"cylinder\", \"base\": [-1, -1, 0], \"apex\": [-1, 1, 0], \"radius\": 0.4, "
    "   \"material\": \"red\"},"
    "  {\"type\": \"sphere\", \"center\": [-2, 0, 3], \"radius\": 0.6, \"material\": \"same\"},"
    "  {\"type\": \"box\", \"min\": [3.1, -1, -1], \"max\": [3.4, 1, 1], \"material\": \"red\"},"
    "  {\"type\": \"plane\", \"point\": [0, 0, -5], \"normal\": [0, 0, 1], \"material\": \"red\"}],"
    "\"instances\": [{\"group\": \"pair\", \"transform\": {\"translate\": [0, 0, 0]}},"
    "  {\"group\": \"pair\", \"transform\": {\"translate\": [2, 0, 0]}}]}";

/* Numbers by hand: plane 1; of the world spheres 2, 3, 4 (4 is haze in haze and none sees
 * it), the cylinder 5 and the slab 6; of the first instance a sphere 7 and two boxes, 8 and 9, of
 * the second 10, 11, 12. */
static void what_a_pixel_shows(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(row);
    struct turner_layers layers = {.wanted = (1u << TURNER_LAYERS) - 1};
    struct turner_image image;
    assert_ok(turner_layers_create(&layers, scene));
    assert_ok(turner_reference_render_layers(&image, &layers, scene, 1, NULL, NULL, NULL));
    static const struct {
        int pixel; /* its centre is at x = pixel / 10 − 3.45 */
        uint32_t id;
        double z; /* of what is there */
    } seen[] = {
        {9, 1, -5},   {4, 2, 0.3969},   {14, 3, 0.3969}, {24, 5, 0.3969}, {67, 6, 1},
        {34, 7, 0.3969}, {41, 8, 1},    {43, 9, 1},   {54, 10, 0.3969}, {61, 11, 1}, {63, 12, 1},
    };
    for (size_t i = 0; i < sizeof seen / sizeof *seen; i++) {
        int p = seen[i].pixel;
        if (layers.whole[TURNER_LAYER_ID][p] != seen[i].id)
            fail_msg("pixel %d shows %u, not %u", p, layers.whole[TURNER_LAYER_ID][p], seen[i].id);
        double x = p / 10.0 - 3.45, z = seen[i].z, stretch = (100 - z) / 100;
        const float *position = layers.real[TURNER_LAYER_POSITION] + 3 * p;
        assert_near((double)position[0], x * stretch, 1e-3);
        assert_near((double)position[1], 0, 1e-3);
        assert_near((double)position[2], z, 5e-3);
        assert_near((double)layers.real[TURNER_LAYER_DEPTH][p],
                    sqrt((100 - z) * (100 - z) + x * x * stretch * stretch), 5e-3);
        const float *albedo = layers.real[TURNER_LAYER_ALBEDO] + 3 * p;
        assert_true(albedo[0] == 0.5f && albedo[1] == 0.25f && albedo[2] == 0.125f);
        const float *n = layers.real[TURNER_LAYER_NORMAL] + 3 * p;
        assert_true(n[2] > 0.9f);
        assert_near((double)sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]), 1, 1e-6);
        assert_int_equal(layers.whole[TURNER_LAYER_RAYS][p], 1);
        assert_int_equal(layers.whole[TURNER_LAYER_RECURSION][p], 0);
        assert_int_equal(layers.whole[TURNER_LAYER_SAMPLES][p], 1);
    }
    turner_image_destroy(&image);
    turner_layers_destroy(&layers);
    assert_null(layers.whole[TURNER_LAYER_ID]);
    turner_scene_destroy(scene);
}

static void background_is_infinitely_far(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}, "
        "\"background\": 1, \"settings\": {\"size\": [2, 2]}}");
    struct turner_layers layers = {.wanted = (1u << TURNER_LAYERS) - 1};
    struct turner_image image;
    assert_ok(turner_layers_create(&layers, scene));
    assert_ok(turner_reference_render_layers(&image, &layers, scene, 1, NULL, NULL, NULL));
    for (int i = 0; i < 4; i++) {
        assert_true(isinf(layers.real[TURNER_LAYER_DEPTH][i]));
        assert_int_equal(layers.whole[TURNER_LAYER_ID][i], 0);
    }
    for (int i = 0; i < 12; i++) {
        assert_true(layers.real[TURNER_LAYER_NORMAL][i] == 0);
        assert_true(layers.real[TURNER_LAYER_ALBEDO][i] == 0);
        assert_true(layers.real[TURNER_LAYER_POSITION][i] == 0);
    }
    turner_image_destroy(&image);
    turner_layers_destroy(&layers);
    turner_scene_destroy(scene);
}

static void pictures_tell_pruned_and_nonfinite(void **state)
{
    (void)state;
    float pixels[] = {1, 2, 3, 0.25f, NAN, 0, 0, 0, 0, 0, INFINITY, 0, 0, 0, 0, -INFINITY};
    struct turner_image image = {4, 1, pixels};
    float pruned[4];
    uint32_t nonfinite[4];
    struct turner_layers layers = {.real[TURNER_LAYER_PRUNED] = pruned,
                                   .whole[TURNER_LAYER_NONFINITE] = nonfinite};
    turner_layers_inspect(&layers, &image);
    assert_true(pruned[0] == 0.25f && pruned[1] == 0);
    assert_true(!nonfinite[0] && nonfinite[1] && nonfinite[2] && nonfinite[3]);
}

/* ---- the error that a picture tells ---- */

static double squared(double x)
{
    return x > 0 ? x * x : 0;
}

/* The part of the unit square where nx·x + ny·y ≤ c, for nx, ny ≥ 0. */
static double part(double nx, double ny, double c)
{
    if (nx < 1e-9 || ny < 1e-9)
        return fmin(fmax(c / fmax(nx, ny), 0), 1);
    return (squared(c) - squared(c - nx) - squared(c - ny) + squared(c - nx - ny)) / (2 * nx * ny);
}

/* The most by which the share of samples behind an edge differs from the share of the pixel, over
 * edges of that angle: it is found where the edge passes a sample. */
static double most_wrong(int samples, double angle)
{
    double nx = fabs(cos(angle)), ny = fabs(sin(angle)), most = 0;
    for (int i = 0; i < samples; i++) {
        double c = 0, x, y;
        int under = 0, level = 0;
        for (int k = -1; k < samples; k++) { /* first the edge through sample i */
            turner_sample_position(&x, &y, k < 0 ? i : k, samples);
            double d = nx * (cos(angle) < 0 ? 1 - x : x) + ny * y;
            if (k < 0)
                c = d;
            under += k >= 0 && d < c - 1e-12;
            level += k >= 0 && fabs(d - c) <= 1e-12;
        }
        double area = part(nx, ny, c);
        most = fmax(most, fmax(fabs(area - (double)under / samples),
                               fabs(area - (double)(under + level) / samples)));
    }
    return most;
}

static void an_edge_is_no_more_wrong_than_said(void **state)
{
    (void)state;
    for (int samples = 1; samples <= 100; samples++) {
        double most = 0, said = turner_edge_share(samples);
        for (int degrees = 0; degrees < 180; degrees++)
            most = fmax(most, most_wrong(samples, degrees * 3.14159265358979 / 180));
        if (!(most <= said + 1e-9 && most >= said / 2))
            fail_msg("%d samples: %g, said is %g", samples, most, said);
    }
}

/* A ball in front of a grey background, by few samples and by many. */
static void estimates_cover_errors(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"camera\": {\"from\": [0, 1, 5], \"at\": [0, 0, 0]}, "
        "\"background\": 0.5, \"materials\": {\"ball\": {\"k_d\": 0.7, \"k_r\": 0.2}, "
        "\"floor\": {\"k_d\": 0.5, \"pattern\": {\"type\": \"checker\", \"colors\": [0.2, 0.9], "
        "\"scale\": 1}}}, \"settings\": {\"size\": [64, 48]}, \"primitives\": ["
        "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"ball\"}, "
        "{\"type\": \"plane\", \"point\": [0, -1, 0], \"normal\": [0, 1, 0], \"material\": "
        "\"floor\"}], \"lights\": [{\"type\": \"directional\", \"direction\": [1, -2, -1], "
        "\"irradiance\": 2}]}");
    static float error[64 * 48];
    struct turner_image truth, image;
    scene->settings.spp = 144;
    assert_ok(turner_reference_render(&truth, scene, 0, NULL, NULL, NULL));
    for (int spp = 1; spp <= 16; spp *= 4) {
        scene->settings.spp = spp;
        assert_ok(turner_reference_render(&image, scene, 0, NULL, NULL, NULL));
        turner_contrast_estimate(error, &image, spp);
        int covered = 0;
        double sum = 0, said = 0;
        for (int i = 0; i < 64 * 48; i++) {
            double off = 0;
            for (int c = 0; c < 3; c++)
                off = fmax(off, fabs((double)image.rgba[4 * i + c] -
                                     (double)truth.rgba[4 * i + c]));
            covered += (double)error[i] >= off;
            sum += off;
            said += (double)error[i];
        }
        printf("  %d samples: %.2f %% covered, mean error %.5f, estimate %.5f\n", spp,
               covered / 30.72, sum / 3072, said / 3072);
        /* the rest is finer than neighbours show: squares towards the horizon */
        assert_true(covered >= 0.93 * 3072);
        assert_true(said < 20 * sum);        /* and it is no scare */
        turner_image_destroy(&image);
    }
    turner_image_destroy(&truth);
    turner_scene_destroy(scene);
}

static void cut_weight_and_nonfinite_pixels_are_in_the_estimate(void **state)
{
    (void)state;
    float pixels[] = {2, 2, 2, 0.25f, 2, 2, 2, 0, NAN, 0, 0, 0}, error[3];
    struct turner_image image = {3, 1, pixels};
    turner_contrast_estimate(error, &image, 1);
    assert_near((double)error[0], 0.25 * 2 + 2e-5, 1e-6);
    assert_near((double)error[1], 2e-5, 1e-6);
    assert_true(isinf(error[2]));
}

/* 2³⁰ things in each of four instances are 2³²: one more than there are numbers beside 0. */
static void ids_that_do_not_fit_are_refused(void **state)
{
    (void)state;
    struct turner_group groups[2] = {{0}, {.sphere_count = 1u << 30}}; /* only counted */
    struct turner_instance instances[4] = {{.group = 1}, {.group = 1}, {.group = 1}, {.group = 1}};
    struct turner_scene scene = {.groups = groups, .group_count = 2, .instances = instances,
                                 .instance_count = 4};
    struct turner_ids ids;
    assert_int_equal(turner_ids_create(&ids, &scene), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "layer id"));
    assert_null(ids.first);
    groups[1].sphere_count--;
    assert_ok(turner_ids_create(&ids, &scene));
    assert_int_equal(turner_id_of(&ids, 1, 0), 1);
    assert_int_equal(turner_id_of(&ids, 4, (1u << 30) - 2), 4 * ((1u << 30) - 1));
    turner_ids_destroy(&ids);
}

/* The picture fits, its layers do not. */
static void too_much_memory_is_refused_in_advance(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}}");
    size_t free_bytes = turner_memory_available();
    int edge = (int)sqrt((double)free_bytes / 16 * 0.9); /* 16 bytes a pixel without layers */
    scene->settings.width = scene->settings.height = edge;
    struct turner_layers layers = {.wanted = (1u << TURNER_LAYERS) - 1};
    assert_int_equal(turner_layers_create(&layers, scene), TURNER_DEVICE);
    assert_non_null(strstr(turner_message(), "with its layers"));
    assert_non_null(strstr(turner_message(), "MiB"));
    for (int i = 0; i < TURNER_LAYERS; i++)
        assert_true(!layers.real[i] && !layers.whole[i]);
    turner_scene_destroy(scene);
}

/* Other programs see the layers in command_aov.py; here that pictures are still read as such. */
static void files_hold_them_behind_the_picture(void **state)
{
    (void)state;
    enum { W = 5, H = 70 }; /* more rows than are written at once */
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}, "
        "\"settings\": {\"size\": [5, 70]}}");
    struct turner_layers layers = {.wanted = (1u << TURNER_LAYERS) - 1};
    struct turner_image image, back;
    assert_ok(turner_layers_create(&layers, scene));
    assert_ok(turner_image_create(&image, W, H));
    for (int i = 0; i < 4 * W * H; i++)
        image.rgba[i] = (float)i + 0.5f;
    struct turner_image_channel channels[TURNER_LAYER_CHANNELS];
    struct turner_image_encoding encoding = {.channels = channels};
    encoding.channel_count = turner_layers_channels(channels, &layers);
    assert_int_equal(encoding.channel_count, TURNER_LAYER_CHANNELS);
    assert_ok(turner_image_write(&image, in_folder("layers.exr"), &encoding));
    assert_ok(turner_image_read(&back, in_folder("layers.exr"), false));
    assert_int_equal(back.width, W);
    assert_int_equal(back.height, H);
    for (int i = 0; i < W * H; i++)
        assert_memory_equal(back.rgba + 4 * i, image.rgba + 4 * i, 3 * sizeof(float));
    turner_image_destroy(&back);

    assert_int_equal(turner_image_write(&image, in_folder("layers.png"), &encoding), TURNER_USAGE);
    assert_non_null(strstr(turner_message(), ".exr"));
    assert_int_equal(turner_image_write(&image, in_folder("layers.tif"), &encoding), TURNER_USAGE);
    turner_image_destroy(&image);
    turner_layers_destroy(&layers);
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names),
        cmocka_unit_test(what_a_pixel_shows),
        cmocka_unit_test(background_is_infinitely_far),
        cmocka_unit_test(pictures_tell_pruned_and_nonfinite),
        cmocka_unit_test(an_edge_is_no_more_wrong_than_said),
        cmocka_unit_test(estimates_cover_errors),
        cmocka_unit_test(cut_weight_and_nonfinite_pixels_are_in_the_estimate),
        cmocka_unit_test(ids_that_do_not_fit_are_refused),
        cmocka_unit_test(too_much_memory_is_refused_in_advance),
        cmocka_unit_test_setup_teardown(files_hold_them_behind_the_picture, folder_create,
                                        folder_destroy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
