/* Small scenes at the edge of what is sensible, on the device and by the reference. */
#include "render_test.h"

#include "base/memory.h"
#include "image/image.h"

static struct rig rig;

#define SIZE "\"settings\": {\"size\": [48, 32]}, \"background\": [0.2, 0.3, 0.4], "
#define LIGHT "\"lights\": [{\"type\": \"point\", \"position\": [3, 5, 6], \"intensity\": 90}], "
#define MATERIALS \
    "\"materials\": {\"red\": {\"k_d\": [0.8, 0.1, 0.1], \"k_s\": 0.2, \"exponent\": 20}, " \
    "\"blue\": {\"k_d\": [0.1, 0.1, 0.8]}, \"mirror\": {\"k_r\": 0.8}, " \
    "\"glass\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5, \"absorption\": [0.1, 0.2, 0]}, " \
    "\"lamp\": {\"k_e\": 1}, \"dark\": {\"k_e\": 0.25}}, "
#define FLOOR "{\"type\": \"box\", \"min\": [-4, -1.5, -4], \"max\": [4, -1, 3], \"material\": " \
              "\"blue\"}"

static void check(const char *rest, double share)
{
    char text[16384];
    snprintf(text, sizeof text, "%s, %s}", SCENE_HEAD, rest);
    struct turner_scene *scene = scene_of(text);
    assert_true_picture(&rig, scene, share);
    turner_scene_destroy(scene);
}

static void nothing_at_all(void **state)
{
    (void)state;
    check(SIZE LIGHT "\"ambient\": 1", 0);
    check(SIZE "\"groups\": {\"empty\": []}, \"instances\": [{\"group\": \"empty\"}]", 0);
}

/* An empty child of the top level was entered once. */
static void one_small_group_beside_a_world(void **state)
{
    (void)state;
    check(SIZE LIGHT MATERIALS "\"primitives\": [" FLOOR ", {\"type\": \"sphere\", \"center\": "
          "[-1, 0, 0], \"radius\": 0.7, \"material\": \"red\"}], \"groups\": {\"ball\": [{\"type\":"
          " \"sphere\", \"center\": [0, 0, 0], \"radius\": 0.7, \"material\": \"mirror\"}]}, "
          "\"instances\": [{\"group\": \"ball\", \"transform\": {\"translate\": [1, 0, 0]}}]",
          0.01);
    check(SIZE LIGHT MATERIALS "\"groups\": {\"ball\": [{\"type\": \"sphere\", \"center\": "
          "[0, 0, 0], \"radius\": 1, \"material\": \"red\"}]}, \"instances\": [{\"group\": "
          "\"ball\"}]", 0.01);
}

/* The same things, made small or large or turned inside out by an instance. */
static void scaled_and_mirrored(void **state)
{
    (void)state;
    static const char *const steps[] = {
        "{\"scale\": 1e-3}", "{\"scale\": 1e3}", "{\"scale\": [-1, 1, 1]}",
        "{\"scale\": [1, -0.02, 50]}", "{\"scale\": [-1, -1, -1]}",
    };
    static const char *const sizes[][3] = {
        {"1000", "1000", "1000"}, {"0.001", "0.001", "0.001"}, {"1", "1", "1"},
        {"1", "50", "0.02"},     {"1", "1", "1"},
    };
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        bool uneven = i == 3; /* there only what stretching leaves exact: a box */
        char text[8192], ball[512];
        printf("%s\n", steps[i]);
        snprintf(ball, sizeof ball, ", {\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": "
                 "%s, \"material\": \"glass\"}", sizes[i][0]);
        snprintf(text, sizeof text, SIZE LIGHT MATERIALS "\"primitives\": [" FLOOR "], \"groups\": "
                 "{\"g\": [{\"type\": \"box\", \"min\": [-%s, -%s, -%s], \"max\": [%s, %s, %s], "
                 "\"material\": \"mirror\"}], \"h\": [{\"type\": \"cone\", \"base\": [0, 0, 0], "
                 "\"apex\": [0, %s, 0], \"base_radius\": %s, \"material\": \"red\"}%s]}, "
                 "\"instances\": [{\"group\": \"g\", \"transform\": [%s, {\"rotate\": 30, \"axis\":"
                 " [1, 2, 0]}, {\"scale\": 0.5}, {\"translate\": [1.2, 0, 0]}]}, {\"group\": \"h\","
                 " \"transform\": [%s, {\"scale\": 0.6}, {\"translate\": [-1, -0.3, 0]}]}]",
                 sizes[i][0], sizes[i][1], sizes[i][2], sizes[i][0], sizes[i][1], sizes[i][2],
                 sizes[i][1], sizes[i][0], uneven ? "" : ball, steps[i], steps[i]);
        check(text, 0.03);
    }
}

/* Two triangles, two spheres, two instances at one place: the one that comes first is seen. */
static void ties(void **state)
{
    (void)state;
    static const char *const shapes[] = {
        "\"type\": \"mesh\", \"positions\": [[-2, -2, 0], [2, -2, 0], [2, 2, 0], [-2, 2, 0]], "
        "\"triangles\": [[0, 1, 2], [0, 2, 3]]",
        "\"type\": \"mesh\", \"positions\": [[-3, -2, 0.5], [2, -2, -0.3], [0, 3, 0.1]], "
        "\"triangles\": [[0, 1, 2]]",
        "\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1",
        "\"type\": \"cylinder\", \"base\": [-1, -1, 0], \"apex\": [1, 1, 0.3], \"radius\": 0.5",
    };
    static const char *const orders[][2] = {{"lamp", "dark"}, {"dark", "lamp"}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        for (int order = 0; order < 2; order++) {
            const char *first = orders[order][0], *second = orders[order][1];
            char in_one[4096], in_two[4096];
            snprintf(in_one, sizeof in_one, SIZE MATERIALS "\"primitives\": [{%s, \"material\": "
                     "\"%s\"}, {%s, \"material\": \"%s\"}]", shapes[i], first, shapes[i], second);
            snprintf(in_two, sizeof in_two, SIZE MATERIALS "\"groups\": {\"g\": [{%s, \"material\":"
                     " \"red\"}]}, \"instances\": [{\"group\": \"g\", \"material\": \"%s\"}, "
                     "{\"group\": \"g\", \"material\": \"%s\"}]", shapes[i], first, second);
            printf("%s before %s\n", first, second);
            check(in_one, 0.005);
            check(in_two, 0.005);
        }
    }
}

/* Pixels of both traversals that are off by more than `relative` of their value and 1e-4. */
static int most_off(const struct turner_scene *scene, double relative)
{
    struct turner_image truth, image;
    struct turner_comparison comparison;
    int most = 0;
    assert_ok(turner_reference_render(&truth, scene, 0, NULL, NULL, NULL));
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        draw(&rig, &image, scene, traversal, NULL, NULL);
        assert_ok(turner_image_compare(&comparison, &image, &truth, 1e-4, relative));
        printf("  %s: %d of %d pixels off by more than %g\n",
               turner_traversal_name(rig.kernels[traversal].kind),
               (int)comparison.pixels_over, (int)comparison.pixels, relative);
        if ((int)comparison.pixels_over > most)
            most = (int)comparison.pixels_over;
        turner_image_destroy(&image);
    }
    turner_image_destroy(&truth);
    return most;
}

/* A world far away, of things of size 1 on multiples of 2⁻⁷, so that moving it moves nothing within
 * it. A point on a surface is rounded to the last bit of its coordinates, 2⁻¹⁴ at 1e3 and 2⁻⁷ at
 * 1e5, half of which is .5 % of the sphere's radius; that much its normal turns, and where light
 * grazes its shading changes by more. What is an edge's width moves by .06 of a pixel at 1e5. */
static void far_from_the_origin(void **state)
{
    (void)state;
    static const struct {
        double distance, relative;
        int pixels; /* of 1536 that may be off by more */
    } cases[] = {{0, 1e-3, 1}, {1000, 1e-3, 8}, {100000, 3e-2, 31}};
    struct turner_scene *scene = scene_of(
        SCENE_HEAD ", " SIZE MATERIALS LIGHT "\"primitives\": [" FLOOR ", {\"type\": \"sphere\", "
        "\"center\": [0, 0, 0], \"radius\": 0.75, \"material\": \"red\"}], \"groups\": {\"g\": ["
        "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 0.75, \"material\": \"red\"}, "
        "{\"type\": \"box\", \"min\": [-1.5, -0.75, -1], \"max\": [-1, 1, 0], \"material\": "
        "\"mirror\"}]}, \"instances\": [{\"group\": \"g\", \"transform\": {\"translate\": "
        "[-1.5, 0, -1]}}, {\"group\": \"g\", \"transform\": [{\"scale\": 0.5}, {\"translate\": "
        "[1.5, 0.5, 0]}]}]}");
    double moved = 0;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double by = cases[i].distance - moved;
        struct turner_vec3 way = {by, -by, by};
        moved = cases[i].distance;
        scene->camera.from = turner_vec3_add(scene->camera.from, way);
        scene->camera.at = turner_vec3_add(scene->camera.at, way);
        scene->lights[0].position = turner_vec3_add(scene->lights[0].position, way);
        scene->groups[0].spheres[0].center =
            turner_vec3_add(scene->groups[0].spheres[0].center, way);
        struct turner_mesh *box = &scene->groups[0].meshes[0];
        for (uint32_t k = 0; k < box->vertex_count; k++)
            box->positions[k] = turner_vec3_add(box->positions[k], way);
        for (size_t k = 0; k < scene->instance_count; k++) {
            struct turner_affine *transform = &scene->instances[k].transform;
            transform->m[0][3] += way.x;
            transform->m[1][3] += way.y;
            transform->m[2][3] += way.z;
        }
        assert_ok(turner_scene_validate(scene));
        printf("at %g\n", cases[i].distance);
        assert_true(most_off(scene, cases[i].relative) <= cases[i].pixels);
    }
    turner_scene_destroy(scene);
}

static void one_pixel(void **state)
{
    (void)state;
    check("\"settings\": {\"size\": [1, 1]}, " LIGHT MATERIALS "\"primitives\": [" FLOOR ", "
          "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"red\"}]",
          0);
    check("\"settings\": {\"size\": [1, 300]}, " LIGHT MATERIALS "\"primitives\": [" FLOOR "]",
          0.01);
    check("\"settings\": {\"size\": [300, 1]}, " LIGHT MATERIALS "\"primitives\": [" FLOOR "]",
          0.01);
}

/* The eye lies on the thing itself, which is not in its own way. */
static void camera_on_a_surface(void **state)
{
    (void)state;
    static const char *const things[] = {
        "{\"type\": \"sphere\", \"center\": [0, 0, 4], \"radius\": 1, \"material\": \"red\"}",
        "{\"type\": \"box\", \"min\": [-1, -1, 4], \"max\": [1, 1, 5], \"material\": \"red\"}",
        "{\"type\": \"plane\", \"point\": [0, 0, 5], \"normal\": [0, 0, 1], \"material\": \"red\"}",
        "{\"type\": \"plane\", \"point\": [0, 0, 5], \"normal\": [0, 1, 0], \"material\": \"red\"}",
        "{\"type\": \"cylinder\", \"base\": [0, 0, 4], \"apex\": [0, 0, 5], \"radius\": 1, "
        "\"material\": \"red\"}",
    };
    for (size_t i = 0; i < sizeof things / sizeof *things; i++) {
        char text[4096];
        printf("%s\n", things[i]);
        snprintf(text, sizeof text, SIZE LIGHT MATERIALS "\"primitives\": [%s, " FLOOR "]",
                 things[i]);
        check(text, 0.01);
    }
}

/* The ray through the middle of a single pixel meets the wall exactly where the light is. */
static void light_at_the_hit_point(void **state)
{
    (void)state;
    static const char *const lights[] = {
        "{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 9}",
        "{\"type\": \"point\", \"position\": [0, 0, 0], \"intensity\": 9, \"falloff\": \"none\"}",
        "{\"type\": \"spot\", \"position\": [0, 0, 0], \"direction\": [0, 0, -1], \"inner\": 10, "
        "\"outer\": 20, \"intensity\": 9}",
    };
    for (size_t i = 0; i < sizeof lights / sizeof *lights; i++) {
        char text[4096];
        snprintf(text, sizeof text, "\"settings\": {\"size\": [1, 1]}, \"ambient\": 0.5, "
                 "\"materials\": {\"m\": {\"k_d\": 0.5, \"k_a\": 0.5, \"k_s\": 0.5, \"exponent\": 9}}, "
                 "\"primitives\": [{\"type\": \"box\", \"min\": [-1, -1, -1], \"max\": [1, 1, 0], "
                 "\"material\": \"m\"}], \"lights\": [%s]", lights[i]);
        check(text, 0);
        char whole[16384];
        snprintf(whole, sizeof whole, "%s, %s}", SCENE_HEAD, text);
        struct turner_scene *scene = scene_of(whole);
        for (int traversal = 0; traversal < rig.traversals; traversal++) {
            struct turner_image image;
            draw(&rig, &image, scene, traversal, NULL, NULL);
            assert_true(image.rgba[0] == 0.25f); /* what the ambient light gives, and no more */
            turner_image_destroy(&image);
        }
        turner_scene_destroy(scene);
    }
}

static void a_thousand_lights(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of(
        SCENE_HEAD ", \"settings\": {\"size\": [24, 16]}, " MATERIALS "\"primitives\": [" FLOOR
        ", {\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"red\"}]}");
    for (int i = 0; i < 1000; i++) {
        double x = i % 10, y = i / 10 % 10, z = i / 100;
        *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) =
            (struct turner_light){
                .kind = TURNER_LIGHT_POINT,
                .position = {0.7 * x - 3.1, 0.5 * y + 1.3, 0.7 * z - 2.3},
                .power = {0.05, 0.04, 0.03},
            };
    }
    assert_ok(turner_scene_validate(scene));
    assert_true_picture(&rig, scene, 0.05);
    turner_scene_destroy(scene);
}

int main(void)
{
    rig_open(&rig);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_at_all),
        cmocka_unit_test(one_small_group_beside_a_world),
        cmocka_unit_test(scaled_and_mirrored),
        cmocka_unit_test(ties),
        cmocka_unit_test(far_from_the_origin),
        cmocka_unit_test(one_pixel),
        cmocka_unit_test(camera_on_a_surface),
        cmocka_unit_test(light_at_the_hit_point),
        cmocka_unit_test(a_thousand_lights),
    };
    return rig_close(&rig, cmocka_run_group_tests(tests, NULL, NULL));
}
