/* How NFF becomes a scene: docs/model.md, "NFF". */
#include <locale.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "base/number.h"
#include "nff_reading.h"

static void same(struct turner_vec3 v, double x, double y, double z)
{
    if (!(v.x == x && v.y == y && v.z == z))
        fail_msg("(%.17g, %.17g, %.17g) instead of (%.17g, %.17g, %.17g)", v.x, v.y, v.z, x, y, z);
}

static struct turner_scene *must_read(const char *text)
{
    struct turner_scene *scene = read_nff(text);
    if (!scene)
        fail_msg("%s", turner_message());
    return scene;
}

static void settings_and_camera(void **state)
{
    (void)state;
    struct turner_scene *scene = must_read("b .078 .361 .753\n" VIEW);
    const struct turner_settings *s = &scene->settings;
    assert_true(s->width == 20 && s->height == 10 && s->depth == 4 && s->spp == 1);
    assert_true(s->cutoff == 0 && s->exposure == 0 && !s->spd_rays && !s->spd_grid);
    assert_true(s->shading == TURNER_SHADING_PHONG && s->shadows == TURNER_SHADOWS_OPAQUE);
    assert_true(s->transfer == TURNER_TRANSFER_LINEAR);
    same(scene->camera.from, 1, 2, 3);
    same(scene->camera.at, 0, 0, 0);
    same(scene->camera.up, 0, 0, 1);
    assert_true(fabs(scene->camera.vfov - acos(-1) / 4) < 1e-15);
    assert_int_equal(scene->background.kind, TURNER_BACKGROUND_CONSTANT);
    same(scene->background.color, .078, .361, .753);
    same(scene->ambient, 0, 0, 0);
    turner_scene_destroy(scene);
}

static void lights_share_by_the_root_of_their_number(void **state)
{
    (void)state;
    struct turner_scene *scene = must_read(VIEW "l 1 2 3\nl 4 5 6 .5 .25 1\nl 0 0 0 l 7 8 9");
    assert_int_equal(scene->light_count, 4);
    for (size_t i = 0; i < 4; i++) {
        assert_int_equal(scene->lights[i].kind, TURNER_LIGHT_POINT);
        assert_int_equal(scene->lights[i].falloff, TURNER_FALLOFF_NONE);
    }
    same(scene->lights[0].position, 1, 2, 3);
    same(scene->lights[0].power, .5, .5, .5);
    same(scene->lights[1].position, 4, 5, 6);
    same(scene->lights[1].power, .25, .125, .5);
    same(scene->lights[3].position, 7, 8, 9);
    turner_scene_destroy(scene);
}

static void fills(void **state)
{
    (void)state;
    struct turner_scene *scene = must_read(
        VIEW "f 1 .5 .25 .5 .125 30 0 0\n s 0 0 0 1\n"   /* opaque: any index will do */
             "f 1 1 1 0 .1 100 .9 1.5\n s 0 0 0 2\n"     /* glass */
             "f 1 .5 .25 .5 .125 30 0 7\n s 0 0 0 3\n"   /* the first again */
             "f 1 0 0 1 0 3 .8 1.5\n s 0 0 0 4\n"        /* the same medium */
             "f 1 1 1 0 .1 100 .9 1.25\n s 0 0 0 5\n");  /* another one */
    assert_int_equal(scene->material_count, 4);
    assert_int_equal(scene->media_count, 2);
    const struct turner_material *m = scene->materials;
    same(m[0].k_d, .5, .25, .125);
    same(m[0].k_a, .5, .25, .125);
    same(m[0].k_s, .125, .125, .125);
    same(m[0].k_r, .125, .125, .125);
    same(m[0].k_t, 0, 0, 0);
    same(m[0].k_e, 0, 0, 0);
    assert_true(m[0].exponent == 30 && m[0].medium == TURNER_NONE);
    same(m[1].k_d, 0, 0, 0);
    same(m[1].k_s, .1, .1, .1);
    same(m[1].k_r, .1, .1, .1);
    same(m[1].k_t, .9, .9, .9);
    assert_true(m[1].exponent == 100 && m[1].medium == 0 && m[2].medium == 0 && m[3].medium == 1);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(m[i].fresnel, TURNER_FRESNEL_NONE);
        assert_int_equal(m[i].pattern, TURNER_PATTERN_NONE);
    }
    assert_true(scene->media[0].index == 1.5 && scene->media[1].index == 1.25);
    same(scene->media[0].absorption, 0, 0, 0);
    assert_int_equal(scene->groups[0].sphere_count, 5);
    static const uint32_t materials[] = {0, 1, 0, 2, 3};
    for (uint32_t i = 0; i < 5; i++)
        assert_int_equal(scene->groups[0].spheres[i].material, materials[i]);
    turner_scene_destroy(scene);
}

static void spheres_and_cones(void **state)
{
    (void)state;
    struct turner_scene *scene =
        must_read(VIEW "f 1 1 1 1 0 0 0 0 s 1 2 3 -4 c 1 2 3 -.5 4 5 6 0 c 0 0 0 1 0 0 1 1");
    const struct turner_group *world = &scene->groups[0];
    assert_true(world->sphere_count == 1 && world->cone_count == 2 && world->mesh_count == 0);
    same(world->spheres[0].center, 1, 2, 3);
    assert_true(world->spheres[0].radius == 4);
    const struct turner_cone *c = &world->cones[0];
    same(c->base, 1, 2, 3);
    same(c->apex, 4, 5, 6);
    assert_true(c->base_radius == .5 && c->apex_radius == 0 && !c->capped);
    turner_scene_destroy(scene);
}

static void polygons_and_patches_are_gathered_by_fill(void **state)
{
    (void)state;
    struct turner_scene *scene = must_read(
        VIEW "f 1 1 1 1 0 0 0 0  p 3 0 0 0 1 0 0 0 1 0\n"
             "f 1 1 1 .5 0 0 0 0 p 4 0 0 1 1 0 1 1 1 1 0 1 1\n"
             "f 1 1 1 1 0 0 0 0  p 4 5 0 0 5 1 0 5 1 1 5 0 1\n"
             "pp 4 0 0 0 0 0 2  1 0 0 0 3 4  1 1 0 0 0 0  0 1 0 0 0 -1\n");
    const struct turner_group *world = &scene->groups[0];
    assert_int_equal(world->mesh_count, 3);
    const struct turner_mesh *flat = &world->meshes[0], *other = &world->meshes[1],
                             *smooth = &world->meshes[2];
    assert_true(flat->material == 0 && other->material == 1 && smooth->material == 0);
    assert_true(flat->triangle_count == 3 && other->triangle_count == 2);
    assert_true(!flat->normals && !flat->uvs && !smooth->uvs);
    same(flat->positions[flat->triangles[0][1]], 1, 0, 0); /* the first polygon comes first */
    assert_true(flat->positions[flat->triangles[1][0]].x == 5);

    assert_int_equal(smooth->triangle_count, 2); /* the fan 0 1 2, 0 2 3 */
    static const double corners[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
    static const float normals[6][3] = {{0, 0, 1},    {0, .6f, .8f}, {0, 0, 1},
                                        {0, 0, 1}, {0, 0, 1},     {0, 0, -1}};
    for (int i = 0; i < 6; i++) {
        uint32_t vertex = smooth->triangles[i / 3][i % 3];
        same(smooth->positions[vertex], corners[i][0], corners[i][1], 0);
        for (int c = 0; c < 3; c++)
            assert_true(smooth->normals[vertex][c] == normals[i][c]);
    }
    turner_scene_destroy(scene);
}

static void concave_polygons_follow_newells_normal(void **state)
{
    (void)state;
    /* an arrow head, clockwise seen from +z */
    struct turner_scene *scene =
        must_read(VIEW "f 1 1 1 1 0 0 0 0 p 4 0 0 0  2 1 0  .5 0 0  2 -1 0");
    const struct turner_mesh *mesh = &scene->groups[0].meshes[0];
    double area = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        struct turner_vec3 n =
            turner_vec3_cross(turner_vec3_sub(mesh->positions[t[1]], mesh->positions[t[0]]),
                              turner_vec3_sub(mesh->positions[t[2]], mesh->positions[t[0]]));
        assert_true(n.z < 0);
        area -= n.z / 2;
    }
    assert_true(fabs(area - 0.5) < 1e-15);
    turner_scene_destroy(scene);
}

static void layout_of_the_text_is_free(void **state)
{
    (void)state;
    struct turner_scene *scene = must_read(
        "# a comment\r\n\tv\n from 1\n2 +3.#no blank\n at 0 0 0 up 0 0 1e0 angle 4.5E+1 hither -0\n"
        "resolution 20\t10 f 1 1 1 1 0 0 0 0 s 1e-3 -.5 00.25 1#end");
    same(scene->camera.from, 1, 2, 3);
    same(scene->groups[0].spheres[0].center, .001, -.5, .25);
    turner_scene_destroy(scene);
}

static void numbers_are_read_to_their_end(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        double value;
        size_t length;
    } cases[] = {
        {"1", 1, 1},          {"-1.5e3 2", -1500, 6},       {"+.25", .25, 4},  {"7.", 7, 2},
        {"1e999", INFINITY, 5}, {"-1E+999", -INFINITY, 7}, {"1e-999", 0, 6}, {"0x10", 0, 1},
        {"inf", 0, 0},        {"nan", 0, 0},                {"+-1", 0, 0},     {"+", 0, 0},
        {"", 0, 0},           {"1e", 1, 1},                 {"4.9e-324", 0x1p-1074, 8},
        {"2.2250738585072011e-308", 0x0.fffffffffffffp-1022, 23}, /* once PHP's endless loop */
        {"9007199254740993", 9007199254740992.0, 16}, /* halfway: to even */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double value;
        print_message("%s\n", cases[i].text);
        assert_int_equal(turner_number_read(&value, cases[i].text, strlen(cases[i].text)),
                         cases[i].length);
        assert_true(value == cases[i].value);
    }
}

static void decimal_commas_of_the_locale_do_not_matter(void **state)
{
    (void)state;
    /* the system's own compiler of locales makes one: there may be none with a comma installed */
    (void)!system("localedef --no-archive -c -i " TURNER_SOURCE_DIR "/tests/nff/data/comma.locale "
                  TURNER_BINARY_DIR "/comma >/dev/null 2>&1");
    setenv("LOCPATH", TURNER_BINARY_DIR, 1);
    if (!setlocale(LC_ALL, "comma")) {
        print_message("localedef made no locale with a decimal comma\n");
        skip();
    }
    assert_true(strtod("1,5", NULL) == 1.5);
    struct turner_scene *scene = must_read(VIEW "f 1 1 1 1 0 0 0 0 s .25 1.5 0 1");
    assert_true(strtod("1,5", NULL) == 1.5); /* as it was */
    setlocale(LC_ALL, "C");
    same(scene->groups[0].spheres[0].center, .25, 1.5, 0);
    turner_scene_destroy(scene);
}

static void what_has_no_area_is_left_out_with_one_warning(void **state)
{
    (void)state;
    struct caught caught = caught_begin();
    struct turner_scene *scene = read_nff(
        VIEW "f 1 1 1 1 0 0 0 0 s 0 0 0 0 s 0 0 0 1 c 0 0 0 0 1 1 1 0 c 1 1 1 2 1 1 1 2\n"
             "p 3 .1 .1 .1 .3 .3 .3 .7 .7 .7 pp 3 0 0 0 0 0 1 0 0 0 0 0 1 1 0 0 0 0 1\n"
             "pp 4 0 0 0 0 0 1 1 0 0 0 0 1 1 0 0 0 0 1 0 1 0 0 0 1"); /* half of it has an area */
    char *output = caught_end(&caught);
    assert_non_null(scene);
    assert_string_equal(output,
                        "turner: warning: test.nff: 5 primitives without area left out\n");
    free(output);
    const struct turner_group *world = &scene->groups[0];
    assert_true(world->sphere_count == 1 && world->cone_count == 0 && world->mesh_count == 1);
    assert_int_equal(world->meshes[0].triangle_count, 1);
    turner_scene_destroy(scene);
}

static void many_different_fills(void **state)
{
    (void)state;
    size_t count = 3000, capacity = 64 * count;
    char *text = malloc(capacity);
    assert_non_null(text);
    size_t length = (size_t)snprintf(text, capacity, VIEW);
    for (size_t i = 0; i < 2 * count; i++) /* each twice */
        length += (size_t)snprintf(text + length, capacity - length, "f 1 1 1 1 0 %zu 0 0\n",
                                   i % count);
    struct turner_scene *scene = must_read(text);
    assert_int_equal(scene->material_count, count);
    for (size_t i = 0; i < count; i++)
        assert_true(scene->materials[i].exponent == (double)i);
    turner_scene_destroy(scene);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(settings_and_camera),
        cmocka_unit_test(lights_share_by_the_root_of_their_number),
        cmocka_unit_test(fills),
        cmocka_unit_test(spheres_and_cones),
        cmocka_unit_test(polygons_and_patches_are_gathered_by_fill),
        cmocka_unit_test(concave_polygons_follow_newells_normal),
        cmocka_unit_test(layout_of_the_text_is_free),
        cmocka_unit_test(numbers_are_read_to_their_end),
        cmocka_unit_test(decimal_commas_of_the_locale_do_not_matter),
        cmocka_unit_test(what_has_no_area_is_left_out_with_one_warning),
        cmocka_unit_test(many_different_fills),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
