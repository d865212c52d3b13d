/* A method that fails where it must hold, holds where it must fail, or is not a number, is not as
 * expected; nor is a row of which nothing was measured taken for one that holds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "app/stability.h"

static const struct turner_sweep sweep = {
    .name = "sweep",
    .values = {1, 10, 100, NAN},
    .methods = {{"always", NULL, 0, TURNER_HOLDS, NULL},
                {"to 10", NULL, 0, TURNER_HOLDS_TO_FAILS(10, 100), NULL},
                {"naive", NULL, 0, TURNER_FAILS(10), NULL},
                {"shown", NULL, 0, TURNER_SHOWN, NULL},
                {"from 10", NULL, 0, TURNER_HOLDS_FROM(10), NULL}}};

/* The verdict on method `m` with these errors, against a bound of 1. */
static struct turner_stability_verdict judge(int m, double a, double b, double c)
{
    struct turner_stability_row row = {.sweep = &sweep};
    const double errors[] = {a, b, c};
    for (int i = 0; i < 3; i++)
        row.cells[m][i] = (struct turner_stability_cell){true, errors[i], 1, 0};
    return turner_stability_judge(&row, m);
}

static void what_holds_is_said_to_hold(void **state)
{
    (void)state;
    struct turner_stability_verdict verdict = judge(0, 0, 1, 0.5);
    assert_true(verdict.expected && verdict.measured);
    assert_string_equal(verdict.text, "holds");
}

static void failures_are_named(void **state)
{
    (void)state;
    struct turner_stability_verdict verdict = judge(0, 0, 1.001, 0);
    assert_false(verdict.expected);
    assert_string_equal(verdict.text, "fails at 10; must hold at 10");
    assert_string_equal(judge(3, 2, 2, 2).text, "fails everywhere");
    assert_true(judge(3, 2, 2, 2).expected);
}

static void infinity_fails(void **state)
{
    (void)state;
    assert_false(judge(0, 0, INFINITY, 0).expected);
}

static void the_naive_must_fail(void **state)
{
    (void)state;
    assert_true(judge(2, 0, 2, 0).expected);
    struct turner_stability_verdict verdict = judge(2, 2, 1, 2);
    assert_false(verdict.expected);
    assert_string_equal(verdict.text, "fails at 1, 100; must fail at 10");
}

static void ranges_count_their_ends(void **state)
{
    (void)state;
    assert_true(judge(1, 0, 1, 2).expected);
    assert_false(judge(1, 0, 2, 2).expected);
    assert_false(judge(1, 0, 0, 0).expected); /* a failure that is known must be there */
    assert_true(judge(4, 2, 0, 0).expected);
    assert_false(judge(4, 2, 2, 0).expected);
}

static void nothing_measured_is_no_success(void **state)
{
    (void)state;
    struct turner_stability_verdict verdict = judge(0, NAN, NAN, NAN);
    assert_false(verdict.measured);
    assert_string_equal(verdict.text, "not measured here");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_holds_is_said_to_hold),
        cmocka_unit_test(failures_are_named),
        cmocka_unit_test(infinity_fails),
        cmocka_unit_test(the_naive_must_fail),
        cmocka_unit_test(ranges_count_their_ends),
        cmocka_unit_test(nothing_measured_is_no_success),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
