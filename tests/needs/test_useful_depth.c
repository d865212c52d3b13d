/* How deep rays can go: against published numbers, against what the reference tracer does, and
 * Fresnel's least value against a scan of the formula. */
#include <math.h>

#include "needs_test.h"
#include "reference/reference.h"
#include "render/depth.h"

#define DEEP 1000 /* no bound but the cutoff */

/* The camera between two parallel planes, so that every ray goes on for ever. */
static struct turner_scene *facing(const char *material, double cutoff, int depth)
{
    return scene_of("\"settings\": {\"size\": [3, 2], \"depth\": %d, \"cutoff\": %.17g}, "
                    "\"materials\": {\"m\": %s}, \"primitives\": ["
                    "{\"type\": \"plane\", \"point\": [0, 0, -9], \"normal\": [0, 0, 1], "
                    "\"material\": \"m\"}, {\"type\": \"plane\", \"point\": [0, 0, 9], "
                    "\"normal\": [0, 0, -1], \"material\": \"m\"}]", depth, cutoff, material);
}

static int largest_depth(struct turner_scene *scene, struct turner_image *image)
{
    struct turner_reference_statistics statistics = {0};
    assert_int_equal(turner_reference_render(image, scene, 1, &statistics, NULL, NULL), TURNER_OK);
    return statistics.largest_depth;
}

/* Two mirrors of reflectance ρ: ρ^8 is the first power of .5 below 1/255, and so on. Rays of that
 * depth are not followed, those one less are. */
static void facing_mirrors(void **state)
{
    (void)state;
    static const struct {
        double reflectance;
        int first_below;
    } published[] = {{.5, 8}, {.8, 25}, {.9, 53}, {.99, 552}};
    for (size_t i = 0; i < sizeof published / sizeof *published; i++) {
        char material[64];
        snprintf(material, sizeof material, "{\"k_r\": %g}", published[i].reflectance);
        struct turner_scene *scene = facing(material, 1. / 255, DEEP);
        struct turner_depth depth = turner_depth_of(scene);
        struct turner_image image;
        assert_int_equal(depth.useful, published[i].first_below - 1);
        assert_true(depth.weight == published[i].reflectance && depth.material == 0);
        assert_int_equal(largest_depth(scene, &image), depth.useful);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* Setting the useful depth draws the same bytes as any deeper one; one less does not. */
static void deeper_draws_the_same(void **state)
{
    (void)state;
    static const char material[] = "{\"k_r\": [0.5, 0.7, 0.3], \"k_e\": 1}";
    struct turner_image images[3];
    int useful = 15; /* .7^15 = 1/211, .7^16 = 1/301 */
    for (int i = 0; i < 3; i++) {
        struct turner_scene *scene = facing(material, 1. / 255, useful - 1 + i * i);
        assert_int_equal(turner_depth_of(scene).useful, useful);
        largest_depth(scene, &images[i]);
        turner_scene_destroy(scene);
    }
    size_t bytes = 3 * 2 * 4 * sizeof(float);
    assert_memory_not_equal(images[0].rgba, images[1].rgba, bytes);
    assert_memory_equal(images[1].rgba, images[2].rgba, bytes);
    for (int i = 0; i < 3; i++)
        turner_image_destroy(&images[i]);
}

/* What the reference follows is never deeper than the bound. */
static void bound_holds(void **state)
{
    (void)state;
    static const struct {
        const char *material;
        double cutoff, weight; /* W; 0 where there is no bound */
    } cases[] = {
        {"{\"k_r\": 0.25}", 0.0625, 0.25}, /* a weight equal to the cutoff is followed */
        {"{\"k_r\": [0.2, 0.3, 0.1]}", 0.01, 0.3},
        {"{\"k_r\": 0.6, \"metal\": \"gold\"}", 0.01, 0.6},
        {"{\"k_t\": 1, \"index\": 1.5}", 0.01, 1 - 0.04},
        {"{\"k_t\": 1, \"index\": 5}", 0.01, 1 - 0.4131944444},
        {"{\"k_t\": 1, \"index\": 1.5, \"fresnel\": \"schlick\"}", 0.01, 1 - 0.04},
        {"{\"k_r\": 0.3, \"k_t\": 0.5, \"index\": 1.5}", 0.01, 0.5 * (1 - 0.04)},
        {"{\"k_r\": 0.9, \"k_t\": 0.5, \"index\": 1}", 0.01, 0.5}, /* F = 0: k_r never shows */
        {"{\"k_r\": 0.2, \"k_t\": 0.5, \"index\": 1.5, \"fresnel\": \"none\"}", 0.01, 0.7},
        {"{\"k_r\": 0.2, \"k_t\": 0.5, \"index\": 1, \"fresnel\": \"none\"}", 0.01, 0.5},
        {"{\"k_r\": 0.5}", 0, 0.5},
        {"{\"k_r\": 1}", 0.01, 1},
        {"{\"k_r\": 0.05, \"fresnel\": \"schlick\"}", 0.01, 1}, /* grazing incidence */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct turner_scene *scene = facing(cases[i].material, cases[i].cutoff, 12);
        struct turner_depth depth = turner_depth_of(scene);
        struct turner_image image;
        print_message("%s, cutoff %g: W = %.10g, useful %d\n", cases[i].material, cases[i].cutoff,
                      depth.weight, depth.useful);
        assert_true(fabs(depth.weight - cases[i].weight) < 1e-9);
        assert_true(largest_depth(scene, &image) <= depth.useful);
        if (cases[i].cutoff == 0 || cases[i].weight >= 1)
            assert_int_equal(depth.useful, TURNER_DEPTH_UNBOUNDED);
        else
            assert_true(pow(depth.weight, depth.useful) >= 0.999 * cases[i].cutoff &&
                        pow(depth.weight, depth.useful + 1) < cases[i].cutoff);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

static void nothing_reflects(void **state)
{
    (void)state;
    struct turner_scene *scene =
        scene_of("\"materials\": {\"m\": {\"k_d\": 1}, \"unused\": {\"k_r\": 1}}, "
                 "\"primitives\": [" SPHERE "]");
    struct turner_depth depth = turner_depth_of(scene);
    assert_int_equal(depth.useful, 0);
    assert_true(depth.weight == 0 && depth.material == TURNER_NONE);
    turner_scene_destroy(scene);
}

/* A bubble ranks above the glass around it: its surface parts 1 from 1.5, and with the glass gone
 * 1 from 1. Glass inside water loses less than in air. */
static void media_that_touch(void **state)
{
    (void)state;
    static const char format[] =
        "\"settings\": {\"cutoff\": 0.5}, \"media\": {\"below\": {\"index\": %g}, \"above\": "
        "{\"index\": %g, \"priority\": 1}}, \"materials\": {\"b\": {\"k_t\": 0.5, \"medium\": "
        "\"below\"}, \"m\": {\"k_t\": 1, \"medium\": \"above\"}}, \"primitives\": [" SPHERE
        ", {\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 2, \"material\": \"b\"}]";
    struct turner_scene *scene = scene_of(format, 1.5, 1.);
    assert_true(turner_depth_of(scene).weight == 1);
    turner_scene_destroy(scene);
    scene = scene_of(format, 1.25, 1.5); /* ratio 1.2: R = 1/121 */
    assert_true(fabs(turner_depth_of(scene).weight - (1 - 1. / 121)) < 1e-12);
    turner_scene_destroy(scene);
}

/* Unpolarised reflectance at the angle of incidence whose cosine is c, from the textbook. */
static double reflectance(double n1, double n2, double c)
{
    double s = n1 / n2 * sqrt(1 - c * c), c_t = sqrt(1 - s * s);
    double r_s = (n1 * c - n2 * c_t) / (n1 * c + n2 * c_t);
    double r_p = (n1 * c_t - n2 * c) / (n1 * c_t + n2 * c);
    return 0.5 * (r_s * r_s + r_p * r_p);
}

static void least_fresnel(void **state)
{
    (void)state;
    static const double indices[] = {1, 1.001, 1.333, 1.5, 2.417, 3.7, 3.74, 4, 5, 10, 100};
    for (size_t i = 0; i < sizeof indices / sizeof *indices; i++) {
        double n = indices[i], least = 1, formula = turner_least_fresnel(1, n);
        for (int step = 1; step <= 1000000; step++)
            least = fmin(least, reflectance(1, n, step * 1e-6));
        print_message("n = %g: %.10f, least of a scan %.10f\n", n, formula, least);
        assert_true(formula <= least + 1e-15 && least - formula < 1e-9);
        assert_true(turner_least_fresnel(n, 1) == formula);
    }
    /* published, at normal incidence */
    assert_true(fabs(turner_least_fresnel(1, 1.333) - .020373) < 5e-7);
    assert_true(fabs(turner_least_fresnel(1, 1.5) - .04) < 5e-7);
    assert_true(fabs(turner_least_fresnel(1, 2.417) - .171969) < 5e-7);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(facing_mirrors),   cmocka_unit_test(deeper_draws_the_same),
        cmocka_unit_test(bound_holds),      cmocka_unit_test(nothing_reflects),
        cmocka_unit_test(media_that_touch), cmocka_unit_test(least_fresnel),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
