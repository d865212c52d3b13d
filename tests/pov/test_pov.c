/* Export to POV-Ray: the numbers are the scene's own, and what POV-Ray cannot say is refused with a
 * way out and without a file. (pov.py draws what is exported.) */
#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

#include "../scene/scene_reading.h"
#include "scene/pov.h"

static char folder[] = "/tmp/turner-pov-XXXXXX";
static char path[64];

static int make_folder(void **state)
{
    (void)state;
    if (!mkdtemp(folder))
        return -1;
    snprintf(path, sizeof path, "%s/out.pov", folder);
    return 0;
}

static int remove_folder(void **state)
{
    (void)state;
    unlink(path);
    return rmdir(folder); /* fails if anything else was left there */
}

/* The exported text (free). */
static char *export_text(const char *json)
{
    struct turner_scene *scene = must_parse(json);
    if (turner_pov_write(scene, path) != TURNER_OK)
        fail_msg("%s", turner_message());
    turner_scene_destroy(scene);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    char *text = calloc(1, 1 << 16);
    size_t size = fread(text, 1, (1 << 16) - 1, file);
    assert_true(size > 100 && size < (1 << 16) - 1);
    fclose(file);
    return text;
}

/* `count` numbers after `words`, whatever stands between them. */
static void numbers(double *out, int count, const char *text, const char *words)
{
    const char *at = strstr(text, words);
    if (!at)
        fail_msg("no \"%s\" in:\n%s", words, text);
    at += strlen(words);
    for (int i = 0; i < count; i++) {
        at += strcspn(at, "-0123456789");
        char *end;
        out[i] = strtod(at, &end);
        assert_ptr_not_equal(end, at);
        at = end;
    }
}

static void expect(const char *text, const char *words, int count, const double *wanted)
{
    double got[12];
    numbers(got, count, text, words);
    for (int i = 0; i < count; i++) {
        if (got[i] != wanted[i])
            fail_msg("%s: number %d is %.17g, not %.17g", words, i, got[i], wanted[i]);
    }
}

static const char careful[] =
    "{\"version\": 1, \"camera\": {\"from\": [0.1, 0.2, 5.3], \"at\": [0.1, 0.2, 0], \"vfov\": 90},"
    "\"settings\": {\"size\": [200, 100], \"depth\": 3, \"cutoff\": 0.0009765625,"
    "  \"shading\": \"phong\"}, \"materials\": {\"a\": {\"k_d\": [0.1, 0.2, 0.7]}},"
    "\"groups\": {\"g\": [{\"type\": \"sphere\", \"center\": [0.3333333333333333, 0.1, -1e-7],"
    "  \"radius\": 0.7, \"material\": \"a\"}]},"
    "\"instances\": [{\"group\": \"g\", \"transform\": {\"matrix\": [1, 2, 3, 4,  5, 6, 7, 8,"
    "  9, 10, 12, 13]}}],"
    "\"lights\": [{\"type\": \"point\", \"position\": [1, 2, 3], \"intensity\": [7, 8, 9]}]}";

static void numbers_are_kept(void **state)
{
    (void)state;
    char *text = export_text(careful);
    assert_non_null(strstr(text, "+W200 +H100"));
    expect(text, "max_trace_level", 1, (double[]){4}); /* depth + 1 */
    expect(text, "adc_bailout", 1, (double[]){1.0 / 1024});
    expect(text, "location", 3, (double[]){0.1, 0.2, 5.3});
    expect(text, "sphere {", 4, (double[]){1.0 / 3, 0.1, -1e-7, 0.7});
    expect(text, "matrix", 12, (double[]){1, 5, 9, 2, 6, 10, 3, 7, 12, 4, 8, 13});
    expect(text, "pigment { rgbft", 5, (double[]){0.1, 0.2, 0.7, 0, 0});
    assert_null(strstr(text, "mesh2"));
    assert_null(strstr(text, "plane"));
    free(text);
}

/* 90 degrees from edge to edge, twice as wide as high, right-handed: x to the right along −z. */
static void camera_is_right_handed(void **state)
{
    (void)state;
    static const double wanted[] = {4, 0, 0, 0, 2, 0, 0, 0, -1};
    double got[9];
    char *text = export_text(careful);
    numbers(got, 3, text, "\n  right");
    numbers(got + 3, 3, text, "\n  up");
    numbers(got + 6, 3, text, "\n  direction");
    for (int i = 0; i < 9; i++)
        assert_true(fabs(got[i] - wanted[i]) <= 1e-15);
    free(text);
}

/* POV-Ray's colour × 2/(1 + (d/fade)²) is J/d². */
static void inverse_square_is_exact(void **state)
{
    (void)state;
    double color[3], fade, power;
    char *text = export_text(careful);
    numbers(color, 3, text, "rgb <");
    numbers(color, 3, strstr(text, "light_source"), "rgb");
    numbers(&fade, 1, text, "fade_distance");
    numbers(&power, 1, text, "fade_power");
    assert_true(power == 2);
    for (double d = 1e-3; d < 1e6; d *= 10) {
        for (int i = 0; i < 3; i++) {
            double got = color[i] * 2 / (1 + pow(d / fade, power)), wanted = (7 + i) / (d * d);
            assert_true(fabs(got - wanted) < 2e-12 * wanted);
        }
    }
    free(text);
}

/* ---- what is refused ---- */

#define SETTINGS(more) ", \"settings\": {\"shading\": \"phong\"" more "}"
#define SUN ", \"lights\": [{\"type\": \"directional\", \"direction\": [0, -1, 0], \"irradiance\": 1}]"
#define LAMP(x) ", \"lights\": [{\"type\": \"point\", \"position\": " x ", \"intensity\": 1}]"
#define MATERIAL(m) ", \"materials\": {\"m\": {" m "}, \"g\": {\"k_d\": 0.5}}"
#define THINGS(t) ", \"primitives\": [" t "]"
#define ON ", \"material\": \"m\"}"
#define SPHERE(x, r) "{\"type\": \"sphere\", \"center\": " x ", \"radius\": " r ON
#define BALL SPHERE("[0, 0, 0]", "1")
#define PLANE(y) "{\"type\": \"plane\", \"point\": [0, " y ", 0], \"normal\": [0, 1, 0]" ON
#define TETRAHEDRON(last)                                                                          \
    "{\"type\": \"mesh\", \"positions\": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],"            \
    " \"triangles\": [[0, 2, 1], [0, 1, 3], [0, 3, 2]" last "]" ON
#define CYLINDER(capped)                                                                           \
    "{\"type\": \"cylinder\", \"base\": [0, 0, 0], \"apex\": [0, 1, 0], \"radius\": 1,"            \
    " \"capped\": " capped ON
#define GLASS "\"k_r\": 1, \"k_t\": 1, \"index\": 1.5"
#define CHECKER "\"k_d\": 1, \"pattern\": {\"type\": \"checker\", \"colors\": [0, 1]}"
#define SPOT(outer)                                                                                \
    ", \"lights\": [{\"type\": \"spot\", \"position\": [0, 1, 0], \"at\": [0, 0, 0], \"inner\": "  \
    "30, \"outer\": " outer ", \"intensity\": 1}]"
/* A ball of glass with a ball of air in it. */
#define HOLLOW(eye, priority, k_r, x)                                                              \
    ", \"camera\": {\"from\": [0, 0, " eye "], \"at\": [0, 0, 0]}" SETTINGS("") SUN                \
    ", \"media\": {\"air\": {\"index\": 1, \"priority\": " priority "}}, \"materials\": {"         \
    "\"g\": {" GLASS "}, \"m\": {\"k_r\": " k_r ", \"k_t\": 1, \"medium\": \"air\"}}"              \
    THINGS("{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"g\"}, "    \
           SPHERE("[" x ", 0, 0]", "0.5"))
#define SCENE(material, things) SETTINGS("") SUN MATERIAL(material) THINGS(things)

/* Each beside something near it that is exported. */
static const struct {
    const char *refused, *words[2], *exported;
} cases[] = {
    {SCENE("\"k_r\": 1, \"metal\": \"gold\"", BALL), {"\"m\"", "complex index"},
     SCENE("\"k_r\": 0.9, \"fresnel\": \"schlick\"", BALL)},
    {SCENE(GLASS ", \"fresnel\": \"schlick\"", BALL), {"\"m\"", "Schlick"}, SCENE(GLASS, BALL)},
    {SCENE("\"k_r\": 0.5, \"k_t\": 1, \"index\": 1.5", BALL), {"\"m\"", "k_r of 1"},
     SCENE("\"k_r\": 0.5, \"k_t\": 1, \"index\": 1", BALL)},
    {SCENE("\"k_t\": 1, \"index\": 1.5", BALL), {"\"m\"", "k_r of 1"},
     SCENE("\"k_t\": 1, \"index\": 1", BALL)},
    {SCENE("\"k_r\": 0.5, \"k_t\": 0.75, \"index\": 1.5, \"fresnel\": \"none\"", BALL),
     {"\"m\"", "k_r + k_t"},
     SCENE("\"k_r\": 0.25, \"k_t\": 0.75, \"index\": 1.5, \"fresnel\": \"none\"", BALL)},
    {SCENE(GLASS ", \"k_s\": [0, 1, 1]", BALL), {"\"m\"", "grey k_s"},
     SCENE(GLASS ", \"k_s\": [0.5, 1, 1]", BALL)},
    {", \"settings\": {}" SUN MATERIAL("\"k_s\": 0.1") THINGS(BALL), {"\"m\"", "phong"},
     ", \"settings\": {}" MATERIAL("\"k_s\": 0.1") THINGS(BALL)},
    {SCENE(CHECKER, BALL), {"\"m\"", "on a sphere"}, SCENE(CHECKER, PLANE("0"))},
    {SCENE(CHECKER, CYLINDER("true")), {"\"m\"", "on a cone"}, SCENE(CHECKER, TETRAHEDRON(""))},
    {SCENE(GLASS, TETRAHEDRON("")), {"\"m\"", "open"}, SCENE(GLASS, TETRAHEDRON(", [1, 2, 3]"))},
    {SCENE(GLASS, TETRAHEDRON(", [1, 3, 2]")), {"\"m\"", "open"},
     SCENE("\"k_d\": 1", TETRAHEDRON(", [1, 3, 2]"))},
    {SCENE(GLASS, CYLINDER("false")), {"\"m\"", "open"}, SCENE(GLASS, CYLINDER("true"))},
    {SCENE(GLASS ", \"absorption\": 1", PLANE("-1")), {"\"m\"", "half space"},
     SCENE(GLASS, PLANE("-1"))},
    {SCENE(GLASS, BALL ", " SPHERE("[0.5, 0, 0]", "1")), {"priorities", "apart"},
     SCENE(GLASS, BALL ", " SPHERE("[2.5, 0, 0]", "1"))},
    {SCENE(GLASS, BALL ", " SPHERE("[0, 0, 0]", "0.5")), {"priorities", "apart"},
     SCENE("\"k_r\": 1", BALL ", " SPHERE("[0, 0, 0]", "0.5"))},
    {SCENE(GLASS, PLANE("-1") ", " BALL), {"priorities", "apart"},
     SCENE(GLASS, PLANE("-1.1") ", " BALL)},
    {SCENE(GLASS, PLANE("-1") ", " PLANE("-2")), {"priorities", "use one"},
     SCENE("\"k_r\": 1", PLANE("-1") ", " PLANE("-2"))},
    {SCENE(GLASS, SPHERE("[0, 0, 5]", "1")), {"camera", "inside"},
     SCENE(GLASS, SPHERE("[0, 0, 3.9]", "1"))},
    {SCENE(GLASS, PLANE("1")), {"camera", "inside"}, SCENE("\"k_d\": 1", PLANE("1"))},
    {SETTINGS("") LAMP("[0, 0.5, 0]") MATERIAL(GLASS ", \"absorption\": 1") THINGS(BALL),
     {"light 0", "absorb"}, SETTINGS("") LAMP("[0, 0.5, 0]") MATERIAL(GLASS) THINGS(BALL)},
    {HOLLOW("5", "-1", "1", "0"), {"priorities", "apart"}, HOLLOW("5", "1", "1", "0")},
    {HOLLOW("5", "1", "1", "0.6"), {"priorities", "apart"}, HOLLOW("5", "1", "1", "0.4")},
    {HOLLOW("5", "1", "0.5", "0"), {"\"m\"", "k_r of 1"}, HOLLOW("5", "1", "0.5", "2")},
    {HOLLOW("0.9", "1", "1", "0"), {"camera", "hollow"}, HOLLOW("1.1", "1", "1", "0")},
    {SPOT("120"), {"light 0", "90 degrees"}, SPOT("80")},
    {SETTINGS(", \"depth\": 256"), {"255", "256"}, SETTINGS(", \"depth\": 255")},
    {SETTINGS(", \"cutoff\": 1.5"), {"cutoff", "1.5"}, SETTINGS(", \"cutoff\": 1")},
};

static void complete(char *json, size_t size, const char *part)
{
    snprintf(json, size, "%s%s}", strstr(part, "camera") ? "{\"version\": 1" : HEAD, part);
}

static void what_cannot_be_said_is_refused(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[4096];
        complete(json, sizeof json, cases[i].refused);
        struct turner_scene *scene = must_parse(json);
        unlink(path);
        if (turner_pov_write(scene, path) != TURNER_BAD_INPUT)
            fail_msg("exported, though it cannot be: %s", json);
        for (int w = 0; w < 2; w++) {
            if (!strstr(turner_message(), cases[i].words[w]))
                fail_msg("no \"%s\" in: %s", cases[i].words[w], turner_message());
        }
        assert_int_equal(access(path, F_OK), -1);
        turner_scene_destroy(scene);
    }
}

static void what_is_near_it_is_exported(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char json[4096];
        complete(json, sizeof json, cases[i].exported);
        free(export_text(json));
    }
}

static void a_file_that_cannot_be_written(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(careful);
    assert_int_equal(turner_pov_write(scene, "/no/such/folder/x.pov"), TURNER_OUTPUT);
    turner_scene_destroy(scene);
}

int main(void)
{
    static const struct CMUnitTest tests[] = {
        cmocka_unit_test(numbers_are_kept),
        cmocka_unit_test(camera_is_right_handed),
        cmocka_unit_test(inverse_square_is_exact),
        cmocka_unit_test(what_cannot_be_said_is_refused),
        cmocka_unit_test(what_is_near_it_is_exported),
        cmocka_unit_test(a_file_that_cannot_be_written),
    };
    return cmocka_run_group_tests_name("pov", tests, make_folder, remove_folder);
}
