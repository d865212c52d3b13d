/* The last word on what scene.h states, whatever reader filled the scene. */
#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "scene/readers.h"

/* The thing that is being looked at, as messages name it. */
struct subject {
    const char *kind;
    size_t number;    /* in its list, from 0 */
    const char *name; /* or NULL */
    const struct turner_group *group; /* that it is in, or NULL */
};

TURNER_PRINTF(2, 3)
static enum turner_result bad(const struct subject *s, const char *format, ...)
{
    char message[512], where[768];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    size_t used = (size_t)snprintf(where, sizeof where, "%s", s->kind);
    if (s->name)
        used += (size_t)snprintf(where + used, sizeof where - used, " \"%s\"", s->name);
    else if (s->number != SIZE_MAX)
        used += (size_t)snprintf(where + used, sizeof where - used, " %zu", s->number);
    if (s->group && s->group->name)
        snprintf(where + used, sizeof where - used, " of group \"%s\"", s->group->name);
    return turner_fail(TURNER_BAD_INPUT, "%s: %s", where, message);
}

static const struct subject settings_subject = {"settings", SIZE_MAX, NULL, NULL};
static const struct subject camera_subject = {"camera", SIZE_MAX, NULL, NULL};
static const struct subject scene_subject = {"scene", SIZE_MAX, NULL, NULL};

/* Returns from the caller with a message unless `condition`; NaN makes every comparison false. */
#define CHECK(subject, condition, ...)                                                             \
    do {                                                                                           \
        if (!(condition))                                                                          \
            return bad((subject), __VA_ARGS__);                                                    \
    } while (0)

/* ---- numbers ---- */

/* Finite, also as the 32-bit float that it becomes on a device. */
static bool usable(double number)
{
    return fabs(number) <= (double)FLT_MAX;
}

static bool usable3(struct turner_vec3 v)
{
    return usable(v.x) && usable(v.y) && usable(v.z);
}

static bool is_unit(struct turner_vec3 v)
{
    return fabs(turner_vec3_length(v) - 1) <= 1e-6;
}

static bool is_black(struct turner_vec3 color)
{
    return color.x == 0 && color.y == 0 && color.z == 0;
}

bool turner_color_usable(struct turner_vec3 c)
{
    return usable3(c) && c.x >= 0 && c.y >= 0 && c.z >= 0;
}

bool turner_affine_usable(const struct turner_affine *affine)
{
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            if (!usable(affine->m[row][column]))
                return false;
        }
    }
    struct turner_affine unused;
    return turner_affine_invert(&unused, affine);
}

/* ---- settings, camera, background ---- */

static enum turner_result check_settings(const struct turner_settings *s)
{
    const struct subject *subject = &settings_subject;
    CHECK(subject, s->width >= 1 && s->width <= TURNER_MAX_SIZE && s->height >= 1 &&
          s->height <= TURNER_MAX_SIZE, "size %d × %d is not between 1 and %d", s->width,
          s->height, TURNER_MAX_SIZE);
    CHECK(subject, s->depth >= 0 && s->depth <= TURNER_MAX_DEPTH,
          "depth %d is not between 0 and %d", s->depth, TURNER_MAX_DEPTH);
    CHECK(subject, usable(s->cutoff) && s->cutoff >= 0, "cutoff %g must be 0 or above", s->cutoff);
    CHECK(subject, s->spp >= 1 && s->spp <= TURNER_MAX_SPP, "spp %d is not between 1 and %d",
          s->spp, TURNER_MAX_SPP);
    CHECK(subject, usable(s->aa_threshold) && s->aa_threshold >= 0,
          "the threshold %g of adaptive samples must be 0 or above", s->aa_threshold);
    CHECK(subject, usable(s->error) && s->error >= 0, "the error %g must be 0 or above", s->error);
    CHECK(subject, s->methods.offset != TURNER_OFFSET_TMIN ||
          (usable(s->methods.tmin) && s->methods.tmin > 0), "tmin %g must be above 0",
          s->methods.tmin);
    CHECK(subject, s->shading == TURNER_SHADING_PHONG ||
          s->shading == TURNER_SHADING_ENERGY_CONSERVING, "unknown shading");
    CHECK(subject, s->shadows == TURNER_SHADOWS_OPAQUE || s->shadows == TURNER_SHADOWS_TINTED,
          "unknown shadows");
    CHECK(subject, usable(s->exposure), "exposure is not finite");
    CHECK(subject, s->transfer == TURNER_TRANSFER_SRGB || s->transfer == TURNER_TRANSFER_LINEAR,
          "unknown transfer");
    CHECK(subject, !s->spd_grid || s->height > 2, "spd_grid needs at least 3 rows");
    return TURNER_OK;
}

enum turner_camera_state turner_camera_check(const struct turner_camera *camera)
{
    struct turner_vec3 view = turner_vec3_sub(camera->at, camera->from);
    if (!(turner_vec3_length(view) > 0))
        return TURNER_CAMERA_NO_DIRECTION;
    struct turner_vec3 right =
        turner_vec3_cross(turner_vec3_normalize(view), turner_vec3_normalize(camera->up));
    /* below this, `right` has lost half of its digits */
    return turner_vec3_length(right) > 1e-8 ? TURNER_CAMERA_GOOD : TURNER_CAMERA_UP_PARALLEL;
}

static enum turner_result check_camera(const struct turner_scene *scene,
                                       const struct turner_camera *c, const struct subject *subject)
{
    CHECK(subject, usable3(c->from) && usable3(c->at) && usable3(c->up),
          "from, at or up is not finite");
    enum turner_camera_state state = turner_camera_check(c);
    CHECK(subject, state != TURNER_CAMERA_NO_DIRECTION, "from and at are the same point");
    CHECK(subject, state != TURNER_CAMERA_UP_PARALLEL, "up lies along the view; choose another");
    CHECK(subject, c->vfov > 0 && c->vfov < acos(-1),
          "the angle of view must be above 0 and below 180 degrees");
    CHECK(subject, c->inside_count <= TURNER_MEDIA_NESTING, "inside of %u media; %d are the limit",
          c->inside_count, TURNER_MEDIA_NESTING);
    for (uint32_t i = 0; i < c->inside_count; i++)
        CHECK(subject, c->inside[i] < scene->media_count, "inside of a medium that is not there");
    return TURNER_OK;
}

static enum turner_result check_background(const struct turner_scene *scene)
{
    const struct turner_background *b = &scene->background;
    const struct subject subject = {"background", SIZE_MAX, NULL, NULL};
    CHECK(&subject, turner_color_usable(b->color) && turner_color_usable(b->top) &&
          turner_color_usable(b->scale), "a colour is negative or not finite");
    switch (b->kind) {
    case TURNER_BACKGROUND_CONSTANT:
        return TURNER_OK;
    case TURNER_BACKGROUND_GRADIENT:
        CHECK(&subject, is_unit(b->up), "up is no unit vector");
        return TURNER_OK;
    case TURNER_BACKGROUND_ENVIRONMENT:
        CHECK(&subject, usable(b->rotation), "rotation is not finite");
        CHECK(&subject, b->image < scene->texture_image_count, "the picture is not there");
        return TURNER_OK;
    }
    return bad(&subject, "unknown kind");
}

/* ---- media, materials, pictures ---- */

static enum turner_result check_media(const struct turner_scene *scene)
{
    CHECK(&scene_subject, scene->media_count <= TURNER_MAX_MEDIA, "%zu media; %d are the limit",
          scene->media_count, TURNER_MAX_MEDIA);
    for (size_t i = 0; i < scene->media_count; i++) {
        const struct turner_medium *m = &scene->media[i];
        const struct subject subject = {"medium", i, m->name, NULL};
        CHECK(&subject, usable(m->index) && m->index > 0, "index %g must be above 0", m->index);
        CHECK(&subject, turner_color_usable(m->absorption), "absorption is negative or not finite");
        CHECK(&subject, i == 0 || scene->media[i - 1].priority <= m->priority,
              "media are not sorted by priority");
    }
    return TURNER_OK;
}

bool turner_material_branches(const struct turner_material *material,
                              const struct turner_settings *settings)
{
    return !is_black(material->k_t) && (!is_black(material->k_r) || settings->spd_rays);
}

static enum turner_result check_material(const struct turner_scene *scene,
                                         const struct turner_material *m,
                                         const struct subject *subject)
{
    const struct turner_vec3 colors[] = {m->k_e, m->k_a, m->k_d, m->k_s, m->k_r, m->k_t};
    static const char *const names[] = {"k_e", "k_a", "k_d", "k_s", "k_r", "k_t"};
    for (size_t i = 0; i < 6; i++)
        CHECK(subject, turner_color_usable(colors[i]), "%s is negative or not finite", names[i]);
    CHECK(subject, usable(m->exponent) && m->exponent >= 0, "exponent %g must be 0 or above",
          m->exponent);
    CHECK(subject, m->fresnel == TURNER_FRESNEL_NONE || m->fresnel == TURNER_FRESNEL_SCHLICK ||
          m->fresnel == TURNER_FRESNEL_EXACT, "unknown fresnel");
    if (m->conductor) {
        CHECK(subject, turner_color_usable(m->eta) && turner_color_usable(m->k),
              "eta or k is negative or not finite");
        CHECK(subject, m->fresnel == TURNER_FRESNEL_EXACT, "a complex index wants fresnel exact");
        CHECK(subject, is_black(m->k_t), "a metal lets no light through, but k_t is above 0");
    }
    if (is_black(m->k_t)) {
        CHECK(subject, m->medium == TURNER_NONE, "a medium behind a surface with k_t = 0");
        CHECK(subject, m->conductor || m->fresnel != TURNER_FRESNEL_EXACT || is_black(m->k_r),
              "fresnel exact on a mirror needs eta and k");
    } else {
        CHECK(subject, m->medium < scene->media_count,
              "k_t is above 0, but what is behind the surface? Give it an index");
    }
    if (m->pattern != TURNER_PATTERN_NONE)
        CHECK(subject, usable(m->uv_scale[0]) && usable(m->uv_scale[1]),
              "the pattern's scale is not finite");
    if (m->pattern == TURNER_PATTERN_CHECKER)
        CHECK(subject, turner_color_usable(m->checker[0]) && turner_color_usable(m->checker[1]),
              "a checker colour is negative or not finite");
    if (m->pattern == TURNER_PATTERN_IMAGE)
        CHECK(subject, m->image < scene->texture_image_count, "its picture is not there");
    CHECK(subject, scene->settings.depth <= TURNER_MAX_BRANCH_DEPTH ||
          !turner_material_branches(m, &scene->settings), "it both reflects and transmits, so "
          "depth %d is too much; %d is the limit", scene->settings.depth, TURNER_MAX_BRANCH_DEPTH);
    return TURNER_OK;
}

static enum turner_result check_materials(const struct turner_scene *scene)
{
    CHECK(&scene_subject, scene->material_count <= TURNER_MAX_MATERIALS,
          "%zu materials; %u are the limit", scene->material_count, TURNER_MAX_MATERIALS);
    for (size_t i = 0; i < scene->material_count; i++) {
        const struct subject subject = {"material", i, scene->materials[i].name, NULL};
        TURNER_TRY(check_material(scene, &scene->materials[i], &subject));
    }
    return TURNER_OK;
}

static enum turner_result check_texture_images(const struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->texture_image_count; i++) {
        const struct turner_texture_image *image = &scene->texture_images[i];
        const struct subject subject = {"picture", i, image->path, NULL};
        CHECK(&subject, image->width > 0 && image->height > 0 && image->rgb, "it is empty");
        size_t count = 3 * (size_t)image->width * (size_t)image->height;
        for (size_t j = 0; j < count; j++)
            CHECK(&subject, isfinite(image->rgb[j]), "the pixel in column %zu of row %zu is not "
                  "finite", j / 3 % (size_t)image->width, j / 3 / (size_t)image->width);
    }
    return TURNER_OK;
}

/* ---- shapes ---- */

static enum turner_result check_planes(const struct turner_scene *scene)
{
    CHECK(&scene_subject, scene->plane_count <= TURNER_MAX_PLANES, "%zu planes; %d are the limit",
          scene->plane_count, TURNER_MAX_PLANES);
    for (size_t i = 0; i < scene->plane_count; i++) {
        const struct turner_plane *p = &scene->planes[i];
        const struct subject subject = {"plane", i, NULL, NULL};
        CHECK(&subject, usable3(p->point), "its point is not finite");
        CHECK(&subject, is_unit(p->normal) && is_unit(p->tangent) &&
              fabs(turner_vec3_dot(p->normal, p->tangent)) <= 1e-6,
              "normal and tangent are not unit vectors at right angles");
        CHECK(&subject, p->material < scene->material_count, "its material is not there");
    }
    return TURNER_OK;
}

static enum turner_result check_mesh(const struct turner_scene *scene,
                                     const struct turner_mesh *mesh, const struct subject *subject)
{
    CHECK(subject, mesh->material < scene->material_count, "its material is not there");
    CHECK(subject, mesh->vertex_count > 0 && mesh->triangle_count > 0 && mesh->positions &&
          mesh->triangles, "it has no triangles");
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        CHECK(subject, usable3(mesh->positions[i]), "vertex %u is not finite", i);
        if (mesh->normals) {
            const float *n = mesh->normals[i];
            double length = turner_vec3_length(
                turner_vec3_of((double)n[0], (double)n[1], (double)n[2]));
            CHECK(subject, fabs(length - 1) <= 1e-3, "the normal of vertex %u is no unit vector",
                  i);
        }
        if (mesh->uvs)
            CHECK(subject, isfinite(mesh->uvs[i][0]) && isfinite(mesh->uvs[i][1]),
                  "the texture coordinates of vertex %u are not finite", i);
    }
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            CHECK(subject, mesh->triangles[i][c] < mesh->vertex_count,
                  "triangle %u uses vertex %u, but there are %u", i, mesh->triangles[i][c],
                  mesh->vertex_count);
    }
    return TURNER_OK;
}

static enum turner_result check_group(const struct turner_scene *scene,
                                      const struct turner_group *group)
{
    for (size_t i = 0; i < group->sphere_count; i++) {
        const struct turner_sphere *s = &group->spheres[i];
        const struct subject subject = {"sphere", i, NULL, group};
        CHECK(&subject, usable3(s->center), "its centre is not finite");
        CHECK(&subject, usable(s->radius) && s->radius > 0, "radius %g must be above 0",
              s->radius);
        CHECK(&subject, s->material < scene->material_count, "its material is not there");
    }
    for (size_t i = 0; i < group->cone_count; i++) {
        const struct turner_cone *c = &group->cones[i];
        const struct subject subject = {"cone", i, NULL, group};
        CHECK(&subject, usable3(c->base) && usable3(c->apex), "an end is not finite");
        CHECK(&subject, turner_vec3_length(turner_vec3_sub(c->apex, c->base)) > 0,
              "base and apex are the same point");
        CHECK(&subject, usable(c->base_radius) && c->base_radius >= 0 && usable(c->apex_radius) &&
              c->apex_radius >= 0 && (c->base_radius > 0 || c->apex_radius > 0),
              "radii %g and %g: none may be negative, one must be above 0", c->base_radius,
              c->apex_radius);
        CHECK(&subject, c->material < scene->material_count, "its material is not there");
    }
    for (size_t i = 0; i < group->mesh_count; i++) {
        const struct subject subject = {"mesh", i, NULL, group};
        TURNER_TRY(check_mesh(scene, &group->meshes[i], &subject));
    }
    return TURNER_OK;
}

static enum turner_result check_groups(const struct turner_scene *scene)
{
    size_t primitives = 0;
    CHECK(&scene_subject, scene->group_count >= 1, "it has no group 0");
    for (size_t i = 0; i < scene->group_count; i++) {
        primitives += turner_group_primitive_count(&scene->groups[i]);
        CHECK(&scene_subject, primitives <= TURNER_MAX_PRIMITIVES,
              "%zu primitives or more; %u are the limit", primitives, TURNER_MAX_PRIMITIVES);
        TURNER_TRY(check_group(scene, &scene->groups[i]));
    }
    CHECK(&scene_subject, scene->instance_count <= TURNER_MAX_INSTANCES,
          "%zu instances; %u are the limit", scene->instance_count, TURNER_MAX_INSTANCES);
    for (size_t i = 0; i < scene->instance_count; i++) {
        const struct turner_instance *instance = &scene->instances[i];
        const struct subject subject = {"instance", i, NULL, NULL};
        CHECK(&subject, instance->group > 0 && instance->group < scene->group_count,
              "its group is not there");
        CHECK(&subject, instance->material == TURNER_NONE ||
              instance->material < scene->material_count, "its material is not there");
        CHECK(&subject, turner_affine_usable(&instance->transform),
              "its transform flattens space or is not finite");
    }
    return TURNER_OK;
}

/* ---- lights ---- */

static enum turner_result check_lights(const struct turner_scene *scene)
{
    CHECK(&scene_subject, scene->light_count <= TURNER_MAX_LIGHTS, "%zu lights; %d are the limit",
          scene->light_count, TURNER_MAX_LIGHTS);
    for (size_t i = 0; i < scene->light_count; i++) {
        const struct turner_light *l = &scene->lights[i];
        const struct subject subject = {"light", i, NULL, NULL};
        CHECK(&subject, l->kind == TURNER_LIGHT_DIRECTIONAL || l->kind == TURNER_LIGHT_POINT ||
              l->kind == TURNER_LIGHT_SPOT, "unknown kind");
        CHECK(&subject, turner_color_usable(l->power), "its power is negative or not finite");
        if (l->kind != TURNER_LIGHT_DIRECTIONAL) {
            CHECK(&subject, usable3(l->position), "its position is not finite");
            CHECK(&subject, l->falloff == TURNER_FALLOFF_NONE ||
                  l->falloff == TURNER_FALLOFF_INVERSE_SQUARE, "unknown falloff");
        }
        if (l->kind != TURNER_LIGHT_POINT)
            CHECK(&subject, is_unit(l->direction), "its direction is no unit vector");
        if (l->kind == TURNER_LIGHT_SPOT)
            CHECK(&subject, l->cos_inner <= 1 && l->cos_outer >= -1 &&
                  l->cos_inner >= l->cos_outer, "its inner angle is larger than its outer one");
    }
    return TURNER_OK;
}

enum turner_result turner_scene_validate(const struct turner_scene *scene)
{
    const struct subject ambient = {"ambient", SIZE_MAX, NULL, NULL};
    TURNER_TRY(check_settings(&scene->settings));
    TURNER_TRY(check_camera(scene, &scene->camera, &camera_subject));
    for (size_t i = 0; i < scene->camera_count; i++) {
        struct subject subject = {"camera", i + 1, NULL, NULL};
        TURNER_TRY(check_camera(scene, &scene->cameras[i], &subject));
    }
    CHECK(&ambient, turner_color_usable(scene->ambient), "it is negative or not finite");
    TURNER_TRY(check_background(scene));
    TURNER_TRY(check_media(scene));
    TURNER_TRY(check_materials(scene));
    TURNER_TRY(check_texture_images(scene));
    TURNER_TRY(check_planes(scene));
    TURNER_TRY(check_groups(scene));
    return check_lights(scene);
}
