/* What mouse and keys do to a camera, against what geometry says. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "view/camera.h"

#define PI 3.14159265358979323846

static struct turner_camera camera_of(void)
{
    return (struct turner_camera){.from = {0, 0, 5}, .at = {0, 0, 0}, .up = {0, 1, 0},
                                  .vfov = PI / 2};
}

static void assert_near(struct turner_vec3 v, double x, double y, double z)
{
    struct turner_vec3 w = {x, y, z};
    double off = turner_vec3_length(turner_vec3_sub(v, w));
    if (!(off < 1e-9))
        fail_msg("(%g, %g, %g) instead of (%g, %g, %g)", v.x, v.y, v.z, x, y, z);
}

static void test_orbit(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    turner_camera_orbit(&c, PI / 2, 0); /* from the front to the right side */
    assert_near(c.from, 5, 0, 0);
    assert_near(c.at, 0, 0, 0);
    turner_camera_orbit(&c, 0, PI / 4);
    assert_near(c.from, 5 * sqrt(0.5), 5 * sqrt(0.5), 0);
    turner_camera_orbit(&c, 2 * PI, 0);
    assert_near(c.from, 5 * sqrt(0.5), 5 * sqrt(0.5), 0);
    turner_camera_orbit(&c, 0, 10); /* the pole is not passed */
    assert_near(c.from, 5 * sin(PI / 360), 5 * cos(PI / 360), 0);
    turner_camera_orbit(&c, 0, -20);
    assert_near(c.from, 5 * sin(PI / 360), -5 * cos(PI / 360), 0);
}

static void test_turn(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    turner_camera_turn(&c, PI / 2, 0);
    assert_near(c.from, 0, 0, 5);
    assert_near(c.at, 5, 0, 5);
    turner_camera_turn(&c, -PI / 2, PI / 6);
    assert_near(c.at, 0, 2.5, 5 - 5 * cos(PI / 6));
}

static void test_pan_and_fly(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    turner_camera_pan(&c, 50, 0, 100); /* 90 degrees: the plane of `at` is 10 high */
    assert_near(c.from, -5, 0, 5);
    assert_near(c.at, -5, 0, 0);
    turner_camera_pan(&c, 0, 10, 100);
    assert_near(c.at, -5, 1, 0);
    turner_camera_fly(&c, 1, 2, 3);
    assert_near(c.from, -4, 3, 2);
    assert_near(c.at, -4, 3, -3);
}

static void test_dolly(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    turner_camera_dolly(&c, 0.5);
    assert_near(c.from, 0, 0, 2.5);
    for (int i = 0; i < 1000; i++)
        turner_camera_dolly(&c, 0.9); /* never arrives */
    assert_true(turner_camera_distance(&c) > 0);
    for (int i = 0; i < 10000; i++)
        turner_camera_dolly(&c, 2);
    assert_true(isfinite(c.from.z));
}

static void test_look_at(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    assert_true(turner_camera_look_at(&c, turner_vec3_of(1, 2, 3)));
    assert_near(c.at, 1, 2, 3);
    assert_near(c.from, 0, 0, 5);
    assert_false(turner_camera_look_at(&c, turner_vec3_of(0, 0, 5)));  /* itself */
    assert_false(turner_camera_look_at(&c, turner_vec3_of(0, 70, 5))); /* along up */
    assert_near(c.at, 1, 2, 3);
}

static void test_random_walk(void **state)
{
    (void)state;
    srand(1);
    struct turner_camera c = camera_of();
    c.up = turner_vec3_of(0.3, 0.8, -0.2);
    for (int i = 0; i < 20000; i++) {
        double a = rand() / (double)RAND_MAX - 0.5, b = rand() / (double)RAND_MAX - 0.5;
        double before = turner_camera_distance(&c);
        switch (rand() % 5) {
        case 0: turner_camera_orbit(&c, 9 * a, 9 * b); break;
        case 1: turner_camera_turn(&c, 9 * a, 9 * b); break;
        case 2: turner_camera_pan(&c, 900 * a, 900 * b, 480); break;
        case 3: turner_camera_fly(&c, a, b, a * b); break;
        case 4: turner_camera_dolly(&c, before > 5 ? 0.9 : 1.1); before = 0; break;
        }
        struct turner_vec3 view = turner_vec3_sub(c.at, c.from);
        double distance = turner_vec3_length(view);
        if (before > 0)
            assert_true(fabs(distance - before) < 1e-9 * before);
        double sine = turner_vec3_length(turner_vec3_cross(view, c.up)) / distance /
                      turner_vec3_length(c.up);
        assert_true(sine > sin(PI / 361)); /* a picture has a right way up */
        if (i % 100 == 0)
            turner_camera_round(&c);
    }
}

static void test_round(void **state)
{
    (void)state;
    struct turner_camera c = camera_of();
    c.from = turner_vec3_of(1.23456789, -0.0000001, 5000.000000123);
    c.at = turner_vec3_of(1, 0, 4999.2);
    turner_camera_round(&c);
    assert_true(c.from.x == 1.234568); /* the number that is printed */
    assert_true(c.from.y == 0 && !signbit(c.from.y));
    assert_true(c.from.z == 5000);
    c.from = turner_vec3_of(123456789012.0, 0, 0);
    c.at = turner_vec3_of(0, 0, 0);
    turner_camera_round(&c);
    assert_true(c.from.x == 123457000000.0 || c.from.x == 123456800000.0);
    c.from = turner_vec3_of(1e-9, 2e-9, 0);
    turner_camera_round(&c);
    assert_true(c.from.x == 1e-9 && c.from.y == 2e-9);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_orbit),        cmocka_unit_test(test_turn),
        cmocka_unit_test(test_pan_and_fly),  cmocka_unit_test(test_dolly),
        cmocka_unit_test(test_look_at),      cmocka_unit_test(test_random_walk),
        cmocka_unit_test(test_round),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
