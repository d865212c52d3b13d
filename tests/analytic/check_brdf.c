/* The two Phong forms: their formula, and what they do to energy. */
#include <math.h>

#include "analytic/checks.h"

#define DEGREE (PI / 180)

static struct turner_light sun_from(struct turner_vec3 l, double irradiance)
{
    return (struct turner_light){.kind = TURNER_LIGHT_DIRECTIONAL,
                                 .direction = turner_vec3_scale(turner_vec3_normalize(l), -1),
                                 .power = GREY(irradiance)};
}

/* ---- the formula ---- */

/* A wall across the view, light from above: every pixel has its own V, and R·V runs from the
 * middle of the highlight to below 0. */
void check_phong(struct analytic *a)
{
    static const double exponents[] = {0, 1, 10, 1000};
    const int size = 24;
    struct turner_vec3 l = turner_vec3_normalize(V3(0.5, 0.7, 0.4)), n = V3(0, 0, 1);
    for (int variant = 0; variant < 8; variant++) {
        double e = exponents[variant / 2];
        bool phong = variant % 2;
        struct turner_scene *scene = analytic_scene(size, size, 0.3, 0);
        struct turner_material paint = analytic_plain();
        paint.k_d = V3(0.3, 0.2, 0);
        paint.k_s = V3(0, 0.5, 0.7);
        paint.k_e = V3(0.1, 0, 0);
        paint.k_a = V3(0, 0.5, 0);
        paint.exponent = e;
        scene->ambient = V3(1, 0.4, 1);
        scene->settings.shading = phong ? TURNER_SHADING_PHONG : TURNER_SHADING_ENERGY_CONSERVING;
        analytic_add_plane(scene, V3(0, 0, -1), n, V3(1, 0, 0),
                           analytic_add_material(scene, paint));
        analytic_add_light(scene, sun_from(l, 2));
        analytic_add_light(scene, sun_from(V3(1, 0, -0.2), 2)); /* from behind */
        analytic_add_light(scene, sun_from(V3(1, 0, 0), 2));    /* at the horizon */
        struct turner_image image;
        int lit = 0;
        analytic_render(a, &image, scene);
        for (int i = 0; image.rgba && i < size * size; i++) {
            struct turner_vec3 v =
                turner_vec3_scale(analytic_direction(scene, i % size, i / size), -1);
            struct turner_vec3 r = V3(-l.x, -l.y, l.z);
            double rv = turner_vec3_dot(r, v), peak = rv > 0 ? pow(rv, e) : 0;
            double diffuse = phong ? l.z : l.z / PI;
            double shine = phong ? peak : (e + 2) / (2 * PI) * peak * l.z;
            double want[3] = {0.1 + 2 * 0.3 * diffuse,
                              0.5 * 0.4 + 2 * (0.2 * diffuse + 0.5 * shine), 2 * 0.7 * shine};
            if (fabs(rv) < 1e-4)
                continue; /* at exponent 0 it steps there */
            for (int c = 0; c < 3; c++)
                analytic_expect(a, (double)image.rgba[4 * i + c], want[c],
                                2 + (c > 0 ? e * shine : 0), "n = %g, %s, pixel %d", e,
                                phong ? "phong" : "energy", i);
            lit += shine > 0.1;
        }
        analytic_require(a, lit > 0, "no highlight at n = %g", e);
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* ---- energy ---- */

/* Gauss and Legendre's nodes and weights on [0, 1] (Newton's method on the polynomial). */
static void gauss_legendre(int count, double *nodes, double *weights)
{
    for (int i = 0; i < count; i++) {
        double x = cos(PI * (i + 0.75) / (count + 0.5)), slope = 1;
        for (int step = 0; step < 50; step++) {
            double p0 = 1, p1 = x;
            for (int k = 2; k <= count; k++) {
                double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            slope = count * (x * p1 - p0) / (x * x - 1);
            x -= p1 / slope;
        }
        nodes[i] = (1 + x) / 2;
        weights[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

enum { ZENITHS = 56, AZIMUTHS = 64, VIEWS = 9 };

/* A sky of radiance 1 made of suns: what a wall shows under it is its albedo, from the angles at
 * which the pixels look, up to 78°. The middle one looks straight at it; for it Gauss' rule in
 * cos θ is exact, since only powers of cos θ up to 101 come up. */
static void sky_picture(struct analytic *a, struct turner_image *image,
                        enum turner_shading shading, double k_d, double k_s, double exponent)
{
    struct turner_scene *scene = analytic_scene(VIEWS, 1, 1.25, 0);
    struct turner_material paint = analytic_plain();
    double nodes[ZENITHS], weights[ZENITHS];
    paint.k_d = GREY(k_d);
    paint.k_s = GREY(k_s);
    paint.exponent = exponent;
    scene->settings.shading = shading;
    analytic_add_plane(scene, V3(0, 0, -1), V3(0, 0, 1), V3(1, 0, 0),
                       analytic_add_material(scene, paint));
    gauss_legendre(ZENITHS, nodes, weights);
    for (int i = 0; i < ZENITHS * AZIMUTHS; i++) {
        double c = nodes[i / AZIMUTHS], s = sqrt(1 - c * c);
        double phi = 2 * PI * (i % AZIMUTHS + 0.5) / AZIMUTHS;
        analytic_add_light(scene, sun_from(V3(s * cos(phi), s * sin(phi), c),
                                           weights[i / AZIMUTHS] * 2 * PI / AZIMUTHS));
    }
    analytic_render(a, image, scene);
    turner_scene_destroy(scene);
}

static const double energy_exponents[] = {1, 5, 10, 100};

/* energy_conserving: straight on the albedo is k_d + k_s, at other angles not above it. (There the
 * sum over the suns is only as good as 1e-3.) */
void check_energy(struct analytic *a)
{
    for (int e = 0; e < 4; e++) {
        struct turner_image image;
        double n = energy_exponents[e];
        sky_picture(a, &image, TURNER_SHADING_ENERGY_CONSERVING, 0.3, 0.7, n);
        for (int x = 0; image.rgba && x < VIEWS; x++) {
            double albedo = (double)analytic_pixel(&image, x, 0)[0];
            if (x == VIEWS / 2)
                analytic_expect(a, albedo, 1, 2 + n / 5, "albedo straight on, n = %g", n);
            analytic_require(a, albedo <= 1.001 && albedo > 0.3, "albedo %.5f, n = %g, pixel %d",
                             albedo, n, x);
        }
        turner_image_destroy(&image);
    }
}

/* phong: k_s gains 2π/(n + 1) straight on, k_d gains π. */
void check_phong_gain(struct analytic *a)
{
    static const double printed[] = {3.14, 1.047, .571, .0622};
    static const double digits[] = {5e-3, 5e-4, 5e-4, 5e-5};
    struct turner_image image;
    for (int e = 0; e < 4; e++) {
        double n = energy_exponents[e];
        sky_picture(a, &image, TURNER_SHADING_PHONG, 0, 1, n);
        if (image.rgba) {
            double gain = (double)analytic_pixel(&image, VIEWS / 2, 0)[0];
            analytic_expect(a, gain, 2 * PI / (n + 1), 6 + n / 5, "gain at n = %g", n);
            analytic_require(a, fabs(gain - printed[e]) < digits[e], "gain %.5f, printed %g", gain,
                             printed[e]);
        }
        turner_image_destroy(&image);
    }
    sky_picture(a, &image, TURNER_SHADING_PHONG, 1, 0, 1);
    if (image.rgba)
        analytic_expect(a, (double)analytic_pixel(&image, 0, 0)[0], PI, 6, "gain of k_d");
    turner_image_destroy(&image);
}

/* ---- reciprocity ---- */

enum { PAIRS = 12 };

/* Facets with all sorts of normals N, or with each N turned half round the direction between V and
 * L, where V and L have changed places. Returns E·cos θ in `cosines` of each. */
static void pair_picture(struct analytic *a, struct turner_image *image, bool turned,
                         enum turner_shading shading, double cosines[PAIRS])
{
    struct turner_vec3 l = turner_vec3_normalize(V3(0.5, 0.6, 0.7));
    struct turner_scene *scene = analytic_scene(PAIRS, 1, 0.12, 0);
    struct turner_material paint = analytic_plain();
    paint.k_d = V3(0.5, 0, 0.2);
    paint.k_s = V3(0, 0.8, 0.5);
    paint.exponent = 6;
    uint32_t material = analytic_add_material(scene, paint);
    scene->settings.shading = shading;
    analytic_add_light(scene, sun_from(l, 1));
    for (int x = 0; x < PAIRS; x++) {
        struct turner_vec3 v = turner_vec3_scale(analytic_direction(scene, x, 0), -1);
        struct turner_vec3 half = turner_vec3_normalize(turner_vec3_add(v, l));
        struct turner_vec3 n = turner_vec3_normalize(
            turner_vec3_add(half, V3(0.4 * sin(x), 0.5 * cos(2 * x), 0.3 * sin(3 * x))));
        if (turned)
            n = turner_vec3_sub(turner_vec3_scale(half, 2 * turner_vec3_dot(half, n)), n);
        cosines[x] = turner_vec3_dot(n, l);
        analytic_add_tile(scene, x, n, material);
    }
    analytic_render(a, image, scene);
    turner_scene_destroy(scene);
}

void check_reciprocity(struct analytic *a)
{
    for (int phong = 0; phong < 2; phong++) {
        struct turner_image images[2];
        double cosines[2][PAIRS], largest = 0;
        for (int turned = 0; turned < 2; turned++) {
            pair_picture(a, &images[turned], turned,
                         phong ? TURNER_SHADING_PHONG : TURNER_SHADING_ENERGY_CONSERVING,
                         cosines[turned]);
        }
        for (int i = 0; images[0].rgba && images[1].rgba && i < 3 * PAIRS; i++) {
            int x = i / 3, c = i % 3;
            double one = (double)analytic_pixel(&images[0], x, 0)[c] / cosines[0][x];
            double other = (double)analytic_pixel(&images[1], x, 0)[c] / cosines[1][x];
            if (!phong)
                analytic_expect(a, one, other, 4 / fmin(cosines[0][x], cosines[1][x]),
                                "f(V, L) and f(L, V), facet %d, channel %d", x, c);
            largest = fmax(largest, fabs(one - other));
            analytic_require(a, one > 0 || c == 1, "facet %d is black", x);
        }
        if (phong) /* known not to be reciprocal */
            analytic_require(a, largest > 0.05, "phong seems to be reciprocal");
        turner_image_destroy(&images[0]);
        turner_image_destroy(&images[1]);
    }
}
