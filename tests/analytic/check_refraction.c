/* Where refracted rays go, and what a slab lets through. */
#include <math.h>

#include "analytic/checks.h"

#define DEGREE (PI / 180)

/* The angle between a pixel's ray and the axis that the camera of analytic_scene looks along. */
static double angle_of(const struct turner_scene *scene, int x)
{
    struct turner_vec3 d = analytic_direction(scene, x, 0);
    return atan2(d.x, -d.z);
}

/* ---- the slab ---- */

/* A slab of glass (n = 1.5) between a red wall behind it and a green one behind the eye: a pixel is
 * (what passes, what returns). The middle pixel looks straight at it. */
static void slab_picture(struct analytic *a, struct turner_image *image, int depth)
{
    struct turner_scene *scene = analytic_scene(31, 1, 0.05, depth);
    struct turner_material glass = analytic_clear(analytic_add_medium(scene, 1.5, GREY(0), 0));
    glass.k_r = GREY(1);
    glass.fresnel = TURNER_FRESNEL_EXACT;
    uint32_t material = analytic_add_material(scene, glass);
    analytic_add_box(scene, V3(-500, -400, -6), V3(600, 700, -5), material);
    analytic_add_plane(scene, V3(0, 0, -10), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_lamp(scene, V3(1, 0, 0)));
    analytic_add_plane(scene, V3(0, 0, 5), V3(0, 0, -1), V3(1, 0, 0),
                       analytic_add_lamp(scene, V3(0, 1, 0)));
    analytic_render(a, image, scene);
    turner_scene_destroy(scene);
}

/* Straight on, with the inner bounces that the depth allows: 0, 1, all. The rest is in `pruned`. */
void check_slab_depth(struct analytic *a)
{
    static const struct {
        int depth;
        double passes, returns;
    } slabs[] = {{1, 0, .04},
                 {2, .9216, .04},
                 {3, .9216, .04 + .036864},
                 {4, .92307456, .04 + .036864},
                 {60, .92307692307692, .07692307692308}};
    for (size_t i = 0; i < sizeof slabs / sizeof *slabs; i++) {
        struct turner_image image;
        slab_picture(a, &image, slabs[i].depth);
        if (image.rgba) {
            const float *p = analytic_pixel(&image, 15, 0);
            analytic_expect(a, (double)p[0], slabs[i].passes, 1, "passes at depth %d",
                            slabs[i].depth);
            analytic_expect(a, (double)p[1], slabs[i].returns, 1, "returns at depth %d",
                            slabs[i].depth);
            analytic_expect(a, (double)p[3], 1 - slabs[i].passes - slabs[i].returns, 1,
                            "pruned at depth %d", slabs[i].depth);
        }
        turner_image_destroy(&image);
    }
}

/* At any angle T = (1 − F)/(1 + F). */
void check_slab_angle(struct analytic *a)
{
    struct turner_scene *view = analytic_scene(31, 1, 0.05, 0);
    struct turner_image image;
    slab_picture(a, &image, 60);
    for (int x = 0; image.rgba && x < 31; x++) {
        double f = analytic_fresnel(1, 1.5, fabs(angle_of(view, x)));
        const float *p = analytic_pixel(&image, x, 0);
        analytic_expect(a, (double)p[0], (1 - f) / (1 + f), 1, "passes at pixel %d", x);
        analytic_expect(a, (double)p[1], 2 * f / (1 + f), 1, "returns at pixel %d", x);
    }
    turner_image_destroy(&image);
    turner_scene_destroy(view);
}

/* A ray goes on parallel to itself, .32914 of the thickness aside at 45° and n = 1.5. */
void check_slab_shift(struct analytic *a)
{
    const double thickness = 3, wall = 10, reach = 20;
    struct turner_scene *scene = analytic_scene(41, 1, 0.02, 2);
    analytic_look(scene, V3(0, 0, 0), V3(1, 0, -1), V3(0, 1, 0));
    uint32_t medium = analytic_add_medium(scene, 1.5, GREY(0), 0);
    uint32_t material = analytic_add_material(scene, analytic_clear(medium));
    analytic_add_box(scene, V3(-50, -40, -4 - thickness), V3(60, 70, -4), material);
    analytic_add_ruler(scene, V3(0, 0, -wall), V3(0, 0, 1), V3(1, 0, 0), reach);
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int x = 0; image.rgba && x < 41; x++) {
        double i = angle_of(scene, x), t = analytic_snell(1, 1.5, i);
        double u = analytic_ruler(analytic_pixel(&image, x, 0), 0, reach);
        analytic_expect(a, u, wall * tan(i) - thickness * (tan(i) - tan(t)), 2 * reach,
                        "place on the wall at %.2f°", i / DEGREE);
        if (x == 20) {
            analytic_expect(a, (wall * tan(i) - u) * cos(i) / thickness, .32914, 2 * reach,
                            "shift over thickness at 45°");
        }
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* The bottom of a pool seems to lie at d/n. */
void check_apparent_depth(struct analytic *a)
{
    const double depth = 2, n = 1.333, reach = 1;
    struct turner_scene *scene = analytic_scene(33, 1, 0.01, 2);
    uint32_t water = analytic_add_medium(scene, n, GREY(0), 0);
    analytic_add_plane(scene, V3(0, 0, -1), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_material(scene, analytic_clear(water)));
    analytic_add_ruler(scene, V3(0, 0, -1 - depth), V3(0, 0, 1), V3(1, 0, 0), reach);
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int x = 0; image.rgba && x < 33; x++) {
        double i = angle_of(scene, x), t = analytic_snell(1, n, i);
        double u = analytic_ruler(analytic_pixel(&image, x, 0), 0, reach);
        analytic_expect(a, u, tan(i) + depth * tan(t), 4, "place on the bottom at pixel %d", x);
        if (x == 17) /* .57° from straight down */
            analytic_expect(a, u / tan(i) - 1, depth / n, 4 / tan(i), "apparent depth");
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* ---- the prism ---- */

/* In the horizontal plane: the point at `angle` from +z towards +x, `length` away from `from`. */
static struct turner_vec3 step(struct turner_vec3 from, double length, double angle)
{
    return V3(from.x + length * sin(angle), from.y, from.z + length * cos(angle));
}

/* An upright wall between two points, seen from the side that `n` points to. */
static void add_wall(struct turner_scene *scene, struct turner_vec3 from, struct turner_vec3 to,
                     struct turner_vec3 n, uint32_t material)
{
    struct turner_vec3 along = turner_vec3_sub(to, from);
    if (turner_vec3_dot(turner_vec3_cross(along, V3(0, 1, 0)), n) < 0) {
        struct turner_vec3 swap = from;
        from = to;
        to = swap;
    }
    analytic_add_quad(scene,
                      (struct turner_vec3[]){V3(from.x, -4, from.z), V3(to.x, -4, to.z),
                                             V3(to.x, 5, to.z), V3(from.x, 5, from.z)},
                      material);
}

/* An upright prism of 60°; the eye looks at its first face under the angle of least deviation. */
static void check_prism_of(struct analytic *a, double n, double published)
{
    enum { COUNT = 129 };
    const double refracting = 60 * DEGREE, side = 6;
    double incidence = asin(n * sin(refracting / 2));
    double least = 2 * incidence - refracting;
    struct turner_scene *scene = analytic_scene(COUNT, 1, 0.002, 2);
    uint32_t medium = analytic_add_medium(scene, n, GREY(0), 0);
    uint32_t material = analytic_add_material(scene, analytic_clear(medium));
    double first = incidence, second = first + PI - refracting; /* where the normals point */
    struct turner_vec3 middle = V3(0, 0, -5);
    struct turner_vec3 apex = step(middle, side / 2, first + PI / 2);
    struct turner_vec3 left = step(middle, -side / 2, first + PI / 2);
    struct turner_vec3 right = step(apex, side, second + PI / 2);
    struct turner_vec3 n1 = step(V3(0, 0, 0), 1, first), n2 = step(V3(0, 0, 0), 1, second);
    add_wall(scene, left, apex, n1, material);
    add_wall(scene, apex, right, n2, material);
    add_wall(scene, right, left, turner_vec3_scale(turner_vec3_add(n1, n2), -1), material);
    /* the compass stands across the least deviated ray, where it is most exact */
    double compass = PI + least - PI / 2;
    analytic_compass(scene, step(V3(0, 0, 0), 1, compass));

    struct turner_image image;
    double smallest = PI;
    analytic_render(a, &image, scene);
    for (int x = 0; image.rgba && x < COUNT; x++) {
        double alpha = angle_of(scene, x), i = alpha + first;
        double t = analytic_snell(1, n, i), e = analytic_snell(n, 1, refracting - t);
        double going = compass + acos(2 * (double)analytic_pixel(&image, x, 0)[0] - 1);
        double deviation = going - (PI - alpha);
        smallest = fmin(smallest, deviation);
        analytic_expect(a, deviation, i + e - refracting, 3, "deviation at %.3f°, n = %g",
                        i / DEGREE, n);
    }
    analytic_require(a, fabs(smallest / DEGREE - published) < 6e-4,
                     "least deviation at n = %g: %.4f°, expected %.3f°", n, smallest / DEGREE,
                     published);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

void check_prism(struct analytic *a)
{
    check_prism_of(a, 1.5, 37.181);
    check_prism_of(a, 1.333, 23.595);
}

/* ---- the ball ---- */

/* A ball lens of radius 1, three radii away, and a wall three radii behind it. */
static void check_ball_lens_of(struct analytic *a, double n, double focal_length)
{
    const double eye = 3, wall = 3, reach = 0.5;
    struct turner_scene *scene = analytic_scene(32, 1, 0.004, 2);
    uint32_t medium = analytic_add_medium(scene, n, GREY(0), 0);
    uint32_t material = analytic_add_material(scene, analytic_clear(medium));
    analytic_look(scene, V3(0, 0, eye), V3(0, 0, 0), V3(0, 1, 0));
    analytic_add_sphere(scene, V3(0, 0, 0), 1, material);
    analytic_add_ruler(scene, V3(0, 0, -wall), V3(0, 0, 1), V3(1, 0, 0), reach);
    struct turner_image image;
    analytic_render(a, &image, scene);
    for (int x = 0; image.rgba && x < 32; x++) {
        /* the ray passes the centre at distance b before and after, and turns by 2(i − t) */
        double alpha = angle_of(scene, x), b = eye * sin(alpha), i = asin(b);
        double gamma = alpha - 2 * (i - asin(b / n));
        double s = (wall + b * sin(gamma)) / cos(gamma);
        double u = analytic_ruler(analytic_pixel(&image, x, 0), 0, reach);
        analytic_expect(a, u, b * cos(gamma) + s * sin(gamma), 4, "place behind a ball of %g, %d",
                        n, x);
        if (x == 16) { /* .002 from the axis, where aberration is 1e-5 */
            double slope = (u - alpha * eye) / wall;
            analytic_expect(a, eye / (1 - slope / alpha), focal_length, 4 / alpha,
                            "focal length at n = %g", n);
        }
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

void check_ball_lens(struct analytic *a)
{
    check_ball_lens_of(a, 1.5, 1.5);
    check_ball_lens_of(a, 1.333, 2.0015);
    check_ball_lens_of(a, 2, 1);
}

/* ---- the rainbow ---- */

enum { BOW_COUNT = 256 };

/* A drop of radius 1 ten radii away; pixels meet it at b0 … b1 from its centre. What passes or is
 * reflected forward ends on a black wall behind it. */
static struct turner_scene *bow_scene(double n, double b0, double b1, double compass, int depth)
{
    double alpha = (b0 + b1) / 20;
    struct turner_scene *scene =
        analytic_scene(BOW_COUNT, 1, (b1 - b0) / 10 / BOW_COUNT, depth);
    struct turner_material drop = analytic_clear(analytic_add_medium(scene, n, GREY(0), 0));
    drop.k_r = GREY(1);
    analytic_look(scene, V3(0, 0, 10), V3(10 * sin(alpha), 0, 10 - 10 * cos(alpha)),
                  V3(0, 1, 0));
    analytic_add_sphere(scene, V3(0, 0, 0), 1, analytic_add_material(scene, drop));
    analytic_add_plane(scene, V3(0, 0, -3), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_lamp(scene, GREY(0)));
    analytic_compass(scene, V3(sin(compass), 0, -cos(compass)));
    return scene;
}

/* `bounces` inner reflections turn a ray by 2(i − t) + bounces·(π − 2t), at least by `least`, where
 * it meets the drop at b. The ray that leaves after them has depth bounces + 2. With more than one
 * bounce those before are taken away with a second picture. */
static void check_bow(struct analytic *a, double n, int bounces, double b0, double b1,
                      double least, double b_least)
{
    double going = (b0 + b1) / 20 - least * DEGREE; /* about */
    struct turner_image image, before = {0};
    struct turner_scene *scene = bow_scene(n, b0, b1, going + PI / 2, bounces + 2);
    analytic_render(a, &image, scene);
    if (bounces > 1) {
        scene->settings.depth--;
        analytic_render(a, &before, scene);
    }
    double smallest = 2 * PI, b_smallest = 0;
    for (int x = 0; image.rgba && x < BOW_COUNT; x++) {
        double alpha = angle_of(scene, x), b = 10 * sin(alpha);
        double i = asin(b), t = asin(b / n);
        double turn = 2 * (i - t) + bounces * (PI - 2 * t);
        double steep = fabs((2 / cos(i) - 2 * (bounces + 1) / (n * cos(t))));
        double value = (double)analytic_pixel(&image, x, 0)[0];
        if (before.rgba)
            value -= (double)analytic_pixel(&before, x, 0)[0];
        double got = alpha - going - asin(2 * value - 1);
        if (got < smallest) {
            smallest = got;
            b_smallest = b;
        }
        /* seen from ten radii away, b is ten times as rough as the direction */
        analytic_expect(a, got, turn, 3 + 10 * steep, "n = %g, %d bounces, b = %.4f", n, bounces,
                        b);
    }
    analytic_require(a, fabs(smallest / DEGREE - least) < 1.5e-3,
                     "least deviation %.4f°, expected %.3f°", smallest / DEGREE, least);
    analytic_require(a, fabs(b_smallest - b_least) < 3e-3, "it lies at b = %.4f, expected %.5f",
                     b_smallest, b_least);
    turner_image_destroy(&image);
    turner_image_destroy(&before);
    turner_scene_destroy(scene);
}

/* The bow stands at 180° less the least deviation. */
void check_rainbow(struct analytic *a)
{
    check_bow(a, 1.333, 1, 0.78, 0.98, 137.922, .86084);
    check_bow(a, 1.331, 1, 0.78, 0.98, 180 - 42.370, sqrt((4 - 1.331 * 1.331) / 3));
    check_bow(a, 1.343, 1, 0.78, 0.98, 180 - 40.646, sqrt((4 - 1.343 * 1.343) / 3));
    check_bow(a, 1.333, 2, 0.90, 0.99, 180 + 50.891, .95020);
}
