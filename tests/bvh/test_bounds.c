/* turner_primitive_bounds against points on the primitives. */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes.h"

/* Bounds hold the point with two ulps of the largest coordinate to spare. */
static void assert_inside(const float lo[3], const float hi[3], const double point[3])
{
    double largest = 0;
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fabs(point[i]));
    for (int i = 0; i < 3; i++) {
        /* points are sampled in double, 1e-14 of the size off */
        double spare = (2 * (double)FLT_EPSILON - 1e-14) * largest;
        assert_true((double)lo[i] <= point[i] - spare);
        assert_true((double)hi[i] >= point[i] + spare);
    }
}

static double largest_of(const float lo[3], const float hi[3])
{
    double largest = 0;
    for (int i = 0; i < 3; i++)
        largest = fmax(largest, fmax(fabs((double)lo[i]), fabs((double)hi[i])));
    return largest;
}

static void put(float out[3], struct turner_vec3 point)
{
    out[0] = (float)point.x, out[1] = (float)point.y, out[2] = (float)point.z;
}

static struct turner_vec3 get(const float in[3])
{
    return turner_vec3_of((double)in[0], (double)in[1], (double)in[2]);
}

/* Both rims of a cone, sampled finely, touch every side of its bounds and stay inside. */
static void check_cone(const struct turner_gpu_primitive *cone)
{
    float lo[3], hi[3];
    turner_primitive_bounds(lo, hi, cone);
    struct turner_vec3 ends[2] = {get(cone->a), get(cone->b)};
    struct turner_vec3 axis = turner_vec3_normalize(turner_vec3_sub(ends[1], ends[0]));
    struct turner_vec3 u = turner_vec3_perpendicular(axis), v = turner_vec3_cross(axis, u);
    double least[3] = {INFINITY, INFINITY, INFINITY};
    double most[3] = {-INFINITY, -INFINITY, -INFINITY};
    const int samples = 4000;
    for (int end = 0; end < 2; end++) {
        double r = (double)cone->c[end];
        for (int i = 0; i < samples; i++) {
            double angle = 2 * acos(-1) * i / samples;
            struct turner_vec3 p =
                turner_vec3_add(ends[end], turner_vec3_add(turner_vec3_scale(u, r * cos(angle)),
                                                           turner_vec3_scale(v, r * sin(angle))));
            double point[3] = {p.x, p.y, p.z};
            assert_inside(lo, hi, point);
            for (int j = 0; j < 3; j++) {
                least[j] = fmin(least[j], point[j]);
                most[j] = fmax(most[j], point[j]);
            }
        }
    }
    /* the nearest sample is at most half a step of the rim off: r·(π/4000)²/2 */
    double r = fmax((double)cone->c[0], (double)cone->c[1]);
    double slack = r * 3.1e-7 + 4 * (double)FLT_EPSILON * largest_of(lo, hi);
    for (int j = 0; j < 3; j++) {
        assert_true(least[j] - (double)lo[j] <= slack);
        assert_true((double)hi[j] - most[j] <= slack);
    }
}

static void test_cones(void **state)
{
    (void)state;
    uint64_t random = 1;
    for (int i = 0; i < 200; i++) {
        struct turner_gpu_primitive cone = {.id = TURNER_KIND_CONE << TURNER_KIND_SHIFT};
        double far = pow(10, random_in(&random, -3, 5));
        struct turner_vec3 base = random_point(&random, -far, far);
        put(cone.a, base);
        put(cone.b, turner_vec3_add(base, random_point(&random, -far / 3, far / 3)));
        cone.c[0] = (float)random_in(&random, 0, far);
        cone.c[1] = i % 4 ? (float)random_in(&random, 0, far) : 0.0f;
        check_cone(&cone);
    }
    for (int axis = 0; axis < 3; axis++) {
        struct turner_gpu_primitive cone = {.c = {2, 1},
                                            .id = TURNER_KIND_CONE << TURNER_KIND_SHIFT};
        cone.b[axis] = 3;
        check_cone(&cone);
    }
}

static void test_cone_without_axis(void **state)
{
    (void)state;
    /* ends that differ in the scene may round to the same floats: any direction is possible */
    struct turner_gpu_primitive cone = {
        .a = {1, 2, 3}, .b = {1, 2, 3}, .c = {2, 0}, .id = TURNER_KIND_CONE << TURNER_KIND_SHIFT};
    float lo[3], hi[3];
    turner_primitive_bounds(lo, hi, &cone);
    for (int i = 0; i < 3; i++) {
        assert_true(lo[i] <= (float)(i - 1));
        assert_true(hi[i] >= (float)(i + 3));
    }
}

static void test_spheres(void **state)
{
    (void)state;
    uint64_t random = 2;
    for (int i = 0; i < 1000; i++) {
        struct turner_gpu_primitive sphere = {.id = TURNER_KIND_SPHERE << TURNER_KIND_SHIFT};
        double far = pow(10, random_in(&random, -6, 6));
        put(sphere.a, random_point(&random, -far, far));
        sphere.b[0] = (float)(far * pow(10, random_in(&random, -9, 1)));
        float lo[3], hi[3];
        turner_primitive_bounds(lo, hi, &sphere);
        for (int side = 0; side < 6; side++) {
            double point[3] = {(double)sphere.a[0], (double)sphere.a[1], (double)sphere.a[2]};
            point[side / 2] += side % 2 ? (double)sphere.b[0] : -(double)sphere.b[0];
            assert_inside(lo, hi, point);
            double side_bound = side % 2 ? (double)hi[side / 2] : (double)lo[side / 2];
            assert_true(fabs(point[side / 2] - side_bound) <=
                        4 * (double)FLT_EPSILON * largest_of(lo, hi));
        }
    }
}

static void test_triangles(void **state)
{
    (void)state;
    uint64_t random = 3;
    for (int i = 0; i < 1000; i++) {
        struct turner_gpu_primitive triangle = {.id = TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT};
        put(triangle.a, random_point(&random, -10, 10));
        put(triangle.b, random_point(&random, -10, 10));
        put(triangle.c, random_point(&random, -10, 10));
        const float *corners[3] = {triangle.a, triangle.b, triangle.c};
        float lo[3], hi[3];
        turner_primitive_bounds(lo, hi, &triangle);
        for (int corner = 0; corner < 3; corner++) {
            double point[3] = {(double)corners[corner][0], (double)corners[corner][1],
                               (double)corners[corner][2]};
            assert_inside(lo, hi, point);
        }
        for (int axis = 0; axis < 3; axis++) {
            float least = fminf(corners[0][axis], fminf(corners[1][axis], corners[2][axis]));
            float most = fmaxf(corners[0][axis], fmaxf(corners[1][axis], corners[2][axis]));
            double slack = 4 * (double)FLT_EPSILON * largest_of(lo, hi);
            assert_true((double)(least - lo[axis]) <= slack);
            assert_true((double)(hi[axis] - most) <= slack);
        }
    }
}

static void test_thin(void **state)
{
    (void)state;
    /* a triangle in a coordinate plane through the origin still has a box with an inside */
    struct turner_gpu_primitive triangle = {
        .b = {1, 0, 0}, .c = {0, 1, 0}, .id = TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT};
    float lo[3], hi[3];
    turner_primitive_bounds(lo, hi, &triangle);
    assert_true(lo[2] < 0 && hi[2] > 0);
    struct turner_gpu_primitive point = {.id = TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT};
    turner_primitive_bounds(lo, hi, &point);
    for (int axis = 0; axis < 3; axis++)
        assert_true(lo[axis] < 0 && hi[axis] > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_cones),   cmocka_unit_test(test_cone_without_axis),
        cmocka_unit_test(test_spheres), cmocka_unit_test(test_triangles),
        cmocka_unit_test(test_thin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
