#include "render/usage.h"

#include <stdlib.h>

#include "base/memory.h"

static void use_group(struct turner_usage *usage, const struct turner_group *group)
{
    for (size_t i = 0; i < group->sphere_count; i++)
        usage->materials[group->spheres[i].material] = true;
    for (size_t i = 0; i < group->cone_count; i++)
        usage->materials[group->cones[i].material] = true;
    for (size_t i = 0; i < group->mesh_count; i++)
        usage->materials[group->meshes[i].material] = true;
}

void turner_usage_create(struct turner_usage *usage, const struct turner_scene *scene)
{
    usage->groups = turner_calloc(scene->group_count, sizeof *usage->groups);
    usage->materials = turner_calloc(scene->material_count, sizeof *usage->materials);
    usage->media = turner_calloc(scene->media_count, sizeof *usage->media);
    bool *own = turner_calloc(scene->group_count, sizeof *own); /* shown in its own materials */
    usage->groups[0] = own[0] = true;
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        usage->groups[instance->group] = true;
        if (instance->material == TURNER_NONE)
            own[instance->group] = true;
        else if (turner_group_primitive_count(&scene->groups[instance->group]))
            usage->materials[instance->material] = true;
    }
    for (size_t i = 0; i < scene->group_count; i++) {
        if (own[i])
            use_group(usage, &scene->groups[i]);
    }
    free(own);
    for (size_t i = 0; i < scene->plane_count; i++)
        usage->materials[scene->planes[i].material] = true;
    for (size_t i = 0; i < scene->material_count; i++) {
        if (usage->materials[i] && scene->materials[i].medium != TURNER_NONE)
            usage->media[scene->materials[i].medium] = true;
    }
    for (uint32_t i = 0; i < scene->camera.inside_count; i++)
        usage->media[scene->camera.inside[i]] = true;
}

void turner_usage_destroy(struct turner_usage *usage)
{
    free(usage->groups);
    free(usage->materials);
    free(usage->media);
}
