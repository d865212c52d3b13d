/* Cameras as text: what is printed is read back the same, and a scene file keeps the rest of its
 * text. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "scene/camera_file.h"
#include "scene/readers.h"

#define ASSERT_OK(call)                                  \
    do {                                                 \
        if ((call) != TURNER_OK)                         \
            fail_msg("%s: %s", #call, turner_message()); \
    } while (0)

static struct turner_scene *scene_of(const char *text)
{
    struct turner_scene *scene;
    ASSERT_OK(turner_scene_parse(&scene, text, strlen(text), "test.json"));
    return scene;
}

static void assert_same_camera(const struct turner_camera *a, const struct turner_camera *b)
{
    assert_memory_equal(&a->from, &b->from, sizeof a->from);
    assert_memory_equal(&a->at, &b->at, sizeof a->at);
    assert_true(turner_vec3_length(turner_vec3_sub(a->up, b->up)) < 1e-15);
    assert_true(fabs(a->vfov - b->vfov) <= 4e-16 * a->vfov);
    assert_int_equal(a->inside_count, b->inside_count);
}

static double any(void)
{
    double digits = rand() / (double)RAND_MAX - 0.5;
    return ldexp(digits, rand() % 40 - 20);
}

static void test_printed_and_read(void **state)
{
    (void)state;
    srand(2);
    for (int i = 0; i < 300; i++) {
        struct turner_scene *plain = scene_of(
            "{\"version\": 1, \"camera\": {\"from\": [1, 2, 3], \"at\": [0, 0, 0],"
            " \"inside\": [\"wa\\\"ter\"]}, \"media\": {\"wa\\\"ter\": {\"index\": 1.3}}}");
        struct turner_camera camera = plain->camera;
        camera.from = turner_vec3_of(any(), any(), any());
        camera.at = turner_vec3_of(any(), any() + 3, any());
        camera.vfov = 0.01 + 3 * (rand() / (double)RAND_MAX);
        char *json = turner_camera_json(&camera, plain), text[2000];
        snprintf(text, sizeof text, "{\"version\": 1, \"camera\": %s, \"media\": {\"wa\\\"ter\": "
                                    "{\"index\": 1.3}}}", json);
        struct turner_scene *again = scene_of(text);
        assert_same_camera(&again->camera, &camera);
        free(json);
        turner_scene_destroy(plain);
        turner_scene_destroy(again);
    }
}

static char name[] = "/tmp/turner-camera-XXXXXX";

static void put(const char *text)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, strlen(text), file), strlen(text));
    fclose(file);
}

static void assert_file(const char *wanted)
{
    char text[4096] = "";
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_int_equal(length, strlen(wanted));
    assert_string_equal(text, wanted);
}

static void test_stored(void **state)
{
    (void)state;
    struct turner_camera camera = {.from = {1.5, -2, 1e20}, .at = {0, 0.1, 0}, .up = {0, 1, 0},
                                   .vfov = 40 * acos(-1) / 180};
    put("\xEF\xBB\xBF{ \"version\":1,\t\"description\": \"{\\\"camera\\\": [\",\r\n"
        "  \"camera\" : {\"at\":[ 0,0.10,0 ],\n\t\"from\": [1,2,3] , \"up\":[0,2,0] },\"lights\":[]}");
    ASSERT_OK(turner_camera_store(name, 0, &camera));
    assert_file("\xEF\xBB\xBF{ \"version\":1,\t\"description\": \"{\\\"camera\\\": [\",\r\n"
                "  \"camera\" : {\"at\":[ 0,0.10,0 ],\n\t\"from\": [1.5, -2, 1e+20] , "
                "\"up\":[0,2,0] },\"lights\":[]}");
    camera.vfov = 55 * acos(-1) / 180;
    camera.up = turner_vec3_of(0, 0, 1);
    camera.from = turner_vec3_of(1, 2, 3);
    put("{\"cameras\": [{\"from\": [1,2,3], \"at\": [0,0,0]},\n {\"from\": [1,2,3], \"at\": "
        "[0,0,1]\n }], \"version\": 1}");
    ASSERT_OK(turner_camera_store(name, 2, &camera));
    assert_file("{\"cameras\": [{\"from\": [1,2,3], \"at\": [0,0,0]},\n {\"from\": [1,2,3], "
                "\"at\": [0, 0.1, 0], \"up\": [0, 0, 1], \"vfov\": 55\n }], \"version\": 1}");
}

static void test_not_stored(void **state)
{
    (void)state;
    struct turner_camera camera = {.at = {0, 0, 1}, .up = {0, 1, 0}, .vfov = 1};
    const char *const bad[] = {"{\"version\": 1}", "[]", "{\"camera\": 7}", "{\"camera\": {}",
                               "{\"cameras\": [{}]}", "", "v\nfrom 1 2 3\n"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        put(bad[i]);
        assert_int_equal(turner_camera_store(name, 0, &camera), TURNER_BAD_INPUT);
        assert_non_null(strstr(turner_message(), name));
        assert_file(bad[i]);
    }
    put("{\"cameras\": [{}]}");
    assert_int_equal(turner_camera_store(name, 2, &camera), TURNER_BAD_INPUT);
    assert_int_equal(turner_camera_store("/nowhere/a.json", 0, &camera), TURNER_BAD_INPUT);
}

static void test_cameras(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"media\": {\"b\": {\"index\": 1, \"priority\": 2}, \"a\": {\"index\": 1}},"
        " \"cameras\": [{\"from\": [1, 0, 0], \"at\": [0, 0, 0], \"inside\": [\"b\"]},"
        " {\"from\": [2, 0, 0], \"at\": [0, 0, 0], \"vfov\": 90}],"
        " \"camera\": {\"from\": [3, 0, 0], \"at\": [0, 0, 0], \"vfov\": 20}}");
    assert_int_equal(scene->camera_count, 2);
    assert_string_equal(scene->media[scene->cameras[0].inside[0]].name, "b");
    assert_true(fabs(scene->cameras[0].vfov - 40 * acos(-1) / 180) < 1e-15);
    assert_int_equal(turner_scene_use_camera(scene, 3), TURNER_USAGE);
    ASSERT_OK(turner_scene_use_camera(scene, 0));
    assert_true(scene->camera.from.x == 3);
    ASSERT_OK(turner_scene_use_camera(scene, 2));
    assert_true(scene->camera.from.x == 2);
    turner_scene_destroy(scene);

    struct turner_scene *none;
    const char *bad = "{\"version\": 1, \"camera\": {\"from\": [1,0,0], \"at\": [0,0,0]},\n"
                      "\"cameras\": [{\"from\": [1, 0, 0], \"at\": [1, 0, 0]}]}";
    assert_int_equal(turner_scene_parse(&none, bad, strlen(bad), "bad.json"), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "bad.json:2:"));
}

static void test_paths(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        "{\"version\": 1, \"camera\": {\"from\": [1, 0, 0], \"at\": [0, 0, 0]}}");
    struct turner_camera cameras[3] = {scene->camera, scene->camera, scene->camera};
    cameras[1].from.y = 0.1;
    cameras[2].vfov = 1;
    struct turner_camera_path path = {25, cameras, 3, 3}, again;
    ASSERT_OK(turner_camera_path_write(&path, name, scene));
    ASSERT_OK(turner_camera_path_load(&again, name, scene));
    assert_true(again.rate == 25);
    assert_int_equal(again.count, 3);
    for (int i = 0; i < 3; i++)
        assert_same_camera(&again.cameras[i], &cameras[i]);
    turner_camera_path_destroy(&again);
    const char *const bad[] = {
        "{\"version\": 2, \"cameras\": []}", "{\"version\": 1, \"cameras\": []}",
        "{\"version\": 1, \"rate\": 0, \"cameras\": [{\"from\": [1,0,0], \"at\": [0,0,0]}]}",
        "{\"version\": 1, \"cameras\": [{\"from\": [1,0,0], \"at\": [1,0,0]}]}",
        "{\"version\": 1, \"cameras\": [{\"from\": [1,0,0], \"to\": [1,0,0]}]}", "x"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        put(bad[i]);
        assert_int_equal(turner_camera_path_load(&again, name, scene), TURNER_BAD_INPUT);
        assert_non_null(strstr(turner_message(), name));
    }
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_printed_and_read), cmocka_unit_test(test_stored),
        cmocka_unit_test(test_not_stored),       cmocka_unit_test(test_cameras),
        cmocka_unit_test(test_paths),
    };
    int file = mkstemp(name);
    if (file < 0)
        return 1;
    close(file);
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(name);
    return failures;
}
