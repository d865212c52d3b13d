/* The truth that estimates are held against, beside one known without it: before a background of 1,
 * glass that loses nothing is not seen. What rays fainter than the first cutoff bring is then all
 * that is missing there. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "reference/reference.h"
#include "scene/readers.h"
#include "truth.h"

#define TOLERANCE 1e-5

/* Balls in each other's light, in which rays go on for long. */
static const char glass[] =
    "{\"version\": 1, \"settings\": {\"size\": [3, 1]},"
    "\"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"vfov\": 4},"
    "\"background\": 1, \"media\": {\"glass\": {\"index\": 2.4}},"
    "\"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": 1, \"medium\": \"glass\"}},"
    "\"primitives\": ["
    "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"glass\"},"
    "{\"type\": \"sphere\", \"center\": [0, 0, -2.2], \"radius\": 1, \"material\": \"glass\"}]}";

static void glass_is_not_seen(void **state)
{
    (void)state;
    struct turner_scene *scene;
    struct truth truth;
    assert_int_equal(turner_scene_parse(&scene, glass, strlen(glass), "test.json"), TURNER_OK);
    assert_int_equal(truth_create(&truth, scene, 1, TOLERANCE, NULL), TURNER_OK);
    for (int i = 0; i < truth.width; i++) {
        double cut, missing = 1 - truth.radiance[i][0];
        struct turner_vec3 first;
        scene->settings.depth = TRUTH_DEPTH;
        scene->settings.cutoff = TRUTH_CUTOFF;
        struct turner_vec3 towards = {(i - 1) * 2 * tan(scene->camera.vfov / 2), 0, -1};
        assert_int_equal(
            turner_reference_radiance(&first, &cut, scene, scene->camera.from, towards), TURNER_OK);
        printf("pixel %d: %.2g missing; with the first cutoff alone %.2g\n", i, missing, cut);
        assert_true(cut > 20 * TOLERANCE); /* else there were nothing to see */
        assert_true(fabs(missing) < 4 * TOLERANCE);
    }
    truth_destroy(&truth);
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(glass_is_not_seen)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
