/* Scenes to measure: files, and two kinds of our own. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/bench.h"
#include "base/memory.h"

#define PI 3.14159265358979323846

/* Coordinates are floats, so that every tracer has the same scene. */
static struct turner_vec3 rounded(struct turner_vec3 v)
{
    return turner_vec3_of((double)(float)v.x, (double)(float)v.y, (double)(float)v.z);
}

/* ---- Haines's sphereflake ("balls" of the Standard Procedural Databases) ---- */

static struct turner_vec3 turned(struct turner_vec3 v, struct turner_vec3 axis, double angle)
{
    double c = cos(angle), s = sin(angle), along = turner_vec3_dot(axis, v) * (1 - c);
    struct turner_vec3 r = turner_vec3_scale(v, c);
    r = turner_vec3_add(r, turner_vec3_scale(turner_vec3_cross(axis, v), s));
    return turner_vec3_add(r, turner_vec3_scale(axis, along));
}

/* By what turns +z to the unit vector `to`. */
static struct turner_vec3 turned_as(struct turner_vec3 v, struct turner_vec3 to)
{
    if (to.z > 1 - 1e-9)
        return v;
    if (to.z < -1 + 1e-9)
        return turner_vec3_of(-v.x, v.y, -v.z);
    return turned(v, turner_vec3_normalize(turner_vec3_of(-to.y, to.x, 0)), acos(to.z));
}

static void child_directions(struct turner_vec3 children[9])
{
    const double d = 1 / sqrt(2);
    const struct turner_vec3 trio[3] = {{d, d, 0}, {d, 0, -d}, {0, d, -d}};
    struct turner_vec3 axis = turner_vec3_of(d, -d, 0), z = turner_vec3_of(0, 0, 1);
    for (int i = 0; i < 9; i++)
        children[i] = turned(turned(trio[i % 3], axis, asin(2 / sqrt(6))), z, i / 3 * 2 * PI / 3);
}

static void add_flake(struct turner_group *group, const struct turner_vec3 children[9], int depth,
                      struct turner_vec3 center, struct turner_vec3 direction, double radius)
{
    *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
        (struct turner_sphere){rounded(center), (double)(float)radius, 0};
    for (int i = 0; i < 9 && depth > 0; i++) {
        struct turner_vec3 way = turned_as(children[i], direction);
        add_flake(group, children, depth - 1,
                  turner_vec3_add(center, turner_vec3_scale(way, radius * 4 / 3)), way, radius / 3);
    }
}

/* ---- a closed mesh: a cube of n × n squares a face, blown up to a sphere with bumps, the shape
 * of tools/make_mesh.py ---- */

static double bump_radius(struct turner_vec3 d)
{
    static const double waves[4][5] = {{5, 3, -4, 0.3, 0.045},
                                       {-3, 6, 5, 1.7, 0.04},
                                       {9, -7, 8, 2.9, 0.02},
                                       {4, 11, -10, 0.8, 0.015}};
    double radius = 1;
    for (int i = 0; i < 4; i++)
        radius += waves[i][4] * sin(waves[i][0] * d.x + waves[i][1] * d.y + waves[i][2] * d.z +
                                    waves[i][3]);
    return radius;
}

/* Number of a point of the cube's surface on its lattice of (n + 1)³. */
static uint32_t corner_number(const uint32_t at[3], uint32_t n)
{
    uint32_t i = at[0], j = at[1], k = at[2], face = (n + 1) * (n + 1);
    if (k == 0 || k == n)
        return (k ? face : 0) + j * (n + 1) + i;
    uint32_t along = j == 0 && i < n ? i : i == n && j < n ? n + j : j == n && i > 0 ? 3 * n - i
                                                                                  : 4 * n - j;
    return 2 * face + (k - 1) * 4 * n + along;
}

static void place_corner(struct turner_mesh *mesh, const uint32_t at[3], uint32_t n)
{
    double c[3];
    for (int i = 0; i < 3; i++) /* tan makes the squares about equal on the sphere */
        c[i] = tan((at[i] / (double)n - 0.5) * PI / 2);
    struct turner_vec3 d = turner_vec3_normalize(turner_vec3_of(c[0], c[1], c[2]));
    mesh->positions[corner_number(at, n)] = rounded(turner_vec3_scale(d, bump_radius(d)));
}

static void add_square(struct turner_mesh *mesh, int axis, uint32_t side, uint32_t a, uint32_t b,
                       uint32_t n)
{
    const uint32_t steps[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    uint32_t square[4];
    for (int s = 0; s < 4; s++) {
        uint32_t at[3];
        at[axis] = side;
        at[(axis + 1) % 3] = a + steps[s][0];
        at[(axis + 2) % 3] = b + steps[s][1];
        place_corner(mesh, at, n);
        square[side ? s : 3 - s] = corner_number(at, n);
    }
    for (int half = 0; half < 2; half++) {
        uint32_t *triangle = mesh->triangles[mesh->triangle_count++];
        triangle[0] = square[0];
        triangle[1] = square[1 + half];
        triangle[2] = square[2 + half];
    }
}

static void add_bumps(struct turner_group *group, int triangles)
{
    uint32_t n = (uint32_t)(sqrt(triangles / 12.0) + 0.5);
    n = n ? n : 1;
    struct turner_mesh mesh = {.vertex_count = 6 * n * n + 2};
    mesh.positions = turner_calloc(mesh.vertex_count, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(12 * (size_t)n * n, sizeof *mesh.triangles);
    for (int axis = 0; axis < 3; axis++) {
        for (uint32_t side = 0; side <= n; side += n) {
            for (uint32_t a = 0; a < n; a++) {
                for (uint32_t b = 0; b < n; b++)
                    add_square(&mesh, axis, side, a, b, n);
            }
        }
    }
    *TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity) = mesh;
}

/* ---- */

static void add_light(struct turner_scene *scene)
{
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) =
        (struct turner_light){.kind = TURNER_LIGHT_POINT, .position = {4, 3, 2},
                              .power = {1, 1, 1}, .falloff = TURNER_FALLOFF_NONE};
}

/* TURNER_OK and no scene when the name is a file's. */
static enum turner_result make_own(struct turner_scene **scene, const char *name)
{
    static const char flake[] = "sphereflake:", mesh[] = "mesh:";
    bool is_flake = strncmp(name, flake, sizeof flake - 1) == 0;
    int amount;
    *scene = NULL;
    if (!is_flake && strncmp(name, mesh, sizeof mesh - 1) != 0)
        return TURNER_OK;
    TURNER_TRY(turner_option_int(&amount, name, strchr(name, ':') + 1, is_flake ? 0 : 12,
                                 is_flake ? 7 : 100000000));
    struct turner_scene *made = turner_scene_create();
    *TURNER_PUSH(made->materials, made->material_count, made->material_capacity) =
        (struct turner_material){.k_d = {0.8, 0.8, 0.8}, .medium = TURNER_NONE};
    made->camera.from = turner_vec3_of(2.1, 1.3, 1.7);
    made->camera.at = turner_vec3_of(0, 0, 0);
    made->camera.up = turner_vec3_of(0, 0, 1);
    made->camera.vfov = 35 * PI / 180;
    add_light(made);
    if (is_flake) {
        struct turner_vec3 children[9];
        child_directions(children);
        add_flake(&made->groups[0], children, amount, turner_vec3_of(0, 0, 0),
                  turner_vec3_of(0, 0, 1), 0.5);
    } else {
        add_bumps(&made->groups[0], amount);
    }
    *scene = made;
    return TURNER_OK;
}

enum turner_result turner_bench_scene(struct turner_scene **scene, const char *name, int width,
                                      int height)
{
    TURNER_TRY(make_own(scene, name));
    if (!*scene)
        TURNER_TRY(turner_scene_load(scene, name));
    struct turner_settings *settings = &(*scene)->settings;
    settings->width = width;
    settings->height = height;
    settings->spp = 1;
    settings->aa_threshold = settings->error = 0;
    settings->shadows = TURNER_SHADOWS_OPAQUE;
    if (!(*scene)->light_count)
        add_light(*scene);
    enum turner_result result = turner_scene_validate(*scene);
    if (result != TURNER_OK) {
        turner_scene_destroy(*scene);
        *scene = NULL;
    }
    return result;
}
