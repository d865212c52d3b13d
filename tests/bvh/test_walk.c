/* A plain walk through the nodes, in double, finds the same hits as trying everything. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "bvh/wide.h"
#include "scenes.h"

#define NEVER ((double)INFINITY)

struct ray {
    struct turner_vec3 origin, direction; /* not unit: t is the same in every space */
};

struct hit {
    double t;
    uint32_t instance, id;
};

static struct turner_vec3 get(const float in[3])
{
    return turner_vec3_of((double)in[0], (double)in[1], (double)in[2]);
}

static struct turner_affine widen(const float rows[12])
{
    struct turner_affine affine;
    for (int i = 0; i < 12; i++)
        affine.m[i / 4][i % 4] = (double)rows[i];
    return affine;
}

/* Roots of a·t² + 2b·t + c = 0, the lower one first; false when there are none. */
static bool roots(double t[2], double a, double b, double c)
{
    double discriminant = b * b - a * c;
    if (a == 0 || discriminant < 0)
        return false;
    double q = -(b + copysign(sqrt(discriminant), b));
    double first = q / a, second = q == 0 ? 0 : c / q;
    t[0] = fmin(first, second);
    t[1] = fmax(first, second);
    return true;
}

/* The hits below are the nearest one with t > after, or NEVER. */
static double hit_sphere(const struct turner_gpu_primitive *sphere, const struct ray *ray,
                         double after)
{
    struct turner_vec3 from = turner_vec3_sub(ray->origin, get(sphere->a));
    double r = (double)sphere->b[0], t[2];
    if (!roots(t, turner_vec3_dot(ray->direction, ray->direction),
               turner_vec3_dot(from, ray->direction), turner_vec3_dot(from, from) - r * r))
        return NEVER;
    return t[0] > after ? t[0] : t[1] > after ? t[1] : NEVER;
}

static double hit_cone(const struct turner_gpu_primitive *cone, const struct ray *ray, double after)
{
    struct turner_vec3 base = get(cone->a), along = turner_vec3_sub(get(cone->b), base);
    double length = turner_vec3_length(along);
    struct turner_vec3 axis = turner_vec3_scale(along, 1 / length);
    struct turner_vec3 from = turner_vec3_sub(ray->origin, base);
    double h0 = turner_vec3_dot(from, axis), h1 = turner_vec3_dot(ray->direction, axis);
    double slope = ((double)cone->c[1] - (double)cone->c[0]) / length;
    double r0 = (double)cone->c[0] + slope * h0, r1 = slope * h1; /* radius at t: r0 + r1·t */
    struct turner_vec3 p = turner_vec3_sub(from, turner_vec3_scale(axis, h0));
    struct turner_vec3 d = turner_vec3_sub(ray->direction, turner_vec3_scale(axis, h1));
    double t[2], nearest = NEVER;
    if (roots(t, turner_vec3_dot(d, d) - r1 * r1, turner_vec3_dot(p, d) - r0 * r1,
              turner_vec3_dot(p, p) - r0 * r0)) {
        for (int i = 0; i < 2; i++) {
            double h = h0 + h1 * t[i];
            if (t[i] > after && h >= 0 && h <= length)
                nearest = fmin(nearest, t[i]);
        }
    }
    for (int end = 0; end < 2 && cone->c[2] > 0; end++) {
        double cap = ((end ? length : 0) - h0) / h1, r = (double)cone->c[end];
        struct turner_vec3 across = turner_vec3_add(p, turner_vec3_scale(d, cap));
        if (cap > after && turner_vec3_dot(across, across) <= r * r)
            nearest = fmin(nearest, cap);
    }
    return nearest;
}

/* Möller and Trumbore: in double, the ray is the same for both walks, so no more is needed. */
static double hit_triangle(const struct turner_gpu_primitive *triangle, const struct ray *ray,
                           double after)
{
    struct turner_vec3 a = get(triangle->a);
    struct turner_vec3 e1 = turner_vec3_sub(get(triangle->b), a);
    struct turner_vec3 e2 = turner_vec3_sub(get(triangle->c), a);
    struct turner_vec3 p = turner_vec3_cross(ray->direction, e2);
    double determinant = turner_vec3_dot(e1, p);
    if (determinant == 0)
        return NEVER;
    struct turner_vec3 s = turner_vec3_sub(ray->origin, a), q = turner_vec3_cross(s, e1);
    double u = turner_vec3_dot(s, p) / determinant;
    double v = turner_vec3_dot(ray->direction, q) / determinant;
    double t = turner_vec3_dot(e2, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > after ? t : NEVER;
}

static bool comes_first(const struct hit *a, const struct hit *b)
{
    if (a->t != b->t)
        return a->t < b->t;
    if (a->instance != b->instance)
        return a->instance < b->instance;
    return a->id < b->id;
}

static void try_primitive(struct hit *best, const struct turner_gpu_primitive *primitive,
                          const struct ray *ray, uint32_t instance)
{
    /* from the point of the ray next to the primitive: far away, roots lose their digits */
    double near = turner_vec3_dot(turner_vec3_sub(get(primitive->a), ray->origin), ray->direction) /
                  turner_vec3_dot(ray->direction, ray->direction);
    struct ray close = {turner_vec3_add(ray->origin, turner_vec3_scale(ray->direction, near)),
                        ray->direction};
    uint32_t kind = primitive->id >> TURNER_KIND_SHIFT;
    struct hit hit = {.instance = instance, .id = primitive->id};
    hit.t = near + (kind == TURNER_KIND_SPHERE ? hit_sphere(primitive, &close, -near)
                    : kind == TURNER_KIND_CONE ? hit_cone(primitive, &close, -near)
                                               : hit_triangle(primitive, &close, -near));
    if (hit.t < NEVER && comes_first(&hit, best))
        *best = hit;
}

static struct ray into_group(const struct turner_gpu_instance *instance, const struct ray *ray)
{
    struct turner_affine to_group = widen(instance->to_group);
    return (struct ray){turner_affine_point(&to_group, ray->origin),
                        turner_affine_vector(&to_group, ray->direction)};
}

/* `ends`: for each group, where its primitives begin, and one entry more. */
static struct hit try_all(const struct turner_flat *flat, const size_t *ends, const struct ray *ray)
{
    struct hit best = {.t = NEVER};
    for (uint32_t i = 0; i < flat->instance_count; i++) {
        struct ray inner = into_group(&flat->instances[i], ray);
        uint32_t group = flat->instance_groups[i];
        for (size_t k = ends[group]; k < ends[group + 1]; k++)
            try_primitive(&best, &flat->primitives[k], &inner, i);
    }
    return best;
}

static bool meets_box(const struct ray *ray, const float lo[3], const float hi[3], double until)
{
    const double origin[3] = {ray->origin.x, ray->origin.y, ray->origin.z};
    const double direction[3] = {ray->direction.x, ray->direction.y, ray->direction.z};
    double near = 0, far = until;
    if (lo[0] > hi[0])
        return false;
    for (int axis = 0; axis < 3; axis++) {
        if (direction[axis] == 0) {
            if (origin[axis] < (double)lo[axis] || origin[axis] > (double)hi[axis])
                return false;
            continue;
        }
        double a = ((double)lo[axis] - origin[axis]) / direction[axis];
        double b = ((double)hi[axis] - origin[axis]) / direction[axis];
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return near <= far;
}

struct walk {
    const struct turner_flat *flat;
    uint32_t *stack; /* max_depth entries, for each of two levels */
    uint32_t height; /* in use, both levels together */
    uint64_t visits;
    struct hit best;
};

static void walk_nodes(struct walk *walk, uint32_t root, const struct ray *ray, bool top,
                       uint32_t instance)
{
    const struct turner_flat *flat = walk->flat;
    assert_true(walk->height < flat->max_depth);
    uint32_t floor = walk->height;
    walk->stack[walk->height++] = root;
    while (walk->height > floor) {
        assert_true(walk->visits++ < flat->max_visits);
        const struct turner_gpu_node *node = &flat->nodes[walk->stack[--walk->height]];
        for (int side = 0; side < 2; side++) {
            const float *lo = side ? node->lo1 : node->lo0, *hi = side ? node->hi1 : node->hi0;
            if (!meets_box(ray, lo, hi, walk->best.t))
                continue;
            uint32_t child = node->child[side], count = node->count[side];
            if (count == 0) {
                assert_true(walk->height < flat->max_depth);
                walk->stack[walk->height++] = child;
            } else if (top) {
                assert_int_equal(count, 1);
                assert_true(walk->visits++ < flat->max_visits);
                struct ray inner = into_group(&flat->instances[child], ray);
                walk_nodes(walk, flat->instances[child].root, &inner, false, child);
            } else {
                for (uint32_t i = child; i < child + count; i++)
                    try_primitive(&walk->best, &flat->primitives[i], ray, instance);
            }
        }
    }
}

static void walk_wide(struct walk *walk, uint32_t root, const struct ray *ray, bool top,
                      uint32_t instance)
{
    const struct turner_flat *flat = walk->flat;
    uint32_t floor = walk->height;
    walk->stack[walk->height++] = root;
    while (walk->height > floor) {
        assert_true(walk->visits++ < flat->max_visits);
        const struct turner_gpu_wide_node *node = &flat->wide[walk->stack[--walk->height]];
        for (int i = 0; i < 4; i++) {
            float lo[3], hi[3];
            for (int axis = 0; axis < 3; axis++) {
                lo[axis] = turner_bvh_wide_plane(node, i, axis, 0);
                hi[axis] = turner_bvh_wide_plane(node, i, axis, 1);
            }
            uint32_t child = node->child[i], first = child & TURNER_WIDE_FIRST;
            if (!child || !meets_box(ray, lo, hi, walk->best.t))
                continue;
            if (!(child & TURNER_WIDE_LEAF)) {
                assert_true(walk->height < floor + flat->max_depth); /* a stack for each level */
                walk->stack[walk->height++] = child;
            } else if (top) {
                assert_true(walk->visits++ < flat->max_visits);
                struct ray inner = into_group(&flat->instances[first], ray);
                walk_wide(walk, flat->instances[first].root, &inner, false, first);
            } else {
                uint32_t count = ((child & ~TURNER_WIDE_LEAF) >> TURNER_WIDE_COUNT_SHIFT) + 1;
                for (uint32_t k = first; k < first + count; k++)
                    try_primitive(&walk->best, &flat->primitives[k], ray, instance);
            }
        }
    }
}

static struct hit walk_all(const struct turner_flat *flat, const struct ray *ray)
{
    struct walk walk = {.flat = flat, .best = {.t = NEVER}};
    walk.stack = turner_calloc(2 * flat->max_depth, sizeof *walk.stack);
    (flat->wide ? walk_wide : walk_nodes)(&walk, flat->root, ray, true, 0);
    free(walk.stack);
    return walk.best;
}

/* A point near a primitive of an instance, in the world as the instance's own floats see it. */
static struct turner_vec3 aim(const struct turner_flat *flat, const size_t *ends, uint64_t *random)
{
    uint32_t i = (uint32_t)(random_bits(random) % flat->instance_count);
    uint32_t group = flat->instance_groups[i];
    size_t count = ends[group + 1] - ends[group];
    if (count == 0)
        return random_point(random, -1, 1);
    float lo[3], hi[3];
    turner_primitive_bounds(lo, hi, &flat->primitives[ends[group] + random_bits(random) % count]);
    struct turner_vec3 point = turner_vec3_of(random_in(random, (double)lo[0], (double)hi[0]),
                                              random_in(random, (double)lo[1], (double)hi[1]),
                                              random_in(random, (double)lo[2], (double)hi[2]));
    struct turner_affine to_group = widen(flat->instances[i].to_group), to_world;
    assert_true(turner_affine_invert(&to_world, &to_group));
    return turner_affine_point(&to_world, point);
}

/* Shoots rays between random points of the scene, some along an axis; at least `least` of a
 * hundred must hit, or the comparison would say little. */
static void compare_in(enum turner_order order, struct turner_scene *scene, int rays, int least)
{
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, order), TURNER_OK);
    size_t *ends = turner_calloc(scene->group_count + 1, sizeof *ends);
    for (size_t g = 0; g < scene->group_count; g++)
        ends[g + 1] = ends[g] + turner_group_primitive_count(&scene->groups[g]);
    uint64_t random = 11;
    int hits = 0;
    for (int i = 0; i < rays; i++) {
        struct turner_vec3 target = aim(&flat, ends, &random);
        struct turner_vec3 origin = i % 2 ? aim(&flat, ends, &random)
                                          : turner_vec3_add(target, random_point(&random, -9, 9));
        struct ray ray = {origin, turner_vec3_sub(target, origin)};
        if (i % 7 == 0)
            ray.direction = turner_vec3_of(i % 3 == 0, i % 3 == 1, i % 3 == 2);
        if (i % 14 == 0)
            ray.direction = turner_vec3_scale(ray.direction, -1);
        struct hit expected = try_all(&flat, ends, &ray), found = walk_all(&flat, &ray);
        assert_true(found.t == expected.t);
        assert_int_equal(found.instance, expected.instance);
        assert_int_equal(found.id, expected.id);
        hits += expected.t < NEVER;
    }
    assert_true(hits * 100 >= rays * least);
    free(ends);
    turner_flat_destroy(&flat);
}

static void compare(struct turner_scene *scene, int rays, int least)
{
    compare_in(TURNER_ORDER_SAH, scene, rays, least);
    compare_in(TURNER_ORDER_WIDE, scene, rays, least);
    turner_scene_destroy(scene);
}

static void test_empty(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    add_instance(scene, add_group(scene), TURNER_NONE, TURNER_AFFINE_IDENTITY);
    compare(scene, 50, 0);
}

static void test_one(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    add_sphere(&scene->groups[0], turner_vec3_of(3, 4, 5), 0.25, 0);
    compare(scene, 300, 30);
}

static void test_world(void **state)
{
    (void)state;
    uint64_t random = 21;
    struct turner_scene *scene = make_scene();
    fill_group(&scene->groups[0], &random, 400, 300, 500);
    compare(scene, 500, 60);
}

static void test_ties(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    for (int i = 0; i < 50; i++)
        add_sphere(&scene->groups[0], turner_vec3_of(1, 2, 3), 0.5, 0);
    uint32_t group = add_group(scene);
    add_sphere(&scene->groups[group], turner_vec3_of(1, 2, 3), 0.5, 0);
    for (int i = 0; i < 20; i++)
        add_instance(scene, group, TURNER_NONE, TURNER_AFFINE_IDENTITY);
    compare(scene, 200, 30);
}

static void test_instances(void **state)
{
    (void)state;
    const double scales[] = {1, -1, 1e-6, 1e6, 0.01, -300};
    const double distances[] = {0, 3, 1e5};
    uint64_t random = 22;
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        for (size_t j = 0; j < sizeof distances / sizeof *distances; j++) {
            struct turner_scene *scene = make_scene();
            uint32_t first = add_group(scene), second = add_group(scene);
            fill_group(&scene->groups[first], &random, 30, 20, 30);
            fill_group(&scene->groups[second], &random, 5, 5, 50);
            for (int k = 0; k < 6; k++) {
                double far = distances[j];
                add_instance(scene, k % 2 ? first : second, TURNER_NONE,
                             make_transform(scales[i], random_point(&random, -far, far)));
            }
            compare(scene, 120, 10);
        }
    }
}

static void test_sheared_and_mirrored(void **state)
{
    (void)state;
    uint64_t random = 23;
    struct turner_scene *scene = make_scene();
    fill_group(&scene->groups[0], &random, 20, 20, 20);
    uint32_t group = add_group(scene);
    fill_group(&scene->groups[group], &random, 50, 50, 50);
    for (int k = 0; k < 40; k++) {
        struct turner_affine transform;
        for (int i = 0; i < 12; i++)
            transform.m[i / 4][i % 4] = random_in(&random, -2, 2) * (i % 4 == 3 ? 5 : 1);
        add_instance(scene, group, TURNER_NONE, transform);
        struct turner_affine mirror = TURNER_AFFINE_IDENTITY;
        mirror.m[k % 3][k % 3] = -1;
        mirror.m[0][3] = k;
        add_instance(scene, group, TURNER_NONE, mirror);
    }
    compare(scene, 300, 40);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_empty),     cmocka_unit_test(test_one),
        cmocka_unit_test(test_world),     cmocka_unit_test(test_ties),
        cmocka_unit_test(test_instances), cmocka_unit_test(test_sheared_and_mirrored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
