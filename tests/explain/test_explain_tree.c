/* The reference's tree of rays: what it says adds up to what the reference draws. */
#include "explain_test.h"

#include <float.h>
#include <stdlib.h>

#include "reference/reference.h"
#include "reference/vector.h"

static void assert_ok(enum turner_result result)
{
    if (result != TURNER_OK)
        fail_msg("%s", turner_message());
}

/* A sum of `terms` positive products loses an ulp or so of itself with each. */
static void near(long double value, long double truth, size_t terms, const char *what)
{
    if (!(fabsl(value - truth) <= LDBL_EPSILON * (long double)(terms + 8) * fabsl(truth)))
        fail_msg("%s: %.21Lg instead of %.21Lg", what, value, truth);
}

static void check_weights(const struct turner_scene *scene, const struct turner_ray_tree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++) {
        const struct turner_ray_record *ray = &tree->rays[i];
        if (ray->parent == TURNER_NONE) {
            assert_int_equal(i, 0);
            continue;
        }
        assert_true(ray->parent < i && ray->depth == tree->rays[ray->parent].depth + 1);
        const struct turner_ray_record *parent = &tree->rays[ray->parent];
        assert_int_equal(parent->end, TURNER_RAY_SURFACE);
        const struct turner_material *material = &scene->materials[parent->place.material];
        const double k_r[3] = {material->k_r.x, material->k_r.y, material->k_r.z};
        const double k_t[3] = {material->k_t.x, material->k_t.y, material->k_t.z};
        bool metal = k_t[0] + k_t[1] + k_t[2] == 0 && !material->conductor;
        for (int c = 0; c < 3; c++) {
            long double f = parent->fresnel[c], factor = 1;
            if (ray->kind == TURNER_RAY_REFLECTED)
                factor = !parent->has_fresnel ? (long double)k_r[c] : metal ? f : k_r[c] * f;
            if (ray->kind == TURNER_RAY_REFRACTED)
                factor = parent->has_fresnel ? k_t[c] * (1 - f) : (long double)k_t[c];
            if (ray->kind == TURNER_RAY_REFLECTED && parent->total &&
                material->fresnel == TURNER_FRESNEL_NONE)
                factor = (long double)k_r[c] + k_t[c];
            near(ray->weight[c], parent->weight[c] * parent->through[c] * factor, 0, "a weight");
        }
    }
}

/* Each light of the scene once at a hit that asks them, and what it brings by its terms. */
static void check_lights(const struct turner_scene *scene, const struct turner_ray_tree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++) {
        const struct turner_ray_record *ray = &tree->rays[i];
        if (ray->end == TURNER_RAY_SURFACE && i + 1 < tree->count &&
            tree->rays[i + 1].kind == TURNER_RAY_SHADOW) {
            for (uint32_t j = 0; j < scene->light_count; j++) {
                assert_int_equal(tree->rays[i + 1 + j].kind, TURNER_RAY_SHADOW);
                assert_int_equal(tree->rays[i + 1 + j].light, j);
                assert_int_equal(tree->rays[i + 1 + j].parent, i);
            }
        }
        if (ray->kind != TURNER_RAY_SHADOW)
            continue;
        bool asked = ray->end == TURNER_RAY_LIGHT || ray->end == TURNER_RAY_BLOCKED ||
                     ray->end == TURNER_RAY_GIVEN_UP;
        assert_true(asked == (ray->n_l > 0 && ray->irradiance[0] + ray->irradiance[1] +
                                                      ray->irradiance[2] > 0));
        for (int c = 0; c < 3; c++) {
            long double sent = ray->weight[c] * ray->through[c] * ray->irradiance[c] *
                               (ray->diffuse[c] + ray->specular[c]);
            near(ray->contribution[c], ray->end == TURNER_RAY_LIGHT ? sent : 0, 4,
                 "a light's contribution");
        }
    }
}

static void adds_up(void **state)
{
    (void)state;
    static const char *const names[] = {SCENES};
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        struct turner_scene *scene = must_load(names[n]);
        struct turner_image image;
        assert_ok(turner_reference_render(&image, scene, 1, NULL, NULL, NULL));
        for (int i = 0; i < 12; i++) {
            int x = (5 + 7 * i) % image.width, y = (3 + 5 * i) % image.height;
            struct turner_ray_tree tree;
            long double sum[3];
            assert_ok(turner_reference_explain(&tree, scene, x + 0.5, y + 0.5));
            turner_ray_tree_sum(sum, &tree, 0);
            const float *pixel = image.rgba + 4 * (y * image.width + x);
            for (int c = 0; c < 3; c++) {
                near(sum[c], tree.radiance[c], tree.count, names[n]);
                assert_true((float)tree.radiance[c] == pixel[c]);
            }
            assert_true((float)tree.pruned == pixel[3]);
            assert_false(tree.truncated);
            check_weights(scene, &tree);
            check_lights(scene, &tree);
            turner_ray_tree_destroy(&tree);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* Straight through a glass ball: both faces reflect .04 (numerics: Fresnel at 0°, n = 1.5). */
static void glass_ball(void **state)
{
    (void)state;
    static const struct {
        enum turner_ray_kind kind;
        enum turner_ray_end end;
        uint32_t parent;
        double weight, t;
    } expected[] = {
        {TURNER_RAY_CAMERA, TURNER_RAY_SURFACE, TURNER_NONE, 1, 4},
        {TURNER_RAY_REFLECTED, TURNER_RAY_BACKGROUND, 0, .04, INFINITY},
        {TURNER_RAY_REFRACTED, TURNER_RAY_SURFACE, 0, .96, 2},
        {TURNER_RAY_REFLECTED, TURNER_RAY_SURFACE, 2, .96 * .04, 2},
        {TURNER_RAY_REFLECTED, TURNER_RAY_CUT, 3, .96 * .04 * .04, 0},
        {TURNER_RAY_REFRACTED, TURNER_RAY_CUT, 3, .96 * .04 * .96, 0},
        {TURNER_RAY_REFRACTED, TURNER_RAY_BACKGROUND, 2, .96 * .96, INFINITY},
    };
    enum { count = sizeof expected / sizeof *expected };
    struct turner_scene *scene = must_parse(GLASS_BALL);
    struct turner_ray_tree tree;
    assert_ok(turner_reference_explain(&tree, scene, 0.5, 0.5));
    assert_int_equal(tree.count, count);
    for (int i = 0; i < count; i++) {
        const struct turner_ray_record *ray = &tree.rays[i];
        assert_int_equal(ray->kind, expected[i].kind);
        assert_int_equal(ray->end, expected[i].end);
        assert_int_equal(ray->parent, expected[i].parent);
        assert_true(fabsl(ray->weight[1] - expected[i].weight) < 1e-15L);
        assert_true(ray->t == expected[i].t || fabsl(ray->t - expected[i].t) < 1e-14L);
        if (ray->end == TURNER_RAY_SURFACE)
            assert_true(ray->has_fresnel && fabsl(ray->fresnel[0] - .04L) < 1e-18L);
        assert_int_equal(ray->media_count, i == 2 || i == 3 || i == 4 ? 1 : 0);
    }
    assert_true(fabsl(tree.pruned - (long double)(.96 * .04)) < 1e-15L);
    assert_true(fabsl(tree.radiance[0] + tree.pruned - 1) < 1e-18L); /* a furnace */

    struct turner_vec3 radiance;
    double pruned;
    assert_ok(turner_reference_radiance(&radiance, &pruned, scene, scene->camera.from,
                                        turner_vec3_of(0, 0, -1)));
    long double sum[3];
    turner_ray_tree_sum(sum, &tree, 0);
    assert_true(fabs(radiance.x - (double)sum[0]) <= DBL_EPSILON);
    assert_true(pruned == (double)tree.pruned);
    turner_ray_tree_destroy(&tree);
    turner_scene_destroy(scene);
}

/* A shadow through two panes: both crossings are there, with what they let through. */
static void tinted_shadow(void **state)
{
    (void)state;
    struct turner_scene *scene = must_parse(
        "{\"version\": 1, \"camera\": {\"from\": [0, 2, 5], \"at\": [0, 0, 0]},"
        "\"settings\": {\"size\": [1, 1], \"depth\": 0},"
        "\"materials\": {\"floor\": {\"k_d\": 0.5},"
        "\"pane\": {\"k_t\": [1, 0.5, 0.25], \"index\": 1, \"absorption\": [0, 0, 2]}},"
        "\"primitives\": [{\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 1, 0],"
        "\"material\": \"floor\"},"
        "{\"type\": \"box\", \"min\": [-9, 3, -9], \"max\": [9, 4, 9], \"material\": \"pane\"}],"
        "\"lights\": [{\"type\": \"directional\", \"direction\": [0, -1, 0], \"irradiance\": 1}]}");
    struct turner_ray_tree tree;
    assert_ok(turner_reference_explain(&tree, scene, 0.5, 0.5));
    assert_int_equal(tree.count, 2);
    size_t crossings;
    assert_null(turner_ray_tree_crossings(&tree, 0, &crossings));
    const struct turner_ray_crossing *crossing = turner_ray_tree_crossings(&tree, 1, &crossings);
    assert_int_equal(crossings, 2);
    assert_true(fabsl(crossing[0].t - 3) < 1e-15L && fabsl(crossing[1].t - 4) < 1e-15L);
    assert_true(crossing[0].real && crossing[0].place.kind == TURNER_PRIMITIVE_TRIANGLE);
    const struct turner_ray_record *shadow = &tree.rays[1];
    assert_int_equal(shadow->end, TURNER_RAY_LIGHT);
    long double through[3] = {1, 0.25L, 0.0625L * expl(-2)};
    for (int c = 0; c < 3; c++) {
        /* rays start 256 ulps off the pane, of numbers up to 9 */
        assert_true(fabsl(shadow->through[c] - through[c]) < 1e-15L * through[c]);
        assert_true(fabsl(shadow->diffuse[c] - 0.5L / TURNER_REAL_PI) < 1e-18L);
        assert_true(shadow->specular[c] == 0);
    }
    assert_true(shadow->n_l == 1);
    turner_ray_tree_destroy(&tree);
    turner_scene_destroy(scene);
}

/* What is more than a tree may hold is missed, not kept. */
static void truncates(void **state)
{
    (void)state;
    struct turner_ray_tree tree = {.mantissa = LDBL_MANT_DIG};
    assert_int_equal(turner_ray_tree_add(&tree, TURNER_RAY_CAMERA, 0), 0);
    for (uint32_t i = 1; i < TURNER_RAY_TREE_MAX; i++)
        assert_int_equal(turner_ray_tree_add(&tree, TURNER_RAY_SHADOW, 1), i);
    assert_false(tree.truncated);
    assert_int_equal(turner_ray_tree_add(&tree, TURNER_RAY_SHADOW, 1), TURNER_NONE);
    assert_true(tree.truncated);
    turner_ray_tree_cross(&tree, TURNER_NONE, (struct turner_ray_place){0}, 1, true);
    assert_int_equal(tree.count, TURNER_RAY_TREE_MAX);
    assert_int_equal(tree.crossing_count, 0);
    turner_ray_tree_destroy(&tree);
}

static void names_what_is_not_finite(void **state)
{
    (void)state;
    struct turner_ray_tree tree = {.mantissa = 24};
    const char *quantity;
    for (int i = 0; i < 3; i++)
        turner_ray_tree_add(&tree, i ? TURNER_RAY_SHADOW : TURNER_RAY_CAMERA, i ? 1 : 0);
    tree.rays[0].t = tree.rays[2].t = INFINITY; /* the scene's end */
    assert_int_equal(turner_ray_tree_nonfinite(&tree, &quantity), TURNER_NONE);
    tree.rays[1].contribution[2] = tree.rays[2].contribution[2] = 3e38L;
    tree.radiance[2] = INFINITY;
    assert_int_equal(turner_ray_tree_nonfinite(&tree, &quantity), 2);
    assert_string_equal(quantity, "sum of the contributions so far");
    tree.rays[1].specular[0] = NAN;
    tree.rays[1].contribution[0] = NAN;
    tree.rays[2].weight[0] = INFINITY;
    assert_int_equal(turner_ray_tree_nonfinite(&tree, &quantity), 1);
    assert_string_equal(quantity, "specular term");
    tree.rays[0].end = TURNER_RAY_SURFACE; /* which is somewhere */
    assert_int_equal(turner_ray_tree_nonfinite(&tree, &quantity), 0);
    assert_string_equal(quantity, "t");
    turner_ray_tree_destroy(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(adds_up),       cmocka_unit_test(glass_ball),
        cmocka_unit_test(tinted_shadow), cmocka_unit_test(truncates),
        cmocka_unit_test(names_what_is_not_finite),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
