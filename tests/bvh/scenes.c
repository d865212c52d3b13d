#include "scenes.h"

#include <math.h>

#include "base/memory.h"

uint64_t random_bits(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}

double random_in(uint64_t *state, double lo, double hi)
{
    return lo + (hi - lo) * ((double)(random_bits(state) >> 11) / 9007199254740992.0);
}

struct turner_vec3 random_point(uint64_t *state, double lo, double hi)
{
    double x = random_in(state, lo, hi), y = random_in(state, lo, hi);
    return turner_vec3_of(x, y, random_in(state, lo, hi));
}

struct turner_scene *make_scene(void)
{
    struct turner_scene *scene = turner_scene_create();
    for (int i = 0; i < 3; i++) {
        struct turner_material material = {.medium = TURNER_NONE};
        if (i == 1)
            material.k_t = turner_vec3_of(0, 0.5, 0);
        if (i == 2)
            material.pattern = TURNER_PATTERN_CHECKER;
        *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = material;
    }
    return scene;
}

uint32_t add_group(struct turner_scene *scene)
{
    struct turner_group group = {.name = turner_strdup("thing")};
    *TURNER_PUSH(scene->groups, scene->group_count, scene->group_capacity) = group;
    return (uint32_t)scene->group_count - 1;
}

void add_sphere(struct turner_group *group, struct turner_vec3 center, double radius,
                uint32_t material)
{
    *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
        (struct turner_sphere){.center = center, .radius = radius, .material = material};
}

void add_cone(struct turner_group *group, struct turner_vec3 base, double base_radius,
              struct turner_vec3 apex, double apex_radius, bool capped, uint32_t material)
{
    *TURNER_PUSH(group->cones, group->cone_count, group->cone_capacity) =
        (struct turner_cone){.base = base,
                             .base_radius = base_radius,
                             .apex = apex,
                             .apex_radius = apex_radius,
                             .capped = capped,
                             .material = material};
}

void add_instance(struct turner_scene *scene, uint32_t group, uint32_t material,
                  struct turner_affine transform)
{
    *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) =
        (struct turner_instance){.group = group, .material = material, .transform = transform};
}

static struct turner_mesh *add_mesh(struct turner_group *group, uint32_t vertices,
                                    uint32_t triangles, uint32_t material)
{
    struct turner_mesh *mesh = TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity);
    *mesh = (struct turner_mesh){
        .positions = turner_calloc(vertices, sizeof *mesh->positions),
        .triangles = turner_calloc(triangles, sizeof *mesh->triangles),
        .vertex_count = vertices,
        .triangle_count = triangles,
        .material = material,
    };
    return mesh;
}

struct turner_mesh *add_soup(struct turner_group *group, uint64_t *state, uint32_t count,
                             double size, uint32_t material)
{
    struct turner_mesh *mesh = add_mesh(group, 3 * count, count, material);
    for (uint32_t i = 0; i < count; i++) {
        struct turner_vec3 center = random_point(state, -1, 1);
        for (uint32_t corner = 0; corner < 3; corner++) {
            mesh->positions[3 * i + corner] =
                turner_vec3_add(center, random_point(state, -size, size));
            mesh->triangles[i][corner] = 3 * i + corner;
        }
    }
    return mesh;
}

void add_ball(struct turner_group *group, uint32_t n, uint32_t material)
{
    const double pi = acos(-1);
    struct turner_mesh *mesh = add_mesh(group, n * n, 2 * (n - 1) * (n - 1), material);
    for (uint32_t i = 0; i < n; i++) {
        for (uint32_t j = 0; j < n; j++) {
            double theta = pi * i / (n - 1), phi = 2 * pi * j / (n - 1);
            double r = 1 + 0.1 * sin(9 * theta) * cos(7 * phi);
            mesh->positions[i * n + j] = turner_vec3_of(r * sin(theta) * cos(phi),
                                                        r * sin(theta) * sin(phi), r * cos(theta));
        }
    }
    uint32_t(*triangle)[3] = mesh->triangles;
    for (uint32_t i = 0; i + 1 < n; i++) {
        for (uint32_t j = 0; j + 1 < n; j++, triangle += 2) {
            uint32_t a = i * n + j, b = a + 1, c = a + n, d = c + 1;
            triangle[0][0] = a, triangle[0][1] = c, triangle[0][2] = b;
            triangle[1][0] = b, triangle[1][1] = c, triangle[1][2] = d;
        }
    }
}

void fill_group(struct turner_group *group, uint64_t *state, int spheres, int cones, int triangles)
{
    for (int i = 0; i < spheres; i++)
        add_sphere(group, random_point(state, -1, 1), random_in(state, 0.001, 0.1), i % 3 == 0);
    for (int i = 0; i < cones; i++) {
        struct turner_vec3 base = random_point(state, -1, 1);
        struct turner_vec3 apex = turner_vec3_add(base, random_point(state, -0.3, 0.3));
        add_cone(group, base, random_in(state, 0, 0.1), apex, random_in(state, 0.001, 0.1),
                 i % 2 == 0, 0);
    }
    if (triangles > 0)
        add_soup(group, state, (uint32_t)triangles, 0.1, 0);
}

void add_flake(struct turner_group *group, struct turner_vec3 center, double radius,
               struct turner_vec3 up, int level)
{
    const double pi = acos(-1);
    add_sphere(group, center, radius, 0);
    if (level == 0)
        return;
    struct turner_vec3 u = turner_vec3_perpendicular(up), v = turner_vec3_cross(up, u);
    for (int i = 0; i < 9; i++) {
        double theta = i < 6 ? pi / 2 : pi / 4;
        double phi = i < 6 ? i * pi / 3 : (i - 6) * 2 * pi / 3 + pi / 6;
        struct turner_vec3 flat =
            turner_vec3_add(turner_vec3_scale(u, cos(phi)), turner_vec3_scale(v, sin(phi)));
        struct turner_vec3 direction =
            turner_vec3_add(turner_vec3_scale(up, cos(theta)), turner_vec3_scale(flat, sin(theta)));
        add_flake(group, turner_vec3_add(center, turner_vec3_scale(direction, radius * 4 / 3)),
                  radius / 3, direction, level - 1);
    }
}

struct turner_affine make_transform(double scale, struct turner_vec3 translation)
{
    double c = cos(0.7), s = sin(0.7);
    struct turner_affine about_z = {{{c, -s, 0, 0}, {s, c, 0, 0}, {0, 0, 1, 0}}};
    struct turner_affine about_x = {{{1, 0, 0, 0}, {0, c, -s, 0}, {0, s, c, 0}}};
    struct turner_affine transform = turner_affine_multiply(&about_x, &about_z);
    double moved[3] = {translation.x, translation.y, translation.z};
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            transform.m[row][column] *= scale;
        transform.m[row][3] = moved[row];
    }
    return transform;
}

struct turner_scene *make_random_scene(uint64_t *random)
{
    struct turner_scene *scene = make_scene();
    int groups = (int)(random_bits(random) % 4), size = 1 << (random_bits(random) % 12);
    for (int g = 0; g <= groups; g++) {
        uint32_t index = g ? add_group(scene) : 0;
        fill_group(&scene->groups[index], random, (int)(random_bits(random) % (uint64_t)size),
                   (int)(random_bits(random) % (uint64_t)size),
                   (int)(random_bits(random) % (uint64_t)size));
        for (int k = 0; index > 0 && k < g * 9; k++)
            add_instance(scene, index, TURNER_NONE,
                         make_transform(pow(10, random_in(random, -3, 3)),
                                        random_point(random, -100, 100)));
    }
    return scene;
}
