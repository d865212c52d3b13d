/* Broken NFF: every message says where and what. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "nff_reading.h"

#define FILL "f 1 1 1 1 0 0 0 0\n"

struct fault {
    const char *text, *message;
};

static const struct fault faults[] = {
    {"", "test.nff:1:1: expected a viewpoint (v), but the file ends here"},
    {"l 1 2 3\n# v\n", "test.nff:3:1: expected a viewpoint (v), but the file ends here"},
    {VIEW "\n  sphere 0 0 0 1", "test.nff:3:3: expected a keyword (b v l f s c p pp; perhaps "
                                "\"s\"), found \"sphere\""},
    {VIEW "Q 1", "test.nff:2:1: expected a keyword (b v l f s c p pp), found \"Q\""},
    {VIEW "P 3", "test.nff:2:1: expected a keyword (b v l f s c p pp; perhaps \"p\"), found \"P\""},
    {VIEW "l 1 2 3 1 1 1 1", "test.nff:2:15: expected a keyword (b v l f s c p pp) because the one "
                             "before has all its numbers, found \"1\""},
    {VIEW "\x1b[31mred", "test.nff:2:1: expected a keyword (b v l f s c p pp), found \"?[31mred\""},
    {VIEW "a_word_that_is_much_too_long_to_be_shown_whole",
     "found \"a_word_that_is_much_too_long_to_be_shown…\""},
    {VIEW "s 0 0 0 1", "test.nff:2:1: expected a fill (f) before the first primitive, found \"s\""},
    {VIEW FILL "s 0 zero 0 1",
     "test.nff:3:5: expected a number, y of a sphere (s), found \"zero\""},
    {VIEW FILL "s 0 0", "test.nff:3:6: expected a number, z of a sphere (s), but the file ends "
                        "here"},
    {VIEW FILL "s 0 0 0 nan", "test.nff:3:9: expected a number, radius of a sphere (s), found"},
    {VIEW FILL "s inf 0 0 1", "test.nff:3:3: expected a number, x of a sphere (s), found \"inf\""},
    {VIEW FILL "s 0x10 0 0 1", "test.nff:3:3: expected a number, x of a sphere (s), found"},
    {VIEW FILL "s 1e999 0 0 1", "test.nff:3:3: expected a number within ±3.4e38, x of a sphere"},
    {VIEW FILL "s 0 0 1e39 1", "test.nff:3:7: expected a number within ±3.4e38, z of a sphere"},
    {VIEW FILL "s 1,5 0 0 1", "test.nff:3:3: expected a number, x of a sphere (s), found \"1,5\""},
    {VIEW FILL "s 1-2 0 0 1", "test.nff:3:3: expected a number, x of a sphere (s), found \"1-2\""},
    {VIEW FILL "s - 0 0 1", "test.nff:3:3: expected a number, x of a sphere (s), found \"-\""},
    {VIEW FILL "s 0 0 0\ns 1 1 1 1", "test.nff:4:1: expected a number, radius of a sphere (s), "
                                     "found \"s\""},
    {VIEW FILL "c 0 0 0 1 0 0 x 1", "test.nff:3:15: expected a number, z of a cone's (c) apex"},
    {VIEW FILL "p 2 0 0 0 1 1 1", "test.nff:3:3: expected 3 to 16384, count of a polygon's (p, pp) "
                                  "corners, found \"2\""},
    {VIEW FILL "p 3.5 0", "test.nff:3:3: expected a whole number, count of a polygon's (p, pp) "
                          "corners, found \"3.5\""},
    {VIEW FILL "p 4000000000 0", "test.nff:3:3: expected 3 to 16384, count of a polygon's"},
    {VIEW FILL "pp -1 0", "test.nff:3:4: expected 3 to 16384, count of a polygon's"},
    {VIEW FILL "p 16384 0 0 0", "test.nff:3:14: expected a number, x of a polygon's (p, pp) "
                                "corner, but the file ends here"},
    {VIEW FILL "pp 3 0 0 0 0 0 1 1 0 0 0 0 up", "test.nff:3:28: expected a number, z of a patch's "
                                                "(pp) normal, found \"up\""},
    {VIEW "f 1 1 1 1 0 0 .5 0", "test.nff:2:18: a transparent fill (T = 0.5) needs an index of "
                                "refraction above 0, not 0"},
    {VIEW "f 1 1 1 1 0 0 .5 -1.5", "test.nff:2:18: a transparent fill"},
    {VIEW "f 1 1 -1 1 0 0 0 0", "test.nff:2:7: expected at least 0, b of a fill (f), found \"-1\""},
    {VIEW "f 1 1 1 1 0 -2 0 0", "test.nff:2:13: expected at least 0, Shine of a fill (f)"},
    {VIEW "f 1e30 1 1 1e30 0 0 0 0", "test.nff:2:23: a fill's (f) colour times Kd is beyond"},
    {VIEW "b 1 1", "test.nff:2:6: expected a number, b of the background (b), but the file ends"},
    {VIEW "b 1 1 -1", "test.nff:2:7: expected at least 0, b of the background (b)"},
    {VIEW "b 1 1 1 b 0 0 0", "test.nff:2:9: a second background (b)"},
    {VIEW VIEW, "test.nff:2:1: a second viewpoint (v)"},
    {VIEW "l 1 2 3 .5 .5", "test.nff:2:14: expected a number, b of a light (l), but the file ends"},
    {VIEW "l 1 2 3 .5 .5 -.5", "test.nff:2:15: expected at least 0, b of a light (l)"},
    {"v at 0 0 0", "test.nff:1:3: expected \"from\", found \"at\""},
    {"v from 1 2 3 at 1 2 3 up 0 0 1 angle",
     "test.nff:1:1: the viewpoint (v) has no direction: \"from\" is \"at\""},
    {"v from 1 2 3 at 1 2 4 up 0 0 9 angle",
     "test.nff:1:1: the viewpoint (v) has no direction: \"up\" lies along the view"},
    {"v from 1 2 3 at 1 2 4 up 0 0 0 angle",
     "test.nff:1:1: the viewpoint (v) has no direction: \"up\" lies along the view"},
    {"v from 1 2 3 at 0 0 0 up 0 0 1 angle 180 hither", "test.nff:1:38: the \"angle\" must lie"},
    {"v from 1 2 3 at 0 0 0 up 0 0 1 angle 181 hither",
     "test.nff:1:38: expected 0 to 180, degrees of \"angle\", found \"181\""},
    {"v from 1 2 3 at 0 0 0 up 0 0 1 angle 45 hither 1 resolution 0 1",
     "test.nff:1:61: expected 1 to 65536, width of \"resolution\", found \"0\""},
    {"v from 1 2 3 at 0 0 0 up 0 0 1 angle 45 hither 1 resolution 512 1e9",
     "test.nff:1:65: expected 1 to 65536, height of \"resolution\", found \"1e9\""},
};

static void messages(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof faults / sizeof *faults; i++) {
        struct turner_scene *scene = read_nff(faults[i].text);
        if (scene)
            fail_msg("read without complaint: %s", faults[i].text);
        if (!strstr(turner_message(), faults[i].message))
            fail_msg("%s\ngives: %s\nand not: %s", faults[i].text, turner_message(),
                     faults[i].message);
    }
}

static void numbers_that_never_end(void **state)
{
    (void)state;
    char text[1024] = VIEW FILL "s 0.";
    size_t start = strlen(text);
    memset(text + start, '3', 250);
    strcpy(text + start + 250, " 0 0 1");
    struct turner_scene *scene = read_nff(text);
    assert_non_null(scene);
    assert_true(scene->groups[0].spheres[0].center.x == 1.0 / 3);
    turner_scene_destroy(scene);
    memset(text + start, '3', 300);
    strcpy(text + start + 300, " 0 0 1");
    assert_null(read_nff(text));
    assert_non_null(strstr(turner_message(), "test.nff:3:3: expected a number, x of a sphere (s), "
                                             "found \"0.33333"));
}

static void too_many_of_a_kind(void **state)
{
    (void)state;
    size_t capacity = 1 << 20;
    char *text = malloc(capacity);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, capacity, VIEW);
    size_t start = length;
    for (int i = 0; i <= TURNER_MAX_MEDIA; i++)
        length += (size_t)snprintf(text + length, capacity - length, "f 1 1 1 1 0 0 1 1.%03d\n", i);
    assert_null(read_nff(text));
    assert_non_null(strstr(turner_message(),
                           "test.nff:257:17: more than 255 different indices of refraction"));
    length = start;
    for (int i = 0; i <= TURNER_MAX_LIGHTS; i++)
        length += (size_t)snprintf(text + length, capacity - length, "l 1 2 %d\n", i);
    assert_null(read_nff(text));
    assert_non_null(strstr(turner_message(), "test.nff:4098:7: more than 4096 lights"));
    free(text);
}

/* Wherever the file is cut off, the reader gives a scene or a message. */
static void truncated_anywhere(void **state)
{
    (void)state;
    static const char whole[] =
        "b 0 0 1\n" VIEW "l 1 2 3 1 1 1\n" FILL "f 1 1 1 0 0 1 .9 1.5\ns 0 0 0 1\n"
        "c 0 0 0 1 0 0 1 .5\np 4 0 0 0 1 0 0 .1 .1 0 0 1 0\n"
        "pp 3 0 0 0 0 0 1 1 0 0 0 0 1 1 1 0 0 0 1\n";
    char cut[sizeof whole];
    turner_set_quiet(true); /* cut numbers make degenerate things */
    int failures = 0;
    for (size_t length = 0; length < sizeof whole; length++) {
        memcpy(cut, whole, length);
        cut[length] = '\0';
        turner_fail(TURNER_BAD_INPUT, "none");
        struct turner_scene *scene = read_nff(cut);
        if (!scene) {
            assert_ptr_equal(strstr(turner_message(), "test.nff:"), turner_message());
            failures++;
        }
        turner_scene_destroy(scene);
    }
    turner_set_quiet(false);
    assert_true(failures > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(messages),
        cmocka_unit_test(numbers_that_never_end),
        cmocka_unit_test(too_many_of_a_kind),
        cmocka_unit_test(truncated_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
