/* Bits that agree, and where two trees part: trees made by hand from one of the reference. */
#include "explain_test.h"

#include <math.h>
#include <stdlib.h>

#include "app/explain.h"
#include "base/memory.h"
#include "reference/reference.h"

static void bits(void **state)
{
    (void)state;
    static const struct {
        long double a, b;
        int bits;
    } rows[] = {
        {1, 1, 24},
        {0, 0, 24},
        {0, 1, 0},
        {1, 0, 0},
        {-1, 1, 0},
        {1 + 0x1p-10L, 1, 10},
        {1 - 0x1p-10L, 1, 10},
        {1 + 1.01L * 0x1p-10L, 1, 9},
        {3 * (1 + 0x1p-23L), 3, 23},
        {1 + 0x1p-25L, 1, 24},
        {0.1f, 0.1L, 24}, /* the nearest float */
        {INFINITY, INFINITY, 24},
        {INFINITY, -INFINITY, 0},
        {INFINITY, 1, 0},
        {NAN, 1, 0},
        {NAN, NAN, 24},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        int got = turner_agreeing_bits(&rows[i].a, &rows[i].b, 1, 0, 24);
        if (got != rows[i].bits)
            fail_msg("%Lg and %Lg agree in %d bits, not %d", rows[i].a, rows[i].b, got,
                     rows[i].bits);
    }
    /* a vector by its largest number; a scale counts where it is larger still */
    const long double a[] = {1, 0x1p-10L, 0}, b[] = {1, 0, 0};
    assert_int_equal(turner_agreeing_bits(a, b, 3, 0, 24), 10);
    assert_int_equal(turner_agreeing_bits(a, b, 3, 4, 24), 12);
    assert_int_equal(turner_agreeing_bits(a, b, 3, 0x1p40L, 24), 24);
}

struct trees {
    struct turner_scene *scene;
    struct turner_ray_tree a, b;
    struct turner_ray_comparison comparison;
};

static int set_up(void **state)
{
    struct trees *trees = turner_calloc(1, sizeof *trees);
    trees->scene = must_parse(GLASS_BALL);
    if (turner_reference_explain(&trees->a, trees->scene, 0.5, 0.5) != TURNER_OK ||
        turner_reference_explain(&trees->b, trees->scene, 0.5, 0.5) != TURNER_OK)
        fail_msg("%s", turner_message());
    trees->a.mantissa = 24;
    *state = trees;
    return 0;
}

static int tear_down(void **state)
{
    struct trees *trees = *state;
    turner_rays_destroy(&trees->comparison);
    turner_ray_tree_destroy(&trees->a);
    turner_ray_tree_destroy(&trees->b);
    turner_scene_destroy(trees->scene);
    free(trees);
    return 0;
}

static const struct turner_ray_comparison *compare(struct trees *trees)
{
    turner_rays_compare(&trees->comparison, &trees->a, &trees->b, 10);
    return &trees->comparison;
}

static void agree(void **state)
{
    const struct turner_ray_comparison *c = compare(*state);
    assert_int_equal(c->mantissa, 24);
    assert_int_equal(c->count, 7);
    assert_int_equal(c->parts, TURNER_NONE);
    for (uint32_t i = 0; i < c->count; i++) {
        assert_int_equal(c->pairs[i].device, i);
        assert_int_equal(c->pairs[i].reference, i);
        assert_int_equal(c->pairs[i].bits[TURNER_RAY_DIRECTION], 24);
    }
    assert_int_equal(c->pairs[1].bits[TURNER_RAY_POINT], TURNER_NO_BITS); /* it left the scene */
    assert_int_equal(c->pairs[4].bits[TURNER_RAY_T], TURNER_NO_BITS);     /* it was cut */
}

static void few_bits(void **state)
{
    struct trees *trees = *state;
    trees->a.rays[3].weight[0] *= 1 + 0x1p-9L; /* both more than enough, */
    trees->a.rays[2].t *= 1 + 0x1p-12L;        /* and few, but not too few */
    const struct turner_ray_comparison *c = compare(trees);
    assert_int_equal(c->parts, 3);
    assert_int_equal(c->why, TURNER_RAYS_FEW_BITS);
    assert_int_equal(c->quantity, TURNER_RAY_WEIGHT);
    assert_true(c->pairs[3].bits[TURNER_RAY_WEIGHT] < 10);
    assert_int_equal(c->worst, 2);
    assert_int_equal(c->worst_quantity, TURNER_RAY_T);
    assert_int_equal(c->count, 7); /* what is below is paired all the same */
}

static void other_thing(void **state)
{
    struct trees *trees = *state;
    trees->a.rays[2].place.index = 1;
    const struct turner_ray_comparison *c = compare(trees);
    assert_int_equal(c->parts, 2);
    assert_int_equal(c->why, TURNER_RAYS_END_DIFFERENTLY);
    assert_int_equal(c->count, 3 + 4 + 4); /* four rays below it, by each alone */
    assert_int_equal(c->pairs[3].device, 3);
    assert_int_equal(c->pairs[3].reference, TURNER_NONE);
    assert_int_equal(c->pairs[7].device, TURNER_NONE);
    assert_int_equal(c->pairs[7].reference, 3);
    assert_int_equal(turner_rays_find(c, false, 6), 10);
}

/* The reference follows a ray that the device does not. */
static void one_alone(void **state)
{
    struct trees *trees = *state;
    trees->a.count = 6;
    const struct turner_ray_comparison *c = compare(trees);
    assert_int_equal(c->parts, 6);
    assert_int_equal(c->why, TURNER_RAYS_ALONE);
    assert_int_equal(c->pairs[6].device, TURNER_NONE);
    assert_int_equal(c->pairs[6].reference, 6);
}

/* What a truncated tree lost cannot be held against it; what it has can. */
static void lost(void **state)
{
    struct trees *trees = *state;
    trees->a.count = 6;
    trees->a.truncated = true;
    const struct turner_ray_comparison *c = compare(trees);
    assert_int_equal(c->parts, TURNER_NONE);
    assert_int_equal(c->count, 7);
    turner_rays_destroy(&trees->comparison);
    trees->a.rays[1].end = TURNER_RAY_CUT;
    c = compare(trees);
    assert_int_equal(c->parts, 1);
    assert_int_equal(c->why, TURNER_RAYS_END_DIFFERENTLY);
}

/* Any occluder will do for a shadow; what a ray crosses must be the same. */
static void crossings_count(void **state)
{
    struct trees *trees = *state;
    trees->a.rays[1].end = trees->b.rays[1].end = TURNER_RAY_BLOCKED;
    trees->a.rays[1].place.index = 7;
    const struct turner_ray_comparison *c = compare(trees);
    assert_int_equal(c->parts, TURNER_NONE);
    turner_rays_destroy(&trees->comparison);
    turner_ray_tree_cross(&trees->a, 6, (struct turner_ray_place){0}, 1, false);
    c = compare(trees);
    assert_int_equal(c->parts, 6);
    assert_int_equal(c->why, TURNER_RAYS_END_DIFFERENTLY);
}

static void reference_alone(void **state)
{
    struct trees *trees = *state;
    turner_rays_compare(&trees->comparison, NULL, &trees->b, 10);
    assert_int_equal(trees->comparison.count, 7);
    assert_int_equal(trees->comparison.parts, TURNER_NONE);
    assert_int_equal(trees->comparison.pairs[0].device, TURNER_NONE);
}

#define TEST(f) cmocka_unit_test_setup_teardown(f, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bits), TEST(agree),           TEST(few_bits), TEST(other_thing),
        TEST(one_alone),        TEST(crossings_count), TEST(lost),     TEST(reference_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
