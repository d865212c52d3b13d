/* What JSON scenes become: every key, and every default. docs/scenes.md. */
#include <locale.h>
#include <stdlib.h>
#include <unistd.h>

#include "scene_reading.h"

static const double pi = 3.14159265358979323846;

static void defaults(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(HEAD "}");
    const struct turner_settings *s = &scene->settings;
    assert_true(s->width == 640 && s->height == 480 && s->depth == 8 && s->spp == 1);
    assert_true(s->cutoff == 1.0 / 512 && s->exposure == 0 && !s->spd_rays && !s->spd_grid);
    assert_int_equal(s->shading, TURNER_SHADING_ENERGY_CONSERVING);
    assert_int_equal(s->shadows, TURNER_SHADOWS_TINTED);
    assert_int_equal(s->transfer, TURNER_TRANSFER_SRGB);
    same(scene->camera.from, 0, 0, 5);
    same(scene->camera.at, 0, 0, 0);
    same(scene->camera.up, 0, 1, 0);
    assert_true(fabs(scene->camera.vfov - 40 * pi / 180) < 1e-15);
    assert_int_equal(scene->camera.inside_count, 0);
    same(scene->ambient, 0, 0, 0);
    assert_int_equal(scene->background.kind, TURNER_BACKGROUND_CONSTANT);
    same(scene->background.color, 0, 0, 0);
    assert_int_equal(scene->group_count, 1);
    assert_true(scene->material_count == 0 && scene->media_count == 0 && scene->light_count == 0);
    assert_null(scene->description);
    assert_string_equal(scene->path, "t.json");
    turner_scene_destroy(scene);
}

static void settings_and_camera(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        "\xEF\xBB\xBF{\"$schema\": \"schema.json\", \"version\": 1, \"description\": \"\\u00e4\", "
        "\"settings\": {\"size\": [64, 48], \"depth\": 3, \"cutoff\": 0, \"spp\": 16, \"shading\": "
        "\"phong\", \"shadows\": \"opaque\", \"exposure\": -1.5, \"transfer\": \"linear\", "
        "\"spd_rays\": true, \"spd_grid\": true}, \"camera\": {\"from\": [1, 2, 3], \"at\": [4, 5, "
        "6.5], \"up\": [0, 0, 2], \"vfov\": 90}, \"ambient\": [0.1, 0.2, 0.3], \"background\": "
        "{\"type\": \"gradient\", \"bottom\": 0.5, \"top\": [1, 2, 3], \"up\": [0, 0, 4]}}");
    const struct turner_settings *s = &scene->settings;
    assert_true(s->width == 64 && s->height == 48 && s->depth == 3 && s->spp == 16);
    assert_true(s->cutoff == 0 && s->exposure == -1.5 && s->spd_rays && s->spd_grid);
    assert_int_equal(s->shading, TURNER_SHADING_PHONG);
    assert_int_equal(s->shadows, TURNER_SHADOWS_OPAQUE);
    assert_int_equal(s->transfer, TURNER_TRANSFER_LINEAR);
    same(scene->camera.from, 1, 2, 3);
    same(scene->camera.at, 4, 5, 6.5);
    same(scene->camera.up, 0, 0, 1);
    assert_true(fabs(scene->camera.vfov - pi / 2) < 1e-15);
    same(scene->ambient, 0.1, 0.2, 0.3);
    assert_int_equal(scene->background.kind, TURNER_BACKGROUND_GRADIENT);
    same(scene->background.color, 0.5, 0.5, 0.5);
    same(scene->background.top, 1, 2, 3);
    same(scene->background.up, 0, 0, 1);
    assert_string_equal(scene->description, "\xC3\xA4");
    turner_scene_destroy(scene);
}

/* sRGB (IEC 61966-2-1): 0x80 is 0.215861 of linear light, 0x0a in the straight part. */
static void colors(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(HEAD ", \"ambient\": \"#80fF0a\", \"background\": 2}");
    assert_true(fabs(scene->ambient.x - 0.21586050011389926) < 1e-9);
    assert_true(scene->ambient.y == 1);
    assert_true(fabs(scene->ambient.z - 10 / 255.0 / 12.92) < 1e-9);
    same(scene->background.color, 2, 2, 2);
    turner_scene_destroy(scene);
}

static void media(void **state)
{
    (void)state;
    /* sorted by priority, then by order; "own" ones of materials come after those with names */
    struct turner_scene *scene = must_parse(
        "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0], \"inside\": "
        "[\"air\", \"oil\"]}, \"media\": {\"oil\": {\"index\": 1.4, \"priority\": 5, "
        "\"absorption\": [1, 2, 3]}, \"water\": {\"index\": 1.333}, \"air\": {\"index\": 1.0003, "
        "\"priority\": -1}}, \"materials\": {\"a\": {\"k_t\": 1, \"index\": 1.5}, \"b\": "
        "{\"k_t\": 1, \"index\": 1.5, \"absorption\": [0, 0, 1]}, \"c\": {\"k_t\": 0.5, \"index\": "
        "1.5}, \"d\": {\"k_t\": 1, \"medium\": \"water\"}, \"e\": {\"k_d\": 1, \"medium\": "
        "\"water\"}, \"f\": {\"index\": 3}}}");
    static const double indices[] = {1.0003, 1.333, 1.5, 1.5, 1.4};
    static const int priorities[] = {-1, 0, 0, 0, 5};
    assert_int_equal(scene->media_count, 5);
    for (size_t i = 0; i < 5; i++) {
        assert_true(scene->media[i].index == indices[i]);
        assert_int_equal(scene->media[i].priority, priorities[i]);
    }
    assert_string_equal(scene->media[4].name, "oil");
    assert_null(scene->media[2].name);
    same(scene->media[4].absorption, 1, 2, 3);
    same(scene->media[3].absorption, 0, 0, 1);
    static const uint32_t of_materials[] = {2, 3, 2, 1, TURNER_NONE, TURNER_NONE};
    for (size_t i = 0; i < 6; i++)
        assert_int_equal(scene->materials[i].medium, of_materials[i]);
    assert_int_equal(scene->camera.inside_count, 2);
    assert_true(scene->camera.inside[0] == 0 && scene->camera.inside[1] == 4);
    turner_scene_destroy(scene);
}

static void materials(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        HEAD ", \"materials\": {\"plain\": {}, \"all\": {\"k_e\": 1, \"k_a\": 2, \"k_d\": [3, 3, "
             "4], \"k_s\": 4, \"k_r\": 0.5, \"k_t\": 0.25, \"exponent\": 0, \"index\": 1.5, "
             "\"fresnel\": \"none\"}, \"glass\": {\"k_t\": 1, \"index\": 1.5}, \"mirror\": "
             "{\"k_r\": 0.9}, \"chrome\": {\"k_r\": 0.9, \"fresnel\": \"schlick\"}, \"iron\": "
             "{\"k_r\": 1, \"eta\": [2.9, 2.6, 2.2], \"k\": 3}, \"tiles\": {\"k_d\": 1, "
             "\"pattern\": {\"type\": \"checker\", \"colors\": [[1, 2, 3], 0.5], \"scale\": [2, "
             "-3]}}, \"cloth\": {\"pattern\": {\"type\": \"checker\", \"colors\": [0, 1], "
             "\"scale\": 7}}, \"rag\": {\"pattern\": {\"type\": \"checker\", \"colors\": [0, "
             "1]}}}}");
    const struct turner_material *m = scene->materials;
    assert_int_equal(scene->material_count, 9);
    assert_string_equal(m[1].name, "all");
    same(m[0].k_d, 0, 0, 0);
    assert_true(m[0].exponent == 1 && m[0].fresnel == TURNER_FRESNEL_NONE && !m[0].conductor);
    assert_true(m[0].pattern == TURNER_PATTERN_NONE && m[0].medium == TURNER_NONE);
    same(m[1].k_e, 1, 1, 1);
    same(m[1].k_a, 2, 2, 2);
    same(m[1].k_d, 3, 3, 4);
    same(m[1].k_s, 4, 4, 4);
    same(m[1].k_r, .5, .5, .5);
    same(m[1].k_t, .25, .25, .25);
    assert_true(m[1].exponent == 0 && m[1].fresnel == TURNER_FRESNEL_NONE);
    assert_int_equal(m[2].fresnel, TURNER_FRESNEL_EXACT);
    assert_int_equal(m[3].fresnel, TURNER_FRESNEL_NONE);
    assert_int_equal(m[4].fresnel, TURNER_FRESNEL_SCHLICK);
    assert_true(m[5].fresnel == TURNER_FRESNEL_EXACT && m[5].conductor);
    same(m[5].eta, 2.9, 2.6, 2.2);
    same(m[5].k, 3, 3, 3);
    assert_int_equal(m[6].pattern, TURNER_PATTERN_CHECKER);
    same(m[6].checker[0], 1, 2, 3);
    same(m[6].checker[1], .5, .5, .5);
    assert_true(m[6].uv_scale[0] == 2 && m[6].uv_scale[1] == -3);
    assert_true(m[7].uv_scale[0] == 7 && m[7].uv_scale[1] == 7);
    assert_true(m[8].uv_scale[0] == 1 && m[8].uv_scale[1] == 1);
    turner_scene_destroy(scene);
}

/* F at 0° of the measured metals, as published for RGB. */
static void metals(void **state)
{
    (void)state;
    static const double published[3][3] = {
        {.9667, .8020, .3241}, {.9748, .9575, .9063}, {.9520, .6198, .5106}};
    struct turner_scene *scene =
        must_parse(HEAD ", \"materials\": {\"a\": {\"k_r\": 1, \"metal\": \"gold\"}, \"b\": "
                        "{\"k_r\": 1, \"metal\": \"silver\"}, \"c\": {\"k_r\": 1, \"metal\": "
                        "\"copper\"}}}");
    for (int i = 0; i < 3; i++) {
        const struct turner_material *m = &scene->materials[i];
        assert_true(m->conductor && m->fresnel == TURNER_FRESNEL_EXACT);
        const double eta[3] = {m->eta.x, m->eta.y, m->eta.z}, k[3] = {m->k.x, m->k.y, m->k.z};
        for (int c = 0; c < 3; c++) {
            double f = ((eta[c] - 1) * (eta[c] - 1) + k[c] * k[c]) /
                       ((eta[c] + 1) * (eta[c] + 1) + k[c] * k[c]);
            if (!(fabs(f - published[i][c]) < 5e-4))
                fail_msg("metal %d channel %d: %g instead of %g", i, c, f, published[i][c]);
        }
    }
    turner_scene_destroy(scene);
}

/* "metal" alone is valid and black, which nobody means. */
static void a_metal_without_k_r_is_warned_of(void **state)
{
    (void)state;
    char line[256] = "";
    FILE *caught = tmpfile();
    int old = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
    struct turner_scene *scene =
        must_parse(HEAD ", \"materials\": {\"ring\": {\"metal\": \"gold\"}}}");
    dup2(old, STDERR_FILENO);
    close(old);
    rewind(caught);
    assert_non_null(fgets(line, sizeof line, caught));
    fclose(caught);
    assert_string_equal(line, "turner: warning: t.json: the metal \"ring\" reflects nothing; add "
                              "\"k_r\": 1\n");
    turner_scene_destroy(scene);
}

static void primitives(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        HEAD ", \"materials\": {\"m\": {}, \"n\": {}}, \"primitives\": ["
             "{\"type\": \"sphere\", \"center\": [1, 2, 3], \"radius\": 4, \"material\": \"n\"}, "
             "{\"type\": \"plane\", \"point\": [1, 2, 3], \"normal\": [0, 2, 0], \"material\": "
             "\"n\"}, {\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 0, -3], "
             "\"tangent\": [3, 4, 5], \"material\": \"m\"}, {\"type\": \"cone\", \"base\": [1, 1, "
             "1], \"base_radius\": 2, \"apex\": [3, 3, 3], \"material\": \"n\"}, {\"type\": "
             "\"cone\", \"base\": [1, 1, 1], \"base_radius\": 0, \"apex\": [3, 3, 3], "
             "\"apex_radius\": 5, \"capped\": false, \"material\": \"n\"}, {\"type\": "
             "\"cylinder\", \"base\": [0, 0, 0], \"apex\": [0, 1, 0], \"radius\": 0.5, "
             "\"material\": \"m\"}, {\"type\": \"box\", \"min\": [0, 0, 0], \"max\": [1, 2, 3], "
             "\"material\": \"n\"}]}");
    const struct turner_group *world = &scene->groups[0];
    assert_true(world->sphere_count == 1 && world->cone_count == 3 && world->mesh_count == 1);
    assert_int_equal(scene->plane_count, 2);
    same(world->spheres[0].center, 1, 2, 3);
    assert_true(world->spheres[0].radius == 4 && world->spheres[0].material == 1);
    same(scene->planes[0].point, 1, 2, 3);
    same(scene->planes[0].normal, 0, 1, 0);
    assert_true(turner_vec3_dot(scene->planes[0].normal, scene->planes[0].tangent) == 0);
    same(scene->planes[1].normal, 0, 0, -1);
    same(scene->planes[1].tangent, .6, .8, 0);
    assert_int_equal(scene->planes[1].material, 0);
    const struct turner_cone *cones = world->cones;
    same(cones[0].base, 1, 1, 1);
    same(cones[0].apex, 3, 3, 3);
    assert_true(cones[0].base_radius == 2 && cones[0].apex_radius == 0 && cones[0].capped);
    assert_true(cones[1].base_radius == 0 && cones[1].apex_radius == 5 && !cones[1].capped);
    assert_true(cones[2].base_radius == .5 && cones[2].apex_radius == .5 && cones[2].capped);
    assert_true(world->meshes[0].triangle_count == 12 && world->meshes[0].material == 1);
    turner_scene_destroy(scene);
}

#define SQUARE                                                                                     \
    "\"positions\": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], \"triangles\": [[0, 1, 2], [0, " \
    "2, 3]]"

static void meshes(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        HEAD ", \"materials\": {\"m\": {}, \"n\": {}}, \"meshes\": {\"square\": {" SQUARE ", "
             "\"smooth\": true, \"uvs\": [[0, 0], [1, 0], [1, 1], [0, 2]]}, \"bent\": {" SQUARE
             ", \"normals\": [[0, 0, 2], [0, 3, 4], [0, 0, 1], [0, 0, 1]]}, \"flat\": {" SQUARE
             ", \"normals\": [[0, 0, 2], [0, 3, 4], [0, 0, 1], [0, 0, 1]], \"smooth\": false}}, "
             "\"primitives\": [{\"type\": \"mesh\", \"mesh\": \"square\", \"material\": \"n\"}, "
             "{\"type\": \"mesh\", \"mesh\": \"bent\", \"material\": \"m\"}, {\"type\": "
             "\"mesh\", \"mesh\": \"flat\", \"material\": \"m\"}, {\"type\": \"mesh\", " SQUARE
             ", \"material\": \"n\"}], \"groups\": {\"g\": [{\"type\": \"mesh\", \"mesh\": "
             "\"square\", \"material\": \"m\"}]}}");
    const struct turner_group *world = &scene->groups[0];
    assert_int_equal(world->mesh_count, 4);
    const struct turner_mesh *square = &world->meshes[0], *bent = &world->meshes[1];
    assert_true(square->vertex_count == 4 && square->triangle_count == 2 && square->material == 1);
    same(square->positions[2], 1, 1, 0);
    assert_true(square->triangles[1][1] == 2 && square->triangles[1][2] == 3);
    assert_true(square->uvs[3][0] == 0 && square->uvs[3][1] == 2);
    assert_true(square->normals[3][2] == 1); /* smooth made them */
    assert_true(bent->normals && fabsf(bent->normals[1][1] - .6f) < 1e-6f);
    assert_null(bent->uvs);
    assert_null(world->meshes[2].normals);
    assert_true(!world->meshes[3].normals && world->meshes[3].material == 1);
    /* a mesh used twice is there twice */
    const struct turner_mesh *again = &scene->groups[1].meshes[0];
    assert_true(again->positions != square->positions && again->material == 0);
    same(again->positions[2], 1, 1, 0);
    turner_scene_destroy(scene);
}

static void instances(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        HEAD ", \"materials\": {\"m\": {}, \"n\": {}}, \"groups\": {\"a\": [], \"b\": "
             "[{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": "
             "\"m\"}]}, \"instances\": [{\"group\": \"b\"}, {\"group\": \"a\", \"material\": "
             "\"n\", \"transform\": [{\"translate\": [1, 0, 0]}, {\"rotate\": 90, \"axis\": [0, 0, "
             "2]}, {\"scale\": [1, 2, 3]}]}, {\"group\": \"b\", \"transform\": {\"scale\": -2}}, "
             "{\"group\": \"b\", \"transform\": {\"matrix\": [1, 2, 3, 4, 0, 1, 5, 6, 0, 0, 1, "
             "7]}}, {\"group\": \"b\", \"transform\": {\"rotate\": 120, \"axis\": [1, 1, 1]}}]}");
    const struct turner_instance *i = scene->instances;
    assert_int_equal(scene->instance_count, 5);
    assert_int_equal(scene->group_count, 3);
    assert_string_equal(scene->groups[2].name, "b");
    assert_true(i[0].group == 2 && i[0].material == TURNER_NONE);
    assert_true(i[1].group == 1 && i[1].material == 1);
    struct turner_vec3 p = {1, 2, 3};
    same(turner_affine_point(&i[0].transform, p), 1, 2, 3);
    /* first moved to (2, 2, 3), then turned to (−2, 2, 3), then stretched */
    same(turner_affine_point(&i[1].transform, p), -2, 4, 9);
    same(turner_affine_point(&i[2].transform, p), -2, -4, -6);
    same(turner_affine_point(&i[3].transform, p), 1 + 4 + 9 + 4, 2 + 15 + 6, 3 + 7);
    same(turner_affine_point(&i[4].transform, p), 3, 1, 2); /* x goes to y, y to z, z to x */
    turner_scene_destroy(scene);
}

static void lights(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        HEAD ", \"lights\": [{\"type\": \"point\", \"position\": [1, 2, 3], \"intensity\": [1, 2, "
             "3]}, {\"type\": \"point\", \"position\": [1, 2, 3], \"flux\": 4, \"falloff\": "
             "\"none\"}, {\"type\": \"directional\", \"direction\": [0, -3, 4], \"irradiance\": "
             "5}, {\"type\": \"spot\", \"position\": [0, 5, 0], \"at\": [0, 0, 0], \"inner\": 30, "
             "\"outer\": 60, \"flux\": 6}, {\"type\": \"spot\", \"position\": [0, 5, 0], "
             "\"direction\": [2, 0, 0], \"inner\": 0, \"outer\": 180, \"intensity\": 7}]}");
    const struct turner_light *l = scene->lights;
    assert_int_equal(scene->light_count, 5);
    assert_int_equal(l[0].kind, TURNER_LIGHT_POINT);
    assert_int_equal(l[0].falloff, TURNER_FALLOFF_INVERSE_SQUARE);
    same(l[0].position, 1, 2, 3);
    same(l[0].power, 1, 2, 3);
    assert_int_equal(l[1].falloff, TURNER_FALLOFF_NONE);
    same(l[1].power, 1 / pi, 1 / pi, 1 / pi);
    assert_int_equal(l[2].kind, TURNER_LIGHT_DIRECTIONAL);
    same(l[2].direction, 0, -.6, .8);
    same(l[2].power, 5, 5, 5);
    assert_int_equal(l[3].kind, TURNER_LIGHT_SPOT);
    same(l[3].direction, 0, -1, 0);
    assert_true(fabs(l[3].cos_inner - sqrt(.75)) < 1e-15 && fabs(l[3].cos_outer - .5) < 1e-15);
    double angle = 2 * pi * (1 - (sqrt(.75) + .5) / 2);
    same(l[3].power, 6 / angle, 6 / angle, 6 / angle);
    same(l[4].direction, 1, 0, 0);
    assert_true(l[4].cos_inner == 1 && l[4].cos_outer == -1);
    same(l[4].power, 7, 7, 7);
    turner_scene_destroy(scene);
}

/* Depths above 64 are for scenes in which no material both reflects and transmits. */
static void deep_where_nothing_branches(void **state)
{
    (void)state;
    turner_scene_destroy(must_parse(
        HEAD ", \"settings\": {\"depth\": 1024}, \"materials\": {\"mirror\": {\"k_r\": 1}, "
             "\"glass\": {\"k_t\": 1, \"index\": 1.5}}}"));
    turner_scene_destroy(must_parse(
        HEAD ", \"settings\": {\"depth\": 64}, \"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": "
             "1, \"index\": 1.5}}}"));
}

static void decimal_commas_of_the_locale_do_not_matter(void **state)
{
    (void)state;
    /* the system's own compiler of locales makes one: there may be none with a comma installed */
    (void)!system("localedef --no-archive -c -i " TURNER_SOURCE_DIR "/tests/nff/data/comma.locale "
                  TURNER_BINARY_DIR "/scene_comma >/dev/null 2>&1");
    setenv("LOCPATH", TURNER_BINARY_DIR, 1);
    if (!setlocale(LC_ALL, "scene_comma")) {
        print_message("localedef made no locale with a decimal comma\n");
        skip();
    }
    assert_true(strtod("1,5", NULL) == 1.5);
    struct turner_scene *scene = must_parse(HEAD ", \"ambient\": [0.25, 1.5e-1, 3]}");
    assert_true(strtod("1,5", NULL) == 1.5); /* as it was */
    setlocale(LC_ALL, "C");
    same(scene->ambient, .25, .15, 3);
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(defaults),
        cmocka_unit_test(settings_and_camera),
        cmocka_unit_test(colors),
        cmocka_unit_test(media),
        cmocka_unit_test(materials),
        cmocka_unit_test(metals),
        cmocka_unit_test(a_metal_without_k_r_is_warned_of),
        cmocka_unit_test(primitives),
        cmocka_unit_test(meshes),
        cmocka_unit_test(instances),
        cmocka_unit_test(lights),
        cmocka_unit_test(deep_where_nothing_branches),
        cmocka_unit_test(decimal_commas_of_the_locale_do_not_matter),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
