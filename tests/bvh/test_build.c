/* The builder itself: one tree for any number of threads, as good as one that tries every plane,
 * and what it does with items that cannot be divided. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "bvh/split.h"
#include "scenes.h"

struct tree {
    struct turner_bvh_item *items;
    struct turner_gpu_node *nodes;
    size_t node_count;
    uint32_t count, levels;
};

static void build(struct tree *tree, const struct turner_bvh_item *items, uint32_t count,
                  uint32_t leaf, unsigned threads)
{
    struct turner_bvh_item *spare = turner_calloc(count, sizeof *spare);
    memset(spare, 0xa5, count * sizeof *spare);
    tree->count = count;
    tree->items = turner_calloc(count, sizeof *tree->items);
    tree->nodes = turner_calloc(count, sizeof *tree->nodes);
    tree->node_count = 0;
    memcpy(tree->items, items, count * sizeof *items);
    turner_parallel_limit(threads);
    tree->levels =
        turner_bvh_build(tree->nodes, &tree->node_count, tree->items, spare, count, leaf, 100);
    turner_parallel_limit(0);
    free(spare);
}

static void destroy(struct tree *tree)
{
    free(tree->items);
    free(tree->nodes);
}

/* ---- items ---- */

/* Boxes of 1000 sizes in a cube. */
static void fill_random(struct turner_bvh_item *items, uint32_t count, uint64_t seed)
{
    for (uint32_t i = 0; i < count; i++) {
        double size = 1e-4 * pow(10, 3 * pow(random_in(&seed, 0, 1), 4));
        for (int axis = 0; axis < 3; axis++) {
            double center = random_in(&seed, -1, 1), half = size * random_in(&seed, 0.1, 1);
            items[i].lo[axis] = (float)(center - half);
            items[i].hi[axis] = (float)(center + half);
        }
        items[i].index = i;
    }
}

static void fill_points(struct turner_bvh_item *items, uint32_t count, float x, float step)
{
    for (uint32_t i = 0; i < count; i++) {
        items[i] = (struct turner_bvh_item){.index = i};
        items[i].lo[0] = items[i].hi[0] = x + step * (float)(i * 7919 % count);
    }
}

/* Halving towards 0: the heuristic alone would cut off one place a level. */
static void fill_halving(struct turner_bvh_item *items, uint32_t count)
{
    fill_points(items, count, 0, 0);
    for (uint32_t i = 0; i < count; i++) {
        for (int axis = 0; axis < 3; axis++)
            items[i].lo[axis] = items[i].hi[axis] = ldexpf(1, 120 - (int)(i * 240 / count));
    }
}

/* ---- threads ---- */

static void check_same(const struct turner_bvh_item *items, uint32_t count, uint32_t leaf)
{
    static const unsigned threads[] = {2, 7};
    struct tree one, more;
    build(&one, items, count, leaf, 1);
    assert_in_range(one.levels, 1, TURNER_BVH_MAX_LEVELS);
    for (int i = 0; i < 2; i++) {
        build(&more, items, count, leaf, threads[i]);
        assert_int_equal(one.levels, more.levels);
        assert_int_equal(one.node_count, more.node_count);
        assert_memory_equal(one.nodes, more.nodes, one.node_count * sizeof *one.nodes);
        assert_memory_equal(one.items, more.items, count * sizeof *items);
        destroy(&more);
    }
    destroy(&one);
}

static void test_threads(void **state)
{
    (void)state;
    const uint32_t count = 40009;
    struct turner_bvh_item *items = turner_calloc(count, sizeof *items);
    fill_random(items, count, 1);
    check_same(items, count, 4);
    check_same(items, count, 1);
    check_same(items, 16385, 4); /* one level above the subtrees */
    check_same(items, 16384, 4); /* none */
    fill_points(items, count, 3, 0);
    check_same(items, count, 4);
    fill_points(items, count, -3e38f, 1e34f);
    check_same(items, count, 4);
    fill_halving(items, count);
    check_same(items, count, 4);
    free(items);
}

/* ---- order ---- */

/* Depth-first numbers, each node once, and every item in one leaf; returns the levels. */
static uint32_t walk(const struct tree *tree, size_t node, size_t *next, uint32_t *item)
{
    assert_int_equal(node, (*next)++);
    assert_true(node < tree->node_count);
    uint32_t levels = 0;
    for (int side = 0; side < 2; side++) {
        uint32_t child = tree->nodes[node].child[side], count = tree->nodes[node].count[side];
        if (count) {
            assert_int_equal(child, 100 + *item);
            *item += count;
            continue;
        }
        uint32_t below = walk(tree, child, next, item);
        levels = below > levels ? below : levels;
    }
    return levels + 1;
}

static void test_order(void **state)
{
    (void)state;
    const uint32_t count = 30000;
    struct turner_bvh_item *items = turner_calloc(count, sizeof *items);
    for (int kind = 0; kind < 3; kind++) {
        struct tree tree;
        size_t next = 0;
        uint32_t item = 0;
        if (kind == 0)
            fill_random(items, count, 2);
        else if (kind == 1)
            fill_points(items, count, 5, 0);
        else
            fill_halving(items, count);
        build(&tree, items, count, 4, 2);
        assert_int_equal(walk(&tree, 0, &next, &item), tree.levels);
        assert_int_equal(next, tree.node_count);
        assert_int_equal(item, count);
        destroy(&tree);
    }
    free(items);
}

/* ---- quality ---- */

static double area_of(const float lo[3], const float hi[3])
{
    double x = (double)hi[0] - (double)lo[0], y = (double)hi[1] - (double)lo[1],
           z = (double)hi[2] - (double)lo[2];
    return x * y + y * z + z * x;
}

/* Σ area · items of the leaves + Σ area of the nodes but the root. */
static double cost_of(const struct tree *tree)
{
    double cost = 0;
    for (size_t i = 0; i < tree->node_count; i++) {
        const struct turner_gpu_node *n = &tree->nodes[i];
        cost += area_of(n->lo0, n->hi0) * (n->count[0] ? n->count[0] : 1);
        cost += area_of(n->lo1, n->hi1) * (n->count[1] ? n->count[1] : 1);
    }
    return cost;
}

static int sort_axis;

static int compare(const void *left, const void *right)
{
    const struct turner_bvh_item *a = left, *b = right;
    float x = turner_bvh_center(a, sort_axis), y = turner_bvh_center(b, sort_axis);
    return x < y ? -1 : x > y ? 1 : a->index < b->index ? -1 : 1;
}

/* The same of the tree that tries each of the planes between sorted centres, in double. */
static double sweep_cost(struct turner_bvh_item *items, uint32_t count, bool root)
{
    double *right = turner_calloc(count, sizeof *right), best = -1, whole = 0;
    int best_axis = 0;
    uint32_t best_left = 0;
    for (int axis = 0; axis < 3; axis++) {
        sort_axis = axis;
        qsort(items, count, sizeof *items, compare);
        struct turner_bvh_bounds sum = TURNER_BVH_EMPTY, left = TURNER_BVH_EMPTY;
        for (uint32_t i = count; i-- > 0;) {
            for (int k = 0; k < 3; k++) {
                sum.lo[k] = fminf(sum.lo[k], items[i].lo[k]);
                sum.hi[k] = fmaxf(sum.hi[k], items[i].hi[k]);
            }
            right[i] = area_of(sum.lo, sum.hi) * (count - i);
        }
        whole = right[0] / count;
        for (uint32_t i = 1; i < count; i++) {
            for (int k = 0; k < 3; k++) {
                left.lo[k] = fminf(left.lo[k], items[i - 1].lo[k]);
                left.hi[k] = fmaxf(left.hi[k], items[i - 1].hi[k]);
            }
            double cost = area_of(left.lo, left.hi) * i + right[i];
            if (best < 0 || cost < best)
                best = cost, best_axis = axis, best_left = i;
        }
    }
    free(right);
    if (count == 1 || (count <= 4 && whole * count <= whole + best))
        return whole * count;
    sort_axis = best_axis;
    qsort(items, count, sizeof *items, compare);
    return (root ? 0 : whole) + sweep_cost(items, best_left, false) +
           sweep_cost(items + best_left, count - best_left, false);
}

static void test_quality(void **state)
{
    (void)state;
    static const uint32_t counts[] = {7, 8, 9, 60, 3000, 20000};
    struct turner_bvh_item *items = turner_calloc(20000, sizeof *items);
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        struct tree tree;
        fill_random(items, counts[i], 3 + i);
        build(&tree, items, counts[i], 4, 0);
        double ratio = cost_of(&tree) / sweep_cost(items, counts[i], true);
        /* few are divided at every plane, too; of more, either may come upon the better tree: from
         * 0.95 to 1.017 in 24 sets */
        if (counts[i] <= TURNER_BVH_FEW)
            assert_true(fabs(ratio - 1) < 1e-6);
        assert_true(ratio < 1.03);
        destroy(&tree);
    }
    free(items);
}

/* ---- loops on all cores ---- */

static void count_call(void *user, uint32_t i)
{
    atomic_fetch_add(&((atomic_uint *)user)[i], 1);
}

static void test_parallel_for(void **state)
{
    (void)state;
    static const uint32_t counts[] = {0, 1, 2, 1000};
    atomic_uint *calls = turner_calloc(1000, sizeof *calls);
    for (unsigned threads = 0; threads < 9; threads += 2) {
        turner_parallel_limit(threads);
        for (int i = 0; i < 4; i++) {
            memset((void *)calls, 0, 1000 * sizeof *calls);
            turner_parallel_for(counts[i], count_call, (void *)calls);
            for (uint32_t k = 0; k < 1000; k++)
                assert_int_equal(atomic_load(&calls[k]), k < counts[i]);
        }
    }
    turner_parallel_limit(0);
    free((void *)calls);
    assert_int_equal(turner_pieces(0, 10), 0);
    assert_int_equal(turner_pieces(UINT32_MAX, 10), 429496730);
    assert_int_equal(turner_piece_end(UINT32_MAX, 10, 429496729), UINT32_MAX);
    assert_int_equal(turner_piece_end(25, 10, 1), 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_order),
        cmocka_unit_test(test_quality),
        cmocka_unit_test(test_parallel_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
