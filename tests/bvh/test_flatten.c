/* The records: what the scene says, in floats, findable by id; and what is refused. */
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
#include "scenes.h"

static void assert_point(const float found[3], struct turner_vec3 point)
{
    assert_true(found[0] == (float)point.x);
    assert_true(found[1] == (float)point.y);
    assert_true(found[2] == (float)point.z);
}

/* By kind and place in the group, the record among `count` from `first` on; each id once. */
static const struct turner_gpu_primitive **
sort_by_id(const struct turner_flat *flat, const struct turner_group *group, size_t first)
{
    size_t count = turner_group_primitive_count(group);
    size_t starts[3] = {0, group->sphere_count, group->sphere_count + group->cone_count};
    const struct turner_gpu_primitive **sorted = turner_calloc(count, sizeof *sorted);
    for (size_t i = first; i < first + count; i++) {
        uint32_t kind = flat->primitives[i].id >> TURNER_KIND_SHIFT;
        assert_in_range(kind, TURNER_KIND_SPHERE, TURNER_KIND_TRIANGLE);
        size_t place = starts[kind] + (flat->primitives[i].id & 0x3fffffffu);
        assert_true(place < (kind == TURNER_KIND_TRIANGLE ? count : starts[kind + 1]));
        assert_null(sorted[place]);
        sorted[place] = &flat->primitives[i];
    }
    return sorted;
}

static void check_group(const struct turner_flat *flat, const struct turner_group *group,
                        size_t first)
{
    const struct turner_gpu_primitive **sorted = sort_by_id(flat, group, first);
    const struct turner_gpu_primitive **next = sorted;
    for (size_t i = 0; i < group->sphere_count; i++, next++) {
        assert_point((*next)->a, group->spheres[i].center);
        assert_true((*next)->b[0] == (float)group->spheres[i].radius);
        assert_int_equal((*next)->material, group->spheres[i].material == 1
                                                ? (1 | TURNER_MATERIAL_TRANSMISSIVE)
                                                : group->spheres[i].material);
        assert_int_equal((*next)->attributes, TURNER_NO_INDEX);
    }
    for (size_t i = 0; i < group->cone_count; i++, next++) {
        assert_point((*next)->a, group->cones[i].base);
        assert_point((*next)->b, group->cones[i].apex);
        assert_true((*next)->c[0] == (float)group->cones[i].base_radius);
        assert_true((*next)->c[1] == (float)group->cones[i].apex_radius);
        assert_true((*next)->c[2] == (group->cones[i].capped ? 1.0f : 0.0f));
        assert_int_equal((*next)->attributes, TURNER_NO_INDEX);
    }
    for (size_t m = 0; m < group->mesh_count; m++) {
        const struct turner_mesh *mesh = &group->meshes[m];
        for (uint32_t i = 0; i < mesh->triangle_count; i++, next++) {
            assert_point((*next)->a, mesh->positions[mesh->triangles[i][0]]);
            assert_point((*next)->b, mesh->positions[mesh->triangles[i][1]]);
            assert_point((*next)->c, mesh->positions[mesh->triangles[i][2]]);
        }
    }
    free(sorted);
}

static void test_records(void **state)
{
    (void)state;
    uint64_t random = 31;
    struct turner_scene *scene = make_scene();
    fill_group(&scene->groups[0], &random, 100, 90, 80);
    add_soup(&scene->groups[0], &random, 33, 0.1, 1);
    uint32_t group = add_group(scene);
    fill_group(&scene->groups[group], &random, 5, 0, 7);
    for (int order = TURNER_ORDER_SAH; order <= TURNER_ORDER_MEDIAN; order++) {
        struct turner_flat flat;
        assert_int_equal(turner_flat_create(&flat, scene, (enum turner_order)order), TURNER_OK);
        assert_int_equal(flat.primitive_count, 303 + 12);
        check_group(&flat, &scene->groups[0], 0);
        check_group(&flat, &scene->groups[1], 303);
        assert_int_equal(flat.corner_count, 0);
        assert_int_equal(flat.vertex_count, 0);
        turner_flat_destroy(&flat);
    }
    turner_scene_destroy(scene);
}

static void give_normals(struct turner_mesh *mesh, uint64_t *random)
{
    mesh->normals = turner_calloc(mesh->vertex_count, sizeof *mesh->normals);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct turner_vec3 n = turner_vec3_normalize(random_point(random, -1, 1));
        mesh->normals[i][0] = (float)n.x, mesh->normals[i][1] = (float)n.y;
        mesh->normals[i][2] = (float)n.z;
    }
}

static void give_uvs(struct turner_mesh *mesh, uint64_t *random)
{
    mesh->uvs = turner_calloc(mesh->vertex_count, sizeof *mesh->uvs);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        mesh->uvs[i][0] = (float)random_in(random, 1, 2);
        mesh->uvs[i][1] = (float)random_in(random, 1, 2);
    }
}

/* The attributes of every triangle of a mesh whose first triangle has id `first` in group 0. */
static void check_attributes(const struct turner_flat *flat, const struct turner_mesh *mesh,
                             uint32_t first, bool normals, bool uvs)
{
    uint32_t seen = 0;
    for (size_t k = 0; k < flat->primitive_count; k++) {
        uint32_t i = (flat->primitives[k].id & 0x3fffffffu) - first;
        uint32_t attributes = flat->primitives[k].attributes;
        if (i >= mesh->triangle_count)
            continue;
        seen++;
        if (!normals && !uvs) {
            assert_int_equal(attributes, TURNER_NO_INDEX);
            continue;
        }
        assert_int_equal((attributes & TURNER_ATTRIBUTES_NORMALS) != 0, normals);
        assert_int_equal((attributes & TURNER_ATTRIBUTES_UVS) != 0, uvs);
        assert_in_range(attributes & TURNER_ATTRIBUTES_MASK, 0, flat->corner_count - 1);
        const struct turner_gpu_corners *corners =
            &flat->corners[attributes & TURNER_ATTRIBUTES_MASK];
        const float none[3] = {0};
        for (int corner = 0; corner < 3; corner++) {
            uint32_t vertex = corners->vertex[corner], own = mesh->triangles[i][corner];
            assert_in_range(vertex, 0, flat->vertex_count - 1);
            assert_memory_equal(flat->normals[vertex], normals ? mesh->normals[own] : none,
                                sizeof *flat->normals);
            assert_memory_equal(flat->uvs[vertex], uvs ? mesh->uvs[own] : none, sizeof *flat->uvs);
        }
    }
    assert_int_equal(seen, mesh->triangle_count);
}

static void test_attributes(void **state)
{
    (void)state;
    uint64_t random = 32;
    struct turner_scene *scene = make_scene();
    struct turner_group *group = &scene->groups[0];
    add_soup(group, &random, 10, 0.2, 2); /* pattern, but no uvs */
    give_normals(add_soup(group, &random, 20, 0.2, 0), &random);
    give_uvs(add_soup(group, &random, 30, 0.2, 0), &random); /* uvs, but no pattern */
    give_uvs(add_soup(group, &random, 40, 0.2, 2), &random);
    struct turner_mesh *both = add_soup(group, &random, 50, 0.2, 2);
    give_uvs(both, &random);
    give_normals(both, &random);
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(flat.corner_count, 20 + 40 + 50);
    assert_int_equal(flat.vertex_count, 3 * (20 + 40 + 50));
    check_attributes(&flat, &group->meshes[0], 0, false, false);
    check_attributes(&flat, &group->meshes[1], 10, true, false);
    check_attributes(&flat, &group->meshes[2], 30, false, false);
    check_attributes(&flat, &group->meshes[3], 60, false, true);
    check_attributes(&flat, &group->meshes[4], 100, true, true);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

static void test_pattern_of_instance(void **state)
{
    (void)state;
    uint64_t random = 33;
    struct turner_scene *scene = make_scene();
    uint32_t group = add_group(scene);
    give_uvs(add_soup(&scene->groups[group], &random, 9, 0.2, 0), &random);
    add_instance(scene, group, TURNER_NONE, TURNER_AFFINE_IDENTITY);
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(flat.vertex_count, 0);
    turner_flat_destroy(&flat);
    add_instance(scene, group, 2, TURNER_AFFINE_IDENTITY);
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(flat.vertex_count, 27);
    check_attributes(&flat, &scene->groups[group].meshes[0], 0, false, true);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

static void test_instances(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    uint32_t group = add_group(scene);
    add_sphere(&scene->groups[0], turner_vec3_of(0, 0, 0), 1, 0);
    add_sphere(&scene->groups[group], turner_vec3_of(1, 0, 0), 1, 0); /* x 0…2, y, z −1…1 */
    struct turner_affine moved = {{{0, -4, 0, 1000}, {4, 0, 0, 0}, {0, 0, 4, -8}}};
    add_instance(scene, group, TURNER_NONE, TURNER_AFFINE_IDENTITY);
    add_instance(scene, group, 1, moved);
    struct turner_flat flat;
    assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
    assert_int_equal(flat.instance_count, 3);
    assert_int_equal(flat.instance_groups[0], 0);
    assert_int_equal(flat.instance_groups[1], group);
    assert_int_equal(flat.instance_groups[2], group);
    assert_int_equal(flat.instances[0].material, TURNER_NO_INDEX);
    assert_int_equal(flat.instances[2].material, 1 | TURNER_MATERIAL_TRANSMISSIVE);
    const float identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};
    for (int i = 0; i < 12; i++) {
        assert_true(flat.instances[0].to_world[i] == identity[i]);
        assert_true(flat.instances[1].to_group[i] == identity[i]);
        assert_true(flat.instances[2].to_world[i] == (float)moved.m[i / 4][i % 4]);
    }
    const float inverse[12] = {0, .25f, 0, 0, -.25f, 0, 0, 250, 0, 0, .25f, 2};
    for (int i = 0; i < 12; i++)
        assert_true(flat.instances[2].to_group[i] == inverse[i]);
    assert_true(flat.instances[0].spawn_scale == 0);
    assert_true(flat.instances[1].spawn_scale == 0);
    /* row 1 of to_group: (4·1 + 1000)/4 + 250 */
    assert_float_equal(flat.instances[2].spawn_scale, 501, 1e-3);
    turner_flat_destroy(&flat);
    turner_scene_destroy(scene);
}

/* spawn_scale bounds every partial sum of a point's way to the world and back. */
static void test_spawn_scale(void **state)
{
    (void)state;
    uint64_t random = 34;
    for (int i = 0; i < 200; i++) {
        struct turner_scene *scene = make_scene();
        uint32_t group = add_group(scene);
        add_sphere(&scene->groups[group], random_point(&random, -5, 5), 0.5, 0);
        double scale = pow(10, random_in(&random, -6, 6));
        add_instance(scene, group, TURNER_NONE,
                     make_transform(scale, random_point(&random, -1e5, 1e5)));
        struct turner_flat flat;
        assert_int_equal(turner_flat_create(&flat, scene, TURNER_ORDER_SAH), TURNER_OK);
        const struct turner_gpu_instance *instance = &flat.instances[1];
        const struct turner_flat_group *bounds = &flat.groups[group];
        double largest = 0;
        for (int corner = 0; corner < 8; corner++) {
            double p[3], world[3];
            for (int j = 0; j < 3; j++)
                p[j] = (double)(corner >> j & 1 ? bounds->hi[j] : bounds->lo[j]);
            for (int row = 0; row < 3; row++) {
                const float *m = instance->to_world + 4 * row;
                world[row] =
                    (double)m[0] * p[0] + (double)m[1] * p[1] + (double)m[2] * p[2] + (double)m[3];
            }
            for (int row = 0; row < 3; row++) {
                const float *m = instance->to_group + 4 * row;
                double sum = 0;
                for (int j = 0; j < 4; j++) {
                    sum += (double)m[j] * (j < 3 ? world[j] : 1);
                    largest = fmax(largest, fabs(sum));
                }
            }
        }
        double spawn_scale = (double)instance->spawn_scale;
        assert_true(spawn_scale >= largest * (1 - 4 * (double)FLT_EPSILON));
        assert_true(spawn_scale <= 20 * largest); /* and is not idle */
        turner_flat_destroy(&flat);
        turner_scene_destroy(scene);
    }
}

static void assert_refused(struct turner_scene *scene, enum turner_result expected,
                           const char *words)
{
    struct turner_flat flat;
    for (int order = TURNER_ORDER_SAH; order <= TURNER_ORDER_MEDIAN; order++) {
        assert_int_equal(turner_flat_create(&flat, scene, (enum turner_order)order), expected);
        assert_non_null(strstr(turner_message(), words));
        assert_null(flat.primitives);
    }
    turner_scene_destroy(scene);
}

static void test_refused_numbers(void **state)
{
    (void)state;
    struct turner_scene *scene = make_scene();
    add_sphere(&scene->groups[0], turner_vec3_of(0, 0, 0), 1, 0);
    add_sphere(&scene->groups[0], turner_vec3_of(0, 1e39, 0), 1, 0);
    assert_refused(scene, TURNER_BAD_INPUT, "sphere 1 of the world");

    scene = make_scene();
    uint32_t group = add_group(scene);
    add_cone(&scene->groups[group], turner_vec3_of(0, 0, 0), 3e38, turner_vec3_of(2e38, 0, 0), 1,
             true, 0);
    scene->groups[group].cones[0].base.y = 2e38;
    assert_refused(scene, TURNER_BAD_INPUT, "cone 0 of group \"thing\"");

    const double scales[] = {1e-39, 1e39, 1e-60, 1e-200};
    for (size_t i = 0; i < sizeof scales / sizeof *scales; i++) {
        scene = make_scene();
        group = add_group(scene);
        add_sphere(&scene->groups[group], turner_vec3_of(0, 0, 0), 1, 0);
        add_instance(scene, group, TURNER_NONE, make_transform(scales[i], turner_vec3_of(0, 0, 0)));
        assert_refused(scene, TURNER_BAD_INPUT, "instance 0");
    }
}

static void test_refused_memory(void **state)
{
    (void)state;
    /* 2^38 triangles that are only claimed: 17 TB for the smaller order */
    struct turner_scene *scene = make_scene();
    struct turner_group *group = &scene->groups[0];
    for (int i = 0; i < 64; i++) {
        *TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity) =
            (struct turner_mesh){.triangle_count = UINT32_MAX};
    }
    assert_refused(scene, TURNER_DEVICE, "MiB");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_records),
        cmocka_unit_test(test_attributes),
        cmocka_unit_test(test_pattern_of_instance),
        cmocka_unit_test(test_instances),
        cmocka_unit_test(test_spawn_scale),
        cmocka_unit_test(test_refused_numbers),
        cmocka_unit_test(test_refused_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
