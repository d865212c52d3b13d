/* Backgrounds, the coordinates of each primitive, checkers and pictures. */
#include <math.h>

#include "analytic/checks.h"

#define DEGREE (PI / 180)

enum { SIZE = 24 };

/* ---- pictures ---- */

static uint32_t add_picture(struct turner_scene *scene, int width, int height)
{
    struct turner_texture_image *image =
        TURNER_PUSH(scene->texture_images, scene->texture_image_count,
                    scene->texture_image_capacity);
    *image = (struct turner_texture_image){.width = width, .height = height};
    image->rgb = turner_calloc((size_t)(3 * width * height), sizeof *image->rgb);
    return (uint32_t)scene->texture_image_count - 1;
}

static int wrap(int i, int n)
{
    return ((i % n) + n) % n;
}

/* Bilinear between texel centres, v upwards; `clamped` for v alone. */
static double lookup(const struct turner_texture_image *image, double u, double v, int channel,
                     bool clamped)
{
    double x = u * image->width - 0.5, y = (1 - v) * image->height - 0.5, sum = 0;
    for (int corner = 0; corner < 4; corner++) {
        int i = (int)floor(x) + corner % 2, j = (int)floor(y) + corner / 2;
        double share = (1 - fabs(x - i)) * (1 - fabs(y - j));
        int row = clamped ? (j < 0 ? 0 : j >= image->height ? image->height - 1 : j)
                          : wrap(j, image->height);
        sum += share * (double)image->rgb[3 * (row * image->width + wrap(i, image->width)) +
                                          channel];
    }
    return sum;
}

/* Texels without any order. */
static void fill(struct turner_texture_image *image)
{
    unsigned state = 12345;
    for (int i = 0; i < 3 * image->width * image->height; i++) {
        state = state * 1103515245u + 12345u;
        image->rgb[i] = (float)(state >> 16 & 1023) / 1023;
    }
}

/* ---- backgrounds ---- */

/* A wide view up, so that all directions but those straight back come up. */
static struct turner_scene *sky_scene(void)
{
    struct turner_scene *scene = analytic_scene(SIZE, SIZE, 0.3, 0);
    analytic_look(scene, V3(0, 0, 0), V3(-0.4, 0.5, 1), V3(0.1, 1, 0));
    return scene;
}

void check_gradient(struct analytic *a)
{
    struct turner_scene *scene = sky_scene();
    struct turner_vec3 up = turner_vec3_normalize(V3(0.2, 0.9, -0.3));
    scene->background = (struct turner_background){.kind = TURNER_BACKGROUND_GRADIENT,
                                                   .color = V3(0.2, 0.9, 0),
                                                   .top = V3(0.8, 0.1, 2),
                                                   .up = up};
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
        double s = (turner_vec3_dot(up, analytic_direction(scene, i % SIZE, i / SIZE)) + 1) / 2;
        analytic_expect(a, (double)image.rgba[4 * i], 0.2 + 0.6 * s, 2, "red, pixel %d", i);
        analytic_expect(a, (double)image.rgba[4 * i + 1], 0.9 - 0.8 * s, 2, "green, pixel %d", i);
        analytic_expect(a, (double)image.rgba[4 * i + 2], 2 * s, 2, "blue, pixel %d", i);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* Equirectangular, −z in the middle at rotation 0; two views make the whole sphere, poles and seam
 * included. */
void check_environment(struct analytic *a)
{
    for (int view = 0; view < 2; view++) {
        struct turner_scene *scene = sky_scene();
        uint32_t picture = add_picture(scene, 8, 4);
        struct turner_vec3 tint = V3(0.5, 1, 2);
        fill(&scene->texture_images[picture]);
        scene->background = (struct turner_background){.kind = TURNER_BACKGROUND_ENVIRONMENT,
                                                       .scale = tint,
                                                       .rotation = view ? -100 * DEGREE
                                                                        : 50 * DEGREE,
                                                       .image = picture};
        if (view)
            analytic_look(scene, V3(0, 0, 0), V3(0.4, -0.5, -1), V3(0.1, 1, 0));
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < 3 * SIZE * SIZE; i++) {
            struct turner_vec3 d = analytic_direction(scene, i / 3 % SIZE, i / 3 / SIZE);
            double u = 0.5 + (atan2(d.x, -d.z) + scene->background.rotation) / (2 * PI);
            double v = 0.5 + asin(d.y) / PI, flat = sqrt(d.x * d.x + d.z * d.z);
            double scale = i % 3 == 0 ? tint.x : i % 3 == 1 ? tint.y : tint.z;
            double want = scale * lookup(&scene->texture_images[picture], u, v, i % 3, true);
            analytic_expect(a, (double)image.rgba[4 * (i / 3) + i % 3], want, 4 + 4 / flat,
                            "view %d, pixel %d", view, i / 3);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- coordinates on primitives ---- */

/* What a surface point shows: (texture at u, texture at v, N·L). */
struct point {
    bool hit;
    double u, v;
    struct turner_vec3 n;
};

static const struct turner_vec3 light_from = {0.36, 0.48, 0.8};

/* A material whose picture goes up and down 16 times with u (red) and with v (green), no part like
 * another, and is white in blue; ambient light shows red and green, a blue sun N·L. */
static uint32_t add_zigzag(struct turner_scene *scene)
{
    uint32_t picture = add_picture(scene, 16, 16);
    struct turner_texture_image *image = &scene->texture_images[picture];
    for (int i = 0; i < 256; i++) {
        image->rgb[3 * i] = (float)(i % 16 % 4 == 0) + 0.5f * (float)(i % 16 % 2) +
                            (float)(i % 16) / 16;
        image->rgb[3 * i + 1] = (float)(i / 16 % 4 == 0) + (float)(i / 16) / 32;
        image->rgb[3 * i + 2] = 1;
    }
    struct turner_material material = analytic_plain();
    material.k_a = material.k_d = GREY(1);
    material.pattern = TURNER_PATTERN_IMAGE;
    material.image = picture;
    scene->ambient = V3(1, 1, 0);
    scene->settings.shading = TURNER_SHADING_PHONG;
    analytic_add_light(scene, (struct turner_light){.kind = TURNER_LIGHT_DIRECTIONAL,
                                                    .direction =
                                                        turner_vec3_scale(light_from, -1),
                                                    .power = V3(0, 0, 1)});
    return analytic_add_material(scene, material);
}

/* Compares a rendering with `trace`, which says in double what a ray meets. Pixels at which u or v
 * step (the seam of a turn) and silhouettes are left to their neighbours. */
static void expect_points(struct analytic *a, struct turner_scene *scene,
                          struct point (*trace)(struct turner_vec3 o, struct turner_vec3 d),
                          int at_least, const char *name)
{
    struct turner_image image;
    int seen = 0;
    const struct turner_texture_image *picture = scene->texture_images;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
        struct turner_vec3 o = scene->camera.from,
                           d = analytic_direction(scene, i % SIZE, i / SIZE);
        struct point p = trace(o, d);
        double facing = -turner_vec3_dot(p.n, d);
        if (!p.hit || facing < 0.05)
            continue;
        const float *rgba = image.rgba + 4 * i;
        double steep = 60 / facing; /* 16 texels that differ by 1, on a slanting surface */
        analytic_expect(a, (double)rgba[0], lookup(picture, p.u, p.v, 0, false), steep,
                        "%s: u = %.5f at pixel (%d, %d)", name, p.u, i % SIZE, i / SIZE);
        analytic_expect(a, (double)rgba[1], lookup(picture, p.u, p.v, 1, false), steep,
                        "%s: v = %.5f at pixel (%d, %d)", name, p.v, i % SIZE, i / SIZE);
        analytic_expect(a, (double)rgba[2], fmax(0, turner_vec3_dot(p.n, light_from)),
                        4 / facing, "%s: N·L at pixel (%d, %d)", name, i % SIZE, i / SIZE);
        seen++;
    }
    analytic_require(a, seen >= at_least, "%s: seen on %d pixels", name, seen);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

static struct turner_vec3 along(struct turner_vec3 o, double t, struct turner_vec3 d)
{
    return turner_vec3_add(o, turner_vec3_scale(d, t));
}

/* The lower root above 0 of a·t² + 2b·t + c = 0, or not-a-number. */
static double first_root(double a, double b, double c)
{
    double root = sqrt(b * b - a * c), t0 = (-b - root) / a, t1 = (-b + root) / a;
    double low = fmin(t0, t1), high = fmax(t0, t1);
    return low > 0 ? low : high > 0 ? high : (double)NAN;
}

static const struct turner_vec3 sphere_center = {0.1, -0.2, 0.3};

static struct point trace_sphere(struct turner_vec3 o, struct turner_vec3 d)
{
    struct turner_vec3 f = turner_vec3_sub(o, sphere_center);
    double t = first_root(1, turner_vec3_dot(f, d), turner_vec3_dot(f, f) - 1);
    struct turner_vec3 n = along(f, t, d);
    return (struct point){!isnan(t), 0.5 + atan2(n.x, n.z) / (2 * PI), 0.5 + asin(n.y) / PI, n};
}

static struct point trace_plane(struct turner_vec3 o, struct turner_vec3 d)
{
    struct turner_vec3 n = turner_vec3_normalize(V3(1, 2, 2)), tangent = V3(0, 0.6, -0.6);
    struct turner_vec3 bitangent, at = V3(0.1, 0.2, -0.3);
    tangent = turner_vec3_normalize(tangent);
    bitangent = turner_vec3_cross(n, tangent);
    double t = turner_vec3_dot(turner_vec3_sub(at, o), n) / turner_vec3_dot(d, n);
    struct turner_vec3 q = turner_vec3_sub(along(o, t, d), at);
    /* the material scales by 0.4 and −0.7 */
    return (struct point){t > 0 && turner_vec3_length(q) < 5, 0.4 * turner_vec3_dot(q, tangent),
                          -0.7 * turner_vec3_dot(q, bitangent), n};
}

/* Base and apex of the cone; its radius runs from .9 to .3. */
static const struct turner_vec3 cone_base = {-0.3, -0.8, 0.1}, cone_apex = {0.5, 0.7, 0.3};
static const double cone_radii[2] = {0.9, 0.3};

static struct point trace_cone(struct turner_vec3 o, struct turner_vec3 d)
{
    struct turner_vec3 w = turner_vec3_sub(cone_apex, cone_base);
    double h = turner_vec3_length(w), k = (cone_radii[1] - cone_radii[0]) / h;
    w = turner_vec3_scale(w, 1 / h);
    /* u starts at w × (the coordinate axis along which w is shortest, here z) */
    struct turner_vec3 e1 = turner_vec3_normalize(turner_vec3_cross(w, V3(0, 0, 1)));
    struct turner_vec3 e2 = turner_vec3_cross(w, e1), q = turner_vec3_sub(o, cone_base);
    double ox = turner_vec3_dot(q, e1), oy = turner_vec3_dot(q, e2), oz = turner_vec3_dot(q, w);
    double dx = turner_vec3_dot(d, e1), dy = turner_vec3_dot(d, e2), dz = turner_vec3_dot(d, w);
    double best = INFINITY;
    struct point point = {0};
    for (int end = 0; end < 2; end++) {
        double t = (end * h - oz) / dz, x = ox + t * dx, y = oy + t * dy;
        if (t > 0 && t < best && hypot(x, y) <= cone_radii[end]) {
            best = t;
            point = (struct point){true, atan2(y, x) / (2 * PI), end,
                                   turner_vec3_scale(w, end ? 1 : -1)};
        }
    }
    double r = cone_radii[0] + k * oz;
    double qa = dx * dx + dy * dy - k * k * dz * dz, qb = ox * dx + oy * dy - k * r * dz,
           qc = ox * ox + oy * oy - r * r;
    for (int sign = -1; sign <= 1; sign += 2) {
        double t = (-qb + sign * sqrt(qb * qb - qa * qc)) / qa;
        double x = ox + t * dx, y = oy + t * dy, z = oz + t * dz, l = hypot(x, y);
        if (t > 0 && t < best && z >= 0 && z <= h) {
            best = t;
            struct turner_vec3 n = turner_vec3_add(
                turner_vec3_scale(turner_vec3_add(turner_vec3_scale(e1, x / l),
                                                  turner_vec3_scale(e2, y / l)), 1),
                turner_vec3_scale(w, -k));
            point = (struct point){true, atan2(y, x) / (2 * PI), z / h, turner_vec3_normalize(n)};
        }
    }
    point.u = point.u < 0 ? point.u + 1 : point.u;
    return point;
}

/* A triangle with normals and texture coordinates at its corners, or without. */
static const struct turner_vec3 corners[3] = {{-1.2, -1, 0.1}, {1.3, -0.8, -0.2}, {0.1, 1.4, 0.3}};
static const float corner_uvs[3][2] = {{0.1f, 0.2f}, {0.9f, -0.3f}, {0.4f, 1.6f}};
static const float corner_normals[3][3] = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0.8f, 0.6f}};

static struct point trace_triangle(struct turner_vec3 o, struct turner_vec3 d)
{
    /* Cramer's rule on o + t·d = p0 + b1·e1 + b2·e2 */
    struct turner_vec3 e1 = turner_vec3_sub(corners[1], corners[0]);
    struct turner_vec3 e2 = turner_vec3_sub(corners[2], corners[0]);
    struct turner_vec3 s = turner_vec3_sub(o, corners[0]), p = turner_vec3_cross(d, e2);
    double det = turner_vec3_dot(p, e1), b1 = turner_vec3_dot(p, s) / det;
    double b2 = turner_vec3_dot(turner_vec3_cross(s, e1), d) / det;
    return (struct point){b1 > 1e-4 && b2 > 1e-4 && b1 + b2 < 1 - 1e-4, b1, b2,
                          turner_vec3_normalize(turner_vec3_cross(e1, e2))};
}

static struct point trace_smooth_triangle(struct turner_vec3 o, struct turner_vec3 d)
{
    struct point p = trace_triangle(o, d);
    double b[3] = {1 - p.u - p.v, p.u, p.v};
    p.u = p.v = 0;
    p.n = V3(0, 0, 0);
    for (int i = 0; i < 3; i++) {
        const float *n = corner_normals[i];
        p.u += b[i] * (double)corner_uvs[i][0];
        p.v += b[i] * (double)corner_uvs[i][1];
        p.n = turner_vec3_add(
            p.n, turner_vec3_scale(V3((double)n[0], (double)n[1], (double)n[2]), b[i]));
    }
    p.n = turner_vec3_normalize(p.n);
    return p;
}

static void add_triangle(struct turner_scene *scene, uint32_t material, bool smooth)
{
    struct turner_group *world = &scene->groups[0];
    struct turner_mesh mesh = {.vertex_count = 3, .triangle_count = 1, .material = material};
    mesh.positions = turner_calloc(3, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(1, sizeof *mesh.triangles);
    if (smooth) {
        mesh.normals = turner_calloc(3, sizeof *mesh.normals);
        mesh.uvs = turner_calloc(3, sizeof *mesh.uvs);
    }
    for (uint32_t i = 0; i < 3; i++) {
        mesh.positions[i] = corners[i];
        mesh.triangles[0][i] = i;
        for (int c = 0; smooth && c < 3; c++)
            mesh.normals[i][c] = corner_normals[i][c];
        for (int c = 0; smooth && c < 2; c++)
            mesh.uvs[i][c] = corner_uvs[i][c];
    }
    *TURNER_PUSH(world->meshes, world->mesh_count, world->mesh_capacity) = mesh;
}

static struct turner_scene *object_scene(struct turner_vec3 from, double spacing)
{
    struct turner_scene *scene = analytic_scene(SIZE, SIZE, spacing, 0);
    analytic_look(scene, from, V3(0, 0, 0), V3(0, 1, 0));
    return scene;
}

void check_coordinates(struct analytic *a)
{
    for (int view = 0; view < 3; view++) { /* from three sides: caps, poles, seams */
        struct turner_vec3 from = view == 0   ? V3(1, 0.7, 4)
                                  : view == 1 ? V3(2, 3, -2)
                                              : V3(-2, -3.5, -1);
        struct turner_scene *scene = object_scene(from, 0.02);
        analytic_add_sphere(scene, sphere_center, 1, add_zigzag(scene));
        expect_points(a, scene, trace_sphere, 300, "sphere");

        scene = object_scene(from, 0.02);
        analytic_add_cone(scene, (struct turner_cone){cone_base, cone_apex, cone_radii[0],
                                                      cone_radii[1], true, add_zigzag(scene)});
        expect_points(a, scene, trace_cone, 150, "cone");
    }
    struct turner_scene *scene = object_scene(V3(1, 3, 3), 0.03);
    uint32_t material = add_zigzag(scene);
    scene->materials[material].uv_scale[0] = 0.4;
    scene->materials[material].uv_scale[1] = -0.7;
    analytic_add_plane(scene, V3(0.1, 0.2, -0.3), V3(1, 2, 2), V3(0, 0.6, -0.6), material);
    expect_points(a, scene, trace_plane, 400, "plane");

    for (int smooth = 0; smooth < 2; smooth++) {
        scene = object_scene(V3(0.3, 0.4, 4), 0.03);
        material = add_zigzag(scene);
        add_triangle(scene, material, smooth);
        expect_points(a, scene, smooth ? trace_smooth_triangle : trace_triangle, 100,
                      smooth ? "triangle with normals" : "triangle");
    }
}

/* ---- the checker ---- */

/* Colour 0 where ⌊u·su⌋ + ⌊v·sv⌋ is even, also on the negative side; it colours k_d and k_a, not
 * k_s and k_e. */
void check_checker(struct analytic *a)
{
    const double su = 3, sv = 1.7;
    struct turner_scene *scene = analytic_scene(SIZE, SIZE, 0.09, 0);
    struct turner_material material = analytic_plain();
    material.k_a = V3(0.5, 0.25, 0);
    material.k_d = V3(0, 0.5, 0);
    material.k_e = V3(0, 0, 0.125);
    material.pattern = TURNER_PATTERN_CHECKER;
    material.checker[0] = V3(0.2, 0.4, 1);
    material.checker[1] = V3(1, 0.6, 0);
    material.uv_scale[0] = su;
    material.uv_scale[1] = sv;
    scene->ambient = GREY(1);
    scene->settings.shading = TURNER_SHADING_PHONG;
    analytic_add_plane(scene, V3(0, 0, -1), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_material(scene, material));
    analytic_add_light(scene, (struct turner_light){.kind = TURNER_LIGHT_DIRECTIONAL,
                                                    .direction = V3(0, 0, -1),
                                                    .power = GREY(1)});
    struct turner_image image;
    int fields[2] = {0};
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
        struct turner_vec3 d = analytic_direction(scene, i % SIZE, i / SIZE);
        double u = -d.x / d.z * su, v = -d.y / d.z * sv;
        if (fabs(u - round(u)) < 1e-4 || fabs(v - round(v)) < 1e-4)
            continue;
        int field = (int)(floor(u) + floor(v)) % 2 != 0;
        struct turner_vec3 color = material.checker[field];
        const float *p = image.rgba + 4 * i;
        analytic_expect(a, (double)p[0], 0.5 * color.x, 1, "red, pixel %d", i);
        analytic_expect(a, (double)p[1], 0.75 * color.y, 1, "green, pixel %d", i);
        analytic_expect(a, (double)p[2], 0.125, 1, "blue, pixel %d", i);
        fields[field]++;
    }
    analytic_require(a, fields[0] > 100 && fields[1] > 100, "%d and %d pixels of the fields",
                     fields[0], fields[1]);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* ---- samples ---- */

/* More samples of a pixel are Hammersley's points: (i + ½)/n and i mirrored at the binary point,
 * plus half of its last step. A wide pixel before a gradient shows their mean. */
void check_samples(struct analytic *a)
{
    static const double four[4][2] = {{.125, .125}, {.375, .625}, {.625, .375}, {.875, .875}};
    static const double three[3][2] = {{1 / 6., .125}, {.5, .625}, {5 / 6., .375}};
    static const double one[1][2] = {{.5, .5}};
    static const struct {
        int count;
        const double (*points)[2];
    } patterns[] = {{1, one}, {3, three}, {4, four}};
    for (size_t k = 0; k < sizeof patterns / sizeof *patterns; k++) {
        struct turner_scene *scene = analytic_scene(2, 2, 1, 0);
        struct turner_vec3 up = turner_vec3_normalize(V3(1, 0.6, 0.3));
        scene->settings.spp = patterns[k].count;
        analytic_compass(scene, up);
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < 4; i++) {
            double sum = 0;
            for (int s = 0; s < patterns[k].count; s++) {
                struct turner_vec3 d = turner_vec3_normalize(
                    V3(i % 2 + patterns[k].points[s][0] - 1, 1 - i / 2 - patterns[k].points[s][1],
                       -1));
                sum += (turner_vec3_dot(d, up) + 1) / 2 / patterns[k].count;
            }
            analytic_expect(a, (double)image.rgba[4 * i], sum, 1, "%d samples, pixel %d",
                            patterns[k].count, i);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}
