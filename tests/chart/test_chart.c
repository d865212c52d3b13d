/* What turner chart computes: the grid's points, quartiles, twins, the front, the tables. All
 * expected values are worked out by hand. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/chart.h"
#include "scene/readers.h"

/* ---- front and tables ---- */

static struct turner_chart_point measured(double seconds, double error)
{
    struct turner_chart_point point = {.runs = 5, .quartiles = {seconds, seconds, seconds}};
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        point.errors[i] = error;
    return point;
}

/* Seconds right, error up:  E . . . . .     .4: A beats it
 *                           A . . C . .     .2: A; C is beaten by B and A
 *                           . B . . . .     .1
 *                           . . . D . F     .03: D; F equals its error and is slower
 *                             and G equals B, later; H has no error; I was not run */
static const double table[][2] = {{1, .2}, {2, .1}, {3, .2}, {4, .03}, {1, .4}, {8, .03}, {2, .1}};
enum { A, B, C, D, E, F, G, H, I, POINTS };

static void make_points(struct turner_chart_point points[POINTS])
{
    for (int i = 0; i <= G; i++)
        points[i] = measured(table[i][0], table[i][1]);
    points[H] = measured(.5, (double)NAN);
    points[I] = measured(.5, .001);
    points[I].runs = 0;
    turner_chart_mark_twins(points, POINTS, TURNER_CHART_RMSE);
    turner_chart_mark_front(points, POINTS, TURNER_CHART_RMSE);
}

static void test_front(void **state)
{
    (void)state;
    struct turner_chart_point points[POINTS];
    make_points(points);
    for (int i = 0; i < POINTS; i++) {
        bool expected = i == A || i == B || i == D;
        if (points[i].front[TURNER_CHART_RMSE] != expected)
            fail_msg("point %c", 'A' + i);
    }
}

static void test_best(void **state)
{
    (void)state;
    struct turner_chart_point points[POINTS];
    make_points(points);
    const struct {
        double seconds;
        size_t best;
    } by_time[] = {{.9, TURNER_CHART_NO_POINT}, {1, A}, {1.99, A}, {2, B}, {3.9, B}, {4, D}, {99, D}};
    for (size_t i = 0; i < sizeof by_time / sizeof *by_time; i++)
        assert_int_equal(
            turner_chart_best_error(points, POINTS, TURNER_CHART_RMSE, by_time[i].seconds),
            by_time[i].best);
    const struct {
        double error;
        size_t best;
    } by_error[] = {{.02, TURNER_CHART_NO_POINT}, {.03, D}, {.09, D}, {.1, B}, {.2, A}, {1, A}};
    for (size_t i = 0; i < sizeof by_error / sizeof *by_error; i++)
        assert_int_equal(
            turner_chart_least_time(points, POINTS, TURNER_CHART_RMSE, by_error[i].error),
            by_error[i].best);
}

static void assert_limits(const double *limits, size_t count, const double *expected, size_t wanted)
{
    assert_int_equal(count, wanted);
    for (size_t i = 0; i < wanted; i++)
        assert_true(fabs(limits[i] / expected[i] - 1) < 1e-12);
}

static void test_limits(void **state)
{
    (void)state;
    struct turner_chart_point points[POINTS];
    double limits[TURNER_CHART_MAX_LIMITS];
    make_points(points);
    size_t count = turner_chart_time_limits(limits, points, POINTS, TURNER_CHART_RMSE);
    assert_limits(limits, count, (double[]){1, 2, 5}, 3);
    count = turner_chart_error_limits(limits, points, POINTS, TURNER_CHART_RMSE);
    assert_limits(limits, count, (double[]){.2, .1, .05}, 3);

    /* 1/255 has a row where a point keeps it, and is a limit of radiance only */
    points[D].errors[TURNER_CHART_RMSE] = points[D].errors[TURNER_CHART_FLIP] = .0015;
    count = turner_chart_error_limits(limits, points, POINTS, TURNER_CHART_RMSE);
    assert_limits(limits, count, (double[]){.2, .1, 1 / 255.0, .002}, 4);
    count = turner_chart_error_limits(limits, points, POINTS, TURNER_CHART_FLIP);
    assert_limits(limits, count, (double[]){.2, .1, .002}, 3);
    for (int i = 0; i < POINTS; i++)
        points[i].runs = 0;
    assert_int_equal(turner_chart_time_limits(limits, points, POINTS, TURNER_CHART_RMSE), 0);
    assert_int_equal(turner_chart_error_limits(limits, points, POINTS, TURNER_CHART_RMSE), 0);
}

/* A point that differs in a method, and is better by less than the spread of times or by less than
 * 1 % of error, is no better than the plain one. */
static void test_twins(void **state)
{
    (void)state;
    struct turner_chart_point points[] = {
        measured(2, .1),     /* plain: quartiles 1.8 … 2.2 */
        measured(1.9, .1),   /* quicker by chance */
        measured(1.2, .1),   /* quicker */
        measured(2, .0995),  /* less error, by half a per cent */
        measured(2, .09),    /* less error */
        measured(1.9, .1),   /* quicker by chance, but as plain */
    };
    const bool twin[] = {false, true, false, true, false, false};
    const bool front[] = {false, false, true, false, true, false};
    enum { COUNT = sizeof points / sizeof *points };
    for (int i = 0; i < COUNT; i++) {
        points[i].quartiles[0] = points[i].quartiles[1] - .2;
        points[i].quartiles[2] = points[i].quartiles[1] + .2;
        points[i].departures = i > 0 && i < 5;
    }
    turner_chart_mark_twins(points, COUNT, TURNER_CHART_LARGEST);
    turner_chart_mark_front(points, COUNT, TURNER_CHART_LARGEST);
    for (int i = 0; i < COUNT; i++) {
        if (points[i].twin[TURNER_CHART_LARGEST] != twin[i] ||
            points[i].front[TURNER_CHART_LARGEST] != front[i])
            fail_msg("point %d", i);
    }
}

static void test_quartiles(void **state)
{
    (void)state;
    double quartiles[3];
    turner_chart_quartiles(quartiles, (double[]){5, 1, 4, 2, 3}, 5);
    assert_true(quartiles[0] == 2 && quartiles[1] == 3 && quartiles[2] == 4);
    turner_chart_quartiles(quartiles, (double[]){8, 1, 2, 4}, 4); /* between 1 2 4 8 */
    assert_true(quartiles[0] == 1.75 && quartiles[1] == 3 && quartiles[2] == 5);
    turner_chart_quartiles(quartiles, (double[]){7}, 1);
    assert_true(quartiles[0] == 7 && quartiles[1] == 7 && quartiles[2] == 7);
}

/* ---- the grid ---- */

static const char scene_text[] =
    "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]},"
    " \"settings\": {\"depth\": 6, \"cutoff\": 0.004, \"spp\": 4},"
    " \"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5}},"
    " \"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1,"
    "  \"material\": \"glass\"}]}";

static enum turner_result read_grid(struct turner_chart *chart, const char *text)
{
    *chart = (struct turner_chart){0};
    assert_int_equal(
        turner_scene_parse(&chart->scene, scene_text, sizeof scene_text - 1, "scene.json"),
        TURNER_OK);
    return turner_chart_read_grid(chart, text, strlen(text), "grid.json");
}

static void drop(struct turner_chart *chart)
{
    turner_scene_destroy(chart->scene);
    free(chart->points);
}

static void test_grid(void **state)
{
    (void)state;
    struct turner_chart chart;
    enum turner_result result =
        read_grid(&chart, "{\"axes\": {\"aa\": [1, \"4\"], \"depth\": [2, 6],"
                          " \"cutoff\": [0.004]},\n"
                          " \"also\": [\"aa=4\", \"sphere=textbook  offset=tmin:0.01 aa=16\"]}");
    if (result != TURNER_OK)
        fail_msg("%s", turner_message());
    static const char *const labels[] = {"aa=1 depth=2", "aa=1", "aa=4 depth=2", "aa=4",
                                         "aa=16 sphere=textbook offset=tmin:0.01"};
    static const int departures[] = {2, 1, 1, 0, 3};
    assert_int_equal(chart.point_count, 5); /* "aa=4" is there already */
    for (size_t i = 0; i < 5; i++) {
        assert_string_equal(chart.points[i].label, labels[i]);
        assert_int_equal(chart.points[i].departures, departures[i]);
    }
    assert_int_equal(chart.points[0].settings.spp, 1);
    assert_int_equal(chart.points[0].settings.depth, 2);
    assert_int_equal(chart.points[4].settings.depth, 6);
    assert_int_equal(chart.points[4].settings.methods.sphere, TURNER_SPHERE_TEXTBOOK);
    drop(&chart);
}

static void test_grid_errors(void **state)
{
    (void)state;
    static const struct {
        const char *text, *place, *says;
    } wrong[] = {
        {"{", "grid.json:1:", ""},
        {"{}", "grid.json:1:1: ", "no points"},
        {"{\"axis\": {}}", "grid.json:1:2: ", "did you mean \"axes\""},
        {"{\"axes\": {\n  \"dept\": [1]}}", "grid.json:2:3: ", "did you mean \"depth\""},
        {"{\"axes\": {\"depth\": []}}", "grid.json:1:20: ", "at least one value"},
        {"{\"axes\": {\"depth\": 3}}", "grid.json:1:20: ", "list"},
        {"{\"axes\": {\"depth\": [1,\n -2]}}", "grid.json:2:2: ", "takes 0 … 1024"},
        {"{\"axes\": {\"depth\": [1, true]}}", "grid.json:1:24: ", "text"},
        {"{\"axes\": {\"depth\": [1], \"depth\": [2]}}", "grid.json:1:", "twice"},
        {"{\"axes\": {\"depth\": [70]}}", "grid.json:1:21: ", "64"}, /* where rays branch */
        {"{\"also\": [\"aa=4 spheer=f64\"]}", "grid.json:1:11: ", "did you mean \"sphere\""},
        {"{\"also\": [\"textbook\"]}", "grid.json:1:11: ", "name=value"},
        {"{\"also\": \"aa=4\"}", "grid.json:1:10: ", "list"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct turner_chart chart;
        if (read_grid(&chart, wrong[i].text) != TURNER_BAD_INPUT)
            fail_msg("%s: is taken", wrong[i].text);
        const char *message = turner_message();
        if (strncmp(message, wrong[i].place, strlen(wrong[i].place)) != 0 ||
            !strstr(message, wrong[i].says))
            fail_msg("%s: says \"%s\"", wrong[i].text, message);
        drop(&chart);
    }
}

/* 33 values on each of two axes are more than 1000 points. */
static void test_grid_too_large(void **state)
{
    (void)state;
    char text[1000] = "{\"axes\": {\"depth\": [0";
    for (int i = 1; i < 33; i++)
        sprintf(text + strlen(text), ",%d", i);
    strcat(text, "], \"aa\": [1");
    for (int i = 2; i <= 33; i++)
        sprintf(text + strlen(text), ",%d", i);
    strcat(text, "]}}");
    struct turner_chart chart;
    assert_int_equal(read_grid(&chart, text), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "more than 1000 points"));
    drop(&chart);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_front),       cmocka_unit_test(test_best),
        cmocka_unit_test(test_limits),      cmocka_unit_test(test_twins),
        cmocka_unit_test(test_quartiles),   cmocka_unit_test(test_grid),
        cmocka_unit_test(test_grid_errors), cmocka_unit_test(test_grid_too_large),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
