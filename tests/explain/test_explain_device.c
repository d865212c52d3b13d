/* The device's tree of rays: it adds up to the pixel that the renderer draws, and is the reference's
 * tree but for rounding. */
#include "explain_test.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "app/explain.h"
#include "base/memory.h"
#include "reference/reference.h"
#include "render/explain.h"

static void assert_ok(enum turner_result result)
{
    if (result != TURNER_OK)
        fail_msg("%s", turner_message());
}

static void explain(struct turner_ray_tree *tree, const struct turner_scene *scene, int x, int y)
{
    static const struct turner_render_options options = {.unspecialised = true};
    struct turner_recorder recorder;
    assert_ok(turner_recorder_create(&recorder, scene, &options));
    assert_ok(turner_recorder_trace(tree, &recorder, x, y, 0.5, 0.5));
    turner_recorder_destroy(&recorder);
}

/* The kernel adds up with compensation: the sum is right to an ulp of its largest terms. */
static void check_sum(const struct turner_ray_tree *tree, const float *pixel)
{
    long double sum[3], size[3] = {0, 0, 0};
    turner_ray_tree_sum(sum, tree, 0);
    for (int c = 0; c < 3; c++) {
        for (uint32_t i = 0; i < tree->count; i++)
            size[c] = fmaxl(size[c], fabsl(tree->rays[i].contribution[c]));
        assert_true(!pixel || (float)tree->radiance[c] == pixel[c]);
        if (!(fabsl(sum[c] - tree->radiance[c]) <= 2 * FLT_EPSILON * fmaxl(size[c], sum[c])))
            fail_msg("contributions make %Lg, the pixel is %Lg", sum[c], tree->radiance[c]);
    }
    assert_true(!pixel || (float)tree->pruned == pixel[3]);
}

/* Pixels whose trees part, of some. With a picture, they must be its pixels. */
static int compare_scene(const char *name, enum turner_traversal traversal, bool picture)
{
    struct turner_scene *scene = must_load(name);
    /* what is not specialised is compiled once for most scenes */
    struct turner_render_options options = {.traversal = traversal, .unspecialised = !picture};
    struct turner_recorder recorder;
    struct turner_image image = {0};
    int parted = 0;
    if (picture)
        assert_ok(turner_render(&image, scene, &options, NULL));
    assert_ok(turner_recorder_create(&recorder, scene, &options));
    for (int i = 0; i < 12; i++) {
        int width = scene->settings.width;
        int x = (5 + 7 * i) % width, y = (3 + 5 * i) % scene->settings.height;
        struct turner_ray_tree device, reference;
        struct turner_ray_comparison comparison;
        assert_ok(turner_recorder_trace(&device, &recorder, x, y, 0.5, 0.5));
        assert_ok(turner_reference_explain(&reference, scene, x + 0.5, y + 0.5));
        check_sum(&device, picture ? image.rgba + 4 * (y * width + x) : NULL);
        turner_rays_compare(&comparison, &device, &reference, 10);
        if (comparison.parts != TURNER_NONE) {
            printf("  %s %d,%d: parts at #%u of %zu rays\n", name, x, y, comparison.parts,
                   comparison.count);
            parted++;
        } else {
            assert_int_equal(device.count, reference.count);
        }
        turner_rays_destroy(&comparison);
        turner_ray_tree_destroy(&device);
        turner_ray_tree_destroy(&reference);
    }
    turner_recorder_destroy(&recorder);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
    return parted;
}

/* The pixels are the same every time, none of them on an edge. */
static void same_tree(void **state)
{
    (void)state;
    static const char *const names[] = {SCENES};
    int parted = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        parted += compare_scene(names[i], TURNER_TRAVERSAL_BVH, i % 4 == 2);
    assert_int_equal(parted, 0);
}

static void same_tree_by_ray_query(void **state)
{
    struct turner_gpu gpu;
    (void)state;
    assert_ok(turner_gpu_create(&gpu, NULL, false));
    bool ray_query = gpu.info.ray_query;
    turner_gpu_destroy(&gpu);
    if (!ray_query)
        skip();
    assert_int_equal(compare_scene("instances", TURNER_TRAVERSAL_RAY_QUERY, true), 0);
}

/* Doubles agree in more bits than floats have. */
static void doubles(void **state)
{
    (void)state;
    struct turner_scene *scene = must_load("bubble");
    struct turner_ray_tree device, reference;
    struct turner_ray_comparison comparison;
    struct turner_gpu gpu;
    assert_ok(turner_gpu_create(&gpu, NULL, false));
    bool float64 = gpu.info.float64;
    turner_gpu_destroy(&gpu);
    if (!float64)
        skip();
    scene->settings.methods.precision = TURNER_PRECISION_F64;
    explain(&device, scene, 12, 9);
    assert_ok(turner_reference_explain(&reference, scene, 12.5, 9.5));
    turner_rays_compare(&comparison, &device, &reference, 10);
    assert_int_equal(comparison.parts, TURNER_NONE);
    assert_int_equal(comparison.mantissa, 53);
    assert_true(comparison.pairs[0].bits[TURNER_RAY_DIRECTION] >= 45);
    assert_true(comparison.pairs[0].bits[TURNER_RAY_POINT] >= 45);
    turner_rays_destroy(&comparison);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    turner_scene_destroy(scene);
}

/* More lights than a tree has rays: what fits is right, the rest is said to be missing. */
static void truncates(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]},"
        "\"settings\": {\"size\": [1, 1], \"depth\": 40, \"cutoff\": 0},"
        "\"materials\": {\"mirror\": {\"k_d\": 0.1, \"k_r\": 0.9}}, \"primitives\": ["
        "{\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"material\": \"mirror\"},"
        "{\"type\": \"plane\", \"point\": [0, 0, 6], \"normal\": [0, 0, -1], \"material\": \"mirror\"}],"
        "\"lights\": [{\"type\": \"point\", \"position\": [0, 1, 3], \"intensity\": 1}]}");
    struct turner_light light = scene->lights[0];
    for (int i = 1; i < TURNER_MAX_LIGHTS; i++)
        *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = light;
    struct turner_ray_tree device, reference;
    struct turner_ray_comparison comparison;
    explain(&device, scene, 0, 0);
    assert_ok(turner_reference_explain(&reference, scene, 0.5, 0.5));
    assert_true(device.truncated && reference.truncated);
    assert_int_equal(device.count, TURNER_RAY_TREE_MAX);
    turner_rays_compare(&comparison, &device, &reference, 10);
    assert_int_equal(comparison.parts, TURNER_NONE);
    turner_rays_destroy(&comparison);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    turner_scene_destroy(scene);
}

/* Where its pattern is black a surface asks no light, by the reference as on a device. */
static void black_pattern(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        "{\"version\": 1, \"camera\": {\"from\": [0.5, 0.5, 5], \"at\": [0.5, 0.5, 0]},"
        "\"settings\": {\"size\": [1, 1]}, \"materials\": {\"board\": {\"k_d\": 0.5,"
        "\"pattern\": {\"type\": \"checker\", \"colors\": [0, 0], \"scale\": 1}}},"
        "\"primitives\": [{\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 0, 1],"
        "\"material\": \"board\"}],"
        "\"lights\": [{\"type\": \"directional\", \"direction\": [0, 0, -1], \"irradiance\": 1}]}");
    struct turner_ray_tree device, reference;
    explain(&device, scene, 0, 0);
    assert_ok(turner_reference_explain(&reference, scene, 0.5, 0.5));
    assert_int_equal(reference.count, 1);
    assert_int_equal(device.count, 1);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    turner_scene_destroy(scene);
}

/* A light 1e-4 from what a weak mirror shows: J/d² is beyond floats, the pixel is not. */
static void nonfinite(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]},"
        "\"settings\": {\"size\": [1, 1], \"cutoff\": 0}, \"materials\": {"
        "\"mirror\": {\"k_r\": 1e-15}, \"wall\": {\"k_d\": 0.5}}, \"primitives\": ["
        "{\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 0, 1], \"material\": \"mirror\"},"
        "{\"type\": \"plane\", \"point\": [0, 0, 8], \"normal\": [0, 0, -1], \"material\": \"wall\"}],"
        "\"lights\": [{\"type\": \"point\", \"position\": [0, 0, 7.9999], \"intensity\": 1e35}]}");
    struct turner_ray_tree device, reference;
    const char *quantity;
    explain(&device, scene, 0, 0);
    assert_ok(turner_reference_explain(&reference, scene, 0.5, 0.5));
    assert_true(isinf(device.radiance[0]));
    uint32_t ray = turner_ray_tree_nonfinite(&device, &quantity);
    assert_int_equal(ray, 2);
    assert_int_equal(device.rays[ray].kind, TURNER_RAY_SHADOW);
    assert_string_equal(quantity, "irradiance");
    assert_int_equal(turner_ray_tree_nonfinite(&reference, &quantity), TURNER_NONE);
    /* .5/π · 1e35/(1e-4)² · 1e-15 */
    assert_true(fabsl(reference.radiance[0] / (0.5e28L / 3.141592653589793L) - 1) < 1e-9L);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    turner_scene_destroy(scene);
}

int main(void)
{
    struct turner_gpu gpu;
    if (turner_gpu_create(&gpu, NULL, false) != TURNER_OK) {
        printf("skipped: %s\n", turner_message());
        return 77;
    }
    turner_gpu_destroy(&gpu);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_tree), cmocka_unit_test(same_tree_by_ray_query),
        cmocka_unit_test(doubles),   cmocka_unit_test(truncates),
        cmocka_unit_test(nonfinite), cmocka_unit_test(black_pattern),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
