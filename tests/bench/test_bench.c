/* What turner bench measures with: its scenes are those of the generators in tools/, its judge sees
 * what it has to see, its fit finds a logarithm. No device. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "app/bench.h"
#include "base/memory.h"

/* ---- scenes ---- */

static struct turner_scene *scene_of(const char *name)
{
    struct turner_scene *scene;
    if (turner_bench_scene(&scene, name, 8, 8) != TURNER_OK)
        fail_msg("%s: %s", name, turner_message());
    return scene;
}

/* What a generator of tools/ writes. */
static struct turner_scene *generated(const char *command, const char *file)
{
    char line[4096], path[2048];
    mkdir(TURNER_WORK_DIR, 0777);
    snprintf(path, sizeof path, TURNER_WORK_DIR "/%s", file);
    snprintf(line, sizeof line, "python3 -B '" TURNER_SOURCE_DIR "/tools/'%s -o '%s' >/dev/null",
             command, path);
    assert_int_equal(system(line), 0);
    return scene_of(path);
}

static void assert_near(struct turner_vec3 a, struct turner_vec3 b, double most)
{
    double d = sqrt(turner_vec3_dot(turner_vec3_sub(a, b), turner_vec3_sub(a, b)));
    if (!(d <= most))
        fail_msg("(%g %g %g) is not (%g %g %g)", a.x, a.y, a.z, b.x, b.y, b.z);
}

static void sphereflake_is_the_generators(void **state)
{
    (void)state;
    struct turner_scene *own = scene_of("sphereflake:3");
    struct turner_scene *other = generated("make_sphereflake.py --depth 3", "flake.nff");
    const struct turner_group *a = &own->groups[0], *b = &other->groups[0];
    assert_int_equal(a->sphere_count, 820); /* 1 + 9 + 81 + 729 */
    assert_int_equal(b->sphere_count, 820);
    for (size_t i = 0; i < a->sphere_count; i++) {
        assert_near(a->spheres[i].center, b->spheres[i].center, 2e-6); /* NFF has 6 digits */
        assert_true(fabs(a->spheres[i].radius - b->spheres[i].radius) < 1e-6);
    }
    turner_scene_destroy(own);
    turner_scene_destroy(other);
}

static struct turner_vec3 corner(const struct turner_mesh *mesh, uint32_t triangle, int i)
{
    return mesh->positions[mesh->triangles[triangle][i]];
}

static void mesh_is_the_generators(void **state)
{
    (void)state;
    struct turner_scene *own = scene_of("mesh:1200");
    struct turner_scene *other = generated("make_mesh.py bumps --triangles 1200", "bumps.ply");
    const struct turner_mesh *a = &own->groups[0].meshes[0], *b = &other->groups[0].meshes[0];
    assert_int_equal(a->triangle_count, 1200);
    assert_int_equal(b->triangle_count, 1200);
    for (uint32_t i = 0; i < a->triangle_count; i++) {
        for (int k = 0; k < 3; k++)
            assert_near(corner(a, i, k), corner(b, i, k), 2e-7);
    }
    turner_scene_destroy(own);
    turner_scene_destroy(other);
}

/* Every edge belongs to two triangles, which pass it in opposite directions. */
static void mesh_is_closed(void **state)
{
    (void)state;
    struct turner_scene *scene = scene_of("mesh:300");
    const struct turner_mesh *mesh = &scene->groups[0].meshes[0];
    uint32_t n = mesh->vertex_count;
    int *edges = turner_calloc((size_t)n * n, sizeof *edges);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int k = 0; k < 3; k++) {
            uint32_t from = mesh->triangles[i][k], to = mesh->triangles[i][(k + 1) % 3];
            assert_true(from < n && to < n && from != to);
            edges[from * n + to]++;
        }
    }
    for (uint32_t from = 0; from < n; from++) {
        for (uint32_t to = 0; to < n; to++) {
            assert_in_range(edges[from * n + to], 0, 1);
            assert_int_equal(edges[from * n + to], edges[to * n + from]);
        }
    }
    free(edges);
    turner_scene_destroy(scene);
}

static void wrong_names_are_refused(void **state)
{
    (void)state;
    static const char *const names[] = {"sphereflake:8", "sphereflake:", "mesh:11", "mesh:many"};
    struct turner_scene *scene;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(turner_bench_scene(&scene, names[i], 8, 8), TURNER_USAGE);
        assert_null(scene);
    }
}

/* ---- the judge ---- */

enum { RAYS = 5000 };

struct court {
    struct turner_scene *scene;
    struct turner_world world;
    struct turner_gpu_ray rays[RAYS];
    struct turner_gpu_hit first[RAYS], second[RAYS]; /* right until a test spoils them */
};

/* Parallel rays down the z axis onto a lattice. */
static int open_court(void **state)
{
    struct court *court = turner_calloc(1, sizeof *court);
    *state = court;
    court->scene = scene_of("sphereflake:2");
    if (turner_world_create(&court->world, court->scene) != TURNER_OK)
        return -1;
    for (int i = 0; i < RAYS; i++) {
        float x = (float)(i % 100) / 70 - 0.7f, y = (float)(i / 100) / 35 - 0.7f;
        court->rays[i] = (struct turner_gpu_ray){{x, y, 3}, INFINITY, {0, 0, -1}, 0};
        struct turner_ray ray = {.origin = vector(x, y, 3), .direction = vector(0, 0, -1)};
        struct turner_hit hit;
        bool met = turner_world_intersect(&hit, &court->world, &ray, INFINITY);
        court->first[i] = (struct turner_gpu_hit){met ? (float)hit.t : INFINITY,
                                                  met ? hit.place.primitive : 0, 0};
        court->second[i] = court->first[i];
    }
    return 0;
}

static int close_court(void **state)
{
    struct court *court = *state;
    turner_world_destroy(&court->world);
    turner_scene_destroy(court->scene);
    free(court);
    return 0;
}

static void judge(struct turner_bench_cell cells[2], struct court *court, size_t check)
{
    struct turner_gpu_hit *hits[] = {court->first, court->second};
    struct turner_bench_stream stream = {.rays = court->rays, .count = RAYS};
    memset(cells, 0, 2 * sizeof *cells);
    turner_bench_check(cells, hits, 2, &stream, &court->world, check);
}

static int some_hit(const struct court *court)
{
    int i = RAYS / 2;
    while (!(court->first[i].t < INFINITY))
        i++;
    return i;
}

static void right_hits_pass(void **state)
{
    struct court *court = *state;
    struct turner_bench_cell cells[2];
    judge(cells, court, RAYS);
    for (int k = 0; k < 2; k++) {
        assert_int_equal(cells[k].checked, RAYS);
        assert_int_equal(cells[k].wrong, 0);
        assert_true(turner_bench_right(&cells[k], RAYS));
    }
    judge(cells, court, 100);
    assert_in_range(cells[0].checked, 99, 101);
}

/* One ray in 5000, where two disagree: found though the sample misses it, and who is wrong. */
static void a_single_wrong_hit_is_found(void **state)
{
    struct court *court = *state;
    struct turner_bench_cell cells[2];
    int i = some_hit(court);
    const struct turner_gpu_hit wrong[] = {
        {INFINITY, 0, 0},                                            /* lost */
        {court->first[i].t * 1.001f, court->first[i].id, 0},         /* too far */
        {court->first[i].t - 0.001f, court->first[i].id, 0},
        {(float)NAN, court->first[i].id, 0},
        {court->first[i].t, court->first[i].id ^ 1, 0},              /* another sphere, */
        {court->first[i].t, court->first[i].id, 1},                  /* or in an instance, */
        {court->first[i].t, court->first[i].id | 2u << 30, 0},       /* or a triangle */
    };
    const size_t misnamed = 4; /* from here on */
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        court->second[i] = wrong[k];
        judge(cells, court, 1);
        assert_int_equal(cells[0].wrong + cells[0].misnamed, 0);
        assert_int_equal(cells[1].wrong, k < misnamed);
        assert_int_equal(cells[1].misnamed, k >= misnamed);
    }
}

/* Two spheres in one place: either will do, another one will not. */
static void either_of_two_is_right(void **state)
{
    struct court *court = *state;
    struct turner_bench_cell cells[2];
    struct turner_group *group = &court->scene->groups[0];
    uint32_t twin = (uint32_t)group->sphere_count;
    for (uint32_t k = 0; k < twin; k++)
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
            (struct turner_sphere){group->spheres[k].center, group->spheres[k].radius, 0};
    turner_world_destroy(&court->world);
    assert_int_equal(turner_world_create(&court->world, court->scene), TURNER_OK);
    for (int i = 0; i < RAYS; i++)
        court->second[i].id += twin;
    judge(cells, court, RAYS);
    assert_int_equal(cells[0].wrong + cells[1].wrong, 0);
    assert_int_equal(cells[0].misnamed + cells[1].misnamed, 0);
    court->second[some_hit(court)].id ^= 1;
    judge(cells, court, 1);
    assert_int_equal(cells[0].misnamed, 0);
    assert_int_equal(cells[1].misnamed, 1);
}

/* What both are wrong about is found by the sample, and gets no figure. */
static void common_errors_are_found(void **state)
{
    struct court *court = *state;
    struct turner_bench_cell cells[2];
    size_t spoilt = 0;
    for (int i = 0; i < RAYS; i++) {
        if (court->first[i].t < INFINITY)
            spoilt++, court->first[i].t = court->second[i].t = court->first[i].t * 0.999f;
    }
    judge(cells, court, RAYS / 10);
    assert_true(spoilt > RAYS / 4);
    for (int k = 0; k < 2; k++) {
        assert_true(cells[k].wrong > spoilt / 20);
        assert_false(turner_bench_right(&cells[k], RAYS));
    }
}

static void shadow_rays_are_yes_or_no(void **state)
{
    struct court *court = *state;
    struct turner_bench_cell cells[2];
    for (int i = 0; i < RAYS; i++) {
        court->rays[i].kind = TURNER_RAY_ANY;
        if (court->first[i].t < INFINITY)
            court->second[i].t = 0; /* anywhere will do */
    }
    judge(cells, court, RAYS);
    assert_int_equal(cells[0].wrong + cells[1].wrong, 0);
    court->second[some_hit(court)].t = INFINITY;
    judge(cells, court, 1);
    assert_int_equal(cells[0].wrong, 0);
    assert_int_equal(cells[1].wrong, 1);
    /* what lies beyond the light casts no shadow */
    for (int i = 0; i < RAYS; i++)
        court->rays[i].t_max = 0.5f;
    judge(cells, court, RAYS);
    assert_true(cells[0].wrong > RAYS / 4);
}

static void limit_of_wrong_rays(void **state)
{
    (void)state;
    assert_true(turner_bench_right(&(struct turner_bench_cell){.wrong = 1}, 100));
    assert_false(turner_bench_right(&(struct turner_bench_cell){.wrong = 2}, 100));
    assert_true(turner_bench_right(&(struct turner_bench_cell){.wrong = 11}, 1000000));
    assert_false(turner_bench_right(&(struct turner_bench_cell){.wrong = 12}, 1000000));
    assert_true(turner_bench_right(&(struct turner_bench_cell){.misnamed = 101}, 1000000));
    assert_false(turner_bench_right(&(struct turner_bench_cell){.misnamed = 102}, 1000000));
}

/* ---- growth ---- */

static void fit_finds_a_logarithm(void **state)
{
    (void)state;
    struct turner_bench_scene *scenes = turner_calloc(4, sizeof *scenes);
    struct turner_bench bench = {.scenes = scenes, .scene_count = 4};
    struct turner_bench_fit fit;
    for (int i = 0; i < 4; i++) {
        scenes[i].primitives = 1024u << (3 * i);
        scenes[i].cells[0][1].rounds = i < 2;
        scenes[i].cells[0][1].rate = 1e9 / (20 + 7 * log2((double)scenes[i].primitives));
    }
    assert_false(turner_bench_fit_log(&fit, &bench, 1, 0)); /* two points are a line anyway */
    for (int i = 0; i < 4; i++)
        scenes[i].cells[0][1].rounds = 1;
    assert_true(turner_bench_fit_log(&fit, &bench, 1, 0));
    assert_true(fabs(fit.a - 20) < 1e-6 && fabs(fit.b - 7) < 1e-6 && fit.off < 1e-6);
    scenes[3].cells[0][1].rate /= 2;
    assert_true(turner_bench_fit_log(&fit, &bench, 1, 0));
    assert_true(fit.off > 0.1);
    free(scenes);
}

int main(void)
{
#define IN_COURT(test) cmocka_unit_test_setup_teardown(test, open_court, close_court)
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sphereflake_is_the_generators),
        cmocka_unit_test(mesh_is_the_generators),
        cmocka_unit_test(mesh_is_closed),
        cmocka_unit_test(wrong_names_are_refused),
        IN_COURT(right_hits_pass),
        IN_COURT(a_single_wrong_hit_is_found),
        IN_COURT(either_of_two_is_right),
        IN_COURT(common_errors_are_found),
        IN_COURT(shadow_rays_are_yes_or_no),
        cmocka_unit_test(limit_of_wrong_rays),
        cmocka_unit_test(fit_finds_a_logarithm),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
