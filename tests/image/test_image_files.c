/* Pictures through files: what comes back is what was written, and the same picture gives the same
 * bytes. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#include "folder.h"
#include "image/image.h"

static const struct turner_image_text texts[] = {
    {"turner:settings", "--size 7x5 --depth 8"}, {"turner:device", "a device"}};
static const struct turner_image_encoding plain = {.texts = texts, .text_count = 2};

/* 7 × 5 pixels in [0,1], none alike. */
static struct turner_image sample(void)
{
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 7, 5), TURNER_OK);
    for (int i = 0; i < 7 * 5; i++) {
        for (int c = 0; c < 3; c++)
            image.rgba[i * 4 + c] = (float)(i * 3 + c) / 104.f;
    }
    return image;
}

static struct turner_image through(const struct turner_image *image, const char *name,
                                   const struct turner_image_encoding *encoding, bool srgb)
{
    struct turner_image back;
    assert_int_equal(turner_image_write(image, in_folder(name), encoding), TURNER_OK);
    assert_int_equal(turner_image_read(&back, in_folder(name), srgb), TURNER_OK);
    assert_int_equal(back.width, image->width);
    assert_int_equal(back.height, image->height);
    return back;
}

static void floats_come_back_exactly(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.tif", "a.TIFF"};
    static const float odd[] = {FLT_MAX, -FLT_MAX, FLT_MIN, 1e-42f, -0.f, 1.f / 3, 65519.f, 1e9f,
                                NAN, INFINITY, -INFINITY};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct turner_image image = sample();
        for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
            image.rgba[i * 4 + i % 3] = odd[i];
        struct turner_image_encoding encoding = {.exposure = 3}; /* not for floats */
        struct turner_image back = through(&image, names[n], &encoding, true);
        for (int i = 0; i < 7 * 5 * 4; i++) {
            if (isnan(image.rgba[i]))
                assert_true(isnan(back.rgba[i]));
            else
                assert_memory_equal(&back.rgba[i], &image.rgba[i], sizeof(float));
        }
        turner_image_destroy(&back);
        turner_image_destroy(&image);
    }
}

/* The largest |a − b| over all colour channels. */
static double largest(const struct turner_image *a, const struct turner_image *b)
{
    double d = 0;
    for (int i = 0; i < a->width * a->height * 4; i++)
        d = i % 4 == 3 ? d : fmax(d, fabs((double)a->rgba[i] - (double)b->rgba[i]));
    return d;
}

static void integers_come_back_to_half_a_step(void **state)
{
    (void)state;
    /* jpeg: a smooth ramp of quality 95 stays within a few steps */
    static const struct { const char *name; double steps, half; } formats[] = {
        {"a.png", 255, .5}, {"a.ppm", 255, .5}, {"a.16.png", 65535, .5}, {"a.jpg", 255, 6}};
    for (size_t n = 0; n < sizeof formats / sizeof *formats; n++) {
        struct turner_image image = sample();
        struct turner_image_encoding encoding = {.linear = true};
        struct turner_image back = through(&image, formats[n].name, &encoding, false);
        assert_true(largest(&image, &back) <= formats[n].half / formats[n].steps + 1e-7);
        assert_true(largest(&image, &back) > 0);
        turner_image_destroy(&back);
        /* under the curve the steps are wider at the bright end: slope 2.4/1.055 = 2.27 */
        back = through(&image, formats[n].name, &plain, true);
        assert_true(largest(&image, &back) <= 2.28 * formats[n].half / formats[n].steps);
        turner_image_destroy(&back);
        turner_image_destroy(&image);
    }
}

static void shared_exponent_keeps_eight_bits(void **state)
{
    (void)state;
    struct turner_image image = sample();
    image.rgba[0] = 1e9f;
    image.rgba[4] = NAN;
    image.rgba[9] = INFINITY;
    struct turner_image back = through(&image, "a.hdr", &plain, true);
    assert_true(back.rgba[4] == 0 && back.rgba[9] == 0);
    for (int i = 3; i < 7 * 5; i++) { /* whole pixels only: one exponent for three channels */
        const float *p = image.rgba + i * 4, *q = back.rgba + i * 4;
        float top = fmaxf(p[0], fmaxf(p[1], p[2]));
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(p[c] - q[c]) <= top / 128);
    }
    assert_true(fabsf(back.rgba[0] / 1e9f - 1) <= 1.f / 128);
    turner_image_destroy(&back);
    turner_image_destroy(&image);
}

static void exposure_curve_and_clamping(void **state)
{
    (void)state;
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 8, 1), TURNER_OK);
    static const float values[] = {.25f, .5f, 1, 2, -1, NAN, INFINITY, 3e38f};
    for (int i = 0; i < 8; i++)
        image.rgba[i * 4] = image.rgba[i * 4 + 1] = image.rgba[i * 4 + 2] = values[i];
    /* × 2, no curve: round(255 v); non-finite is 0, an overflow is white */
    static const int expected[] = {128, 255, 255, 255, 0, 0, 0, 255};
    struct turner_image_encoding encoding = {.linear = true, .exposure = 1};
    struct turner_image back = through(&image, "a.png", &encoding, false);
    for (int i = 0; i < 8; i++)
        assert_int_equal(lrintf(back.rgba[i * 4] * 255), expected[i]);
    turner_image_destroy(&back);
    /* under the curve 0.5 is 188 (0.735357), 0.25 is 137 (0.537099) */
    encoding = (struct turner_image_encoding){0};
    back = through(&image, "a.png", &encoding, false);
    assert_int_equal(lrintf(back.rgba[0] * 255), 137);
    assert_int_equal(lrintf(back.rgba[4] * 255), 188);
    turner_image_destroy(&back);
    turner_image_destroy(&image);
}

/* More rows than are packed at once: each sample comes back where it was. */
static void rows_of_large_pictures(void **state)
{
    (void)state;
    struct turner_image image;
    const struct turner_image_encoding encoding = {.linear = true};
    assert_int_equal(turner_image_create(&image, 1237, 1291), TURNER_OK);
    for (uint32_t i = 0; i < 1237 * 1291 * 4; i++)
        image.rgba[i] = (float)(i * 2654435761u >> 24) / 255.f;
    static const char *const names[] = {"a.png", "a.16.png"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct turner_image back = through(&image, names[n], &encoding, false);
        assert_true(largest(&back, &image) < 1e-5);
        turner_image_destroy(&back);
    }
    turner_image_destroy(&image);
}

/* Around each float where an 8-bit sample changes, the sample is the one that the formula gives. */
static void every_step_is_where_the_curve_has_it(void **state)
{
    (void)state;
    static const struct turner_image_encoding encodings[] = {
        {0}, {.linear = true}, {.exposure = 2.5}, {.exposure = -7.25}, {.exposure = 900}};
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 256, 7), TURNER_OK);
    for (size_t e = 0; e < sizeof encodings / sizeof *encodings; e++) {
        double scale = exp2(encodings[e].exposure);
        for (int i = 0; i < 256 * 7; i++) {
            double step = (i % 256 - 0.5) / 255;
            float v = (float)((encodings[e].linear ? step : turner_srgb_to_linear(step)) / scale);
            for (int k = i / 256; k != 3; k += k < 3 ? 1 : -1) /* 3 floats below to 3 above */
                v = nextafterf(v, k < 3 ? -INFINITY : INFINITY);
            image.rgba[i * 4] = v;
        }
        struct turner_image back = through(&image, "a.png", &encodings[e], false);
        for (int i = 0; i < 256 * 7; i++) {
            double v = (double)image.rgba[i * 4] * scale;
            v = v < 0 ? 0 : v > 1 ? 1 : v;
            v = encodings[e].linear ? v : turner_linear_to_srgb(v);
            assert_int_equal(lrintf(back.rgba[i * 4] * 255), (int)(v * 255 + .5));
        }
        turner_image_destroy(&back);
    }
    turner_image_destroy(&image);
}

static bool contains(const char *bytes, size_t size, const char *text)
{
    size_t length = strlen(text);
    for (size_t i = 0; i + length <= size; i++) {
        if (memcmp(bytes + i, text, length) == 0)
            return true;
    }
    return false;
}

static void texts_are_in_the_file_and_the_date_is_not(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.png", "a.16.png", "a.tif"};
    char year[16];
    time_t now = time(NULL);
    strftime(year, sizeof year, "%Y:", gmtime(&now));
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct turner_image image = sample();
        assert_int_equal(turner_image_write(&image, in_folder(names[n]), &plain), TURNER_OK);
        size_t size = 0;
        char *bytes = read_bytes(in_folder(names[n]), &size);
        assert_non_null(bytes);
        for (size_t i = 0; i < plain.text_count; i++) {
            assert_true(contains(bytes, size, texts[i].key));
            assert_true(contains(bytes, size, texts[i].value));
        }
        assert_false(contains(bytes, size, year));
        free(bytes);
        turner_image_destroy(&image);
    }
}

static void same_picture_same_bytes(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.hdr", "a.tif", "a.png", "a.16.png", "a.jpg",
                                        "a.ppm"};
    struct turner_image image = sample();
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        assert_int_equal(turner_image_write(&image, in_folder(names[n]), &plain), TURNER_OK);
    char *first[sizeof names / sizeof *names];
    size_t first_sizes[sizeof names / sizeof *names];
    for (size_t n = 0; n < sizeof names / sizeof *names; n++)
        first[n] = read_bytes(in_folder(names[n]), &first_sizes[n]);
    sleep(1); /* a date, if one were written, would now be another */
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        assert_int_equal(turner_image_write(&image, in_folder(names[n]), &plain), TURNER_OK);
        size_t size;
        char *bytes = read_bytes(in_folder(names[n]), &size);
        assert_non_null(first[n]);
        assert_non_null(bytes);
        assert_int_equal(first_sizes[n], size);
        assert_memory_equal(first[n], bytes, size);
        free(first[n]);
        free(bytes);
    }
    turner_image_destroy(&image);
}

static void one_pixel(void **state)
{
    (void)state;
    static const char *const names[] = {"a.exr", "a.hdr", "a.tif", "a.png", "a.16.png", "a.jpg",
                                        "a.ppm"};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct turner_image image;
        assert_int_equal(turner_image_create(&image, 1, 1), TURNER_OK);
        for (int c = 0; c < 3; c++)
            image.rgba[c] = 1;
        struct turner_image back = through(&image, names[n], &plain, true);
        assert_true(largest(&image, &back) <= 1e-6);
        turner_image_destroy(&back);
        turner_image_destroy(&image);
    }
}

/* Reads `name` and expects the pixels `rgb` (values of the file, no curve). */
static void expect_pixels(const char *name, int pixels, const float *rgb)
{
    struct turner_image image;
    assert_int_equal(turner_image_read(&image, in_folder(name), false), TURNER_OK);
    assert_int_equal(image.width * image.height, pixels);
    for (int i = 0; i < pixels; i++) {
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(image.rgba[i * 4 + c] - rgb[i * 3 + c]) <= 1e-6f);
        assert_true(image.rgba[i * 4 + 3] == 0);
    }
    turner_image_destroy(&image);
}

static void pictures_of_others(void **state)
{
    (void)state;
    assert_true(write_png(in_folder("grey.png"), 2, 1, 8, 0, (uint8_t[]){51, 255}));
    expect_pixels("grey.png", 2, (float[]){.2f, .2f, .2f, 1, 1, 1});
    assert_true(write_png(in_folder("grey16.png"), 1, 2, 16, 0, (uint8_t[]){0x33, 0x33, 0, 1}));
    expect_pixels("grey16.png", 2, (float[]){.2f, .2f, .2f, 1 / 65535.f, 1 / 65535.f, 1 / 65535.f});
    assert_true(write_png(in_folder("rgb16.png"), 1, 1, 16, 2,
                          (uint8_t[]){0, 0, 0xff, 0xff, 0x66, 0x66}));
    expect_pixels("rgb16.png", 1, (float[]){0, 1, .4f});
    /* alpha is dropped and does not darken the colour, not even where it is 0 */
    assert_true(write_png(in_folder("alpha.png"), 2, 1, 8, 6,
                          (uint8_t[]){51, 102, 255, 0, 102, 51, 0, 128}));
    expect_pixels("alpha.png", 2, (float[]){.2f, .4f, 1, .4f, .2f, 0});
    assert_true(write_png(in_folder("grey-alpha.png"), 1, 1, 8, 4, (uint8_t[]){51, 10}));
    expect_pixels("grey-alpha.png", 1, (float[]){.2f, .2f, .2f});
    assert_true(write_bytes(in_folder("a.pgm"), "P5 2 1 255\n\x33\xff", 13));
    expect_pixels("a.pgm", 2, (float[]){.2f, .2f, .2f, 1, 1, 1});
}

static void curve_is_taken_off_integers_only(void **state)
{
    (void)state;
    assert_true(write_png(in_folder("grey.png"), 2, 1, 8, 0, (uint8_t[]){188, 10}));
    struct turner_image image;
    assert_int_equal(turner_image_read(&image, in_folder("grey.png"), true), TURNER_OK);
    assert_true(fabsf(image.rgba[0] - .5028865f) <= 1e-6f);
    assert_true(fabsf(image.rgba[4] - .00303527f) <= 1e-7f); /* the straight part */
    assert_true(image.rgba[0] == image.rgba[1] && image.rgba[0] == image.rgba[2]);
    turner_image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_come_back_exactly),
        cmocka_unit_test(integers_come_back_to_half_a_step),
        cmocka_unit_test(shared_exponent_keeps_eight_bits),
        cmocka_unit_test(exposure_curve_and_clamping),
        cmocka_unit_test(rows_of_large_pictures),
        cmocka_unit_test(every_step_is_where_the_curve_has_it),
        cmocka_unit_test(texts_are_in_the_file_and_the_date_is_not),
        cmocka_unit_test(same_picture_same_bytes),
        cmocka_unit_test(one_pixel),
        cmocka_unit_test(pictures_of_others),
        cmocka_unit_test(curve_is_taken_off_integers_only),
    };
    return cmocka_run_group_tests(tests, folder_create, folder_destroy);
}
