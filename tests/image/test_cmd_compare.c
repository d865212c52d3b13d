/* turner compare: its exit status is what can be trusted, its figures are those of the pictures. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cjson/cJSON.h>
#include <cmocka.h>

#include "app/app.h"
#include "folder.h"
#include "image/image.h"

/* What the last command printed, and its message. */
static char output[8192];
static char message[2048];

/* Runs compare with up to 10 arguments, NULL-terminated. */
static int compare(const char *first, ...)
{
    char storage[12][512] = {"compare"};
    char *argv[13] = {storage[0]};
    int argc = 1;
    va_list arguments;
    va_start(arguments, first);
    for (const char *a = first; a && argc < 12; a = va_arg(arguments, const char *)) {
        snprintf(storage[argc], sizeof storage[0], "%s", a);
        argv[argc] = storage[argc];
        argc++;
    }
    va_end(arguments);
    fflush(stdout);
    FILE *file = tmpfile();
    int saved = dup(STDOUT_FILENO);
    dup2(fileno(file), STDOUT_FILENO);
    turner_fail(TURNER_OK, "no message");
    int result = (int)turner_cmd_compare(argc, argv);
    fflush(stdout);
    dup2(saved, STDOUT_FILENO);
    ssize_t size = pread(fileno(file), output, sizeof output - 1, 0);
    output[size > 0 ? size : 0] = '\0';
    close(saved);
    fclose(file);
    strcpy(message, turner_message());
    return result;
}

static void says(const char *text, const char *what)
{
    if (!strstr(text, what))
        fail_msg("no \"%s\" in \"%s\"", what, text);
}

/* A 10 × 10 EXR of `value`, `count` pixels of which are `off` higher. */
static const char *picture(const char *name, float value, int count, float off)
{
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 10, 10), TURNER_OK);
    for (int i = 0; i < 400; i++)
        image.rgba[i] = value + (i / 4 < count ? off : 0);
    assert_int_equal(turner_image_write(&image, in_folder(name), &(struct turner_image_encoding){0}),
                     TURNER_OK);
    turner_image_destroy(&image);
    return in_folder(name);
}

static void magnitude_and_count(void **state)
{
    (void)state;
    const char *a = picture("a.exr", 1, 3, .5f), *b = picture("b.exr", 1, 0, 0);
    assert_int_equal(compare(a, a, NULL), TURNER_OK);
    says(output, "equal within the tolerance");
    says(output, "0 of 100 (0 %), 0 allowed");
    assert_int_equal(compare(a, b, NULL), TURNER_DIFFERS);
    says(output, "3 of 100 (3 %), 0 allowed");
    says(output, "0.5 at pixel (0,0)");
    says(output, "different");
    says(message, "3 of 100 pixels");
    assert_int_equal(compare(a, b, "-n", "2", NULL), TURNER_DIFFERS);
    assert_int_equal(compare(a, b, "-n", "3", NULL), TURNER_OK);
    assert_int_equal(compare(a, b, "--pixels=2.9%", NULL), TURNER_DIFFERS);
    assert_int_equal(compare(a, b, "--pixels=3%", NULL), TURNER_OK);
    assert_int_equal(compare(a, b, "-t", ".49", NULL), TURNER_DIFFERS);
    assert_int_equal(compare(a, b, "-t", ".5", NULL), TURNER_OK);
    assert_int_equal(compare(a, b, "-r", ".49", NULL), TURNER_DIFFERS);
    assert_int_equal(compare(a, b, "-r", ".5", NULL), TURNER_OK);
    /* 3 of 100 pixels off by ½: RMSE = ½ √.03 = 0.0866 */
    assert_int_equal(compare(a, b, "-n", "3", "--max-rmse", "0.0866", NULL), TURNER_DIFFERS);
    says(message, "RMSE");
    assert_int_equal(compare(a, b, "-n", "3", "--max-rmse", "0.0867", NULL), TURNER_OK);
    assert_int_equal(compare(a, b, "-n", "2", "--max-rmse", "1", NULL), TURNER_DIFFERS);
}

static void nothing_excuses_nan_or_size(void **state)
{
    (void)state;
    const char *good = picture("a.exr", 1, 0, 0), *nan = picture("nan.exr", 1, 1, NAN),
               *infinite = picture("inf.exr", 1, 1, INFINITY);
    const char *const bad[] = {nan, infinite};
    for (int i = 0; i < 2; i++) {
        const char *all = "--pixels=100%", *far = "--threshold=1e30";
        assert_int_equal(compare(good, bad[i], all, far, NULL), TURNER_DIFFERS);
        says(message, "not finite");
        assert_int_equal(compare(bad[i], good, all, far, NULL), TURNER_DIFFERS);
        assert_int_equal(compare(bad[i], bad[i], all, far, NULL), TURNER_DIFFERS);
        says(output, "first at (0,0)");
    }
    struct turner_image other;
    assert_int_equal(turner_image_create(&other, 100, 1), TURNER_OK);
    assert_int_equal(turner_image_write(&other, in_folder("other.exr"),
                                        &(struct turner_image_encoding){0}), TURNER_OK);
    turner_image_destroy(&other);
    assert_int_equal(compare(good, in_folder("other.exr"), "-n", "100%", "-t", "1e30", NULL),
                     TURNER_DIFFERS);
    says(message, "10×10");
    says(message, "100×1");
}

static void missing_and_unreadable(void **state)
{
    (void)state;
    const char *good = picture("a.exr", 1, 0, 0);
    assert_int_equal(compare(good, in_folder("missing.exr"), NULL), TURNER_BAD_INPUT);
    says(message, "missing.exr");
    assert_int_equal(compare(in_folder("missing.exr"), good, NULL), TURNER_BAD_INPUT);
    assert_true(write_bytes(in_folder("text.png"), "text", 4));
    assert_int_equal(compare(good, in_folder("text.png"), NULL), TURNER_BAD_INPUT);
    says(message, "text.png");
}

static void wrong_command_lines(void **state)
{
    (void)state;
    const char *good = picture("a.exr", 1, 0, 0);
    assert_int_equal(compare(NULL, NULL), TURNER_USAGE);
    assert_int_equal(compare(good, NULL), TURNER_USAGE);
    assert_int_equal(compare(good, good, good, NULL), TURNER_USAGE);
    static const char *const wrong[] = {"--threshold=nan", "--threshold=-1", "--threshold=inf",
                                        "--threshold=", "--threshold=1x", "--relative=1%",
                                        "--pixels=1.5", "--pixels=101%", "--pixels=-1",
                                        "--pixels=x", "--max-rmse=x", "--unknown", "-q", "--max-rmse",
                                        "--heatmap=a.xyz"};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        if (compare(good, good, wrong[i], NULL) != TURNER_USAGE)
            fail_msg("%s is accepted", wrong[i]);
        assert_string_not_equal(message, "no message");
    }
    assert_int_equal(compare("--help", NULL), TURNER_OK);
    says(output, "Usage: turner compare");
}

static void heat_map(void **state)
{
    (void)state;
    const char *a = picture("a.exr", 1, 1, .5f), *b = picture("b.exr", 1, 0, 0);
    const char *map = in_folder("map.png");
    assert_int_equal(compare(a, b, "--heatmap", map, NULL), TURNER_DIFFERS);
    says(output, "white is 0.5");
    struct turner_image image;
    assert_int_equal(turner_image_read(&image, map, false), TURNER_OK);
    assert_true(image.width == 10 && image.height == 10);
    assert_true(image.rgba[0] == 1 && image.rgba[1] == 1 && image.rgba[2] == 1);
    assert_true(image.rgba[4] == 0 && image.rgba[5] == 0 && image.rgba[6] == 0);
    turner_image_destroy(&image);
    assert_int_equal(compare(a, b, "--heatmap", in_folder("nowhere/map.png"), NULL), TURNER_OUTPUT);
    says(message, "nowhere");
    assert_int_equal(compare(a, b, "--json", in_folder("nowhere/a.json"), NULL), TURNER_OUTPUT);
}

static void preview(void **state)
{
    (void)state;
    const char *a = picture("a.exr", .5f, 0, 0), *b = picture("b.exr", 1, 0, 0);
    assert_int_equal(compare(a, b, "--preview", folder, NULL), TURNER_DIFFERS);
    static const struct { const char *name; int code; } expected[] = {
        {"picture.png", 188}, {"reference.png", 255}}; /* under the sRGB curve */
    for (int i = 0; i < 2; i++) {
        struct turner_image image;
        assert_int_equal(turner_image_read(&image, in_folder(expected[i].name), false), TURNER_OK);
        assert_int_equal(lrintf(image.rgba[0] * 255), expected[i].code);
        turner_image_destroy(&image);
    }
    assert_int_equal(compare(a, b, "--preview", in_folder("nowhere"), NULL), TURNER_OUTPUT);
}

static double number(const cJSON *json, const char *key)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(json, key);
    assert_true(cJSON_IsNumber(item));
    return item->valuedouble;
}

static void json_report(void **state)
{
    (void)state;
    const char *a = picture("a.exr", 1, 1, .5f), *b = picture("b \"quoted\".exr", 1, 0, 0);
    assert_int_equal(compare(a, b, "--json", "-", NULL), TURNER_DIFFERS);
    cJSON *json = cJSON_Parse(output);
    assert_non_null(json);
    assert_true(cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(json, "different")));
    assert_true(fabs(number(json, "rmse") - .05) <= 1e-12);
    assert_true(number(json, "largest") == .5);
    assert_true(number(json, "pixels_over") == 1 && number(json, "pixels") == 100);
    assert_string_equal(
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(json, "reference")), b);
    cJSON_Delete(json);
    assert_int_equal(compare(a, a, "--json", in_folder("a.json"), NULL), TURNER_OK);
    says(output, "equal within");
    size_t size;
    char *bytes = read_bytes(in_folder("a.json"), &size);
    json = cJSON_Parse(bytes);
    assert_true(cJSON_IsFalse(cJSON_GetObjectItemCaseSensitive(json, "different")));
    cJSON_Delete(json);
    free(bytes);
}

static void curve_or_none(void **state)
{
    (void)state;
    assert_true(write_png(in_folder("a.png"), 1, 1, 8, 0, (uint8_t[]){255}));
    assert_true(write_png(in_folder("b.png"), 1, 1, 8, 0, (uint8_t[]){254}));
    const char *a = in_folder("a.png"), *b = in_folder("b.png");
    assert_int_equal(compare(a, b, "--linear", NULL), TURNER_OK); /* one step: the default */
    assert_int_equal(compare(a, b, NULL), TURNER_DIFFERS); /* 0.0089 of radiance */
    assert_int_equal(compare(a, b, "-t", ".0089", NULL), TURNER_OK);
}

/* A folder first in PATH whose python3 is the given shell script. */
static void fake_python(const char *body)
{
    char script[512];
    snprintf(script, sizeof script, "#!/bin/sh\n%s\n", body);
    assert_true(write_bytes(in_folder("python3"), script, strlen(script)));
    assert_int_equal(chmod(in_folder("python3"), 0755), 0);
}

static void flip_tool(void **state)
{
    (void)state;
    const char *a = picture("a.exr", 1, 1, .5f);
    char *path = strdup(getenv("PATH"));
    setenv("PATH", folder, 1);
    assert_int_equal(compare(a, a, "--flip", NULL), TURNER_BAD_INPUT); /* no python3 at all */
    says(message, "python3");
    fake_python("exit 86");
    assert_int_equal(compare(a, a, "--flip", NULL), TURNER_BAD_INPUT);
    says(message, "pip install flip-evaluator numpy");
    fake_python("exit 1");
    assert_int_equal(compare(a, a, "--flip", NULL), TURNER_BAD_INPUT);
    fake_python("echo nothing");
    assert_int_equal(compare(a, a, "--flip", NULL), TURNER_BAD_INPUT);
    fake_python("echo 0.125");
    assert_int_equal(compare(a, a, "--flip", NULL), TURNER_OK);
    says(output, "FLIP (HDR)     0.125"); /* 1.5 is above the range of the other kind */
    setenv("PATH", path, 1);
    free(path);
}

static void flip_itself(void **state)
{
    (void)state;
    if (system("python3 -c 'import flip_evaluator, numpy' 2>/dev/null") != 0) {
        print_message("skipped: python3 has no packages flip-evaluator and numpy\n");
        skip();
    }
    const char *a = picture("a.exr", .25f, 50, .5f), *b = picture("b.exr", .25f, 0, 0);
    assert_int_equal(compare(a, a, "--flip", "--json", "-", NULL), TURNER_OK);
    cJSON *json = cJSON_Parse(output);
    assert_true(number(json, "flip") == 0);
    cJSON_Delete(json);
    assert_int_equal(compare(a, b, "--flip", "--json", "-", NULL), TURNER_DIFFERS);
    json = cJSON_Parse(output);
    assert_true(number(json, "flip") > .1 && number(json, "flip") < 1);
    assert_string_equal(
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(json, "flip_kind")), "LDR");
    cJSON_Delete(json);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_create, folder_destroy)
        IN_FOLDER(magnitude_and_count),
        IN_FOLDER(nothing_excuses_nan_or_size),
        IN_FOLDER(missing_and_unreadable),
        IN_FOLDER(wrong_command_lines),
        IN_FOLDER(heat_map),
        IN_FOLDER(preview),
        IN_FOLDER(json_report),
        IN_FOLDER(curve_or_none),
        IN_FOLDER(flip_tool),
        IN_FOLDER(flip_itself),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
