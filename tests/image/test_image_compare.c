/* Comparison against numbers worked out by hand, and the sRGB curve against the standard. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "image/image.h"

/* A 2 × 2 picture, every channel `v`. */
static struct turner_image grey(float v)
{
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 2, 2), TURNER_OK);
    for (int i = 0; i < 16; i++)
        image.rgba[i] = i % 4 == 3 ? 0 : v;
    return image;
}

static void close_to(double value, double expected)
{
    if (!(fabs(value - expected) <= 1e-9 * fabs(expected)))
        fail_msg("%.17g instead of %.17g", value, expected);
}

static void equal_pictures(void **state)
{
    (void)state;
    struct turner_image a = grey(.5f), b = grey(.5f);
    a.rgba[3] = 7; /* the fourth channel is not looked at */
    b.rgba[7] = NAN;
    struct turner_comparison c;
    assert_int_equal(turner_image_compare(&c, &a, &b, 0, 0), TURNER_OK);
    assert_true(c.rmse == 0 && c.relative_mse == 0 && c.largest == 0);
    assert_true(c.pixels == 4 && c.pixels_over == 0);
    assert_true(c.nonfinite_a == 0 && c.nonfinite_b == 0);
    assert_int_equal(c.largest_x, -1);
    assert_int_equal(c.nonfinite_x, -1);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
}

static void by_hand(void **state)
{
    (void)state;
    struct turner_image a = grey(1), b = grey(1);
    a.rgba[2 * 4 + 1] = 4;   /* pixel (0,1), green: 3 off */
    a.rgba[3 * 4 + 0] = 1.5f; /* pixel (1,1), red: ½ off */
    b.rgba[3 * 4 + 2] = 3;   /* and blue: 2 off, reference 3 */
    struct turner_comparison c;
    assert_int_equal(turner_image_compare(&c, &a, &b, .5, 0), TURNER_OK);
    close_to(c.rmse, sqrt((9 + .25 + 4) / 12));
    close_to(c.relative_mse, (9 / 1.01 + .25 / 1.01 + 4 / 9.01) / 12);
    close_to(c.largest, 3);
    assert_int_equal(c.largest_x, 0);
    assert_int_equal(c.largest_y, 1);
    assert_int_equal(c.pixels_over, 2); /* exactly at the threshold is not over it */
    /* relative 0.7: 2 against 0.7 · 3 is not over, 3 against 0.7 · 1 is */
    assert_int_equal(turner_image_compare(&c, &a, &b, .5, .7), TURNER_OK);
    assert_int_equal(c.pixels_over, 1);
    /* both thresholds must be passed: relative alone does not make a pixel differ */
    assert_int_equal(turner_image_compare(&c, &a, &b, 3, 0), TURNER_OK);
    assert_int_equal(c.pixels_over, 0);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
}

static void nan_and_infinity_always_differ(void **state)
{
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        for (int both = 0; both < 2; both++) {
            struct turner_image a = grey(1), b = grey(1);
            a.rgba[1 * 4 + 2] = bad[k];
            if (both)
                b.rgba[1 * 4 + 2] = bad[k];
            b.rgba[0] = 3;
            struct turner_comparison c;
            assert_int_equal(turner_image_compare(&c, &a, &b, 100, 100), TURNER_OK);
            assert_int_equal(c.pixels_over, 1);
            assert_int_equal(c.nonfinite_a, 1);
            assert_int_equal(c.nonfinite_b, both);
            assert_int_equal(c.nonfinite_x, 1);
            assert_int_equal(c.nonfinite_y, 0);
            close_to(c.largest, 2); /* the finite rest is still measured */
            close_to(c.rmse, sqrt(4. / 11));
            turner_image_destroy(&a);
            turner_image_destroy(&b);
        }
    }
    struct turner_image a = grey(NAN), b = grey(NAN);
    struct turner_comparison c;
    assert_int_equal(turner_image_compare(&c, &a, &b, 100, 100), TURNER_OK);
    assert_int_equal(c.pixels_over, 4);
    assert_true(c.rmse == 0 && c.relative_mse == 0);
    /* a threshold that is no number lets nothing pass either */
    turner_image_destroy(&a);
    turner_image_destroy(&b);
    a = grey(1), b = grey(2);
    assert_int_equal(turner_image_compare(&c, &a, &b, (double)NAN, (double)NAN), TURNER_OK);
    assert_int_equal(c.pixels_over, 4);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
}

static void unequal_sizes(void **state)
{
    (void)state;
    struct turner_image a = grey(1), b, heatmap;
    assert_int_equal(turner_image_create(&b, 4, 1), TURNER_OK); /* as many pixels */
    struct turner_comparison c;
    assert_int_equal(turner_image_compare(&c, &a, &b, 100, 100), TURNER_DIFFERS);
    assert_non_null(strstr(turner_message(), "2×2"));
    assert_non_null(strstr(turner_message(), "4×1"));
    assert_true(c.pixels == 0);
    assert_int_equal(turner_image_heatmap(&heatmap, &a, &b, 1), TURNER_DIFFERS);
    assert_null(heatmap.rgba);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
}

static void heatmap_colours(void **state)
{
    (void)state;
    struct turner_image a, b, heatmap;
    assert_int_equal(turner_image_create(&a, 6, 1), TURNER_OK);
    assert_int_equal(turner_image_create(&b, 6, 1), TURNER_OK);
    static const float differences[] = {0, 1, 2, 3, 100, NAN};
    static const float colours[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                       {1, 1, 1}, {1, 1, 1}, {1, 0, 1}};
    for (int i = 0; i < 6; i++)
        b.rgba[i * 4 + i % 3] = differences[i];
    assert_int_equal(turner_image_heatmap(&heatmap, &a, &b, 3), TURNER_OK);
    for (int i = 0; i < 6; i++) {
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(heatmap.rgba[i * 4 + c] - colours[i][c]) <= 1e-6f);
    }
    turner_image_destroy(&heatmap);
    assert_int_equal(turner_image_heatmap(&heatmap, &a, &b, 0), TURNER_OK);
    assert_true(heatmap.rgba[0] == 0 && heatmap.rgba[4] == 1 && heatmap.rgba[6] == 1);
    turner_image_destroy(&heatmap);
    turner_image_destroy(&a);
    turner_image_destroy(&b);
}

/* IEC 61966-2-1: 18 % grey is 117.64/255, the two parts meet at 0.04045 = 12.92 · 0.0031308. */
static void srgb_curve(void **state)
{
    (void)state;
    static const struct { double encoded, linear; } table[] = {
        {0, 0}, {1, 1}, {.5, .21404114048223255}, {.2, .033104766570885055},
        {.04, .04 / 12.92}, {188 / 255., .5028864580325687}, {.46135612950044164, .18}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_true(fabs(turner_srgb_to_linear(table[i].encoded) - table[i].linear) <= 1e-12);
        assert_true(fabs(turner_linear_to_srgb(table[i].linear) - table[i].encoded) <= 1e-12);
    }
    assert_true(fabs(turner_linear_to_srgb(.0031308) - .04045) <= 1e-6);
    assert_true(fabs(turner_linear_to_srgb(.0031308) - turner_linear_to_srgb(.00313081)) <= 1e-6);
    assert_true(isnan(turner_srgb_to_linear((double)NAN)) && isnan(turner_linear_to_srgb((double)NAN)));
    for (int i = 0; i < 65536; i++) { /* every code of both depths finds its way back */
        double code = turner_linear_to_srgb((double)(float)turner_srgb_to_linear(i / 65535.));
        assert_int_equal(lrint(code * 65535), i);
        if (i < 256) {
            code = turner_linear_to_srgb((double)(float)turner_srgb_to_linear(i / 255.));
            assert_int_equal(lrint(code * 255), i);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures),
        cmocka_unit_test(by_hand),
        cmocka_unit_test(nan_and_infinity_always_differ),
        cmocka_unit_test(unequal_sizes),
        cmocka_unit_test(heatmap_colours),
        cmocka_unit_test(srgb_curve),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
