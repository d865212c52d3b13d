#include "bvh/flatten.h"

#include <string.h>

uint32_t turner_flat_material(const struct turner_scene *scene, uint32_t material)
{
    if (material == TURNER_NONE)
        return TURNER_NO_INDEX;
    const struct turner_vec3 *k_t = &scene->materials[material].k_t;
    bool transmissive = k_t->x > 0 || k_t->y > 0 || k_t->z > 0;
    return material | (transmissive ? TURNER_MATERIAL_TRANSMISSIVE : 0);
}

bool turner_flat_needs_uvs(const struct turner_scene *scene, const struct turner_mesh *mesh,
                           bool patterned)
{
    return mesh->uvs &&
           (patterned || scene->materials[mesh->material].pattern != TURNER_PATTERN_NONE);
}

static void round_point(float out[3], struct turner_vec3 point)
{
    out[0] = (float)point.x;
    out[1] = (float)point.y;
    out[2] = (float)point.z;
}

/* Triangles from `out` on, with ids from `index` on. */
static void flatten_mesh(struct turner_flat *flat, struct turner_gpu_primitive *out,
                         const struct turner_mesh *mesh, uint32_t index, uint32_t material,
                         bool needs_uvs)
{
    uint32_t attributes = TURNER_NO_INDEX, first_vertex = (uint32_t)flat->vertex_count;
    if (mesh->normals || needs_uvs) {
        attributes = (uint32_t)flat->corner_count |
                     (mesh->normals ? TURNER_ATTRIBUTES_NORMALS : 0) |
                     (needs_uvs ? TURNER_ATTRIBUTES_UVS : 0);
        if (mesh->normals)
            memcpy(flat->normals + first_vertex, mesh->normals,
                   mesh->vertex_count * sizeof *mesh->normals);
        if (needs_uvs)
            memcpy(flat->uvs + first_vertex, mesh->uvs, mesh->vertex_count * sizeof *mesh->uvs);
        flat->vertex_count += mesh->vertex_count;
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *corners = mesh->triangles[i];
        round_point(out[i].a, mesh->positions[corners[0]]);
        round_point(out[i].b, mesh->positions[corners[1]]);
        round_point(out[i].c, mesh->positions[corners[2]]);
        out[i].id = TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT | (index + i);
        out[i].material = material;
        out[i].attributes = attributes;
        if (attributes != TURNER_NO_INDEX) {
            struct turner_gpu_corners *shared = &flat->corners[flat->corner_count++];
            for (int corner = 0; corner < 3; corner++)
                shared->vertex[corner] = first_vertex + corners[corner];
            attributes++;
        }
    }
}

void turner_flat_group(struct turner_flat *flat, const struct turner_scene *scene, size_t index,
                       size_t first, bool patterned)
{
    const struct turner_group *group = &scene->groups[index];
    struct turner_gpu_primitive *out = flat->primitives + first;
    for (size_t i = 0; i < group->sphere_count; i++, out++) {
        const struct turner_sphere *sphere = &group->spheres[i];
        *out = (struct turner_gpu_primitive){
            .b = {(float)sphere->radius},
            .id = TURNER_KIND_SPHERE << TURNER_KIND_SHIFT | (uint32_t)i,
            .material = turner_flat_material(scene, sphere->material),
            .attributes = TURNER_NO_INDEX,
        };
        round_point(out->a, sphere->center);
    }
    for (size_t i = 0; i < group->cone_count; i++, out++) {
        const struct turner_cone *cone = &group->cones[i];
        *out = (struct turner_gpu_primitive){
            .c = {(float)cone->base_radius, (float)cone->apex_radius, cone->capped ? 1.0f : 0.0f},
            .id = TURNER_KIND_CONE << TURNER_KIND_SHIFT | (uint32_t)i,
            .material = turner_flat_material(scene, cone->material),
            .attributes = TURNER_NO_INDEX,
        };
        round_point(out->a, cone->base);
        round_point(out->b, cone->apex);
    }
    uint32_t triangle = 0;
    for (size_t i = 0; i < group->mesh_count; i++) {
        const struct turner_mesh *mesh = &group->meshes[i];
        flatten_mesh(flat, out, mesh, triangle, turner_flat_material(scene, mesh->material),
                     turner_flat_needs_uvs(scene, mesh, patterned));
        out += mesh->triangle_count;
        triangle += mesh->triangle_count;
    }
}
