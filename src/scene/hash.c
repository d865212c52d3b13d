#include "scene/hash.h"

#include "base/hash.h"

/* Structs are taken member by member: what lies between members is not defined. */

struct sum {
    uint64_t hash;
};

static void add(struct sum *sum, const void *bytes, size_t size)
{
    sum->hash = turner_hash_bytes(sum->hash, bytes, size);
}

static void add_real(struct sum *sum, double value)
{
    value += 0.0; /* −0 draws as 0 does */
    add(sum, &value, sizeof value);
}

static void add_count(struct sum *sum, uint64_t value)
{
    add(sum, &value, sizeof value);
}

static void add_vec3(struct sum *sum, struct turner_vec3 v)
{
    add_real(sum, v.x);
    add_real(sum, v.y);
    add_real(sum, v.z);
}

static void add_camera(struct sum *sum, const struct turner_camera *camera)
{
    add_vec3(sum, camera->from);
    add_vec3(sum, camera->at);
    add_vec3(sum, camera->up);
    add_real(sum, camera->vfov);
    add_count(sum, camera->inside_count);
    for (uint32_t i = 0; i < camera->inside_count; i++)
        add_count(sum, camera->inside[i]);
}

static void add_background(struct sum *sum, const struct turner_background *background)
{
    add_count(sum, background->kind);
    add_vec3(sum, background->color);
    add_vec3(sum, background->top);
    add_vec3(sum, background->up);
    add_vec3(sum, background->scale);
    add_real(sum, background->rotation);
    add_count(sum, background->image);
}

static void add_material(struct sum *sum, const struct turner_material *m)
{
    const struct turner_vec3 colours[] = {m->k_e, m->k_a, m->k_d, m->k_s,        m->k_r,
                                          m->k_t, m->eta, m->k,   m->checker[0], m->checker[1]};
    for (size_t i = 0; i < sizeof colours / sizeof *colours; i++)
        add_vec3(sum, colours[i]);
    add_real(sum, m->exponent);
    add_count(sum, m->fresnel);
    add_count(sum, m->conductor);
    add_count(sum, m->medium);
    add_count(sum, m->pattern);
    add_real(sum, m->uv_scale[0]);
    add_real(sum, m->uv_scale[1]);
    add_count(sum, m->image);
}

static void add_image(struct sum *sum, const struct turner_texture_image *image)
{
    add_count(sum, (uint64_t)image->width);
    add_count(sum, (uint64_t)image->height);
    add(sum, image->rgb, (size_t)image->width * (size_t)image->height * 3 * sizeof(float));
}

static void add_mesh(struct sum *sum, const struct turner_mesh *mesh)
{
    add_count(sum, mesh->material);
    add_count(sum, mesh->vertex_count);
    add_count(sum, mesh->triangle_count);
    add_count(sum, (mesh->normals ? 1u : 0u) | (mesh->uvs ? 2u : 0u));
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        add_vec3(sum, mesh->positions[i]);
    if (mesh->normals)
        add(sum, mesh->normals, mesh->vertex_count * sizeof *mesh->normals);
    if (mesh->uvs)
        add(sum, mesh->uvs, mesh->vertex_count * sizeof *mesh->uvs);
    add(sum, mesh->triangles, mesh->triangle_count * sizeof *mesh->triangles);
}

static void add_group(struct sum *sum, const struct turner_group *group)
{
    add_count(sum, group->sphere_count);
    for (size_t i = 0; i < group->sphere_count; i++) {
        add_vec3(sum, group->spheres[i].center);
        add_real(sum, group->spheres[i].radius);
        add_count(sum, group->spheres[i].material);
    }
    add_count(sum, group->cone_count);
    for (size_t i = 0; i < group->cone_count; i++) {
        const struct turner_cone *cone = &group->cones[i];
        add_vec3(sum, cone->base);
        add_vec3(sum, cone->apex);
        add_real(sum, cone->base_radius);
        add_real(sum, cone->apex_radius);
        add_count(sum, cone->capped);
        add_count(sum, cone->material);
    }
    add_count(sum, group->mesh_count);
    for (size_t i = 0; i < group->mesh_count; i++)
        add_mesh(sum, &group->meshes[i]);
}

static void add_light(struct sum *sum, const struct turner_light *light)
{
    add_count(sum, light->kind);
    add_vec3(sum, light->position);
    add_vec3(sum, light->direction);
    add_vec3(sum, light->power);
    add_count(sum, light->falloff);
    add_real(sum, light->cos_inner);
    add_real(sum, light->cos_outer);
}

static void add_surfaces(struct sum *sum, const struct turner_scene *scene)
{
    add_count(sum, scene->plane_count);
    for (size_t i = 0; i < scene->plane_count; i++) {
        add_vec3(sum, scene->planes[i].point);
        add_vec3(sum, scene->planes[i].normal);
        add_vec3(sum, scene->planes[i].tangent);
        add_count(sum, scene->planes[i].material);
    }
    add_count(sum, scene->group_count);
    for (size_t i = 0; i < scene->group_count; i++)
        add_group(sum, &scene->groups[i]);
    add_count(sum, scene->instance_count);
    for (size_t i = 0; i < scene->instance_count; i++) {
        add_count(sum, scene->instances[i].group);
        add_count(sum, scene->instances[i].material);
        for (int k = 0; k < 12; k++)
            add_real(sum, scene->instances[i].transform.m[k / 4][k % 4]);
    }
}

uint64_t turner_scene_hash(const struct turner_scene *scene)
{
    struct sum sum = {TURNER_HASH_START};
    add_camera(&sum, &scene->camera);
    add_vec3(&sum, scene->ambient);
    add_background(&sum, &scene->background);
    add_count(&sum, scene->media_count);
    for (size_t i = 0; i < scene->media_count; i++) {
        add_real(&sum, scene->media[i].index);
        add_vec3(&sum, scene->media[i].absorption);
        add_count(&sum, (uint64_t)scene->media[i].priority);
    }
    add_count(&sum, scene->material_count);
    for (size_t i = 0; i < scene->material_count; i++)
        add_material(&sum, &scene->materials[i]);
    add_count(&sum, scene->texture_image_count);
    for (size_t i = 0; i < scene->texture_image_count; i++)
        add_image(&sum, &scene->texture_images[i]);
    add_surfaces(&sum, scene);
    add_count(&sum, scene->light_count);
    for (size_t i = 0; i < scene->light_count; i++)
        add_light(&sum, &scene->lights[i]);
    for (size_t i = 0; i < scene->param_count; i++) {
        sum.hash = turner_hash_text(sum.hash, scene->params[i].name);
        sum.hash = turner_hash_text(sum.hash, scene->params[i].value);
    }
    if (scene->shader_hash)
        add_count(&sum, scene->shader_hash);
    return sum.hash;
}
