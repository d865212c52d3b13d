/* Independent sample patterns of the reference, and the hash that names its pictures. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>

#include "reference/reference.h"
#include "scene/hash.h"
#include "scene/readers.h"

/* A mirror ball before a checkerboard: edges in many directions. */
static const char text[] =
    "{\"version\": 1, \"camera\": {\"from\": [0, 1, 5], \"at\": [0, 0, 0]},"
    " \"background\": {\"type\": \"gradient\", \"bottom\": 0.2, \"top\": 1},"
    " \"settings\": {\"size\": [24, 18], \"depth\": 2, \"spp\": 16},"
    " \"materials\": {\"mirror\": {\"k_r\": 0.8}, \"tiles\": {\"k_e\": 0, \"k_a\": 1,"
    "   \"pattern\": {\"type\": \"checker\", \"colors\": [0, 1], \"scale\": 2}}},"
    " \"ambient\": 1, \"primitives\": ["
    "  {\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"mirror\"},"
    "  {\"type\": \"plane\", \"point\": [0, -1, 0], \"normal\": [0, 1, 0],"
    "   \"material\": \"tiles\"}], \"lights\": []}";

static struct turner_scene *load(void)
{
    struct turner_scene *scene;
    assert_int_equal(turner_scene_parse(&scene, text, sizeof text - 1, "test.json"), TURNER_OK);
    return scene;
}

static struct turner_image draw(const struct turner_scene *scene, uint32_t pattern)
{
    struct turner_image image;
    assert_int_equal(
        turner_reference_render_pattern(&image, scene, pattern, 2, NULL, NULL, NULL), TURNER_OK);
    return image;
}

static double rms(const struct turner_image *a, const struct turner_image *b)
{
    double sum = 0;
    size_t count = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count * 4; i++)
        sum += i % 4 == 3 ? 0 : pow((double)(a->rgba[i] - b->rgba[i]), 2);
    return sqrt(sum / (double)(3 * count));
}

static void test_pattern_0_is_the_renderers(void **state)
{
    (void)state;
    struct turner_scene *scene = load();
    struct turner_image plain, same = draw(scene, 0);
    assert_int_equal(turner_reference_render(&plain, scene, 1, NULL, NULL, NULL), TURNER_OK);
    assert_memory_equal(plain.rgba, same.rgba, sizeof(float) * 4 * 24 * 18);
    turner_image_destroy(&plain);
    turner_image_destroy(&same);
    turner_scene_destroy(scene);
}

static void test_threads_do_not_matter(void **state)
{
    (void)state;
    struct turner_scene *scene = load();
    struct turner_image two = draw(scene, 7), one;
    assert_int_equal(turner_reference_render_pattern(&one, scene, 7, 1, NULL, NULL, NULL),
                     TURNER_OK);
    assert_memory_equal(one.rgba, two.rgba, sizeof(float) * 4 * 24 * 18);
    turner_image_destroy(&one);
    turner_image_destroy(&two);
    turner_scene_destroy(scene);
}

/* Patterns are independent and none is biased: half the difference of two is the error of their
 * mean. Against a truth of 64 times the samples that holds to the accuracy of the estimate, whose
 * relative deviation is about √(2/edge values): some 150 pixels here have an edge, 3 channels that
 * go together, so 12 %; the bound is three of that. */
static void test_half_the_difference_is_the_error(void **state)
{
    (void)state;
    struct turner_scene *scene = load();
    struct turner_image a = draw(scene, 1), b = draw(scene, 2), mean;
    scene->settings.spp = 1024;
    struct turner_image truth = draw(scene, 3);
    assert_int_equal(turner_image_create(&mean, a.width, a.height), TURNER_OK);
    for (size_t i = 0; i < (size_t)a.width * (size_t)a.height * 4; i++)
        mean.rgba[i] = (a.rgba[i] + b.rgba[i]) / 2;
    double estimate = rms(&a, &b) / 2, error = rms(&mean, &truth);
    print_message("estimate %g, error %g\n", estimate, error);
    assert_true(estimate > 0);
    assert_true(fabs(error / estimate - 1) < 0.36);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
    turner_image_destroy(&mean);
    turner_image_destroy(&truth);
    turner_scene_destroy(scene);
}

/* Each change that shows changes the hash; names, paths and settings do not. */
static void test_scene_hash(void **state)
{
    (void)state;
    static const struct {
        const char *from, *to;
        bool same;
    } changes[] = {
        {"\"radius\": 1", "\"radius\": 2", false},
        {"[0, 1, 5]", "[0, 1, 6]", false},
        {"\"bottom\": 0.2", "\"bottom\": 0.3", false},
        {"\"k_r\": 0.8", "\"k_r\": 0.7", false},
        {"\"scale\": 2", "\"scale\": 3", false},
        {"\"ambient\": 1", "\"ambient\": 2", false},
        {"[0, -1, 0]", "[0, -2, 0]", false},
        {"\"depth\": 2", "\"depth\": 3", true},
        {"\"size\": [24, 18]", "\"size\": [25, 18]", true},
        {"\"mirror\"", "\"merror\"", true},
    };
    struct turner_scene *scene = load();
    uint64_t hash = turner_scene_hash(scene);
    turner_scene_destroy(scene);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        char changed[sizeof text];
        strcpy(changed, text);
        size_t length = strlen(changes[i].from);
        assert_int_equal(length, strlen(changes[i].to));
        int found = 0;
        for (char *at = changed; (at = strstr(at, changes[i].from)); at += length, found++)
            memcpy(at, changes[i].to, length);
        assert_true(found > 0);
        if (turner_scene_parse(&scene, changed, strlen(changed), "other.json") != TURNER_OK)
            fail_msg("%s", turner_message());
        bool same = turner_scene_hash(scene) == hash;
        turner_scene_destroy(scene);
        if (same != changes[i].same)
            fail_msg("%s → %s: the hash %s", changes[i].from, changes[i].to,
                     same ? "stays" : "changes");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pattern_0_is_the_renderers),
        cmocka_unit_test(test_threads_do_not_matter),
        cmocka_unit_test(test_half_the_difference_is_the_error),
        cmocka_unit_test(test_scene_hash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
