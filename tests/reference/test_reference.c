/* What the reference tracer promises of itself: the same bytes with any number of threads, rays
 * that never meet the surface they leave, no gap in a mesh, ties, instances, deep recursion. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "image/image.h"
#include "reference/reference.h"
#include "reference/world.h"

/* ---- building ---- */

static uint32_t add_material(struct turner_scene *scene, struct turner_material material)
{
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = material;
    return (uint32_t)scene->material_count - 1;
}

static struct turner_material plain(void)
{
    return (struct turner_material){
        .exponent = 1, .medium = TURNER_NONE, .uv_scale = {1, 1}, .fresnel = TURNER_FRESNEL_NONE};
}

static struct turner_vec3 v3(double x, double y, double z)
{
    return turner_vec3_of(x, y, z);
}

static uint32_t add_mirror(struct turner_scene *scene, double k_r)
{
    struct turner_material mirror = plain();
    mirror.k_r = v3(k_r, k_r, k_r);
    return add_material(scene, mirror);
}

static uint32_t add_lamp(struct turner_scene *scene, double k_e)
{
    struct turner_material lamp = plain();
    lamp.k_e = v3(k_e, k_e, k_e);
    return add_material(scene, lamp);
}

static void add_sphere(struct turner_group *group, struct turner_vec3 center, double radius,
                       uint32_t material)
{
    *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
        (struct turner_sphere){center, radius, material};
}

static void add_cone(struct turner_group *group, struct turner_vec3 base, double base_radius,
                     struct turner_vec3 apex, double apex_radius, uint32_t material)
{
    *TURNER_PUSH(group->cones, group->cone_count, group->cone_capacity) =
        (struct turner_cone){base, apex, base_radius, apex_radius, true, material};
}

static struct turner_group *add_group(struct turner_scene *scene)
{
    struct turner_group *group =
        TURNER_PUSH(scene->groups, scene->group_count, scene->group_capacity);
    *group = (struct turner_group){0};
    return group;
}

static void add_instance(struct turner_scene *scene, uint32_t group, uint32_t material,
                         struct turner_affine transform)
{
    *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) =
        (struct turner_instance){group, material, transform};
}

/* A sphere of 2·rings·rings triangles, closed and convex. */
static void add_globe(struct turner_group *group, struct turner_vec3 center, double radius,
                      uint32_t rings, uint32_t material)
{
    uint32_t turns = 2 * rings;
    struct turner_mesh mesh = {.material = material,
                               .vertex_count = turns * (rings - 1) + 2,
                               .triangle_count = turns * (2 * rings - 2)};
    mesh.positions = turner_calloc(mesh.vertex_count, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(mesh.triangle_count, sizeof *mesh.triangles);
    uint32_t vertex = 0, north = mesh.vertex_count - 2, south = mesh.vertex_count - 1, t = 0;
    for (uint32_t ring = 1; ring < rings; ring++) {
        for (uint32_t turn = 0; turn < turns; turn++) {
            double theta = acos(-1) * ring / rings, phi = 2 * acos(-1) * turn / turns;
            mesh.positions[vertex++] =
                v3(center.x + radius * sin(theta) * sin(phi), center.y + radius * cos(theta),
                   center.z + radius * sin(theta) * cos(phi));
        }
    }
    mesh.positions[north] = v3(center.x, center.y + radius, center.z);
    mesh.positions[south] = v3(center.x, center.y - radius, center.z);
    for (uint32_t turn = 0; turn < turns; turn++) {
        uint32_t next = (turn + 1) % turns, last = turns * (rings - 2);
        memcpy(mesh.triangles[t++], (uint32_t[]){north, turn, next}, sizeof *mesh.triangles);
        memcpy(mesh.triangles[t++], (uint32_t[]){south, last + next, last + turn},
               sizeof *mesh.triangles);
        for (uint32_t ring = 0; ring + 2 < rings; ring++) {
            uint32_t a = ring * turns + turn, b = ring * turns + next;
            memcpy(mesh.triangles[t++], (uint32_t[]){a, a + turns, b}, sizeof *mesh.triangles);
            memcpy(mesh.triangles[t++], (uint32_t[]){b, a + turns, b + turns},
                   sizeof *mesh.triangles);
        }
    }
    assert_int_equal(t, mesh.triangle_count);
    *TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity) = mesh;
}

/* A furnace: everything around has radiance 1. */
static struct turner_scene *furnace(int size, int depth)
{
    struct turner_scene *scene = turner_scene_create();
    scene->settings.width = scene->settings.height = size;
    scene->settings.depth = depth;
    scene->settings.cutoff = 0;
    scene->background.color = v3(1, 1, 1);
    return scene;
}

static void render(struct turner_image *image, const struct turner_scene *scene)
{
    if (turner_scene_validate(scene) != TURNER_OK ||
        turner_reference_render(image, scene, 2, NULL, NULL, NULL) != TURNER_OK)
        fail_msg("%s", turner_message());
}

/* Counts pixels that differ from `value` by more than 1e-6. */
static int count_other(const struct turner_image *image, double value)
{
    int count = 0;
    for (int i = 0; i < image->width * image->height; i++)
        count += !(fabs((double)image->rgba[4 * i] - value) <= 1e-6);
    return count;
}

/* ---- threads and progress ---- */

static struct turner_scene *mixed_scene(void)
{
    struct turner_scene *scene = furnace(33, 6);
    scene->background = (struct turner_background){
        .kind = TURNER_BACKGROUND_GRADIENT, .top = v3(1, 0.5, 0.2), .up = v3(0, 1, 0)};
    uint32_t mirror = add_mirror(scene, 0.8);
    for (int i = 0; i < 27; i++)
        add_sphere(&scene->groups[0], v3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1), 0.4, mirror);
    return scene;
}

static void test_threads(void **state)
{
    (void)state;
    struct turner_scene *scene = mixed_scene();
    scene->settings.spp = 3;
    struct turner_image one = {0}, other = {0};
    struct turner_reference_statistics s1, s2;
    assert_int_equal(turner_reference_render(&one, scene, 1, &s1, NULL, NULL), TURNER_OK);
    for (int threads = 2; threads < 40; threads = 3 * threads - 1) {
        assert_int_equal(turner_reference_render(&other, scene, threads, &s2, NULL, NULL),
                         TURNER_OK);
        assert_memory_equal(one.rgba, other.rgba, 33 * 33 * 4 * sizeof(float));
        assert_memory_equal(&s1, &s2, sizeof s1);
        turner_image_destroy(&other);
    }
    assert_int_equal(s1.camera_rays, 33 * 33 * 3);
    assert_true(s1.reflected_rays > 0 && s1.largest_depth > 2);
    turner_image_destroy(&one);
    turner_scene_destroy(scene);
}

struct progress {
    double last;
    int calls, stop_after;
};

static bool on_progress(double share, void *user)
{
    struct progress *progress = user;
    assert_true(share > progress->last && share <= 1);
    progress->last = share;
    return ++progress->calls != progress->stop_after;
}

static void test_progress(void **state)
{
    (void)state;
    struct turner_scene *scene = mixed_scene();
    struct turner_image image;
    struct progress whole = {0}, stopped = {.stop_after = 1};
    assert_int_equal(turner_reference_render(&image, scene, 2, NULL, on_progress, &whole),
                     TURNER_OK);
    assert_true(whole.calls >= 1 && whole.last == 1);
    turner_image_destroy(&image);
    assert_int_equal(turner_reference_render(&image, scene, 2, NULL, on_progress, &stopped),
                     TURNER_INTERRUPTED);
    assert_null(image.rgba);
    turner_scene_destroy(scene);
}

/* ---- rays that leave a surface ---- */

/* A convex mirror in a furnace sends every ray out at once: with depth 1 all pixels are 1. One ray
 * that met its own surface again would be cut and leave a black pixel. */
static void check_convex(struct turner_scene *scene, struct turner_vec3 center, double radius)
{
    struct turner_image image;
    scene->camera.at = center;
    scene->camera.from =
        turner_vec3_add(center, turner_vec3_scale(v3(0.3, 0.5, 1), 4 * radius));
    render(&image, scene);
    assert_int_equal(count_other(&image, 1), 0);
    turner_image_destroy(&image);

    scene->settings.depth = 0; /* it is there at all */
    render(&image, scene);
    assert_true(count_other(&image, 1) > 200);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

static void test_leaving(void **state)
{
    (void)state;
    static const double places[][2] = {{1, 0}, {1, 1e3}, {1, 1e5}, {100, 0}, {1e4, 0}, {1e-6, 1}};
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        double r = places[i][0];
        struct turner_vec3 c = v3(places[i][1], -places[i][1], 2 * places[i][1]);

        struct turner_scene *scene = furnace(64, 1);
        add_sphere(&scene->groups[0], c, r, add_mirror(scene, 1));
        check_convex(scene, c, r);

        scene = furnace(64, 1);
        add_globe(&scene->groups[0], c, r, 8, add_mirror(scene, 1));
        check_convex(scene, c, r);

        scene = furnace(64, 1);
        add_cone(&scene->groups[0], turner_vec3_sub(c, v3(0, r, 0.1 * r)), r,
                 turner_vec3_add(c, v3(0, r, 0)), r / 3, add_mirror(scene, 1));
        check_convex(scene, c, r);

        scene = furnace(64, 1);
        turner_group_add_box(&scene->groups[0], turner_vec3_sub(c, v3(r, r, r)),
                             turner_vec3_add(c, v3(r, r, r)), add_mirror(scene, 1));
        check_convex(scene, c, r);

        /* the same as an instance whose group stands a thousand radii from its origin */
        scene = furnace(64, 1);
        uint32_t mirror = add_mirror(scene, 1);
        struct turner_group *group = add_group(scene);
        add_globe(group, v3(1000, 0, 0), 1, 8, mirror);
        add_instance(scene, 1, TURNER_NONE,
                     (struct turner_affine){{{r, 0, 0, c.x - 1000 * r},
                                             {0, 0, r, c.y},
                                             {0, -r, 0, c.z}}});
        check_convex(scene, c, r);
    }
}

/* From inside, a ball of glass that lets everything straight through shows what is around it; what
 * the surface hides from its own rays would be missing. */
static void test_leaving_inward(void **state)
{
    (void)state;
    for (int kind = 0; kind < 4; kind++) {
        struct turner_scene *scene = furnace(64, 2);
        *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
            (struct turner_medium){.index = 1};
        struct turner_material clear = plain();
        clear.k_t = v3(0.5, 0.5, 0.5);
        clear.medium = 0;
        uint32_t material = add_material(scene, clear);
        struct turner_group *world = &scene->groups[0];
        if (kind == 0)
            add_sphere(world, v3(0, 0, 0), 1.5, material);
        else if (kind == 1)
            add_cone(world, v3(0, -1, 0), 1, v3(0, 1, 0), 1, material);
        else if (kind == 2)
            add_cone(world, v3(-1, -1, 0), 1.2, v3(1, 1, 0), 0, material);
        else
            add_globe(world, v3(0, 0, 0), 1.5, 6, material);
        struct turner_image image;
        render(&image, scene);
        int crossed = 0;
        for (int i = 0; i < 64 * 64; i++) { /* around it 1; through it in and out: 1/4 */
            float value = image.rgba[4 * i];
            assert_true(value == 1 || value == 0.25f);
            crossed += value == 0.25f;
        }
        assert_true(crossed > 200);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* Two surfaces 4e-5 apart are two. */
static void test_concentric(void **state)
{
    (void)state;
    struct turner_scene *scene = furnace(1, 2);
    scene->background.color = v3(0, 0, 0);
    *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
        (struct turner_medium){.index = 1.5};
    struct turner_material glass = plain();
    glass.k_t = v3(0.5, 0.5, 0.5);
    glass.medium = 0;
    add_sphere(&scene->groups[0], v3(0, 0, 0), 1 + 4e-5, add_material(scene, glass));
    add_sphere(&scene->groups[0], v3(0, 0, 0), 1, add_lamp(scene, 1));
    struct turner_image image;
    render(&image, scene);
    assert_true(image.rgba[0] == 0.5f);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* ---- meshes ---- */

/* Shoots at a corner or an edge of a closed convex mesh from inside. 0: the mesh is met, and from
 * there the mirrored ray meets the other side; 1: the ray got out; 2: it met its own edge again. */
static int shoot(const struct turner_world *world, turner_vector origin, turner_vector target)
{
    struct turner_ray ray = {.origin = origin, .direction = normalize(sub(target, origin))};
    struct turner_hit hit;
    if (!turner_world_intersect(&hit, world, &ray, INFINITY))
        return 1;
    struct turner_surface surface;
    turner_world_surface(&surface, world, &ray, &hit);
    turner_vector n = surface.ng, d = ray.direction;
    ray = turner_surface_leave(&surface, sub(d, scale(n, 2 * dot(d, n))), false);
    if (!turner_world_intersect(&hit, world, &ray, INFINITY))
        return 1;
    return hit.t < 0.1L ? 2 : 0;
}

/* No ray from inside a closed mesh of 1e5 triangles gets out at a corner or an edge. */
static void test_watertight(void **state)
{
    (void)state;
    struct turner_scene *scene = furnace(1, 0);
    add_globe(&scene->groups[0], v3(3, 1, -2), 1, 159, add_lamp(scene, 1));
    const struct turner_mesh *mesh = &scene->groups[0].meshes[0];
    assert_true(mesh->triangle_count > 100000);
    struct turner_world world;
    assert_int_equal(turner_world_create(&world, scene), TURNER_OK);
    turner_vector origin = vector(3.1L, 0.9L, -2.3L);
    int count[3] = {0};
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        count[shoot(&world, origin, widen(mesh->positions[i]))]++;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        uint32_t edge = i % 3;
        turner_vector p = mix(widen(mesh->positions[t[edge]]),
                              widen(mesh->positions[t[(edge + 1) % 3]]), i % 97 / 96.0L);
        count[shoot(&world, origin, p)]++;
    }
    assert_int_equal(count[1], 0);
    assert_int_equal(count[2], 0);
    turner_world_destroy(&world);
    turner_scene_destroy(scene);
}

/* Two triangles that a float Möller–Trumbore test lets a ray through. */
static void test_shared_edge(void **state)
{
    (void)state;
    struct turner_vec3 corners[4] = {v3(-5, -5, 0), v3(5, -5, 0), v3(5, 5, 0), v3(-5, 5, 0)};
    uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    struct turner_mesh mesh = {
        .positions = corners, .triangles = triangles, .vertex_count = 4, .triangle_count = 2};
    struct turner_ray ray = {.origin = vector(0, 0, 10),
                             .direction = vector(0.30458447L, 0.30458447L, -0.9024725L)};
    struct turner_hit hit;
    assert_true(turner_triangle_intersect(&hit, &mesh, 0, &ray, NULL) ||
                turner_triangle_intersect(&hit, &mesh, 1, &ray, NULL));
    uint32_t needles[2][3] = {{0, 0, 2}, {1, 1, 1}}; /* without area: never met */
    mesh.triangles = needles;
    for (uint32_t i = 0; i < 2; i++)
        assert_false(turner_triangle_intersect(&hit, &mesh, i, &ray, NULL));
}

/* ---- ties and instances ---- */

static float center_pixel(const struct turner_scene *scene)
{
    struct turner_image image;
    render(&image, scene);
    float value = image.rgba[0];
    turner_image_destroy(&image);
    return value;
}

/* Of hits at equal t the lower wins: planes, the world, instances in order; in a group spheres,
 * cones, triangles. */
static void test_ties(void **state)
{
    (void)state;
    struct turner_scene *scene = furnace(1, 0);
    uint32_t lamps[8];
    for (int i = 0; i < 8; i++)
        lamps[i] = add_lamp(scene, i + 1);
    struct turner_group *group = add_group(scene);
    add_sphere(group, v3(0, 0, 0), 1, lamps[0]);
    add_instance(scene, 1, lamps[7], TURNER_AFFINE_IDENTITY);
    add_instance(scene, 1, lamps[6], TURNER_AFFINE_IDENTITY);
    assert_true(center_pixel(scene) == 8);

    struct turner_group *world = &scene->groups[0];
    struct turner_mesh mesh = {.vertex_count = 3, .triangle_count = 2, .material = lamps[5]};
    mesh.positions = turner_calloc(3, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(2, sizeof *mesh.triangles);
    mesh.positions[0] = v3(-1, -1, 1);
    mesh.positions[1] = v3(2, -1, 1);
    mesh.positions[2] = v3(-1, 2, 1);
    for (uint32_t i = 0; i < 3; i++)
        mesh.triangles[0][i] = mesh.triangles[1][i] = i;
    *TURNER_PUSH(world->meshes, world->mesh_count, world->mesh_capacity) = mesh;
    assert_true(center_pixel(scene) == 6);

    add_cone(world, v3(0, 0, 0), 1, v3(0, 0, 1), 1, lamps[4]);
    assert_true(center_pixel(scene) == 5);
    add_sphere(world, v3(0, 0, 0), 1, lamps[3]);
    add_sphere(world, v3(0, 0, 0), 1, lamps[2]);
    assert_true(center_pixel(scene) == 4);
    for (int i = 1; i >= 0; i--) {
        *TURNER_PUSH(scene->planes, scene->plane_count, scene->plane_capacity) =
            (struct turner_plane){v3(0, 0, 1), v3(0, 0, 1), v3(1, 0, 0), lamps[i]};
        assert_true(center_pixel(scene) == 2);
    }
    turner_scene_destroy(scene);
}

/* A group that is moved, turned, mirrored and scaled shows what the same primitives show when they
 * are given at their final places; directions, normals and sides included. */
static void test_instances(void **state)
{
    (void)state;
    struct turner_image pictures[2];
    for (int moved = 0; moved < 2; moved++) {
        struct turner_scene *scene = furnace(48, 5);
        scene->background = (struct turner_background){
            .kind = TURNER_BACKGROUND_GRADIENT, .top = v3(1, 0.5, 0.2), .up = v3(0, 1, 0)};
        *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
            (struct turner_medium){.index = 1.5, .absorption = v3(0.1, 0.5, 0.9)};
        struct turner_material glass = plain();
        glass.k_r = glass.k_t = v3(1, 1, 1);
        glass.fresnel = TURNER_FRESNEL_EXACT;
        glass.medium = 0;
        uint32_t material = add_material(scene, glass);
        /* p ↦ (1 − 2z, 2x, 2y − 1), a mirror image */
        struct turner_group *group = moved ? add_group(scene) : &scene->groups[0];
        struct turner_vec3 s = v3(0.3, 0.1, 0.2), b = v3(-0.4, -0.2, 0), a = v3(-0.3, 0.5, 0.4);
        if (!moved) {
            s = v3(-2 * s.z + 1, 2 * s.x, 2 * s.y - 1);
            b = v3(-2 * b.z + 1, 2 * b.x, 2 * b.y - 1);
            a = v3(-2 * a.z + 1, 2 * a.x, 2 * a.y - 1);
        }
        double size = moved ? 1 : 2;
        add_sphere(group, s, 0.3 * size, material);
        add_cone(group, b, 0.3 * size, a, 0.1 * size, material);
        if (moved)
            add_instance(scene, 1, TURNER_NONE,
                         (struct turner_affine){
                             {{0, 0, -2, 1}, {2, 0, 0, 0}, {0, 2, 0, -1}}});
        render(&pictures[moved], scene);
        turner_scene_destroy(scene);
    }
    int other = 0, background = 0;
    for (int i = 0; i < 48 * 48 * 4; i++)
        other += !(fabsf(pictures[0].rgba[i] - pictures[1].rgba[i]) <= 1e-6f);
    for (int i = 0; i < 48 * 48; i++)
        background += pictures[0].rgba[4 * i + 3] == 0;
    assert_int_equal(other, 0);
    assert_true(background < 47 * 48); /* there is something to see */
    turner_image_destroy(&pictures[0]);
    turner_image_destroy(&pictures[1]);
}

/* The same for a transform that bends angles: its normals are not those of the group moved along. */
static void test_stretched(void **state)
{
    (void)state;
    struct turner_affine stretch = {{{2, 0.3, 0, 0.1}, {0, 0.5, 0.2, 0}, {0.1, 0, 1, -0.4}}};
    struct turner_image pictures[2];
    for (int moved = 0; moved < 2; moved++) {
        struct turner_scene *scene = furnace(48, 3);
        scene->background = (struct turner_background){
            .kind = TURNER_BACKGROUND_GRADIENT, .top = v3(1, 0.5, 0.2), .up = v3(0, 1, 0)};
        uint32_t mirror = add_mirror(scene, 1);
        struct turner_group *group = moved ? add_group(scene) : &scene->groups[0];
        add_globe(group, v3(0, 0, 0), 1, 6, mirror);
        struct turner_mesh *mesh = &group->meshes[0];
        for (uint32_t i = 0; !moved && i < mesh->vertex_count; i++)
            mesh->positions[i] = turner_affine_point(&stretch, mesh->positions[i]);
        if (moved)
            add_instance(scene, 1, TURNER_NONE, stretch);
        render(&pictures[moved], scene);
        turner_scene_destroy(scene);
    }
    int other = 0, mirrored = 0;
    for (int i = 0; i < 48 * 48 * 4; i++)
        other += !(fabsf(pictures[0].rgba[i] - pictures[1].rgba[i]) <= 1e-6f);
    for (int i = 0; i < 47 * 48; i++) /* the background is brighter above, its mirror image is not */
        mirrored += pictures[0].rgba[4 * i] < pictures[0].rgba[4 * (i + 48)] - 0.01f;
    assert_int_equal(other, 0);
    assert_true(mirrored > 20);
    turner_image_destroy(&pictures[0]);
    turner_image_destroy(&pictures[1]);
}

/* ---- depth ---- */

/* Two facing mirrors that glow: 1 − ρ^(depth + 1). Also shows that the threads' stacks suffice. */
static void test_deep(void **state)
{
    (void)state;
    struct turner_scene *scene = furnace(1, TURNER_MAX_DEPTH);
    double rho = 0.9990234375;
    struct turner_material mirror = plain();
    mirror.k_r = v3(rho, rho, rho);
    mirror.k_e = v3(1 - rho, 1 - rho, 1 - rho);
    uint32_t material = add_material(scene, mirror);
    for (int side = -1; side <= 1; side += 2) {
        *TURNER_PUSH(scene->planes, scene->plane_count, scene->plane_capacity) =
            (struct turner_plane){v3(0, 0, 9 * side), v3(0, 0, -side), v3(1, 0, 0), material};
    }
    struct turner_vec3 radiance;
    double pruned, lost = pow(rho, TURNER_MAX_DEPTH + 1);
    assert_int_equal(turner_reference_radiance(&radiance, &pruned, scene, v3(0, 0, 0),
                                               v3(0.1, 0.2, 3)),
                     TURNER_OK);
    assert_true(fabs(radiance.x - (1 - lost)) < 1e-14 && fabs(pruned - lost) < 1e-14);
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threads),         cmocka_unit_test(test_progress),
        cmocka_unit_test(test_leaving),         cmocka_unit_test(test_leaving_inward),
        cmocka_unit_test(test_concentric),      cmocka_unit_test(test_watertight),
        cmocka_unit_test(test_shared_edge),     cmocka_unit_test(test_ties),
        cmocka_unit_test(test_instances),       cmocka_unit_test(test_stretched),
        cmocka_unit_test(test_deep),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
