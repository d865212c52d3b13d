/* The parts of the data model that compute something. */
#include <stdlib.h>

#include "base/memory.h"
#include "scene/nearest.h"
#include "scene_reading.h"

static void a_new_scene_is_valid(void **state)
{
    (void)state;
    struct turner_scene *scene = turner_scene_create();
    assert_int_equal(turner_scene_validate(scene), TURNER_OK);
    assert_true(scene->group_count == 1 && !scene->groups[0].name);
    turner_scene_destroy(scene);
    turner_scene_destroy(NULL);
}

static struct turner_vec3 face_normal(const struct turner_mesh *mesh, uint32_t triangle)
{
    const uint32_t *t = mesh->triangles[triangle];
    const struct turner_vec3 *p = mesh->positions;
    return turner_vec3_cross(turner_vec3_sub(p[t[1]], p[t[0]]), turner_vec3_sub(p[t[2]], p[t[0]]));
}

static void boxes(void **state)
{
    (void)state;
    struct turner_group group = {0};
    const struct turner_vec3 lo = {1, 2, 3}, hi = {2, 4, 6}, middle = {1.5, 3, 4.5};
    turner_group_add_box(&group, lo, hi, 7);
    struct turner_mesh *box = &group.meshes[0];
    assert_int_equal(turner_group_primitive_count(&group), 12);
    assert_true(box->material == 7 && !box->normals);
    double area = 0, volume = 0;
    for (uint32_t i = 0; i < 12; i++) {
        struct turner_vec3 normal = face_normal(box, i);
        struct turner_vec3 corner = box->positions[box->triangles[i][0]];
        double outward = turner_vec3_dot(normal, turner_vec3_sub(corner, middle));
        assert_true(outward > 0);
        area += turner_vec3_length(normal) / 2;
        volume += outward / 6;
        /* u × v of a face runs as the corners do: no mirrored pictures */
        const float *a = box->uvs[box->triangles[i][0]], *b = box->uvs[box->triangles[i][1]],
                    *c = box->uvs[box->triangles[i][2]];
        assert_true((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) == 1);
    }
    assert_true(fabs(area - 22) < 1e-12 && fabs(volume - 6) < 1e-12);
    turner_mesh_destroy(box);
    free(group.meshes);
}

/* Of a cube whose faces share nothing, all three faces at a corner weigh the same, however they
 * are cut into triangles. */
static void smooth_cube(void **state)
{
    (void)state;
    struct turner_group group = {0};
    turner_group_add_box(&group, turner_vec3_of(-1, -1, -1), turner_vec3_of(1, 1, 1), 0);
    struct turner_mesh *box = &group.meshes[0];
    turner_mesh_smooth(box);
    for (uint32_t i = 0; i < box->vertex_count; i++) {
        struct turner_vec3 p = turner_vec3_normalize(box->positions[i]);
        for (int c = 0; c < 3; c++) {
            double expected = c == 0 ? p.x : c == 1 ? p.y : p.z;
            assert_true(fabs((double)box->normals[i][c] - expected) < 1e-6);
        }
    }
    turner_mesh_destroy(box);
    free(group.meshes);
}

static void smooth_oddities(void **state)
{
    (void)state;
    /* a sheet with both sides, a triangle without area, a vertex that nothing uses */
    static const struct turner_vec3 positions[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5},
                                                   {6, 6, 6}, {7, 7, 7}, {9, 9, 9}};
    static const uint32_t triangles[][3] = {{0, 1, 2}, {0, 2, 1}, {3, 4, 5}};
    struct turner_mesh mesh = {.vertex_count = 7, .triangle_count = 3};
    mesh.positions = turner_calloc(7, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(3, sizeof *mesh.triangles);
    memcpy(mesh.positions, positions, sizeof positions);
    memcpy(mesh.triangles, triangles, sizeof triangles);
    turner_mesh_smooth(&mesh);
    for (uint32_t i = 0; i < 3; i++)
        assert_true(fabsf(mesh.normals[i][2]) == 1);
    for (uint32_t i = 3; i < 7; i++)
        assert_true(mesh.normals[i][0] == 0 && mesh.normals[i][1] == 1 && mesh.normals[i][2] == 0);
    turner_mesh_destroy(&mesh);
    assert_null(mesh.positions);
}

static void sample_pattern(void **state)
{
    (void)state;
    double x, y;
    turner_sample_position(&x, &y, 0, 1);
    assert_true(x == .5 && y == .5);
    static const double four[] = {.125, .625, .375, .875};
    for (int i = 0; i < 4; i++) {
        turner_sample_position(&x, &y, i, 4);
        assert_true(x == (i + .5) / 4 && y == four[i]);
    }
    /* 5 samples use ⌈log₂ 5⌉ = 3 bits: 0, 1/2, 1/4, 3/4, 1/8 plus 1/16 */
    static const double five[] = {.0625, .5625, .3125, .8125, .1875};
    for (int i = 0; i < 5; i++) {
        turner_sample_position(&x, &y, i, 5);
        assert_true(y == five[i]);
    }
    /* any power of two: the mean is the centre */
    double sum_x = 0, sum_y = 0;
    for (int i = 0; i < 1024; i++) {
        turner_sample_position(&x, &y, i, 1024);
        assert_true(x > 0 && x < 1 && y > 0 && y < 1);
        sum_x += x;
        sum_y += y;
    }
    assert_true(sum_x == 512 && sum_y == 512);
}

static void branching(void **state)
{
    (void)state;
    const struct turner_settings plain = {0}, spd = {.spd_rays = true};
    struct turner_material m = {.k_r = {1, 1, 1}};
    assert_false(turner_material_branches(&m, &plain));
    m.k_t = turner_vec3_of(0, 0, .1);
    assert_true(turner_material_branches(&m, &plain));
    m.k_r = turner_vec3_of(0, 0, 0);
    assert_false(turner_material_branches(&m, &plain));
    assert_true(turner_material_branches(&m, &spd));
}

static void distances(void **state)
{
    (void)state;
    static const struct {
        const char *a, *b;
        size_t limit, distance;
    } cases[] = {
        {"", "", 3, 0},          {"abc", "abc", 3, 0},       {"abc", "ABC", 3, 0},
        {"abc", "abd", 3, 1},    {"abc", "ab", 3, 1},        {"", "abc", 3, 3},
        {"abc", "acb", 3, 1},    {"kitten", "sitting", 9, 3}, {"kitten", "sitting", 2, 3},
        {"center", "centre", 2, 1}, {"abcdef", "badcfe", 9, 3}, {"a", "abcdefgh", 3, 4},
        {"ca", "abc", 9, 3}, /* optimal string alignment: no edit inside of a swap */
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        size_t there = turner_edit_distance(cases[i].a, cases[i].b, cases[i].limit);
        size_t back = turner_edit_distance(cases[i].b, cases[i].a, cases[i].limit);
        if (there != cases[i].distance || back != cases[i].distance)
            fail_msg("%s, %s: %zu, %zu", cases[i].a, cases[i].b, there, back);
    }
    char longest[300];
    memset(longest, 'x', sizeof longest);
    longest[299] = '\0';
    assert_int_equal(turner_edit_distance(longest, longest, 5), 6);
    longest[255] = '\0';
    assert_int_equal(turner_edit_distance(longest, longest, 5), 0);
}

static const char *word_of(const void *user, size_t i)
{
    return ((const char *const *)user)[i];
}

static void suggestions(void **state)
{
    (void)state;
    static const char *const words[] = {"k_r", "k_t", "radius", "radios", "k"};
    static const struct {
        const char *text, *nearest;
    } cases[] = {{"k_rr", "k_r"}, {"Radius", "radius"}, {"radiuss", "radius"},
                 {"radioss", "radios"}, {"raidus", "radius"}, {"x", NULL}, {"kr", "k_r"}, {"colour", NULL}, {"", NULL}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *nearest = turner_nearest(cases[i].text, 5, word_of, words);
        if (nearest ? !cases[i].nearest || strcmp(nearest, cases[i].nearest) != 0
                    : cases[i].nearest != NULL)
            fail_msg("%s: %s", cases[i].text, nearest ? nearest : "nothing");
    }
}

static void paths(void **state)
{
    (void)state;
    static const struct {
        const char *path, *name, *beside;
    } cases[] = {{"a.json", "b.png", "b.png"}, {"/x/a.json", "b.png", "/x/b.png"},
                 {"x/y/a.json", "../b.png", "x/y/../b.png"}, {"x/a.json", "/b.png", "/b.png"}};
    for (size_t i = 0; i < 4; i++) {
        char *beside = turner_path_beside(cases[i].path, cases[i].name);
        assert_string_equal(beside, cases[i].beside);
        free(beside);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_scene_is_valid), cmocka_unit_test(boxes),
        cmocka_unit_test(smooth_cube),          cmocka_unit_test(smooth_oddities),
        cmocka_unit_test(sample_pattern),       cmocka_unit_test(branching),
        cmocka_unit_test(distances),            cmocka_unit_test(suggestions),
        cmocka_unit_test(paths),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
