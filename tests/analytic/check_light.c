/* Lights: how they weaken with distance and angle, spots, flux, shadows. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "analytic/checks.h"
#include "scene/readers.h"

#define DEGREE (PI / 180)

enum { SIZE = 24 };

/* The eye two metres above a floor (z = 0) of k_d = 1: a pixel of energy-conserving shading is
 * E cos θ/π. */
static struct turner_scene *floor_scene(double spacing)
{
    struct turner_scene *scene = analytic_scene(SIZE, SIZE, spacing, 0);
    struct turner_material chalk = analytic_plain();
    chalk.k_d = GREY(1);
    analytic_look(scene, V3(0.2, 0.1, 2), V3(0, 0, 0), V3(0, 1, 0));
    analytic_add_plane(scene, V3(0, 0, 0), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_material(scene, chalk));
    return scene;
}

/* Where a pixel's ray meets the floor. */
static struct turner_vec3 floor_point(const struct turner_scene *scene, int pixel)
{
    struct turner_vec3 d = analytic_direction(scene, pixel % SIZE, pixel / SIZE);
    struct turner_vec3 from = scene->camera.from;
    return turner_vec3_add(from, turner_vec3_scale(d, -from.z / d.z));
}

static struct turner_light point_light(struct turner_vec3 position, double intensity)
{
    return (struct turner_light){
        .kind = TURNER_LIGHT_POINT, .position = position, .power = GREY(intensity)};
}

static struct turner_light sun(struct turner_vec3 direction, struct turner_vec3 irradiance)
{
    return (struct turner_light){.kind = TURNER_LIGHT_DIRECTIONAL,
                                 .direction = turner_vec3_normalize(direction),
                                 .power = irradiance};
}

/* ---- attenuation ---- */

/* J/d² · cos θ, J · cos θ without falloff; in the notes' shading without 1/π. */
void check_point_light(struct analytic *a)
{
    struct turner_vec3 position = V3(0.7, -0.4, 0.9);
    for (int variant = 0; variant < 4; variant++) {
        struct turner_scene *scene = floor_scene(0.08);
        bool bare = variant & 1, phong = variant & 2;
        struct turner_light light = point_light(position, 1);
        light.falloff = bare ? TURNER_FALLOFF_NONE : TURNER_FALLOFF_INVERSE_SQUARE;
        analytic_add_light(scene, light);
        analytic_add_light(scene, point_light(V3(0, 0, -1), 5)); /* behind: nothing */
        scene->settings.shading = phong ? TURNER_SHADING_PHONG : TURNER_SHADING_ENERGY_CONSERVING;
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
            struct turner_vec3 way = turner_vec3_sub(position, floor_point(scene, i));
            double d = turner_vec3_length(way);
            double want = way.z / d / (bare ? 1 : d * d) / (phong ? 1 : PI);
            analytic_expect(a, (double)image.rgba[4 * i], want, 2, "variant %d, pixel %d", variant,
                            i);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* The sun at 0, 45 and 90°, one in each channel; and one from below. */
void check_sun(struct analytic *a)
{
    struct turner_scene *scene = floor_scene(0.08);
    analytic_add_light(scene, sun(V3(0, 0, -1), V3(PI, 0, 0)));
    analytic_add_light(scene, sun(V3(1, 0, -1), V3(0, PI, 0)));
    analytic_add_light(scene, sun(V3(0, 1, 0), V3(0, 0, PI)));
    analytic_add_light(scene, sun(V3(0, 1, 1), V3(PI, PI, PI)));
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
        analytic_expect(a, (double)image.rgba[4 * i], 1, 1, "0°, pixel %d", i);
        analytic_expect(a, (double)image.rgba[4 * i + 1], sqrt(0.5), 1, "45°, pixel %d", i);
        analytic_expect(a, (double)image.rgba[4 * i + 2], 0, 1, "90°, pixel %d", i);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* ---- spots and flux ---- */

/* A spot one metre above the floor looking straight down: J/d² · cos θ · s²(3 − 2s); and the sum
 * over the floor is its flux, J · 2π(1 − (cos inner + cos outer)/2). */
void check_spot(struct analytic *a)
{
    static const double cones[][2] = {{20, 40}, {0, 45}, {30, 30}};
    for (size_t k = 0; k < sizeof cones / sizeof *cones; k++) {
        struct turner_scene *scene = floor_scene(0.05);
        struct turner_light light = point_light(V3(0, 0, 1), 1);
        analytic_look(scene, V3(0, 0, 2), V3(0, 0, 0), V3(0, 1, 0));
        light.kind = TURNER_LIGHT_SPOT;
        light.direction = V3(0, 0, -1);
        light.cos_inner = cos(cones[k][0] * DEGREE);
        light.cos_outer = cos(cones[k][1] * DEGREE);
        analytic_add_light(scene, light);
        struct turner_image image;
        double flux = 0, pixel_area = 4 * 0.05 * 0.05;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
            struct turner_vec3 p = floor_point(scene, i);
            double d = sqrt(p.x * p.x + p.y * p.y + 1), cosine = 1 / d;
            double s = light.cos_inner > light.cos_outer
                           ? (cosine - light.cos_outer) / (light.cos_inner - light.cos_outer)
                           : cosine >= light.cos_outer;
            if (light.cos_inner == light.cos_outer && fabs(cosine - light.cos_outer) < 1e-4)
                continue; /* on the step */
            s = fmin(fmax(s, 0), 1);
            double want = s * s * (3 - 2 * s) * cosine / (d * d) / PI;
            analytic_expect(a, (double)image.rgba[4 * i], want, 2 / (1.1 - light.cos_inner),
                            "cone %g–%g°, pixel %d", cones[k][0], cones[k][1], i);
            flux += PI * (double)image.rgba[4 * i] * pixel_area;
        }
        double expected = 2 * PI * (1 - (light.cos_inner + light.cos_outer) / 2);
        if (cones[k][0] < cones[k][1]) /* the midpoint rule needs a soft edge */
            analytic_require(a, fabs(flux / expected - 1) < 0.004,
                             "cone %g–%g°: flux %.5f, expected %.5f", cones[k][0], cones[k][1],
                             flux, expected);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* A light of flux Φ: J = Φ/4π for a point, Φ/(2π(1 − (cos inner + cos outer)/2)) for a spot. */
void check_flux(struct analytic *a)
{
    static const char *const lights[] = {
        "{\"type\": \"point\", \"position\": [0, 0, 2], \"flux\": 100}",
        "{\"type\": \"spot\", \"position\": [0, 0, 2], \"at\": [0, 0, 0], \"inner\": 20,"
        " \"outer\": 60, \"flux\": 100}"};
    double solid_angles[] = {4 * PI, 2 * PI * (1 - (cos(20 * DEGREE) + 0.5) / 2)};
    for (int k = 0; k < 2; k++) {
        char text[1024];
        struct turner_scene *scene;
        struct turner_image image = {0};
        snprintf(text, sizeof text,
                 "{\"version\": 1, \"settings\": {\"size\": [1, 1]},"
                 " \"camera\": {\"from\": [1, 0, 1], \"at\": [0, 0, 0]},"
                 " \"materials\": {\"chalk\": {\"k_d\": 1}},"
                 " \"primitives\": [{\"type\": \"plane\", \"point\": [0, 0, 0],"
                 " \"normal\": [0, 0, 1], \"material\": \"chalk\"}], \"lights\": [%s]}",
                 lights[k]);
        if (turner_scene_parse(&scene, text, strlen(text), "flux.json") != TURNER_OK) {
            analytic_require(a, false, "%s", turner_message());
            continue;
        }
        if (analytic_render(a, &image, scene)) {
            analytic_expect(a, (double)image.rgba[0], 100 / solid_angles[k] / 4 / PI, 2,
                            "light %d", k);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- shadows ---- */

/* A ball between floor and light: points whose way to the light passes it are black. Another ball,
 * beyond the light, takes nothing away. */
void check_shadow(struct analytic *a)
{
    const double radius = 0.3;
    struct turner_vec3 ball = V3(0.1, -0.2, 0.6), position = V3(0.3, 0.2, 1.4);
    for (int opaque = 0; opaque < 2; opaque++) {
        struct turner_scene *scene = floor_scene(0.08);
        uint32_t black = analytic_add_material(scene, analytic_plain());
        scene->settings.shadows = opaque ? TURNER_SHADOWS_OPAQUE : TURNER_SHADOWS_TINTED;
        analytic_look(scene, V3(0, 0, 0.2), V3(0.1, 0.1, 0), V3(0, 1, 0)); /* below the ball */
        analytic_add_sphere(scene, ball, radius, black);
        analytic_add_sphere(scene, V3(0.35, 0.3, 1.9), 0.4, black);
        analytic_add_light(scene, point_light(position, 1));
        struct turner_image image;
        int dark = 0;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
            struct turner_vec3 p = floor_point(scene, i);
            struct turner_vec3 way = turner_vec3_sub(position, p);
            double d = turner_vec3_length(way);
            double apart = turner_vec3_length(turner_vec3_cross(turner_vec3_sub(ball, p), way)) / d;
            if (fabs(apart - radius) < 1e-4)
                continue;
            analytic_expect(a, (double)image.rgba[4 * i],
                            apart < radius ? 0 : way.z / (d * d * d) / PI, 2, "pixel %d", i);
            dark += apart < radius;
        }
        analytic_require(a, dark > 30 && dark < SIZE * SIZE - 30, "%d dark pixels", dark);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* Through two boxes of one medium that overlap, from 1 to 1.8 above the floor: k_t for each surface
 * and absorption along the straight line. The way ends at the light: a black ceiling above it takes
 * nothing away. With opaque shadows nothing comes through. */
void check_tinted_shadow(struct analytic *a)
{
    static const struct {
        double height; /* of the light; 0: the sun */
        enum turner_shadows shadows;
        int surfaces;
        double thickness; /* of glass on the way, straight up */
    } lights[] = {{0, TURNER_SHADOWS_TINTED, 2, 0.8},
                  {3, TURNER_SHADOWS_TINTED, 2, 0.8},
                  {1.4, TURNER_SHADOWS_TINTED, 1, 0.4},
                  {0.95, TURNER_SHADOWS_TINTED, 0, 0},
                  {0.95, TURNER_SHADOWS_OPAQUE, 0, 0},
                  {3, TURNER_SHADOWS_OPAQUE, -1, 0}};
    struct turner_vec3 sigma = V3(0.2, 0.5, 2), k_t = V3(0.9, 0.5, 0.2);
    for (size_t k = 0; k < sizeof lights / sizeof *lights; k++) {
        struct turner_scene *scene = floor_scene(0.04);
        struct turner_material glass =
            analytic_clear(analytic_add_medium(scene, 1.5, sigma, 0));
        glass.k_t = k_t;
        glass.fresnel = TURNER_FRESNEL_EXACT;
        uint32_t material = analytic_add_material(scene, glass);
        bool is_sun = lights[k].height == 0;
        analytic_look(scene, V3(0, 0, 0.9), V3(0, 0, 0), V3(0, 1, 0));
        analytic_add_box(scene, V3(-20, -21, 1), V3(22, 23, 1.5), material);
        analytic_add_box(scene, V3(-19, -22, 1.2), V3(23, 24, 1.8), material);
        if (is_sun) {
            analytic_add_light(scene, sun(V3(0.3, 0.2, -1), GREY(1)));
        } else {
            analytic_add_light(scene, point_light(V3(0.3, 0.4, lights[k].height), 1));
            analytic_add_plane(scene, V3(0, 0, 3.3), V3(0, 0, -1), V3(1, 0, 0),
                               analytic_add_material(scene, analytic_plain()));
        }
        scene->settings.shadows = lights[k].shadows;
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < SIZE * SIZE; i++) {
            struct turner_vec3 way = turner_vec3_scale(scene->lights[0].direction, -1);
            double d = 1;
            if (!is_sun) {
                way = turner_vec3_sub(scene->lights[0].position, floor_point(scene, i));
                d = turner_vec3_length(way);
            }
            double cosine = is_sun ? way.z : way.z / d, bare = cosine / (d * d) / PI;
            for (int c = 0; c < 3; c++) {
                double each = c == 0 ? k_t.x : c == 1 ? k_t.y : k_t.z;
                double s = c == 0 ? sigma.x : c == 1 ? sigma.y : sigma.z;
                double through =
                    lights[k].surfaces < 0
                        ? 0
                        : pow(each, lights[k].surfaces) * exp(-s * lights[k].thickness / cosine);
                analytic_expect(a, (double)image.rgba[4 * i + c], bare * through, 2,
                                "light %d, pixel %d, channel %d", (int)k, i, c);
            }
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* A shadow ray starts in the medium on the viewer's side: on the bottom of a lake, seen from in the
 * water, the light of a lamp in the water is absorbed all the way and the sun's as far as the
 * surface; on a slab of glass with a coat of paint, seen from outside, none is. */
void check_shadow_medium(struct analytic *a)
{
    struct turner_vec3 sigma = V3(0, 0.5, 2);
    for (int kind = 0; kind < 3; kind++) {
        struct turner_scene *scene = floor_scene(0.04);
        struct turner_material paint = analytic_clear(analytic_add_medium(scene, 1.333, sigma, 0));
        if (kind < 2) {
            scene->camera.inside[scene->camera.inside_count++] = 0;
            analytic_look(scene, V3(0, 0, 0.9), V3(0, 0, 0), V3(0, 1, 0));
            analytic_add_plane(scene, V3(0, 0, 1), V3(0, 0, 1), V3(1, 0, 0),
                               analytic_add_material(scene, paint));
        } else {
            paint.k_d = GREY(1);
            scene->planes[0].material = analytic_add_material(scene, paint);
        }
        if (kind == 0)
            analytic_add_light(scene, point_light(V3(0.1, 0.3, 0.8), 1));
        else
            analytic_add_light(scene, sun(V3(0.3, 0.2, -1), GREY(1)));
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < 3 * SIZE * SIZE; i++) {
            struct turner_vec3 p = floor_point(scene, i / 3), way = V3(-0.3, -0.2, 1);
            double s = i % 3 == 0 ? sigma.x : i % 3 == 1 ? sigma.y : sigma.z;
            if (kind == 0)
                way = turner_vec3_sub(scene->lights[0].position, p);
            double d = turner_vec3_length(way), cosine = way.z / d;
            double bare = cosine / PI / (kind == 0 ? d * d : 1);
            double wet = kind == 0 ? d : kind == 1 ? 1 / cosine : 0; /* of the way */
            double seen = kind < 2 ? turner_vec3_length(turner_vec3_sub(p, scene->camera.from)) : 0;
            analytic_expect(a, (double)image.rgba[4 * (i / 3) + i % 3],
                            bare * exp(-s * (wet + seen)), 2, "kind %d, pixel %d", kind, i / 3);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}
