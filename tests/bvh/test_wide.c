/* Trees of four children a node: every primitive in exactly one leaf, boxes on their grid that hold
 * what is below them and no step more, bounds on stacks and work that the worst walk keeps to. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "bvh/build.h"
#include "bvh/wide.h"
#include "scenes.h"

struct survey {
    const struct turner_flat *flat;
    uint8_t *leaves; /* how often each primitive (top level: instance) is in a leaf */
    uint8_t *nodes;
    uint64_t node_count;
    bool top;
};

static void grow(struct turner_bvh_bounds *box, const struct turner_bvh_bounds *by)
{
    for (int axis = 0; axis < 3; axis++) {
        box->lo[axis] = fminf(box->lo[axis], by->lo[axis]);
        box->hi[axis] = fmaxf(box->hi[axis], by->hi[axis]);
    }
}

static bool is_power_of_two(float x)
{
    int exponent;
    return frexpf(x, &exponent) == 0.5f;
}

/* The planes of a child hold `below`, and the next ones on the grid lie within it (at its side where
 * the grid is finer than floats are). */
static void check_planes(const struct turner_gpu_wide_node *node, int child,
                         const struct turner_bvh_bounds *below)
{
    for (int axis = 0; axis < 3; axis++) {
        const struct turner_gpu_face *face = &node->face[2 * axis];
        assert_true(is_power_of_two(face[1].grid) && face[1].grid >= FLT_MIN);
        assert_true(turner_bvh_wide_plane(node, child, axis, 0) <= below->lo[axis]);
        assert_true(turner_bvh_wide_plane(node, child, axis, 1) >= below->hi[axis]);
        struct turner_gpu_wide_node tighter = *node;
        uint32_t step = 1u << (8 * child), mask = 0xffu * step;
        if ((face[0].planes & mask) != mask) {
            tighter.face[2 * axis].planes += step;
            float plane = turner_bvh_wide_plane(&tighter, child, axis, 0);
            assert_true(plane >= below->lo[axis]);
        }
        if (face[1].planes & mask) {
            tighter.face[2 * axis + 1].planes -= step;
            float plane = turner_bvh_wide_plane(&tighter, child, axis, 1);
            assert_true(plane <= below->hi[axis]);
        }
    }
}

/* Surveys the tree from `node` down into *whole; returns the most entries of a walk that puts every
 * child on its stack, takes one, and always finds the deepest last. */
static uint32_t survey_node(struct survey *survey, uint32_t node, struct turner_bvh_bounds *whole)
{
    const struct turner_flat *flat = survey->flat;
    assert_in_range(node, 0, flat->node_count - 1);
    assert_int_equal(survey->nodes[node]++, 0);
    survey->node_count++;
    const struct turner_gpu_wide_node *n = &flat->wide[node];
    *whole = TURNER_BVH_EMPTY;
    uint32_t children = 0, deepest = 0;
    for (int i = 0; i < 4; i++) {
        uint32_t child = n->child[i];
        if (child == 0)
            continue;
        children++;
        struct turner_bvh_bounds below = TURNER_BVH_EMPTY;
        uint32_t entries = 1;
        if (!(child & TURNER_WIDE_LEAF)) {
            entries = survey_node(survey, child, &below);
        } else {
            uint32_t first = child & TURNER_WIDE_FIRST;
            uint32_t count = ((child & ~TURNER_WIDE_LEAF) >> TURNER_WIDE_COUNT_SHIFT) + 1;
            assert_in_range(count, 1, survey->top ? 1 : TURNER_BVH_LEAF);
            for (uint32_t p = first; p < first + count; p++) {
                struct turner_bvh_bounds box;
                survey->leaves[p]++;
                if (survey->top) /* test_walk.c has the world bounds of instances */
                    continue;
                turner_primitive_bounds(box.lo, box.hi, &flat->primitives[p]);
                grow(&below, &box);
            }
        }
        deepest = entries > deepest ? entries : deepest;
        if (!survey->top)
            check_planes(n, i, &below);
        grow(whole, &below);
    }
    return children ? children - 1 + deepest : 0;
}

static void check_scene(struct turner_scene *scene)
{
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_WIDE), TURNER_OK);
    assert_null(flat.nodes);
    struct survey survey = {.flat = &flat,
                            .leaves = turner_calloc(flat.primitive_count + 1, 1),
                            .nodes = turner_calloc(flat.node_count, 1)};
    uint64_t *group_nodes = turner_calloc(scene->group_count, sizeof *group_nodes);
    uint32_t most = 0;
    struct turner_bvh_bounds whole;
    for (size_t g = 0; g < scene->group_count; g++) {
        survey.node_count = 0;
        uint32_t entries = survey_node(&survey, flat.groups[g].root, &whole);
        most = entries > most ? entries : most;
        group_nodes[g] = survey.node_count;
        assert_true(memcmp(whole.lo, flat.groups[g].lo, sizeof whole.lo) == 0);
        assert_true(memcmp(whole.hi, flat.groups[g].hi, sizeof whole.hi) == 0);
    }
    for (size_t i = 0; i < flat.primitive_count; i++)
        assert_int_equal(survey.leaves[i], 1);
    free(survey.leaves);

    survey.leaves = turner_calloc(flat.instance_count, 1);
    survey.top = true;
    survey.node_count = 0;
    uint32_t entries = survey_node(&survey, flat.root, &whole);
    uint64_t visits = survey.node_count + flat.instance_count;
    for (size_t i = 0; i < flat.instance_count; i++) {
        const struct turner_flat_group *group = &flat.groups[flat.instance_groups[i]];
        assert_int_equal(survey.leaves[i], group->lo[0] <= group->hi[0]);
        assert_int_equal(flat.instances[i].root, group->root);
        visits += group_nodes[flat.instance_groups[i]];
    }
    assert_int_equal(flat.max_visits, visits);
    assert_int_equal(flat.max_depth, 1 + (entries > most ? entries : most));
    for (size_t i = 0; i < flat.node_count; i++)
        assert_int_equal(survey.nodes[i], 1); /* no node is lost */
    free(survey.leaves);
    free(survey.nodes);
    free(group_nodes);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

static void test_few(void **state)
{
    (void)state;
    for (int count = 0; count < 24; count++) {
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
        check_scene(make_random_scene(&random));
}

/* Where numbers are far apart, tiny, huge, or of all sizes at once. */
static void test_sizes(void **state)
{
    (void)state;
    static const struct {
        double at, radius;
    } places[] = {{0, 1e-30}, {0, 1e30}, {1e7, 1e-3}, {-1e30, 1}, {1e34, 1e34}, {1, 1e-7}};
    for (size_t place = 0; place < sizeof places / sizeof *places; place++) {
        uint64_t random = 9;
        struct turner_scene *scene = make_scene();
        double at = places[place].at, r = places[place].radius;
        for (int i = 0; i < 500; i++)
            add_sphere(&scene->groups[0],
                       turner_vec3_add(turner_vec3_of(at, -at, at / 3),
                                       random_point(&random, -10 * r, 10 * r)), r, 0);
        add_sphere(&scene->groups[0], turner_vec3_of(at, 1000 * r, 0), 1000 * r, 0);
        check_scene(scene);
    }
}

static void test_coincident(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    for (int i = 0; i < 100000; i++)
        add_sphere(&scene->groups[0], turner_vec3_of(1, 2, 3), 0.5, 0);
    uint32_t group = add_group(scene);
    add_sphere(&scene->groups[group], turner_vec3_of(0, 0, 0), 1, 0);
    for (int i = 0; i < 5000; i++)
        add_instance(scene, group, TURNER_NONE, make_transform(2, turner_vec3_of(1, 2, 3)));
    check_scene(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_few),
        cmocka_unit_test(test_random),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_coincident),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
