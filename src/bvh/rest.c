/* What rounding to floats took from a flat scene, for kernels that compute in double. */
#include <stdlib.h>

#include "base/memory.h"
#include "bvh/flat.h"

static float rest_of(double exact, float rounded)
{
    return (float)(exact - (double)rounded);
}

static void point_rest(float rest[3], struct turner_vec3 exact, const float rounded[3])
{
    rest[0] = rest_of(exact.x, rounded[0]);
    rest[1] = rest_of(exact.y, rounded[1]);
    rest[2] = rest_of(exact.z, rounded[2]);
}

/* Triangle `index` of the group is triangle *local of the returned mesh; firsts says which is the
 * first of each mesh. */
static const struct turner_mesh *mesh_of(const struct turner_group *group, const uint32_t *firsts,
                                         uint32_t index, uint32_t *local)
{
    size_t low = 0, high = group->mesh_count; /* the last mesh that begins by then */
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (firsts[middle] <= index)
            low = middle;
        else
            high = middle;
    }
    *local = index - firsts[low];
    return &group->meshes[low];
}

static struct turner_gpu_primitive_rest primitive_rest(const struct turner_group *group,
                                                       const uint32_t *firsts,
                                                       const struct turner_gpu_primitive *rounded)
{
    struct turner_gpu_primitive_rest rest = {0};
    uint32_t index = rounded->id & ((1u << TURNER_KIND_SHIFT) - 1);
    switch (rounded->id >> TURNER_KIND_SHIFT) {
    case TURNER_KIND_SPHERE:
        point_rest(rest.a, group->spheres[index].center, rounded->a);
        rest.b[0] = rest_of(group->spheres[index].radius, rounded->b[0]);
        break;
    case TURNER_KIND_CONE: {
        const struct turner_cone *cone = &group->cones[index];
        point_rest(rest.a, cone->base, rounded->a);
        point_rest(rest.b, cone->apex, rounded->b);
        rest.c[0] = rest_of(cone->base_radius, rounded->c[0]);
        rest.c[1] = rest_of(cone->apex_radius, rounded->c[1]);
        break;
    }
    default: {
        uint32_t local;
        const struct turner_mesh *mesh = mesh_of(group, firsts, index, &local);
        const uint32_t *corners = mesh->triangles[local];
        point_rest(rest.a, mesh->positions[corners[0]], rounded->a);
        point_rest(rest.b, mesh->positions[corners[1]], rounded->b);
        point_rest(rest.c, mesh->positions[corners[2]], rounded->c);
    }
    }
    return rest;
}

void turner_flat_primitive_rests(struct turner_gpu_primitive_rest *rests,
                                 const struct turner_flat *flat, const struct turner_scene *scene)
{
    size_t first = 0;
    for (size_t g = 0; g < scene->group_count; g++) {
        const struct turner_group *group = &scene->groups[g];
        size_t end = first + turner_group_primitive_count(group);
        uint32_t *firsts = turner_calloc(group->mesh_count + 1, sizeof *firsts);
        for (size_t i = 0; i < group->mesh_count; i++)
            firsts[i + 1] = firsts[i] + group->meshes[i].triangle_count;
        for (; first < end; first++)
            rests[first] = primitive_rest(group, firsts, &flat->primitives[first]);
        free(firsts);
    }
}

void turner_flat_instance_rests(struct turner_gpu_instance_rest *rests,
                                const struct turner_flat *flat, const struct turner_scene *scene)
{
    rests[0] = (struct turner_gpu_instance_rest){0};
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_affine *to_world = &scene->instances[i].transform;
        const struct turner_gpu_instance *rounded = &flat->instances[i + 1];
        struct turner_affine to_group;
        turner_affine_invert(&to_group, to_world);
        for (int j = 0; j < 12; j++) {
            rests[i + 1].to_world[j] =
                rest_of(to_world->m[j / 4][j % 4], rounded->to_world[j]);
            rests[i + 1].to_group[j] =
                rest_of(to_group.m[j / 4][j % 4], rounded->to_group[j]);
        }
    }
}
