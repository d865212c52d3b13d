#include "scene/ids.h"

#include <stdlib.h>

#include "base/memory.h"

static const struct turner_group *group_of(const struct turner_ids *ids, uint32_t instance,
                                           uint32_t *index)
{
    *index = instance ? ids->scene->instances[instance - 1].group : 0;
    return &ids->scene->groups[*index];
}

enum turner_result turner_ids_create(struct turner_ids *ids, const struct turner_scene *scene)
{
    *ids = (struct turner_ids){
        .scene = scene,
        .first = turner_calloc(scene->instance_count + 1, sizeof *ids->first),
        .before = turner_calloc(scene->group_count, sizeof *ids->before),
    };
    for (size_t i = 0; i < scene->group_count; i++) {
        const struct turner_group *group = &scene->groups[i];
        ids->before[i] = turner_calloc(group->mesh_count + 1, sizeof **ids->before);
        for (size_t m = 0; m < group->mesh_count; m++)
            ids->before[i][m + 1] = ids->before[i][m] + group->meshes[m].triangle_count;
    }
    uint64_t next = 1 + scene->plane_count;
    for (uint32_t i = 0; i <= scene->instance_count; i++) {
        uint32_t index;
        const struct turner_group *group = group_of(ids, i, &index);
        ids->first[i] = (uint32_t)next;
        next += group->sphere_count + group->cone_count + group->mesh_count;
    }
    if (next <= (uint64_t)UINT32_MAX + 1)
        return TURNER_OK;
    turner_ids_destroy(ids);
    return turner_fail(TURNER_BAD_INPUT,
                       "the scene shows more things, counted in each instance, than the layer id "
                       "has numbers (2³² − 1); ask for other layers");
}

void turner_ids_destroy(struct turner_ids *ids)
{
    for (size_t i = 0; ids->before && i < ids->scene->group_count; i++)
        free(ids->before[i]);
    free(ids->before);
    free(ids->first);
    *ids = (struct turner_ids){0};
}

uint32_t turner_id_of(const struct turner_ids *ids, uint32_t instance, uint32_t primitive)
{
    uint32_t index;
    const struct turner_group *group = group_of(ids, instance, &index);
    uint32_t others = (uint32_t)(group->sphere_count + group->cone_count);
    if (primitive < others)
        return ids->first[instance] + primitive;
    size_t low = 0, high = group->mesh_count; /* the mesh is in low … high − 1 */
    while (high - low > 1) {
        size_t half = (low + high) / 2;
        if (ids->before[index][half] <= primitive - others)
            low = half;
        else
            high = half;
    }
    return ids->first[instance] + others + (uint32_t)low;
}
