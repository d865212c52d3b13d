/* Surfaces: primitives, groups as unions, instances as copies with a matrix. */
#include <stdlib.h>

#include "base/memory.h"
#include "scene/pov_parts.h"

/* What a primitive is printed as: with its material, as part of a union that has the interior, or
 * as the shade it casts. A transmissive thing lets light through in POV-Ray; under `shadows: opaque`
 * it casts no shadow itself, and a black twin that nothing but shadow rays can see does. */
enum role { ROLE_ITSELF, ROLE_PART, ROLE_SHADE };

static bool has_shade(const struct turner_scene *scene, uint32_t material)
{
    return scene->settings.shadows == TURNER_SHADOWS_OPAQUE && scene->light_count &&
           !turner_pov_zero(scene->materials[material].k_t);
}

static void write_interior(FILE *out, const struct turner_scene *scene, uint32_t material)
{
    if (!turner_pov_zero(scene->materials[material].k_t))
        fprintf(out, " interior { I%u } hollow", (unsigned)material);
}

static void end_surface(FILE *out, const struct turner_scene *scene, uint32_t material,
                        const struct turner_plane *plane, enum role role)
{
    const struct turner_material *m = &scene->materials[material];
    if (role == ROLE_SHADE) {
        fputs(" pigment { rgb 0 } no_image no_reflection }\n", out);
        return;
    }
    if (m->pattern == TURNER_PATTERN_NONE) {
        fprintf(out, " texture { M%u }", (unsigned)material);
    } else {
        fputs(plane ? "\n" : " uv_mapping\n", out);
        turner_pov_texture(out, scene, material, plane);
    }
    if (role == ROLE_ITSELF)
        write_interior(out, scene, material);
    fputs(has_shade(scene, material) ? " no_shadow }\n" : " }\n", out);
}

static void write_sphere(FILE *out, const struct turner_sphere *sphere)
{
    fputs("sphere { ", out);
    turner_pov_vector(out, sphere->center);
    fprintf(out, ", %.17g", sphere->radius);
}

static void write_cone(FILE *out, const struct turner_cone *cone)
{
    fputs("cone { ", out);
    turner_pov_vector(out, cone->base);
    fprintf(out, ", %.17g, ", cone->base_radius);
    turner_pov_vector(out, cone->apex);
    fprintf(out, ", %.17g%s", cone->apex_radius, cone->capped ? "" : " open");
}

static void write_plane(FILE *out, const struct turner_plane *plane)
{
    fputs("plane { ", out);
    turner_pov_vector(out, plane->normal);
    fprintf(out, ", %.17g", turner_vec3_dot(plane->normal, plane->point));
}

/* Without uvs of its own a triangle has its barycentric coordinates. */
static void write_uvs(FILE *out, const struct turner_mesh *mesh)
{
    if (!mesh->uvs) {
        fprintf(out, "  uv_vectors { 3, <0, 0>, <1, 0>, <0, 1> }\n");
        return;
    }
    fprintf(out, "  uv_vectors { %u", (unsigned)mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        fprintf(out, ",\n<%.9g, %.9g>", (double)mesh->uvs[i][0], (double)mesh->uvs[i][1]);
    fputs(" }\n", out);
}

static void write_indices(FILE *out, const char *what, const struct turner_mesh *mesh, bool own)
{
    fprintf(out, "  %s { %u", what, (unsigned)mesh->triangle_count);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        if (own)
            fputs(",\n<0, 1, 2>", out);
        else
            fprintf(out, ",\n<%u, %u, %u>", (unsigned)t[0], (unsigned)t[1], (unsigned)t[2]);
    }
    fputs(" }\n", out);
}

static void write_mesh(FILE *out, const struct turner_mesh *mesh, bool textured)
{
    fprintf(out, "mesh2 {\n  vertex_vectors { %u", (unsigned)mesh->vertex_count);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        fputs(",\n", out);
        turner_pov_vector(out, mesh->positions[i]);
    }
    fputs(" }\n", out);
    if (mesh->normals) {
        fprintf(out, "  normal_vectors { %u", (unsigned)mesh->vertex_count);
        for (uint32_t i = 0; i < mesh->vertex_count; i++)
            fprintf(out, ",\n<%.9g, %.9g, %.9g>", (double)mesh->normals[i][0],
                    (double)mesh->normals[i][1], (double)mesh->normals[i][2]);
        fputs(" }\n", out);
    }
    if (textured)
        write_uvs(out, mesh);
    write_indices(out, "face_indices", mesh, false);
    if (textured)
        write_indices(out, "uv_indices", mesh, !mesh->uvs);
}

static bool is_hole(const struct turner_pov_holes *holes, const struct turner_sphere *sphere)
{
    for (size_t i = 0; i < holes->count; i++) {
        if (holes->list[i].sphere == sphere)
            return true;
    }
    return false;
}

/* How a primitive that may have holes begins; end_container ends it. */
static enum role begin_container(FILE *out, const struct turner_pov_holes *holes,
                                 const void *primitive)
{
    for (size_t i = 0; i < holes->count; i++) {
        if (holes->list[i].container == primitive) {
            fputs("union {\n", out);
            return ROLE_PART;
        }
    }
    return ROLE_ITSELF;
}

static void end_container(FILE *out, const struct turner_scene *scene,
                          const struct turner_pov_holes *holes, const void *primitive,
                          uint32_t material)
{
    for (size_t i = 0; i < holes->count; i++) {
        if (holes->list[i].container != primitive)
            continue;
        write_sphere(out, holes->list[i].sphere);
        end_surface(out, scene, holes->list[i].sphere->material, NULL, ROLE_PART);
    }
    write_interior(out, scene, material);
    fputs(" }\n", out);
}

static void write_spheres(FILE *out, const struct turner_scene *scene,
                          const struct turner_pov_holes *holes, const struct turner_group *group,
                          uint32_t override, bool shade)
{
    for (size_t i = 0; i < group->sphere_count; i++) {
        const struct turner_sphere *sphere = &group->spheres[i];
        uint32_t m = override != TURNER_NONE ? override : sphere->material;
        if (shade ? !has_shade(scene, m) : is_hole(holes, sphere))
            continue;
        enum role role = shade ? ROLE_SHADE : begin_container(out, holes, sphere);
        write_sphere(out, sphere);
        end_surface(out, scene, m, NULL, role);
        if (role == ROLE_PART)
            end_container(out, scene, holes, sphere, m);
    }
}

static void write_meshes(FILE *out, const struct turner_scene *scene,
                         const struct turner_pov_holes *holes, const struct turner_group *group,
                         uint32_t override, bool shade)
{
    for (size_t i = 0; i < group->mesh_count; i++) {
        const struct turner_mesh *mesh = &group->meshes[i];
        uint32_t m = override != TURNER_NONE ? override : mesh->material;
        if (!mesh->triangle_count || (shade && !has_shade(scene, m)))
            continue;
        enum role role = shade ? ROLE_SHADE : begin_container(out, holes, mesh);
        write_mesh(out, mesh, scene->materials[m].pattern != TURNER_PATTERN_NONE && !shade);
        end_surface(out, scene, m, NULL, role);
        if (role == ROLE_PART)
            end_container(out, scene, holes, mesh, m);
    }
}

/* `override` is the instance's material or TURNER_NONE. */
static void write_group(FILE *out, const struct turner_scene *scene,
                        const struct turner_pov_holes *holes, const struct turner_group *group,
                        uint32_t override)
{
    for (int shade = 0; shade <= 1; shade++) {
        write_spheres(out, scene, holes, group, override, shade);
        for (size_t i = 0; i < group->cone_count; i++) {
            uint32_t m = override != TURNER_NONE ? override : group->cones[i].material;
            if (shade && !has_shade(scene, m))
                continue;
            write_cone(out, &group->cones[i]);
            end_surface(out, scene, m, NULL, shade ? ROLE_SHADE : ROLE_ITSELF);
        }
        write_meshes(out, scene, holes, group, override, shade);
    }
}

static void write_instances(FILE *out, const struct turner_scene *scene)
{
    static const struct turner_pov_holes none;
    bool *declared = turner_calloc(scene->group_count, sizeof *declared);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        const struct turner_group *group = &scene->groups[instance->group];
        bool own = instance->material != TURNER_NONE; /* then no other can share the union */
        if (!turner_group_primitive_count(group))
            continue;
        if (!own && !declared[instance->group]) {
            fprintf(out, "#declare G%u = union {\n", (unsigned)instance->group);
            write_group(out, scene, &none, group, TURNER_NONE);
            fputs("}\n", out);
            declared[instance->group] = true;
        }
        if (own) {
            fputs("union {\n", out);
            write_group(out, scene, &none, group, instance->material);
        } else {
            fprintf(out, "object { G%u", (unsigned)instance->group);
        }
        fputs(" matrix <", out); /* POV-Ray's rows are our columns */
        for (int column = 0; column < 4; column++)
            for (int row = 0; row < 3; row++)
                fprintf(out, "%s%.17g", column || row ? ", " : "",
                        instance->transform.m[row][column]);
        fputs("> }\n", out);
    }
    free(declared);
}

static enum turner_result check_group(const struct turner_scene *scene,
                                      const struct turner_group *group, uint32_t override)
{
    for (size_t i = 0; i < group->sphere_count + group->cone_count; i++) {
        bool cone = i >= group->sphere_count;
        uint32_t m = override != TURNER_NONE ? override
                     : cone ? group->cones[i - group->sphere_count].material
                            : group->spheres[i].material;
        if (scene->materials[m].pattern != TURNER_PATTERN_NONE)
            return turner_fail(TURNER_BAD_INPUT, "%s is on a %s, round which POV-Ray lays a "
                               "pattern otherwise: use it on planes and meshes only",
                               turner_pov_material_name(scene, m), cone ? "cone" : "sphere");
    }
    return TURNER_OK;
}

enum turner_result turner_pov_check_patterns(const struct turner_scene *scene)
{
    TURNER_TRY(check_group(scene, &scene->groups[0], TURNER_NONE));
    for (size_t i = 0; i < scene->instance_count; i++)
        TURNER_TRY(check_group(scene, &scene->groups[scene->instances[i].group],
                               scene->instances[i].material));
    return TURNER_OK;
}

void turner_pov_objects(FILE *out, const struct turner_scene *scene,
                        const struct turner_pov_holes *holes)
{
    for (size_t i = 0; i < scene->plane_count; i++) {
        const struct turner_plane *plane = &scene->planes[i];
        write_plane(out, plane);
        end_surface(out, scene, plane->material, plane, ROLE_ITSELF);
        if (has_shade(scene, plane->material)) {
            write_plane(out, plane);
            end_surface(out, scene, plane->material, plane, ROLE_SHADE);
        }
    }
    write_group(out, scene, holes, &scene->groups[0], TURNER_NONE);
    write_instances(out, scene);
}

static void use_group(bool *used, const struct turner_group *group)
{
    for (size_t i = 0; i < group->sphere_count; i++)
        used[group->spheres[i].material] = true;
    for (size_t i = 0; i < group->cone_count; i++)
        used[group->cones[i].material] = true;
    for (size_t i = 0; i < group->mesh_count; i++)
        used[group->meshes[i].material] = true;
}

bool *turner_pov_materials_used(const struct turner_scene *scene)
{
    bool *used = turner_calloc(scene->material_count + 1, sizeof *used);
    for (size_t i = 0; i < scene->plane_count; i++)
        used[scene->planes[i].material] = true;
    use_group(used, &scene->groups[0]);
    for (size_t i = 0; i < scene->instance_count; i++) {
        if (scene->instances[i].material != TURNER_NONE)
            used[scene->instances[i].material] = true;
        else
            use_group(used, &scene->groups[scene->instances[i].group]);
    }
    return used;
}
