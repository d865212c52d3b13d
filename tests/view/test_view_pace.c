/* How much is traced while the camera moves: enough frames, and no less than they allow. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "view/pace.h"

#define WIDTH 1280
#define HEIGHT 720

/* A device that takes so long for a pixel at depth 0, and as much again for each depth. */
struct device {
    double pixel, deeper;
};

static double cost(const struct device *device, int depth)
{
    return device->pixel + device->deeper * depth;
}

/* Draws `frames` frames; returns the seconds the last took. */
static double run(struct turner_pace *pace, const struct device *device, int frames)
{
    double seconds = 0;
    for (int i = 0; i < frames; i++) {
        int width, height, depth;
        turner_pace_choose(pace, WIDTH, HEIGHT, &width, &height, &depth);
        assert_in_range(width, 1, WIDTH);
        assert_in_range(height, 1, HEIGHT);
        seconds = cost(device, depth) * width * height;
        turner_pace_took(pace, depth, (double)width * height, seconds);
    }
    return seconds;
}

static void last(struct turner_pace *pace, double *scale, int *depth)
{
    *scale = pace->scale;
    *depth = pace->depth[pace->rung];
}

static void test_fast_gives_up_nothing(void **state)
{
    (void)state;
    struct turner_pace pace;
    struct device fast = {1e-9, 1e-9};
    double scale;
    int depth;
    turner_pace_start(&pace, 8);
    run(&pace, &fast, 3);
    last(&pace, &scale, &depth);
    assert_true(scale == 1);
    assert_int_equal(depth, 8);
}

static void test_any_cost_is_met(void **state)
{
    (void)state;
    for (double pixel = 1e-9; pixel < 3e-4; pixel *= 1.7) {
        for (double deeper = 0; deeper < 1e-4; deeper = deeper * 3 + 1e-9) {
            struct turner_pace pace;
            struct device device = {pixel, deeper};
            turner_pace_start(&pace, 12);
            run(&pace, &device, 20);
            int slow = 0;
            for (int i = 0; i < 100; i++)
                slow += run(&pace, &device, 1) > TURNER_PACE_SECONDS * 1.05;
            /* at the smallest scale nothing more can be given up; else only what is tried is slow */
            if (pace.scale > 0.031)
                assert_in_range(slow, 0, 5);
        }
    }
}

static void test_no_more_than_needed(void **state)
{
    (void)state;
    for (double pixel = 1e-9; pixel < 1e-5; pixel *= 1.3) {
        struct turner_pace pace;
        struct device device = {pixel, pixel};
        double scale;
        int depth;
        turner_pace_start(&pace, 6);
        double seconds = run(&pace, &device, 30);
        last(&pace, &scale, &depth);
        /* a full frame fits, or the time is used: a scale may lie 12 % below what is possible */
        if (cost(&device, 6) * WIDTH * HEIGHT < TURNER_PACE_SECONDS * 0.99)
            assert_true(scale == 1 && depth == 6);
        else if (scale < 1)
            assert_true(seconds >= TURNER_PACE_SECONDS * 0.75);
        /* depth is kept as long as a quarter of the resolution can be had with it */
        if (sqrt(TURNER_PACE_SECONDS / (cost(&device, 6) * WIDTH * HEIGHT)) > 0.285)
            assert_int_equal(depth, 6);
    }
}

static void test_comes_back(void **state)
{
    (void)state;
    struct turner_pace pace;
    struct device slow = {2e-7, 2e-7}, fast = {2e-9, 2e-9};
    double scale;
    int depth;
    turner_pace_start(&pace, 8);
    run(&pace, &slow, 20);
    last(&pace, &scale, &depth);
    assert_true(depth < 8 && scale < 0.5);
    assert_true(run(&pace, &fast, 200) <= TURNER_PACE_SECONDS * 1.05);
    last(&pace, &scale, &depth);
    assert_true(scale == 1);
    assert_int_equal(depth, 8);
    run(&pace, &slow, 20);
    last(&pace, &scale, &depth);
    assert_true(depth < 8 && scale < 0.5);
}

static void test_holds_still(void **state)
{
    (void)state;
    struct turner_pace pace;
    int changes = 0;
    double before = 0;
    turner_pace_start(&pace, 8);
    for (int i = 0; i < 200; i++) {
        struct device device = {1e-7 * (1 + 0.02 * sin(i)), 0};
        run(&pace, &device, 1);
        changes += i > 20 && pace.scale != before;
        before = pace.scale;
    }
    assert_in_range(changes, 0, 5);
}

static void test_frames_are_seen(void **state)
{
    (void)state;
    struct turner_pace pace;
    turner_pace_start(&pace, 8);
    for (int i = 0; i < 1000; i++) { /* showing takes 15 ms more than tracing */
        double interval = pace.seconds + 0.015;
        turner_pace_seen(&pace, interval);
    }
    assert_true(pace.seconds + 0.015 < 1.0 / 30 && pace.seconds > 0.012);
    for (int i = 0; i < 1000; i++) /* and then 1 ms */
        turner_pace_seen(&pace, pace.seconds + 0.001);
    assert_true(pace.seconds + 0.001 > 0.029 && pace.seconds + 0.001 < 1.0 / 30);
    for (int i = 0; i < 1000; i++)
        turner_pace_seen(&pace, 1);
    assert_true(pace.seconds > 0.01);
}

static void test_small_pictures(void **state)
{
    (void)state;
    struct turner_pace pace;
    int width, height, depth;
    turner_pace_start(&pace, 0);
    turner_pace_choose(&pace, 1, 1, &width, &height, &depth);
    assert_int_equal(width, 1);
    assert_int_equal(height, 1);
    assert_int_equal(depth, 0);
    turner_pace_took(&pace, 0, 1, 0.5);
    turner_pace_choose(&pace, 1, 3, &width, &height, &depth);
    assert_int_equal(width, 1);
    assert_int_equal(height, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fast_gives_up_nothing), cmocka_unit_test(test_any_cost_is_met),
        cmocka_unit_test(test_no_more_than_needed),   cmocka_unit_test(test_comes_back),
        cmocka_unit_test(test_holds_still),           cmocka_unit_test(test_small_pictures),
        cmocka_unit_test(test_frames_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
