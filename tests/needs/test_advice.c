/* Who asks for what, what single precision is good for, and the warnings: that they come where they
 * should and stay away where they should not. */
#include <math.h>
#include <unistd.h>

#include "needs_test.h"
#include "render/advice.h"
#include "render/needs.h"
#include "render/precision.h"

#include "../shaders/shared.h"

/* ---- reasons ---- */

static void expect_reason(const struct turner_scene *scene, uint32_t bit, const char *reason)
{
    struct turner_why why[TURNER_NEEDS_COUNT];
    char text[TURNER_WHY_TEXT];
    struct turner_needs needs = turner_needs_explain(why, scene);
    int place = 0;
    while (bit >> place != 1)
        place++;
    turner_why_text(text, scene, &why[place]);
    assert_string_equal(text, reason);
    assert_int_equal((needs.bits & bit) != 0, *reason != 0);
}

static void reasons(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "\"settings\": {\"shading\": \"phong\"}, \"background\": {\"type\": \"gradient\", "
        "\"bottom\": 0, \"top\": 1}, \"media\": {\"tea\": {\"index\": 1.3, \"absorption\": 1}, "
        "\"milk\": {\"index\": 1.35, \"absorption\": 9}}, \"materials\": {\"a\": {\"k_d\": 1}, "
        "\"m\": {\"k_r\": 1, \"k_t\": 1, \"medium\": \"tea\"}, \"gold\": {\"metal\": \"gold\", "
        "\"k_r\": 1}, \"mirror\": {\"k_r\": 0.5}, \"never\": {\"k_r\": 1, \"fresnel\": "
        "\"schlick\", \"k_s\": 1}}, \"groups\": {\"trees\": [{\"type\": \"cone\", \"base\": "
        "[0, 0, 0], \"apex\": [0, 1, 0], \"base_radius\": 1, \"material\": \"a\"}], \"unseen\": "
        "[{\"type\": \"box\", \"min\": [0, 0, 0], \"max\": [1, 1, 1], \"material\": \"never\"}]}, "
        "\"instances\": [{\"group\": \"trees\", \"material\": \"mirror\"}, {\"group\": "
        "\"trees\", \"material\": \"gold\"}], \"primitives\": [" SPHERE ", " SPHERE ", " SPHERE "],"
        " \"lights\": [{\"type\": \"point\", \"position\": [0, 9, 0], \"intensity\": 1}, "
        "{\"type\": \"spot\", \"position\": [0, 3, 0], \"at\": [0, 0, 0], \"inner\": 5, "
        "\"outer\": 9, \"intensity\": 1}]");
    expect_reason(scene, TURNER_NEEDS_SPHERES, "sphere 0 and 2 more");
    expect_reason(scene, TURNER_NEEDS_CONES, "cone 0 of group \"trees\"");
    expect_reason(scene, TURNER_NEEDS_INSTANCES, "instance 0 and 1 more");
    expect_reason(scene, TURNER_NEEDS_TRIANGLES, ""); /* no instance of that group */
    expect_reason(scene, TURNER_NEEDS_SCHLICK, "");   /* nor of its material */
    expect_reason(scene, TURNER_NEEDS_SPECULAR, "");
    expect_reason(scene, TURNER_NEEDS_REFLECTION, "material \"m\" and 2 more");
    expect_reason(scene, TURNER_NEEDS_BRANCHING, "material \"m\"");
    expect_reason(scene, TURNER_NEEDS_CONDUCTOR, "material \"gold\"");
    expect_reason(scene, TURNER_NEEDS_MEDIA, "material \"m\"");
    expect_reason(scene, TURNER_NEEDS_ABSORPTION, "medium \"tea\"");
    expect_reason(scene, TURNER_NEEDS_POINT, "light 0 and 1 more");
    expect_reason(scene, TURNER_NEEDS_SPOT, "light 1");
    expect_reason(scene, TURNER_NEEDS_PHONG, "settings.shading");
    expect_reason(scene, TURNER_NEEDS_GRADIENT, "background.type");
    turner_scene_destroy(scene);

    scene = scene_of("\"media\": {\"sea\": {\"index\": 1.3}}, \"background\": 1");
    scene->camera.inside_count = 1;
    expect_reason(scene, TURNER_NEEDS_MEDIA, "the camera is inside a medium");
    turner_scene_destroy(scene);
}

/* ---- precision ---- */

/* δ = 8·2^-24·S, seen from d: the numbers of the header, by hand. */
static void error_of_single_precision(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of("\"settings\": {\"size\": [200, 100]}, \"materials\": "
                                          "{\"m\": {\"k_d\": 1}}, \"primitives\": [" SPHERE "]");
    scene->camera.vfov = 2 * atan(0.5); /* a pixel is 0.01 at distance 1 */
    struct turner_f32_error error = turner_f32_error_of(scene);
    double delta = 5 * 0x1p-21; /* the eye's 5 is the largest coordinate */
    assert_true(fabs(error.pixels / (delta / (4 * 0.01)) - 1) < 1e-9);
    assert_true(fabs(error.shape / delta - 1) < 1e-9);
    assert_true(error.object.asker == TURNER_ASKER_SPHERE && error.object.count == 1);
    assert_false(turner_f64_can_show(scene, 8));
    assert_true(turner_f64_can_show(scene, 16) && turner_f64_can_show(scene, 32));

    /* 1e5 radii from the origin single precision loses pixels */
    scene->camera.from.x += 1e5;
    scene->groups[0].spheres[0].center.x += 1e5;
    assert_true(turner_f32_error_of(scene).pixels > 1 && turner_f64_can_show(scene, 8));
    scene->camera.from.x -= 1e5;
    scene->groups[0].spheres[0].center.x -= 1e5;

    scene->materials[0].k_r.x = 0.1; /* a mirror enlarges the error: nothing is known */
    assert_true(turner_f64_can_show(scene, 8));
    scene->settings.depth = 0;
    assert_false(turner_f64_can_show(scene, 8));
    turner_scene_destroy(scene);
}

/* ---- warnings ---- */

/* What turner_advise writes to stderr. */
static void advice_of(char *text, size_t size, const struct turner_scene *scene, int bits)
{
    FILE *file = tmpfile();
    assert_non_null(file);
    fflush(stderr);
    int old = dup(STDERR_FILENO);
    dup2(fileno(file), STDERR_FILENO);
    turner_advise(scene, "s.json", bits);
    fflush(stderr);
    dup2(old, STDERR_FILENO);
    close(old);
    rewind(file);
    text[fread(text, 1, size - 1, file)] = 0;
    fclose(file);
}

#define ONE(material) "\"materials\": {\"m\": " material "}, \"primitives\": [" SPHERE "]"
#define LAMP "\"lights\": [{\"type\": \"point\", \"position\": [0, 4, 4], \"intensity\": 9}]"

static void warnings(void **state)
{
    (void)state;
    static const struct {
        const char *scene;
        int bits;
        const char *expected; /* part of the only warning; NULL: none */
    } cases[] = {
        /* depth */
        {"\"settings\": {\"depth\": 20}, " ONE("{\"k_d\": 1}"), 8, "depth 20, but nothing reflects"},
        {"\"settings\": {\"depth\": 0}, " ONE("{\"k_d\": 1}"), 8, NULL},
        {ONE("{\"k_d\": 1}"), 8, NULL}, /* the default: nobody asked */
        {"\"settings\": {\"depth\": 20, \"cutoff\": 0.01}, " ONE("{\"k_r\": 0.5}"), 8,
         "no ray deeper than 6 reaches the cutoff 0.01"},
        {"\"settings\": {\"depth\": 6, \"cutoff\": 0.01}, " ONE("{\"k_r\": 0.5}"), 8, NULL},
        {"\"settings\": {\"depth\": 20, \"cutoff\": 0}, " ONE("{\"k_r\": 0.5}"), 8, NULL},
        {"\"settings\": {\"depth\": 1000}, " ONE("{\"k_r\": 1}"), 8, NULL},
        /* materials that cannot be seen */
        {ONE("{\"k_t\": 1, \"k_r\": 1, \"index\": 1}"), 8, "material \"m\" cannot be seen"},
        {ONE("{\"k_t\": 1, \"index\": 1, \"fresnel\": \"none\"}"), 8, "cannot be seen"},
        {ONE("{\"k_t\": 0.9, \"index\": 1}"), 8, NULL},
        {ONE("{\"k_t\": 0.9, \"k_r\": 1, \"index\": 1}"), 8, "k_r of material \"m\" never shows"},
        {ONE("{\"k_t\": 1, \"index\": 1, \"absorption\": 1}"), 8, NULL},
        {ONE("{\"k_t\": 1, \"index\": 1.0001}"), 8, NULL},
        {ONE("{\"k_t\": 1, \"index\": 1, \"k_d\": 0.1}") ", " LAMP, 8, NULL},
        {ONE("{\"k_t\": 1, \"k_r\": 1, \"index\": 1, \"fresnel\": \"schlick\"}"), 8, NULL},
        {ONE("{\"k_t\": 1, \"k_r\": 1, \"index\": 1, \"fresnel\": \"none\"}"), 8, NULL},
        {"\"settings\": {\"shadows\": \"opaque\"}, " ONE("{\"k_t\": 1, \"index\": 1}") ", " LAMP, 8,
         NULL}, /* its shadow can */
        /* a bubble of index 1, in glass and in nothing but dye */
        {"\"media\": {\"glass\": {\"index\": 1.5}, \"air\": {\"index\": 1, \"priority\": 1}}, "
         "\"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"inside\": [\"glass\"]}, "
         ONE("{\"k_t\": 1, \"medium\": \"air\"}"), 8, NULL},
        {"\"media\": {\"dye\": {\"index\": 1, \"absorption\": 1}, \"air\": {\"index\": 1, "
         "\"priority\": 1}}, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"inside\": "
         "[\"dye\"]}, " ONE("{\"k_t\": 1, \"medium\": \"air\"}"), 8, NULL},
        /* samples */
        {"\"settings\": {\"spp\": 4}, \"background\": 1", 8, "4 samples per pixel"},
        {"\"settings\": {\"spp\": 4}, \"background\": {\"type\": \"gradient\", \"bottom\": 0, "
         "\"top\": 1}", 8, NULL},
        {"\"settings\": {\"spp\": 4}, " ONE("{\"k_d\": 1}"), 8, NULL},
        /* precision */
        {"\"settings\": {\"methods\": {\"precision\": \"f64\"}}, " ONE("{\"k_d\": 1}"), 8,
         "f32 is at the limit of a picture of 8 bits"},
        {"\"settings\": {\"methods\": {\"precision\": \"f64\"}}, " ONE("{\"k_d\": 1}"), 16, NULL},
        {"\"settings\": {\"methods\": {\"precision\": \"f64\"}}, " ONE("{\"k_d\": 1}"), 32, NULL},
        {"\"settings\": {\"methods\": {\"precision\": \"f64\"}}, " ONE("{\"k_d\": 1}"), 0, NULL},
        {"\"settings\": {\"methods\": {\"precision\": \"f64\"}}, " ONE("{\"k_r\": 1}"), 8, NULL},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *rest = cases[i].scene;
        struct turner_scene *scene;
        char text[8192], said[2048];
        bool camera = strstr(rest, "\"camera\"") != NULL;
        snprintf(text, sizeof text, "{\"version\": 1, %s%s}",
                 camera ? "" : "\"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}, ", rest);
        if (turner_scene_parse(&scene, text, strlen(text), "test.json") != TURNER_OK)
            fail_msg("%s: %s", text, turner_message());
        advice_of(said, sizeof said, scene, cases[i].bits);
        const char *line = strchr(said, '\n');
        if (cases[i].expected ? !strstr(said, cases[i].expected) || !line || line[1]
                              : said[0] != 0)
            fail_msg("%s, %d bits: \"%s\" instead of %s", rest, cases[i].bits, said,
                     cases[i].expected ? cases[i].expected : "nothing");
        turner_set_quiet(true);
        advice_of(said, sizeof said, scene, cases[i].bits);
        turner_set_quiet(false);
        assert_string_equal(said, "");
        turner_scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reasons),
        cmocka_unit_test(error_of_single_precision),
        cmocka_unit_test(warnings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
