/* Triangles of flat polygons against the even-odd rule, point by point, and against areas known
 * beforehand. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "scene/polygon.h"

#define PI 3.14159265358979323846
#define COUNT(array) (sizeof(array) / sizeof *(array))

struct outline {
    double (*points)[2];
    size_t count, capacity;
};

static void add_point(struct outline *outline, double x, double y)
{
    double *p = *TURNER_PUSH(outline->points, outline->count, outline->capacity);
    p[0] = x;
    p[1] = y;
}

static double random_in(double low, double high, uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*state >> 11) / 9007199254740992.0;
}

/* Where the plane's (x, y) lies in space, and back. */
struct frame {
    struct turner_vec3 origin, x, y;
};

static struct turner_vec3 place(const struct frame *f, double x, double y)
{
    return turner_vec3_add(f->origin, turner_vec3_add(turner_vec3_scale(f->x, x),
                                                      turner_vec3_scale(f->y, y)));
}

static double area_of(const struct turner_polygon *p, const uint32_t *t)
{
    struct turner_vec3 n = turner_vec3_cross(turner_vec3_sub(p->corners[t[1]], p->corners[t[0]]),
                                             turner_vec3_sub(p->corners[t[2]], p->corners[t[0]]));
    assert_true(turner_vec3_dot(n, p->normal) > 0);
    return turner_vec3_length(n) / 2;
}

/* Twice the area of the triangle a, b, (x, y). */
static double edge_side(const double a[2], const double b[2], double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static bool near_edge(const double a[2], const double b[2], double x, double y)
{
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    if (length == 0 || fabs(edge_side(a, b, x, y)) > 1e-7 * length)
        return false;
    double along = ((x - a[0]) * (b[0] - a[0]) + (y - a[1]) * (b[1] - a[1])) / length;
    return along > -1e-7 && along < length + 1e-7;
}

/* Every random point must lie in exactly one triangle when the outline is crossed an odd number of
 * times on the way out, in none otherwise; the areas must add up to `area`. */
static void check_in(const struct outline *o, double area, const struct frame *frame)
{
    struct turner_polygon polygon = {0};
    for (size_t i = 0; i < o->count; i++)
        *TURNER_PUSH(polygon.corners, polygon.corner_count, polygon.corner_capacity) =
            place(frame, o->points[i][0], o->points[i][1]);
    assert_int_equal(turner_polygon_triangulate(&polygon), TURNER_OK);

    double sum = 0;
    for (size_t i = 0; i < polygon.triangle_count; i++)
        sum += area_of(&polygon, polygon.triangles[i]);
    if (!(fabs(sum - area) <= 1e-9 * area))
        fail_msg("area %.12g instead of %.12g", sum, area);

    double(*flat)[2] = turner_calloc(polygon.corner_count, sizeof *flat);
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (size_t i = 0; i < polygon.corner_count; i++) {
        struct turner_vec3 p = turner_vec3_sub(polygon.corners[i], frame->origin);
        flat[i][0] = turner_vec3_dot(p, frame->x);
        flat[i][1] = turner_vec3_dot(p, frame->y);
        low = fmin(low, fmin(flat[i][0], flat[i][1]));
        high = fmax(high, fmax(flat[i][0], flat[i][1]));
    }
    uint64_t seed = 1;
    int inside = 0;
    for (int k = 0; k < 200; k++) {
        double x = random_in(low, high, &seed), y = random_in(low, high, &seed);
        bool odd = false, skip = false;
        for (size_t i = 0; i < o->count; i++) {
            const double *a = o->points[i], *b = o->points[(i + 1) % o->count];
            skip |= near_edge(a, b, x, y);
            if ((a[1] > y) != (b[1] > y))
                odd ^= (edge_side(a, b, x, y) > 0) == (b[1] > a[1]);
        }
        int found = 0;
        for (size_t i = 0; i < polygon.triangle_count; i++) {
            const uint32_t *t = polygon.triangles[i];
            int positive = 0, negative = 0;
            for (int c = 0; c < 3; c++) {
                const double *a = flat[t[c]], *b = flat[t[(c + 1) % 3]];
                skip |= near_edge(a, b, x, y);
                positive += edge_side(a, b, x, y) > 0;
                negative += edge_side(a, b, x, y) < 0;
            }
            found += positive == 3 || negative == 3;
        }
        if (skip)
            continue;
        if (found != (int)odd)
            fail_msg("the point %g, %g lies in %d triangles instead of %d", x, y, found, odd);
        inside += odd;
    }
    assert_true(inside > 5);
    free(flat);
    turner_polygon_destroy(&polygon);
}

/* The same outline in the coordinate planes, tilted, and far away. */
static void check(struct outline *o, double area)
{
    static const struct frame frames[] = {
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},    {{0, 0, 2}, {0, 1, 0}, {1, 0, 0}},
        {{3, 0, 0}, {0, 1, 0}, {0, 0, 1}},    {{-3, 0, 0}, {0, 0, 1}, {0, 1, 0}},
        {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}},
        {{100, -50, 7}, {0.6, 0, 0.8}, {-0.48, 0.8, 0.36}},
    };
    for (size_t i = 0; i < COUNT(frames); i++)
        check_in(o, area, &frames[i]);
    free(o->points);
}

static double shoelace(const struct outline *o)
{
    double sum = 0;
    for (size_t i = 0; i < o->count; i++) {
        const double *a = o->points[i], *b = o->points[(i + 1) % o->count];
        sum += a[0] * b[1] - a[1] * b[0];
    }
    return fabs(sum) / 2;
}

static void convex(void **state)
{
    (void)state;
    struct outline o = {0};
    for (int i = 0; i < 7; i++)
        add_point(&o, cos(i * 2 * PI / 7), sin(i * 2 * PI / 7));
    check(&o, 3.5 * sin(2 * PI / 7));
}

static void corners_on_a_line_and_doubled(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {0.3, 0}, {1, 0}, {1, 0}, {1, 0.7}, {1, 1},
                                       {0, 1}, {0, 0.1}, {0, 0}};
    struct outline o = {0};
    for (size_t i = 0; i < COUNT(points); i++)
        add_point(&o, points[i][0], points[i][1]);
    check(&o, 1);
}

static void concave_quadrilateral_from_every_corner(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {2, -1}, {0.5, 0}, {2, 1}};
    for (size_t first = 0; first < 4; first++) {
        for (int backwards = 0; backwards < 2; backwards++) {
            struct outline o = {0};
            for (size_t i = 0; i < 4; i++) {
                const double *p = points[(backwards ? 7 + first - i : first + i) % 4];
                add_point(&o, p[0], p[1]);
            }
            check(&o, 2 - 1.5); /* the notch out of the whole */
        }
    }
}

static void gear(void **state)
{
    (void)state;
    struct outline o = {0};
    for (int i = 0; i < 144; i++) {
        double r = i % 4 < 2 ? 1 : 0.9, angle = i * 2 * PI / 144;
        add_point(&o, r * cos(angle), r * sin(angle));
    }
    check(&o, shoelace(&o));
}

static void spiral(void **state)
{
    (void)state;
    struct outline o = {0};
    for (int i = 0; i <= 200; i++)
        add_point(&o, (1 + i / 50.0) * cos(i * 0.15), (1 + i / 50.0) * sin(i * 0.15));
    for (int i = 200; i >= 0; i--)
        add_point(&o, (1.4 + i / 50.0) * cos(i * 0.15), (1.4 + i / 50.0) * sin(i * 0.15));
    check(&o, shoelace(&o));
}

static void comb_with_level_edges(void **state)
{
    (void)state;
    struct outline o = {0};
    add_point(&o, 0, -1);
    add_point(&o, 20, -1);
    for (int i = 20; i > 0; i--) {
        add_point(&o, i, i % 2 ? 0 : 3);
        add_point(&o, i - 1, i % 2 ? 0 : 3);
    }
    check(&o, 20 + 10 * 3);
}

static void hole_on_a_keyhole_edge(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                       {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    struct outline o = {0};
    for (size_t i = 0; i < COUNT(points); i++)
        add_point(&o, points[i][0], points[i][1]);
    check(&o, 12);
}

static void pentagram_has_a_hole(void **state)
{
    (void)state;
    struct outline o = {0};
    for (int i = 0; i < 5; i++)
        add_point(&o, sin(i * 4 * PI / 5), cos(i * 4 * PI / 5));
    /* five points of a star: the triangles between the circle and the inner pentagon */
    double inner = cos(2 * PI / 5) / cos(PI / 5), half_base = inner * sin(PI / 5);
    check(&o, 5 * half_base * (1 - inner * cos(PI / 5)));
}

static void lopsided_bow_tie(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {3, 3}, {3, 0}, {0, 1.5}};
    struct outline o = {0};
    for (size_t i = 0; i < COUNT(points); i++)
        add_point(&o, points[i][0], points[i][1]);
    check(&o, 0.5 * 1.5 * 1 + 0.5 * 3 * 2); /* the sides cross at (1, 1) */
}

static void lobes_that_touch_in_a_corner(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {1, 1}, {2, 0}, {2, 3}, {1, 1}, {0, 2}};
    struct outline o = {0};
    for (size_t i = 0; i < COUNT(points); i++)
        add_point(&o, points[i][0], points[i][1]);
    check(&o, 1 + 1.5);
}

static void tangle(void **state)
{
    (void)state;
    static const double points[][2] = {{0, 0}, {5, 1}, {1, 4}, {2, -1}, {4, 5}, {0, 2}, {6, 3}};
    struct outline o = {0};
    for (size_t i = 0; i < COUNT(points); i++)
        add_point(&o, points[i][0], points[i][1]);
    /* only the points are checked: take the area from the triangles themselves */
    struct turner_polygon polygon = {0};
    for (size_t i = 0; i < o.count; i++)
        *TURNER_PUSH(polygon.corners, polygon.corner_count, polygon.corner_capacity) =
            turner_vec3_of(o.points[i][0], o.points[i][1], 0);
    assert_int_equal(turner_polygon_triangulate(&polygon), TURNER_OK);
    double area = 0;
    for (size_t i = 0; i < polygon.triangle_count; i++)
        area += area_of(&polygon, polygon.triangles[i]);
    turner_polygon_destroy(&polygon);
    check(&o, area);
}

static void random_stars(void **state)
{
    (void)state;
    uint64_t seed = 7;
    for (int k = 0; k < 20; k++) {
        struct outline o = {0};
        for (int i = 0; i < 40; i++) {
            double r = random_in(0.1, 1, &seed);
            add_point(&o, r * cos(i * 2 * PI / 40), r * sin(i * 2 * PI / 40));
        }
        check(&o, shoelace(&o));
    }
}

static struct turner_polygon triangulated(const struct turner_vec3 *corners, size_t count)
{
    struct turner_polygon polygon = {0};
    for (size_t i = 0; i < count; i++)
        *TURNER_PUSH(polygon.corners, polygon.corner_count, polygon.corner_capacity) = corners[i];
    assert_int_equal(turner_polygon_triangulate(&polygon), TURNER_OK);
    return polygon;
}

static void not_quite_flat(void **state)
{
    (void)state;
    static const struct turner_vec3 corners[] = {{0, 0, 0.01}, {1, 0, -0.01}, {1, 1, 0.02},
                                                 {0.4, 0.5, 0}, {0, 1, 0}};
    struct turner_polygon polygon = triangulated(corners, COUNT(corners));
    assert_int_equal(polygon.triangle_count, 3);
    for (size_t i = 0; i < 3; i++)
        area_of(&polygon, polygon.triangles[i]); /* asserts the side */
    turner_polygon_destroy(&polygon);
}

static void without_area(void **state)
{
    (void)state;
    static const struct turner_vec3 line[] = {{0.1, 0.1, 0.1}, {0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}};
    static const struct turner_vec3 point[] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
    static const struct turner_vec3 huge[] = {{1e300, 0, 0}, {0, 1e300, 0}, {-1e300, 0, 0}};
    static const struct turner_vec3 there_and_back[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 0, 0}};
    const struct turner_vec3 *const cases[] = {line, point, huge, there_and_back};
    static const size_t counts[] = {COUNT(line), COUNT(point), COUNT(huge), COUNT(there_and_back)};
    for (size_t i = 0; i < COUNT(cases); i++) {
        struct turner_polygon polygon = triangulated(cases[i], counts[i]);
        assert_int_equal(polygon.triangle_count, 0);
        turner_polygon_destroy(&polygon);
    }
}

static void too_many_crossings(void **state)
{
    (void)state;
    struct turner_polygon polygon = {0};
    for (int i = 0; i < 1001; i++) {
        double angle = i * 500 * 2 * PI / 1001;
        *TURNER_PUSH(polygon.corners, polygon.corner_count, polygon.corner_capacity) =
            turner_vec3_of(cos(angle), sin(angle), 0);
    }
    assert_int_equal(turner_polygon_triangulate(&polygon), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "1001 corners crosses itself too often"));
    turner_polygon_destroy(&polygon);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(convex),
        cmocka_unit_test(corners_on_a_line_and_doubled),
        cmocka_unit_test(concave_quadrilateral_from_every_corner),
        cmocka_unit_test(gear),
        cmocka_unit_test(spiral),
        cmocka_unit_test(comb_with_level_edges),
        cmocka_unit_test(hole_on_a_keyhole_edge),
        cmocka_unit_test(pentagram_has_a_hole),
        cmocka_unit_test(lopsided_bow_tie),
        cmocka_unit_test(lobes_that_touch_in_a_corner),
        cmocka_unit_test(tangle),
        cmocka_unit_test(random_stars),
        cmocka_unit_test(not_quite_flat),
        cmocka_unit_test(without_area),
        cmocka_unit_test(too_many_crossings),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
