/* Absorption, nested media, a camera under water. */
#include <math.h>

#include "analytic/checks.h"

enum { COUNT = 15 };

static double cosine_of(const struct turner_scene *scene, int x)
{
    return -analytic_direction(scene, x, 0).z;
}

static double channel(struct turner_vec3 v, int c)
{
    return c == 0 ? v.x : c == 1 ? v.y : v.z;
}

static void put_inside(struct turner_scene *scene, uint32_t medium)
{
    scene->camera.inside[scene->camera.inside_count++] = medium;
}

/* ---- absorption ---- */

/* exp(−σ d) from a glowing wall to an eye in the medium; without the wall nothing arrives where
 * σ > 0, and everything where it is 0. */
void check_absorption(struct analytic *a)
{
    struct turner_vec3 sigma = V3(0.1, 0.5, 2);
    struct turner_scene *scene = analytic_scene(COUNT, 1, 0.1, 0);
    put_inside(scene, analytic_add_medium(scene, 1.2, sigma, 0));
    analytic_add_plane(scene, V3(0, 0, -2), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_lamp(scene, GREY(1)));
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < 3 * COUNT; i++) {
        analytic_expect(a, (double)analytic_pixel(&image, i / 3, 0)[i % 3],
                        exp(-channel(sigma, i % 3) * 2 / cosine_of(scene, i / 3)), 1,
                        "wall, pixel %d, channel %d", i / 3, i % 3);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);

    scene = analytic_scene(1, 1, 0.1, 0);
    put_inside(scene, analytic_add_medium(scene, 1.2, V3(0, 1e-3, 0), 0));
    scene->background.color = GREY(1);
    if (analytic_render(a, &image, scene)) {
        analytic_expect(a, (double)image.rgba[0], 1, 1, "background, clear");
        analytic_expect(a, (double)image.rgba[1], 0, 1, "background, absorbed");
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* Through a slab: k_t² and the way in the slab, which refraction shortens. */
void check_absorbing_slab(struct analytic *a)
{
    struct turner_vec3 sigma = V3(0, 0.3, 1);
    struct turner_scene *scene = analytic_scene(COUNT, 1, 0.1, 2);
    struct turner_material glass = analytic_clear(analytic_add_medium(scene, 1.5, sigma, 0));
    glass.k_t = V3(0.8, 0.9, 1);
    uint32_t material = analytic_add_material(scene, glass);
    analytic_add_box(scene, V3(-50, -40, -4), V3(60, 70, -3), material);
    scene->background.color = GREY(1);
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < 3 * COUNT; i++) {
        double way = 1 / cos(analytic_snell(1, 1.5, acos(cosine_of(scene, i / 3))));
        double k_t = channel(glass.k_t, i % 3);
        analytic_expect(a, (double)analytic_pixel(&image, i / 3, 0)[i % 3],
                        k_t * k_t * exp(-channel(sigma, i % 3) * way), 1,
                        "slab, pixel %d, channel %d", i / 3, i % 3);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* The same with all inner bounces, F at each and a on each way through: T = (1 − F)²a/(1 − F²a²)
 * passes, R = F + F a T returns. A ray that is mirrored outside is not absorbed on its way, one that
 * is mirrored inside is. */
void check_absorbing_bounces(struct analytic *a)
{
    struct turner_vec3 sigma = V3(0.1, 0.3, 1);
    for (int side = 0; side < 2; side++) {
        struct turner_scene *scene = analytic_scene(COUNT, 1, 0.1, 40);
        struct turner_material glass = analytic_clear(analytic_add_medium(scene, 2.4, sigma, 0));
        glass.k_r = GREY(1);
        glass.fresnel = TURNER_FRESNEL_EXACT;
        uint32_t material = analytic_add_material(scene, glass);
        analytic_add_box(scene, V3(-50, -40, -4), V3(60, 70, -3), material);
        if (side == 0) /* a black wall behind the slab leaves what returns; else what passes */
            analytic_add_plane(scene, V3(0, 0, -5), V3(0, 0, 1), V3(1, 0, 0),
                               analytic_add_lamp(scene, GREY(0)));
        else
            analytic_add_plane(scene, V3(0, 0, 5), V3(0, 0, -1), V3(1, 0, 0),
                               analytic_add_lamp(scene, GREY(0)));
        scene->background.color = GREY(1);
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < 3 * COUNT; i++) {
            double angle = acos(cosine_of(scene, i / 3)), f = analytic_fresnel(1, 2.4, angle);
            double way = 1 / cos(analytic_snell(1, 2.4, angle));
            double once = exp(-channel(sigma, i % 3) * way);
            double passes = (1 - f) * (1 - f) * once / (1 - f * f * once * once);
            analytic_expect(a, (double)analytic_pixel(&image, i / 3, 0)[i % 3],
                            side == 0 ? f + f * once * passes : passes, 1,
                            "%s, pixel %d, channel %d", side == 0 ? "returns" : "passes", i / 3,
                            i % 3);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- the camera under water ---- */

/* From below the surface shows (F, 1 − F, 1), total beyond 48.6°; the same when the camera does not
 * say that it is in the water, since leaving a medium counts as having been in it. */
void check_under_water(struct analytic *a)
{
    for (int said = 0; said < 2; said++) {
        struct turner_scene *scene = analytic_scene(41, 1, 0.1, 1);
        uint32_t water = analytic_add_medium(scene, 1.333, GREY(0), 0);
        if (said)
            put_inside(scene, water);
        uint32_t surface =
            analytic_add_material(scene, analytic_split(water, TURNER_FRESNEL_EXACT));
        analytic_add_plane(scene, V3(0, 0, -1), V3(0, 0, -1), V3(1, 0, 0), surface);
        scene->background.color = GREY(1);
        struct turner_image image;
        int total = 0;
        analytic_render(a, &image, scene);
        for (int x = 0; image.rgba && x < 41; x++) {
            const float *p = analytic_pixel(&image, x, 0);
            double i = acos(cosine_of(scene, x)), f = analytic_fresnel(1.333, 1, i), h = 1e-6;
            double steep = fabs(analytic_fresnel(1.333, 1, i + h) - f) / h;
            analytic_expect(a, (double)p[0], f, 1 + steep, "F at pixel %d", x);
            analytic_expect(a, (double)p[1], 1 - f, 1 + steep, "1 − F at pixel %d", x);
            analytic_expect(a, (double)p[2], 1, 1, "furnace at pixel %d", x);
            total += p[0] == 1 && p[1] == 0;
        }
        analytic_require(a, total > 10, "%d pixels outside of Snell's window", total);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- overlapping media ---- */

/* Layers that a ray crosses straight on: what passes is the product of 1 − F and of absorption. */
struct layer {
    double index, thickness;
    struct turner_vec3 absorption;
};

/* What an eye in air sees of white through the layers, pixel after pixel. */
static void expect_layers(struct analytic *a, struct turner_scene *scene,
                          const struct layer *layers, int count, const char *name)
{
    scene->background.color = GREY(1);
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int i = 0; image.rgba && i < 3 * COUNT; i++) {
        double angle = acos(cosine_of(scene, i / 3)), index = 1, passes = 1;
        for (int l = 0; l < count; l++) {
            passes *= 1 - analytic_fresnel(index, layers[l].index, angle);
            angle = analytic_snell(index, layers[l].index, angle);
            index = layers[l].index;
            passes *= exp(-channel(layers[l].absorption, i % 3) * layers[l].thickness /
                          cos(angle));
        }
        passes *= 1 - analytic_fresnel(index, 1, angle);
        analytic_expect(a, (double)analytic_pixel(&image, i / 3, 0)[i % 3], passes, 2,
                        "%s, pixel %d, channel %d", name, i / 3, i % 3);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* A box with faces at those depths, of a material that only refracts. */
static void add_layer(struct turner_scene *scene, double near, double far, uint32_t medium)
{
    struct turner_material material = analytic_clear(medium);
    material.fresnel = TURNER_FRESNEL_EXACT;
    analytic_add_box(scene, V3(-50 - far, -40, -far), V3(60 + far, 70, -near),
                     analytic_add_material(scene, material));
}

/* Glass from 3 to 5 and water from 4 to 6: who ranks higher has the part they share. Of equals the
 * later one ranks higher. Depth 3 suffices: the surface that is none does not count. */
void check_priority(struct analytic *a)
{
    struct turner_vec3 red = V3(1, 0, 0), green = V3(0, 1, 0);
    for (int priority = 0; priority < 2; priority++) {
        struct turner_scene *scene = analytic_scene(COUNT, 1, 0.05, 3);
        uint32_t water = analytic_add_medium(scene, 1.333, green, 0);
        uint32_t glass = analytic_add_medium(scene, 1.5, red, priority);
        add_layer(scene, 3, 5, glass);
        add_layer(scene, 4, 6, water);
        expect_layers(a, scene, (struct layer[]){{1.5, 2, red}, {1.333, 1, green}}, 2,
                      "glass above water");
    }
    struct turner_scene *scene = analytic_scene(COUNT, 1, 0.05, 3);
    uint32_t glass = analytic_add_medium(scene, 1.5, red, -3);
    uint32_t water = analytic_add_medium(scene, 1.333, green, 2);
    add_layer(scene, 3, 5, glass);
    add_layer(scene, 4, 6, water);
    expect_layers(a, scene, (struct layer[]){{1.5, 1, red}, {1.333, 2, green}}, 2,
                  "water above glass");
}

/* Bodies of one medium that overlap are one body, whatever their order along the ray. */
void check_union(struct analytic *a)
{
    struct turner_vec3 sigma = V3(0.1, 0.3, 0.5);
    struct turner_scene *scene = analytic_scene(COUNT, 1, 0.05, 2);
    uint32_t glass = analytic_add_medium(scene, 1.5, sigma, 0);
    add_layer(scene, 3, 5, glass);
    add_layer(scene, 4, 6, glass);
    add_layer(scene, 4.2, 4.8, glass);
    expect_layers(a, scene, (struct layer[]){{1.5, 3, sigma}}, 1, "union");
}

/* Nine media one in the other: the ninth drops the lowest, so the way out of the second leads to
 * air; the far side of the first is then met as if its medium had been there. Straight on, F does
 * not depend on the way before. */
void check_nine_media(struct analytic *a)
{
    static const double n[9] = {1.9, 1.1, 1.3, 1.5, 1.7, 1.6, 1.4, 1.2, 1.35};
    struct turner_scene *scene = analytic_scene(1, 1, 0.02, 18);
    double passes = 1;
    for (int i = 0; i < 9; i++) {
        add_layer(scene, 3 + 0.1 * i, 5 - 0.1 * i,
                  analytic_add_medium(scene, n[i], GREY(0), 0));
        passes *= 1 - analytic_fresnel(i > 0 ? n[i - 1] : 1, n[i], 0); /* in */
        passes *= 1 - analytic_fresnel(n[i], i > 1 ? n[i - 1] : 1, 0); /* out */
    }
    scene->background.color = GREY(1);
    struct turner_image image;
    if (analytic_render(a, &image, scene))
        analytic_expect(a, (double)image.rgba[0], passes, 4, "nine media");
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}
