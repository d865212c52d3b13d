/* Scenes for the checks, and the formulas they share. */
#include <math.h>

#include "analytic/analytic.h"

struct turner_scene *analytic_scene(int width, int height, double spacing, int depth)
{
    struct turner_scene *scene = turner_scene_create();
    scene->settings.width = width;
    scene->settings.height = height;
    scene->settings.depth = depth;
    scene->settings.cutoff = 0;
    scene->camera.vfov = 2 * atan(height * spacing / 2);
    analytic_look(scene, V3(0, 0, 0), V3(0, 0, -1), V3(0, 1, 0));
    return scene;
}

void analytic_look(struct turner_scene *scene, struct turner_vec3 from, struct turner_vec3 at,
                   struct turner_vec3 up)
{
    scene->camera.from = from;
    scene->camera.at = at;
    scene->camera.up = up;
}

struct turner_vec3 analytic_direction(const struct turner_scene *scene, int x, int y)
{
    const struct turner_camera *camera = &scene->camera;
    double width = scene->settings.width, height = scene->settings.height;
    double s = 2 * tan(camera->vfov / 2) / height;
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_sub(camera->from, camera->at));
    struct turner_vec3 u = turner_vec3_normalize(turner_vec3_cross(camera->up, w));
    struct turner_vec3 v = turner_vec3_cross(w, u);
    return turner_vec3_normalize(
        turner_vec3_sub(turner_vec3_add(turner_vec3_scale(u, (x + 0.5 - width / 2) * s),
                                        turner_vec3_scale(v, (height / 2 - y - 0.5) * s)),
                        w));
}

const float *analytic_pixel(const struct turner_image *image, int x, int y)
{
    return image->rgba + 4 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* ---- materials and media ---- */

struct turner_material analytic_plain(void)
{
    return (struct turner_material){.exponent = 1,
                                    .fresnel = TURNER_FRESNEL_NONE,
                                    .medium = TURNER_NONE,
                                    .uv_scale = {1, 1}};
}

struct turner_material analytic_clear(uint32_t medium)
{
    struct turner_material clear = analytic_plain();
    clear.k_t = GREY(1);
    clear.medium = medium;
    return clear;
}

struct turner_material analytic_split(uint32_t medium, enum turner_fresnel fresnel)
{
    struct turner_material split = analytic_plain();
    split.k_r = V3(1, 0, 1);
    split.k_t = V3(0, 1, 1);
    split.medium = medium;
    split.fresnel = fresnel;
    return split;
}

uint32_t analytic_add_material(struct turner_scene *scene, struct turner_material material)
{
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = material;
    return (uint32_t)scene->material_count - 1;
}

uint32_t analytic_add_lamp(struct turner_scene *scene, struct turner_vec3 k_e)
{
    struct turner_material lamp = analytic_plain();
    lamp.k_e = k_e;
    return analytic_add_material(scene, lamp);
}

uint32_t analytic_add_medium(struct turner_scene *scene, double index,
                             struct turner_vec3 absorption, int priority)
{
    *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
        (struct turner_medium){.index = index, .absorption = absorption, .priority = priority};
    return (uint32_t)scene->media_count - 1;
}

/* ---- primitives ---- */

void analytic_add_sphere(struct turner_scene *scene, struct turner_vec3 center, double radius,
                         uint32_t material)
{
    struct turner_group *world = &scene->groups[0];
    *TURNER_PUSH(world->spheres, world->sphere_count, world->sphere_capacity) =
        (struct turner_sphere){center, radius, material};
}

void analytic_add_plane(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, struct turner_vec3 tangent, uint32_t material)
{
    *TURNER_PUSH(scene->planes, scene->plane_count, scene->plane_capacity) =
        (struct turner_plane){point, turner_vec3_normalize(normal),
                              turner_vec3_normalize(tangent), material};
}

void analytic_add_box(struct turner_scene *scene, struct turner_vec3 low, struct turner_vec3 high,
                      uint32_t material)
{
    turner_group_add_box(&scene->groups[0], low, high, material);
}

void analytic_add_cone(struct turner_scene *scene, struct turner_cone cone)
{
    struct turner_group *world = &scene->groups[0];
    *TURNER_PUSH(world->cones, world->cone_count, world->cone_capacity) = cone;
}

/* A fan around the first corner. */
static void add_polygon(struct turner_scene *scene, const struct turner_vec3 *corners,
                        uint32_t count, uint32_t material)
{
    struct turner_group *world = &scene->groups[0];
    struct turner_mesh mesh = {
        .vertex_count = count, .triangle_count = count - 2, .material = material};
    mesh.positions = turner_calloc(count, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(count - 2, sizeof *mesh.triangles);
    for (uint32_t i = 0; i < count; i++)
        mesh.positions[i] = corners[i];
    for (uint32_t i = 0; i < count - 2; i++) {
        mesh.triangles[i][1] = i + 1;
        mesh.triangles[i][2] = i + 2;
    }
    *TURNER_PUSH(world->meshes, world->mesh_count, world->mesh_capacity) = mesh;
}

void analytic_add_quad(struct turner_scene *scene, const struct turner_vec3 corners[4],
                       uint32_t material)
{
    add_polygon(scene, corners, 4, material);
}

void analytic_add_facet(struct turner_scene *scene, int x, double angle, bool behind,
                        uint32_t material)
{
    double spacing = 2 * tan(scene->camera.vfov / 2) / scene->settings.height;
    struct turner_vec3 d = analytic_direction(scene, x, 0);
    struct turner_vec3 up = turner_vec3_normalize(scene->camera.up);
    struct turner_vec3 h = turner_vec3_normalize(turner_vec3_cross(d, up));
    struct turner_vec3 w = turner_vec3_cross(h, d);
    struct turner_vec3 n = turner_vec3_sub(turner_vec3_scale(w, sin(angle)),
                                           turner_vec3_scale(d, cos(angle)));
    if (behind)
        n = turner_vec3_scale(n, -1);
    struct turner_vec3 e = turner_vec3_cross(n, h);
    /* long where the tilt is measured, narrow enough for its pixel's vertical plane */
    struct turner_vec3 center = turner_vec3_add(scene->camera.from, turner_vec3_scale(d, 4));
    struct turner_vec3 across = turner_vec3_scale(h, 0.8 * spacing), along = e;
    struct turner_vec3 low = turner_vec3_sub(center, along);
    add_polygon(scene,
                (struct turner_vec3[]){turner_vec3_sub(low, across), turner_vec3_add(low, across),
                                       turner_vec3_add(center, turner_vec3_scale(along, 2))},
                3, material);
}

void analytic_add_tile(struct turner_scene *scene, int x, struct turner_vec3 normal,
                       uint32_t material)
{
    double spacing = 2 * tan(scene->camera.vfov / 2) / scene->settings.height;
    struct turner_vec3 center = turner_vec3_add(
        scene->camera.from, turner_vec3_scale(analytic_direction(scene, x, 0), 4));
    struct turner_vec3 e1 = turner_vec3_scale(turner_vec3_perpendicular(normal), 1.5 * spacing);
    struct turner_vec3 e2 = turner_vec3_cross(normal, e1);
    struct turner_vec3 corners[3];
    for (int i = 0; i < 3; i++) {
        corners[i] = turner_vec3_add(
            center, turner_vec3_add(turner_vec3_scale(e1, cos(i * 2 * PI / 3)),
                                    turner_vec3_scale(e2, sin(i * 2 * PI / 3))));
    }
    add_polygon(scene, corners, 3, material);
}

void analytic_add_light(struct turner_scene *scene, struct turner_light light)
{
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = light;
}

/* ---- measuring ---- */

void analytic_add_ruler(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, struct turner_vec3 tangent, double reach)
{
    /* Two by two texels, repeated: red falls from column 0 to column 1, green rises from row 0 to
     * row 1. Between the centres of the last column of one copy and the first of the next, which
     * lie at u = ∓1/4, bilinear interpolation is the ramp. */
    static const float ramp[2][2][3] = {{{1, 0, 0}, {0, 0, 0}}, {{1, 1, 0}, {0, 1, 0}}};
    struct turner_texture_image *image =
        TURNER_PUSH(scene->texture_images, scene->texture_image_count,
                    scene->texture_image_capacity);
    *image = (struct turner_texture_image){.width = 2, .height = 2};
    image->rgb = turner_calloc(12, sizeof *image->rgb);
    for (int i = 0; i < 12; i++)
        image->rgb[i] = ramp[i / 6][i / 3 % 2][i % 3];
    struct turner_material material = analytic_plain();
    material.k_a = GREY(1);
    material.pattern = TURNER_PATTERN_IMAGE;
    material.image = (uint32_t)scene->texture_image_count - 1;
    material.uv_scale[0] = material.uv_scale[1] = 0.25 / reach;
    analytic_add_plane(scene, point, normal, tangent, analytic_add_material(scene, material));
    scene->ambient = GREY(1);
}

double analytic_ruler(const float *pixel, int channel, double reach)
{
    return ((double)pixel[channel] - 0.5) * 2 * reach;
}

void analytic_compass(struct turner_scene *scene, struct turner_vec3 up)
{
    scene->background = (struct turner_background){
        .kind = TURNER_BACKGROUND_GRADIENT, .top = GREY(1), .up = turner_vec3_normalize(up)};
}

/* ---- formulas ---- */

double analytic_snell(double n1, double n2, double i)
{
    return asin(n1 / n2 * sin(i)); /* asin of more than 1 is not a number */
}

double analytic_fresnel(double n1, double n2, double i)
{
    double t = analytic_snell(n1, n2, i);
    if (n1 == n2)
        return 0;
    if (isnan(t))
        return 1;
    if (i < 1e-4) /* the laws below are 0/0 at 0 */
        return pow((n1 - n2) / (n1 + n2), 2);
    double s = sin(i - t) / sin(i + t), p = tan(i - t) / tan(i + t);
    return (s * s + p * p) / 2;
}
