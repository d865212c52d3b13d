#include "scene/scene.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/readers.h"

struct turner_scene *turner_scene_create(void)
{
    struct turner_scene *scene = turner_calloc(1, sizeof *scene);
    scene->settings = (struct turner_settings){
        .width = 640,
        .height = 480,
        .depth = 8,
        .cutoff = 1.0 / 512,
        .spp = 1,
        .shading = TURNER_SHADING_ENERGY_CONSERVING,
        .shadows = TURNER_SHADOWS_TINTED,
        .transfer = TURNER_TRANSFER_SRGB,
    };
    scene->camera.from = turner_vec3_of(0, 0, 5);
    scene->camera.up = turner_vec3_of(0, 1, 0);
    scene->camera.vfov = 40 * acos(-1) / 180;
    scene->background.up = turner_vec3_of(0, 1, 0);
    scene->background.scale = turner_vec3_of(1, 1, 1);
    scene->background.image = TURNER_NONE;
    turner_scene_add_group(scene, NULL);
    return scene;
}

enum turner_fresnel turner_material_fresnel(const struct turner_settings *settings,
                                            const struct turner_material *material)
{
    struct turner_vec3 k_t = material->k_t;
    bool transmits = k_t.x > 0 || k_t.y > 0 || k_t.z > 0;
    switch (transmits ? settings->methods.fresnel : TURNER_OVERRIDE_MATERIAL) {
    case TURNER_OVERRIDE_MATERIAL: break;
    case TURNER_OVERRIDE_NONE: return TURNER_FRESNEL_NONE;
    case TURNER_OVERRIDE_SCHLICK: return TURNER_FRESNEL_SCHLICK;
    case TURNER_OVERRIDE_EXACT: return TURNER_FRESNEL_EXACT;
    }
    return material->fresnel;
}

void turner_mesh_destroy(struct turner_mesh *mesh)
{
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->triangles);
    *mesh = (struct turner_mesh){0};
}

void turner_scene_free_params(struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->param_count; i++) {
        free(scene->params[i].name);
        free(scene->params[i].value);
    }
    free(scene->params);
    scene->params = NULL;
    scene->param_count = scene->param_capacity = 0;
}

void turner_scene_own_params(struct turner_scene *scene)
{
    struct turner_scene_param *shared = scene->params;
    scene->params = turner_calloc(scene->param_count + 1, sizeof *scene->params);
    scene->param_capacity = scene->param_count + 1;
    for (size_t i = 0; i < scene->param_count; i++) {
        scene->params[i].name = turner_strdup(shared[i].name);
        scene->params[i].value = turner_strdup(shared[i].value);
    }
}

void turner_scene_destroy(struct turner_scene *scene)
{
    if (!scene)
        return;
    free(scene->path);
    free(scene->description);
    turner_scene_free_params(scene);
    free(scene->shaders);
    for (size_t i = 0; i < scene->media_count; i++)
        free(scene->media[i].name);
    free(scene->media);
    for (size_t i = 0; i < scene->material_count; i++)
        free(scene->materials[i].name);
    free(scene->materials);
    for (size_t i = 0; i < scene->texture_image_count; i++) {
        free(scene->texture_images[i].path);
        free(scene->texture_images[i].rgb);
    }
    free(scene->texture_images);
    free(scene->cameras);
    free(scene->planes);
    for (size_t i = 0; i < scene->group_count; i++) {
        struct turner_group *group = &scene->groups[i];
        free(group->name);
        free(group->spheres);
        free(group->cones);
        for (size_t j = 0; j < group->mesh_count; j++)
            turner_mesh_destroy(&group->meshes[j]);
        free(group->meshes);
    }
    free(scene->groups);
    free(scene->instances);
    free(scene->lights);
    free(scene);
}

uint32_t turner_scene_add_group(struct turner_scene *scene, const char *name)
{
    struct turner_group group = {.name = name ? turner_strdup(name) : NULL};
    *TURNER_PUSH(scene->groups, scene->group_count, scene->group_capacity) = group;
    return (uint32_t)(scene->group_count - 1);
}

void turner_group_add_mesh(struct turner_group *group, struct turner_mesh *mesh)
{
    *TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity) = *mesh;
    *mesh = (struct turner_mesh){0};
}

size_t turner_group_primitive_count(const struct turner_group *group)
{
    size_t count = group->sphere_count + group->cone_count;
    for (size_t i = 0; i < group->mesh_count; i++)
        count += group->meshes[i].triangle_count;
    return count;
}

void turner_group_add_box(struct turner_group *group, struct turner_vec3 lo, struct turner_vec3 hi,
                          uint32_t material)
{
    /* The corner number's bits say hi or lo in x (1), y (2), z (4). Each face starts at its corner
     * of (u, v) = (0, 0) and runs counter-clockwise seen from outside. */
    static const int faces[6][4] = {
        {0, 4, 6, 2}, {5, 1, 3, 7}, /* −x, +x */
        {0, 1, 5, 4}, {6, 7, 3, 2}, /* −y, +y */
        {1, 0, 2, 3}, {4, 5, 7, 6}, /* −z, +z */
    };
    static const float uvs[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    struct turner_mesh mesh = {.vertex_count = 24, .triangle_count = 12, .material = material};
    mesh.positions = turner_calloc(24, sizeof *mesh.positions);
    mesh.uvs = turner_calloc(24, sizeof *mesh.uvs);
    mesh.triangles = turner_calloc(12, sizeof *mesh.triangles);
    for (uint32_t face = 0; face < 6; face++) {
        uint32_t first = 4 * face;
        for (uint32_t i = 0; i < 4; i++) {
            int corner = faces[face][i];
            mesh.positions[first + i] =
                turner_vec3_of(corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y,
                               corner & 4 ? hi.z : lo.z);
            memcpy(mesh.uvs[first + i], uvs[i], sizeof uvs[i]);
        }
        for (uint32_t i = 0; i < 2; i++) {
            uint32_t *triangle = mesh.triangles[2 * face + i];
            triangle[0] = first;
            triangle[1] = first + 1 + i;
            triangle[2] = first + 2 + i;
        }
    }
    turner_group_add_mesh(group, &mesh);
}

struct ranked_medium {
    struct turner_medium medium;
    uint32_t declared;
};

static int compare_ranks(const void *left, const void *right)
{
    const struct ranked_medium *a = left, *b = right;
    if (a->medium.priority != b->medium.priority)
        return a->medium.priority < b->medium.priority ? -1 : 1;
    return a->declared < b->declared ? -1 : a->declared > b->declared;
}

static void rank_inside(struct turner_camera *camera, const uint32_t *rank, size_t count)
{
    for (uint32_t i = 0; i < camera->inside_count && i < TURNER_MEDIA_NESTING; i++) {
        if (camera->inside[i] < count)
            camera->inside[i] = rank[camera->inside[i]];
    }
}

void turner_scene_sort_media(struct turner_scene *scene)
{
    size_t count = scene->media_count;
    if (count == 0)
        return;
    struct ranked_medium *ranked = turner_calloc(count, sizeof *ranked);
    uint32_t *rank = turner_calloc(count, sizeof *rank);
    for (size_t i = 0; i < count; i++)
        ranked[i] = (struct ranked_medium){scene->media[i], (uint32_t)i};
    qsort(ranked, count, sizeof *ranked, compare_ranks);
    for (size_t i = 0; i < count; i++) {
        scene->media[i] = ranked[i].medium;
        rank[ranked[i].declared] = (uint32_t)i;
    }
    /* wrong indices stay as they are: turner_scene_validate refuses them */
    for (size_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].medium < count)
            scene->materials[i].medium = rank[scene->materials[i].medium];
    }
    rank_inside(&scene->camera, rank, count);
    for (size_t i = 0; i < scene->camera_count; i++)
        rank_inside(&scene->cameras[i], rank, count);
    free(ranked);
    free(rank);
}

enum turner_result turner_scene_use_camera(struct turner_scene *scene, int number)
{
    if (number < 0 || (size_t)number > scene->camera_count)
        return turner_fail(TURNER_USAGE, "camera %d: the scene has %zu beside camera 0", number,
                           scene->camera_count);
    if (number > 0)
        scene->camera = scene->cameras[number - 1];
    return TURNER_OK;
}

void turner_sample_position(double *x, double *y, int index, int count)
{
    assert(index >= 0 && index < count);
    /* van der Corput in k = ⌈log₂ count⌉ bits, plus half a step of that many bits */
    double radical = 0, step = 1;
    int remaining = index;
    for (int span = 1; span < count; span *= 2) {
        step /= 2;
        radical += step * (remaining & 1);
        remaining >>= 1;
    }
    *x = (index + 0.5) / count;
    *y = radical + step / 2;
}
