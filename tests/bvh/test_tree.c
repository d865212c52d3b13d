/* The trees themselves: every primitive in exactly one leaf, boxes that hold what is below them and
 * nothing more, levels, bounds on work, and bytes that do not change. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <cmocka.h>

#include "base/memory.h"
#include "bvh/build.h"
#include "scenes.h"

struct box {
    float lo[3], hi[3];
};

static const struct box nothing = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};

static void join(struct box *box, const float lo[3], const float hi[3])
{
    for (int axis = 0; axis < 3; axis++) {
        box->lo[axis] = fminf(box->lo[axis], lo[axis]);
        box->hi[axis] = fmaxf(box->hi[axis], hi[axis]);
    }
}

/* What has been seen of one tree. */
struct survey {
    const struct turner_flat *flat;
    uint8_t *leaves; /* how often each primitive (top level: instance) is in a leaf */
    uint8_t *nodes;
    uint32_t node_count;
    uint32_t largest_leaf;
    bool top;
};

/* Returns the levels from `node` down, and the union of what lies there. */
static uint32_t survey_node(struct survey *survey, uint32_t node, struct box *whole)
{
    const struct turner_flat *flat = survey->flat;
    assert_in_range(node, 0, flat->node_count - 1);
    assert_int_equal(survey->nodes[node]++, 0);
    survey->node_count++;
    const struct turner_gpu_node *n = &flat->nodes[node];
    uint32_t levels = 0;
    *whole = nothing;
    for (int side = 0; side < 2; side++) {
        const float *lo = side ? n->lo1 : n->lo0, *hi = side ? n->hi1 : n->hi0;
        if (lo[0] > hi[0]) { /* empty */
            for (int axis = 0; axis < 3; axis++) {
                assert_true(lo[axis] == FLT_MAX);
                assert_true(hi[axis] == -FLT_MAX);
            }
            assert_int_equal(n->count[side], 0);
            assert_int_equal(n->child[side], 0);
            continue;
        }
        struct box below = nothing;
        uint32_t count = n->count[side];
        if (count == 0) {
            uint32_t deep = survey_node(survey, n->child[side], &below);
            levels = deep > levels ? deep : levels;
        }
        survey->largest_leaf = count > survey->largest_leaf ? count : survey->largest_leaf;
        for (uint32_t i = n->child[side]; i < n->child[side] + count; i++) {
            struct box box;
            assert_in_range(i, 0, (survey->top ? flat->instance_count : flat->primitive_count) - 1);
            survey->leaves[i]++;
            if (survey->top) /* test_walk.c has the world bounds of instances */
                continue;
            turner_primitive_bounds(box.lo, box.hi, &flat->primitives[i]);
            join(&below, box.lo, box.hi);
        }
        if (!survey->top || count == 0)
            assert_true(memcmp(below.lo, lo, sizeof below.lo) == 0 &&
                        memcmp(below.hi, hi, sizeof below.hi) == 0);
        join(whole, lo, hi);
    }
    return levels + 1;
}

static void check_trees(const struct turner_flat *flat, const struct turner_scene *scene)
{
    struct survey survey = {.flat = flat,
                            .leaves = turner_calloc(flat->primitive_count + 1, 1),
                            .nodes = turner_calloc(flat->node_count, 1)};
    uint32_t deepest = 0;
    uint32_t *group_nodes = turner_calloc(scene->group_count, sizeof *group_nodes);
    for (size_t g = 0; g < scene->group_count; g++) {
        struct box whole;
        const struct turner_flat_group *group = &flat->groups[g];
        survey.node_count = 0;
        uint32_t levels = survey_node(&survey, group->root, &whole);
        group_nodes[g] = survey.node_count;
        assert_true(memcmp(whole.lo, group->lo, sizeof whole.lo) == 0);
        assert_true(memcmp(whole.hi, group->hi, sizeof whole.hi) == 0);
        assert_in_range(levels, 1, TURNER_BVH_MAX_LEVELS);
        deepest = levels > deepest ? levels : deepest;
    }
    assert_true(survey.largest_leaf <= TURNER_BVH_LEAF);
    for (size_t i = 0; i < flat->primitive_count; i++)
        assert_int_equal(survey.leaves[i], 1);
    free(survey.leaves);

    struct box whole;
    survey.leaves = turner_calloc(flat->instance_count, 1);
    survey.top = true;
    survey.node_count = survey.largest_leaf = 0;
    uint32_t levels = survey_node(&survey, flat->root, &whole);
    assert_true(survey.largest_leaf <= 1);
    uint64_t visits = survey.node_count + flat->instance_count;
    for (size_t i = 0; i < flat->instance_count; i++) {
        const struct turner_flat_group *group = &flat->groups[flat->instance_groups[i]];
        assert_int_equal(survey.leaves[i], group->lo[0] <= group->hi[0]);
        assert_int_equal(flat->instances[i].root, group->root);
        visits += group_nodes[flat->instance_groups[i]];
    }
    assert_int_equal(flat->max_visits, visits);
    assert_int_equal(flat->max_depth, levels + 1 + deepest);
    for (size_t i = 0; i < flat->node_count; i++)
        assert_int_equal(survey.nodes[i], 1); /* no node is lost */
    free(survey.leaves);
    free(survey.nodes);
    free(group_nodes);
}

static void assert_same_bytes(const void *a, const void *b, size_t count, size_t size)
{
    assert_true(count == 0 || memcmp(a, b, count * size) == 0);
}

static void assert_same(const struct turner_flat *a, const struct turner_flat *b)
{
    assert_int_equal(a->node_count, b->node_count);
    assert_int_equal(a->primitive_count, b->primitive_count);
    assert_same_bytes(a->nodes, b->nodes, a->node_count, sizeof *a->nodes);
    assert_same_bytes(a->primitives, b->primitives, a->primitive_count, sizeof *a->primitives);
    assert_same_bytes(a->instances, b->instances, a->instance_count, sizeof *a->instances);
    assert_int_equal(a->root, b->root);
    assert_int_equal(a->max_depth, b->max_depth);
}

static void check_scene(struct turner_scene *scene)
{
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    check_trees(&flat, scene);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

static void check_twice(struct turner_scene *scene)
{
    struct turner_flat flat, again;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(turner_flat_create(&again, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_same(&flat, &again);
    turner_flat_destroy(&flat);
    turner_flat_destroy(&again);
    check_scene(scene);
}

static void test_empty(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(flat.primitive_count, 0);
    assert_int_equal(flat.instance_count, 1);
    assert_int_equal(flat.node_count, 2);
    assert_true(flat.groups[0].lo[0] > flat.groups[0].hi[0]);
    check_trees(&flat, scene);
    turner_flat_destroy(&flat);
    turner_flat_destroy(&flat); /* zeroed: nothing happens */

    uint32_t group = add_group(scene); /* an empty group that is there twice */
    add_instance(scene, group, TURNER_NONE, make_transform(2, turner_vec3_of(1, 2, 3)));
    add_instance(scene, group, TURNER_NONE, make_transform(1, turner_vec3_of(1, 2, 3)));
    check_scene(scene);
}

static void test_few(void **state)
{
    (void)state;
    for (int count = 1; count < 12; count++) {
        uint64_t random = (uint64_t)count;
        struct turner_scene *scene = make_scene();
        for (int i = 0; i < count; i++)
            add_sphere(&scene->groups[0], random_point(&random, -1, 1), 0.1, 0);
        check_scene(scene);
    }
}

static void test_random(void **state)
{
    (void)state;
    uint64_t random = 4;
    for (int i = 0; i < 20; i++)
        check_twice(make_random_scene(&random));
}

static void test_coincident(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    for (int i = 0; i < 100000; i++)
        add_sphere(&scene->groups[0], turner_vec3_of(1, 2, 3), 0.5, 0);
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    /* halving: 100000 / 4 leaves need 15 levels */
    assert_int_equal(flat.max_depth, 1 + 1 + 15);
    check_trees(&flat, scene);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

static void test_coincident_instances(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    uint32_t group = add_group(scene);
    add_sphere(&scene->groups[group], turner_vec3_of(0, 0, 0), 1, 0);
    for (int i = 0; i < 5000; i++)
        add_instance(scene, group, TURNER_NONE, make_transform(2, turner_vec3_of(1, 2, 3)));
    check_scene(scene);
}

static void test_line(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    struct turner_group *group = &scene->groups[0];
    uint64_t random = 5;
    struct turner_mesh *mesh = add_soup(group, &random, 100000, 0, 0);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) /* triangles that are points on a line */
        mesh->positions[i] = turner_vec3_of(i / 3 * 1e-3, 0, 0);
    check_scene(scene);
}

/* Positions that halve towards 0: a plane between bins cuts off only the outermost few, so that
 * the heuristic alone would go one level deeper for each. */
static void test_halving_towards_zero(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    for (int exponent = -120; exponent < 120; exponent++) {
        for (int i = 0; i < 200; i++) {
            double x = ldexp(1, exponent);
            add_sphere(&scene->groups[0], turner_vec3_of(x, x, x), x * 1e-3, 0);
        }
    }
    check_scene(scene);
}

static void test_extremes(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    uint64_t random = 6;
    for (int i = 0; i < 1000; i++) {
        /* areas overflow a float here, and vanish there */
        add_sphere(&scene->groups[0], random_point(&random, -1e38, 1e38), 1e36, 0);
        add_sphere(&scene->groups[0], random_point(&random, -1e-38, 1e-38), 1e-39, 0);
    }
    check_scene(scene);
}

/* Halves [first, first + count) as lavapipe does and sees that the halves lie apart along the
 * widest axis of the centres. */
static void check_halves(const struct turner_gpu_primitive *primitives, uint32_t count)
{
    if (count <= 2)
        return;
    float(*centers)[3] = turner_calloc(count, sizeof *centers);
    struct box whole = nothing;
    for (uint32_t i = 0; i < count; i++) {
        float lo[3], hi[3];
        turner_primitive_bounds(lo, hi, &primitives[i]);
        for (int axis = 0; axis < 3; axis++)
            centers[i][axis] = 0.5f * lo[axis] + 0.5f * hi[axis];
        join(&whole, centers[i], centers[i]);
    }
    int widest = 0;
    for (int axis = 1; axis < 3; axis++) {
        if (whole.hi[axis] - whole.lo[axis] > whole.hi[widest] - whole.lo[widest])
            widest = axis;
    }
    uint32_t last = count - 1, half = last / 2 + 1; /* 0…last/2, and the rest */
    float most = -FLT_MAX, least = FLT_MAX;
    for (uint32_t i = 0; i < half; i++)
        most = fmaxf(most, centers[i][widest]);
    for (uint32_t i = half; i < count; i++)
        least = fminf(least, centers[i][widest]);
    assert_true(most <= least);
    free(centers);
    check_halves(primitives, half);
    check_halves(primitives + half, count - half);
}

static void test_median_order(void **state)
{
    (void)state;
    uint64_t random = 7;
    struct turner_scene *scene = make_scene();
    fill_group(&scene->groups[0], &random, 777, 123, 1001);
    uint32_t second = add_group(scene);
    fill_group(&scene->groups[second], &random, 0, 3, 0);
    add_instance(scene, second, TURNER_NONE, make_transform(1, turner_vec3_of(5, 0, 0)));
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_MEDIAN), TURNER_OK);
    assert_int_equal(flat.node_count, 0);
    assert_null(flat.nodes);
    const uint32_t expected[2][4] = {{0, 1001, 1001, 900}, {1901, 0, 1901, 3}};
    for (size_t g = 0; g < 2; g++) {
        const struct turner_flat_group *group = &flat.groups[g];
        assert_int_equal(group->triangles, expected[g][0]);
        assert_int_equal(group->triangle_count, expected[g][1]);
        assert_int_equal(group->boxes, expected[g][2]);
        assert_int_equal(group->box_count, expected[g][3]);
        assert_int_equal(flat.instances[g].triangles, group->triangles);
        assert_int_equal(flat.instances[g].boxes, group->boxes);
        for (uint32_t i = 0; i < group->triangle_count; i++)
            assert_int_equal(flat.primitives[group->triangles + i].id >> TURNER_KIND_SHIFT,
                             TURNER_KIND_TRIANGLE);
        for (uint32_t i = 0; i < group->box_count; i++)
            assert_int_not_equal(flat.primitives[group->boxes + i].id >> TURNER_KIND_SHIFT,
                                 TURNER_KIND_TRIANGLE);
        check_halves(flat.primitives + group->triangles, group->triangle_count);
        check_halves(flat.primitives + group->boxes, group->box_count);
    }
    struct turner_flat again;
    assert_int_equal(turner_flat_create(&again, scene, TURNER_ORDER_MEDIAN), TURNER_OK);
    assert_same(&flat, &again);
    turner_flat_destroy(&flat);
    turner_flat_destroy(&again);
    turner_scene_destroy(scene);
}

static void check_and_print(const char *name, struct turner_scene *scene, size_t most_bytes)
{
    for (int order = TURNER_ORDER_SAH; order <= TURNER_ORDER_MEDIAN; order++) {
        struct turner_flat flat;
        struct timespec start, end;
        clock_gettime(CLOCK_MONOTONIC, &start);
        assert_int_equal(turner_flat_create(&flat, scene, (enum turner_order)order), TURNER_OK);
        clock_gettime(CLOCK_MONOTONIC, &end);
        double seconds =
            (double)(end.tv_sec - start.tv_sec) + 1e-9 * (double)(end.tv_nsec - start.tv_nsec);
        size_t bytes =
            flat.primitive_count * sizeof *flat.primitives + flat.node_count * sizeof *flat.nodes;
        printf("%s, %zu primitives, %s: %.1f ms, %.1f bytes each\n", name, flat.primitive_count,
               order == TURNER_ORDER_SAH ? "SAH" : "median", seconds * 1e3,
               (double)bytes / (double)flat.primitive_count);
        assert_true(bytes <= most_bytes * flat.primitive_count);
        if (order == TURNER_ORDER_SAH)
            check_trees(&flat, scene);
        turner_flat_destroy(&flat);
    }
    turner_scene_destroy(scene);
}

static void test_size_and_time(void **state)
{
    (void)state;
    struct turner_scene *flake = make_scene(), *ball = make_scene();
    add_flake(&flake->groups[0], turner_vec3_of(0, 0, 0), 1, turner_vec3_of(0, 0, 1), 5);
    add_ball(&ball->groups[0], 224, 0);
    check_and_print("sphereflake", flake, 120);
    check_and_print("ball", ball, 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty),
        cmocka_unit_test(test_few),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_coincident),
        cmocka_unit_test(test_coincident_instances),
        cmocka_unit_test(test_line),
        cmocka_unit_test(test_halving_towards_zero),
        cmocka_unit_test(test_extremes),
        cmocka_unit_test(test_median_order),
        cmocka_unit_test(test_size_and_time),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
