/* Where energy goes: white furnaces, facing mirrors, total internal reflection, and what the limits
 * of the recursion cut off. */
#include <math.h>

#include "analytic/checks.h"

#define DEGREE (PI / 180)

/* ---- the white furnace ---- */

enum { FURNACE_SIZE = 40 };

enum loss { LOSSLESS_EXACT, LOSSLESS_SCHLICK, LOSSLESS_NONE, LOSSLESS_COUNT };

static const char *const loss_names[] = {"exact", "schlick", "none"};

/* Glass that keeps all energy: k_r F + k_t (1 − F) = 1, or k_r + k_t = 1. */
static struct turner_material lossless(uint32_t medium, enum loss loss)
{
    struct turner_material glass = analytic_clear(medium);
    glass.k_r = GREY(loss == LOSSLESS_NONE ? 0.3 : 1);
    glass.k_t = GREY(loss == LOSSLESS_NONE ? 0.7 : 1);
    glass.fresnel = loss == LOSSLESS_EXACT     ? TURNER_FRESNEL_EXACT
                    : loss == LOSSLESS_SCHLICK ? TURNER_FRESNEL_SCHLICK
                                               : TURNER_FRESNEL_NONE;
    return glass;
}

static struct turner_scene *furnace(int depth)
{
    struct turner_scene *scene = analytic_scene(FURNACE_SIZE, FURNACE_SIZE, 0.02, depth);
    analytic_look(scene, V3(0.3, 0.4, 5), V3(0, 0, 0), V3(0, 1, 0));
    scene->background.color = GREY(1);
    return scene;
}

/* Every pixel is 1 less its pruned weight. At depth 0 that is 0 on at least `covered` pixels, so
 * that it is known that the thing is there, and at the scene's own depth nearly all must be left.
 * Destroys the scene. */
static void expect_furnace(struct analytic *a, struct turner_scene *scene, int covered,
                           double mean_left, const char *name)
{
    double left = 0;
    int dark = 0;
    struct turner_image image;
    if (analytic_render(a, &image, scene)) {
        for (int i = 0; i < FURNACE_SIZE * FURNACE_SIZE; i++) {
            const float *p = image.rgba + 4 * i;
            left += (double)p[0];
            for (int c = 0; c < 3; c++)
                analytic_expect(a, (double)p[c] + (double)p[3], 1, 1, "%s, pixel (%d, %d)", name,
                                i % FURNACE_SIZE, i / FURNACE_SIZE);
        }
    }
    turner_image_destroy(&image);
    left /= FURNACE_SIZE * FURNACE_SIZE;
    analytic_require(a, left > mean_left, "%s: only %.4f is left", name, left);

    scene->settings.depth = 0;
    if (analytic_render(a, &image, scene)) {
        for (int i = 0; i < FURNACE_SIZE * FURNACE_SIZE; i++)
            dark += image.rgba[4 * i] == 0 && image.rgba[4 * i + 3] == 1;
    }
    analytic_require(a, dark >= covered, "%s: seen on %d pixels, expected %d", name, dark, covered);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

void check_furnace_ball(struct analytic *a)
{
    for (enum loss loss = 0; loss < LOSSLESS_COUNT; loss++) {
        struct turner_scene *scene = furnace(8);
        uint32_t medium = analytic_add_medium(scene, 1.5, GREY(0), 0);
        analytic_add_sphere(scene, V3(0, 0, 0), 1.2,
                            analytic_add_material(scene, lossless(medium, loss)));
        if (loss == LOSSLESS_SCHLICK)
            scene->settings.cutoff = 0.01; /* what that cuts is in the pruned weight too */
        expect_furnace(a, scene, 450, 0.99, loss_names[loss]);
    }
}

void check_furnace_bubble(struct analytic *a)
{
    for (enum loss loss = 0; loss < LOSSLESS_COUNT; loss++) {
        struct turner_scene *scene = furnace(8);
        scene->camera.inside[0] = analytic_add_medium(scene, 1.5, GREY(0), 0);
        scene->camera.inside_count = 1;
        uint32_t air = analytic_add_medium(scene, 1, GREY(0), 1);
        analytic_add_sphere(scene, V3(0, 0, 0), 1.2,
                            analytic_add_material(scene, lossless(air, loss)));
        expect_furnace(a, scene, 450, 0.99, loss_names[loss]);
    }
}

void check_furnace_slab(struct analytic *a)
{
    for (enum loss loss = 0; loss < LOSSLESS_COUNT; loss++) {
        struct turner_scene *scene = furnace(10);
        uint32_t medium = analytic_add_medium(scene, 1.5, GREY(0), 0);
        uint32_t material = analytic_add_material(scene, lossless(medium, loss));
        analytic_add_box(scene, V3(-1.3, -1.1, -0.3), V3(1.2, 1, 0.3), material);
        expect_furnace(a, scene, 400, 0.99, loss_names[loss]);
    }
}

/* Convex mirrors need one bounce. */
void check_furnace_mirror(struct analytic *a)
{
    struct turner_scene *scene = furnace(1);
    struct turner_material mirror = analytic_plain();
    mirror.k_r = GREY(1);
    uint32_t material = analytic_add_material(scene, mirror);
    analytic_add_sphere(scene, V3(0, 0, 0), 1.2, material);
    expect_furnace(a, scene, 450, 0.999999, "sphere");

    scene = furnace(1);
    material = analytic_add_material(scene, mirror);
    analytic_add_cone(scene, (struct turner_cone){V3(-0.5, -1, 0.3), V3(0.5, 1, -0.2), 1, 0.4,
                                                  true, material});
    expect_furnace(a, scene, 350, 0.999999, "cone");
}

/* A glass of water: glass ranks higher, the water reaches into it; in the water floats a bubble. */
void check_furnace_nested(struct analytic *a)
{
    for (enum loss loss = 0; loss < LOSSLESS_COUNT; loss++) {
        struct turner_scene *scene = furnace(10);
        uint32_t water = analytic_add_medium(scene, 1.333, GREY(0), 0);
        uint32_t glass = analytic_add_medium(scene, 1.5, GREY(0), 1);
        uint32_t air = analytic_add_medium(scene, 1, GREY(0), 2);
        analytic_add_cone(scene, (struct turner_cone){
            V3(0, -1, 0), V3(0, 1, 0), 1.1, 1.1, true,
            analytic_add_material(scene, lossless(water, loss))});
        analytic_add_box(scene, V3(-1.2, -1.3, -1.3), V3(1.25, -0.8, 1.2),
                         analytic_add_material(scene, lossless(glass, loss)));
        analytic_add_sphere(scene, V3(0.2, 0.3, 0.3), 0.4,
                            analytic_add_material(scene, lossless(air, loss)));
        expect_furnace(a, scene, 600, loss == LOSSLESS_NONE ? 0.9 : 0.97, loss_names[loss]);
    }
}

/* ---- mirrors and the limits of the recursion ---- */

/* Two facing mirrors of reflectance ρ that emit 1 − ρ: radiance 1 when all is followed. */
static struct turner_scene *facing_mirrors(struct turner_vec3 rho, int depth)
{
    struct turner_scene *scene = analytic_scene(1, 1, 0.1, depth);
    struct turner_material mirror = analytic_plain();
    analytic_look(scene, V3(0, 0, 0), V3(0.1, 0.2, -1), V3(0, 1, 0));
    mirror.k_r = rho;
    mirror.k_e = turner_vec3_sub(GREY(1), rho);
    uint32_t material = analytic_add_material(scene, mirror);
    for (int side = -1; side <= 1; side += 2)
        analytic_add_plane(scene, V3(0, 0, 2 * side), V3(0, 0, -side), V3(1, 0, 0), material);
    return scene;
}

static void expect_mirrors(struct analytic *a, struct turner_scene *scene, int bounces)
{
    struct turner_vec3 rho = scene->materials[0].k_r;
    struct turner_image image;
    if (analytic_render(a, &image, scene)) {
        const float *p = image.rgba;
        double lost[3] = {pow(rho.x, bounces + 1), pow(rho.y, bounces + 1),
                          pow(rho.z, bounces + 1)};
        for (int c = 0; c < 3; c++)
            analytic_expect(a, (double)p[c], 1 - lost[c], 1, "channel %d after %d bounces", c,
                            bounces);
        analytic_expect(a, (double)p[3], fmax(lost[0], fmax(lost[1], lost[2])), 1,
                        "pruned after %d bounces", bounces);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

void check_facing_mirrors(struct analytic *a)
{
    static const int depths[] = {0, 1, 5, 15, 60};
    for (size_t i = 0; i < sizeof depths / sizeof *depths; i++)
        expect_mirrors(a, facing_mirrors(V3(.5, .8, .9), depths[i]), depths[i]);
    expect_mirrors(a, facing_mirrors(GREY(.99), 551), 551);
}

/* A weight below the cutoff is not followed; one equal to it is. */
void check_cutoff(struct analytic *a)
{
    static const struct {
        double cutoff;
        int bounces;
    } cuts[] = {{.1, 3}, {.125, 3}, {.126, 2}, {.5, 1}, {.51, 0}};
    for (size_t i = 0; i < sizeof cuts / sizeof *cuts; i++) {
        struct turner_scene *scene = facing_mirrors(V3(.25, .5, .125), 60);
        scene->settings.cutoff = cuts[i].cutoff; /* the largest channel decides for all */
        expect_mirrors(a, scene, cuts[i].bounces);
    }
}

/* ---- total internal reflection ---- */

enum { BALL_COUNT = 61 };

/* Only refraction counts (k_r = 0), so total internal reflection is black: the pixel is (1 − F)²,
 * F at the angle asin(b) where its ray passes the centre at b. */
static void check_ball_of(struct analytic *a, double outside, double inside)
{
    struct turner_scene *scene = analytic_scene(BALL_COUNT, 1, 0.5 / BALL_COUNT, 4);
    if (outside != 1) {
        scene->camera.inside[0] = analytic_add_medium(scene, outside, GREY(0), 0);
        scene->camera.inside_count = 1;
    }
    struct turner_material ball = analytic_clear(analytic_add_medium(scene, inside, GREY(0), 1));
    ball.fresnel = TURNER_FRESNEL_EXACT;
    analytic_add_sphere(scene, V3(0, 0, -5), 1.01, analytic_add_material(scene, ball));
    scene->background.color = GREY(1);
    struct turner_image image;
    int total = 0, seen = 0;
    analytic_render(a, &image, scene);
    for (int x = 0; image.rgba && x < BALL_COUNT; x++) {
        double b = 5 / 1.01 * fabs(analytic_direction(scene, x, 0).x), got;
        got = (double)analytic_pixel(&image, x, 0)[0];
        double critical = inside / outside;
        if (b > 0.99 || fabs(b - critical) < 0.01)
            continue;
        double f = analytic_fresnel(outside, inside, asin(b)), h = 1e-6;
        double steep = fabs(analytic_fresnel(outside, inside, asin(b + h)) - f) / h;
        analytic_expect(a, got, (1 - f) * (1 - f), 2 + 10 * steep, "%g in %g at b = %.4f", inside,
                        outside, b);
        total += got == 0;
        seen++;
    }
    if (inside > outside) /* never in a solid ball seen from outside */
        analytic_require(a, total == 0 && seen > 40, "%d of %d pixels are total", total, seen);
    else
        analytic_require(a, total > 5 && total < seen, "%d of %d pixels are total", total, seen);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

void check_total_reflection(struct analytic *a)
{
    check_ball_of(a, 1, 1.5);
    check_ball_of(a, 1, 1.333);
    check_ball_of(a, 1.5, 1);
    check_ball_of(a, 1.333, 1);
}

/* What the compass shows in a pixel's vertical plane at `angle` upwards from the way back to the
 * eye. */
static double compass_at(const struct turner_scene *scene, int x, double angle)
{
    struct turner_vec3 d = analytic_direction(scene, x, 0), back = turner_vec3_scale(d, -1);
    struct turner_vec3 right = turner_vec3_normalize(turner_vec3_cross(d, V3(0, 1, 0)));
    struct turner_vec3 up = scene->background.up, tilt = turner_vec3_cross(right, d);
    return (turner_vec3_dot(up, back) * cos(angle) + turner_vec3_dot(up, tilt) * sin(angle) + 1) /
           2;
}

/* Where mirrored and refracted rays go and with what weight (`fresnel: none`): facets before a
 * background that tells directions. Past the critical angle the refracted share is mirrored. */
void check_directions(struct analytic *a)
{
    enum { COUNT = 24 };
    const double k_r = 0.25, k_t = 0.5, n = 1.5;
    for (int behind = 0; behind < 2; behind++) {
        struct turner_scene *scene = analytic_scene(COUNT, 1, 0.05, 1);
        struct turner_material glass = analytic_clear(analytic_add_medium(scene, n, GREY(0), 0));
        glass.k_r = GREY(k_r);
        glass.k_t = GREY(k_t);
        uint32_t material = analytic_add_material(scene, glass);
        for (int x = 0; x < COUNT; x++)
            analytic_add_facet(scene, x, 3.7 * x * DEGREE, behind, material);
        analytic_compass(scene, V3(0.3, 0.8, 0.5));
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int x = 0; image.rgba && x < COUNT; x++) {
            double i = 3.7 * x * DEGREE, t = behind ? analytic_snell(n, 1, i)
                                                    : analytic_snell(1, n, i);
            double mirrored = compass_at(scene, x, 2 * i);
            double refracted = compass_at(scene, x, PI + i - t);
            double want = isnan(t) ? (k_r + k_t) * mirrored : k_r * mirrored + k_t * refracted;
            double steep = isnan(t) ? 1 : 1 + (behind ? n : 1) * cos(i) / cos(t);
            analytic_expect(a, (double)analytic_pixel(&image, x, 0)[0], want, steep,
                            "%s at %.1f°", behind ? "inside" : "outside", i / DEGREE);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- interpolated normals ---- */

/* Facets whose vertex normals stand at another angle, `s`, than their geometric one, `g`. Rays go
 * by `s`, but one that would end on the wrong side of the facet is mirrored back by `g`: from angle
 * φ to 2g + 180° − φ. Beyond 90° N·V is negative: F is that of grazing incidence, 1, or 0 between
 * equal indices. Normals against the winding are turned to the geometric one's side. */
void check_bent_normals(struct analytic *a)
{
    static const struct {
        double g, s;
        bool mirrored_back, refracted_back; /* with n = 1.5, the latter from inside */
    } facets[] = {{0, 20, false, false},  {40, 60, false, false}, {60, 85, true, false},
                  {80, 95, true, false},  {85, 60, false, false}, {30, 70, true, false},
                  {70, 10, false, false}, {80, 20, false, true},  {84, 12, false, true}};
    enum { COUNT = sizeof facets / sizeof *facets };
    const double weights[3][2] = {{0.25, 0.5}, {1, 1}, {1, 1}}; /* k_r, k_t */
    for (int variant = 0; variant < 6; variant++) {
        bool behind = variant % 2;
        double n = variant / 2 == 2 ? 1 : 1.5, k_r = weights[variant / 2][0],
               k_t = weights[variant / 2][1];
        struct turner_scene *scene = analytic_scene(COUNT, 1, 0.12, 1);
        struct turner_material glass = analytic_clear(analytic_add_medium(scene, n, GREY(0), 0));
        glass.fresnel = variant / 2 == 0 ? TURNER_FRESNEL_NONE : TURNER_FRESNEL_EXACT;
        glass.k_r = GREY(k_r);
        glass.k_t = GREY(k_t);
        uint32_t material = analytic_add_material(scene, glass);
        analytic_compass(scene, V3(0.3, 0.8, 0.5));
        for (int x = 0; x < COUNT; x++) {
            struct turner_vec3 d = analytic_direction(scene, x, 0), ns;
            struct turner_vec3 right = turner_vec3_normalize(turner_vec3_cross(d, V3(0, 1, 0)));
            double s = facets[x].s * DEGREE;
            ns = turner_vec3_sub(turner_vec3_scale(turner_vec3_cross(right, d), sin(s)),
                                 turner_vec3_scale(d, cos(s)));
            analytic_add_facet(scene, x, facets[x].g * DEGREE, behind, material);
            struct turner_mesh *mesh = &scene->groups[0].meshes[x];
            mesh->normals = turner_calloc(3, sizeof *mesh->normals);
            for (int corner = 0; corner < 3; corner++) {
                float sign = x % 2 ? -1.0f : 1.0f;
                mesh->normals[corner][0] = sign * (float)ns.x;
                mesh->normals[corner][1] = sign * (float)ns.y;
                mesh->normals[corner][2] = sign * (float)ns.z;
            }
        }
        struct turner_image image;
        analytic_render(a, &image, scene);
        for (int x = 0; image.rgba && x < COUNT; x++) {
            double g = facets[x].g * DEGREE, s = facets[x].s * DEGREE;
            double n1 = behind ? n : 1, n2 = behind ? 1 : n, t = analytic_snell(n1, n2, s);
            double mirrored = 2 * s, refracted = PI + s - t;
            bool back = cos(refracted - g) > 0;
            if (facets[x].mirrored_back)
                mirrored = 2 * g + PI - mirrored;
            if (back)
                refracted = 2 * g + PI - refracted;
            if (n == 1.5 && !isnan(t))
                analytic_require(a, back == (behind && facets[x].refracted_back),
                                 "facet %d is not what it should test", x);
            double f = s > PI / 2 ? n != 1 : analytic_fresnel(n1, n2, s);
            bool plain = glass.fresnel == TURNER_FRESNEL_NONE;
            double w_r = k_r * (plain ? 1 : f), w_t = k_t * (plain ? 1 : 1 - f), steep = 1;
            if (isnan(t)) {
                w_r = plain ? k_r + k_t : k_r;
                w_t = 0;
            } else {
                steep += fabs(n1 / n2 * cos(s) / cos(t));
                steep += s < PI / 2 && !plain
                             ? fabs(analytic_fresnel(n1, n2, s + 1e-6) - f) / 1e-6
                             : 0;
            }
            double want = w_r * compass_at(scene, x, mirrored);
            if (w_t > 0)
                want += w_t * compass_at(scene, x, refracted);
            /* the normals are floats even for an exact renderer */
            analytic_expect(a, (double)analytic_pixel(&image, x, 0)[0], want, 3 * steep,
                            "variant %d, facet %g°, normal %g°", variant, facets[x].g,
                            facets[x].s);
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}
