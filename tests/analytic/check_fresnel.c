/* What interfaces reflect: one facet a pixel, each at its own angle, in a white surrounding. */
#include <complex.h>
#include <math.h>

#include "analytic/checks.h"

#define DEGREE (PI / 180)

/* One picture of many interfaces. A pixel shows (F, 1 − F, 1). */
struct facet {
    double index, angle;
    double want; /* F */
};

static struct turner_scene *facet_scene(int count, int depth)
{
    struct turner_scene *scene = analytic_scene(count, 1, 1.2 / count, depth);
    scene->background.color = GREY(1);
    return scene;
}

/* Steepness of a curve at x, for the conditioning: rounding moves the angle too. */
static double steepness(double (*curve)(double n1, double n2, double i), double n1, double n2,
                        double i)
{
    double h = 1e-7;
    return fabs(curve(n1, n2, i + h) - curve(n1, n2, fabs(i - h))) / (2 * h);
}

static double schlick(double n1, double n2, double i)
{
    double t = analytic_snell(n1, n2, i), r0 = pow((n1 - n2) / (n1 + n2), 2);
    if (isnan(t))
        return 1;
    return r0 + (1 - r0) * pow(1 - cos(n1 <= n2 ? i : t), 5);
}

static void expect_facets(struct analytic *a, struct turner_scene *scene,
                          const struct facet *facets, int count, bool behind,
                          enum turner_fresnel fresnel)
{
    for (int i = 0; i < count; i++) {
        uint32_t medium = 0;
        while (medium < scene->media_count && scene->media[medium].index != facets[i].index)
            medium++;
        if (medium == scene->media_count)
            analytic_add_medium(scene, facets[i].index, GREY(0), 0);
        analytic_add_facet(scene, i, facets[i].angle, behind,
                           analytic_add_material(scene, analytic_split(medium, fresnel)));
    }
    struct turner_image image;
    if (analytic_render(a, &image, scene)) {
        for (int i = 0; i < count; i++) {
            const float *p = analytic_pixel(&image, i, 0);
            double n1 = behind ? facets[i].index : 1, n2 = behind ? 1 : facets[i].index;
            double steep = steepness(fresnel == TURNER_FRESNEL_EXACT ? analytic_fresnel : schlick,
                                     n1, n2, facets[i].angle);
            double angle = facets[i].angle / DEGREE;
            analytic_expect(a, (double)p[0], facets[i].want, 1 + steep, "F of %g→%g at %.4f°", n1,
                            n2, angle);
            analytic_expect(a, (double)p[1], 1 - facets[i].want, 1 + steep,
                            "1 − F of %g→%g at %.4f°", n1, n2, angle);
            analytic_expect(a, (double)p[2], 1, 1, "furnace %g→%g at %.4f°", n1, n2, angle);
        }
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}

/* Printed values, six digits. */
void check_fresnel_table(struct analytic *a)
{
    static const double angles[] = {0, 30, 45, 56.309932474020213, 60, 75, 80, 85};
    static const double indices[] = {1.333, 1.5, 2.417};
    static const double table[3][8] = {
        {.020373, .021436, .027898, .046874, .059691, .212378, .347917, .583523},
        {.040000, .041523, .050240, .073964, .089187, .253061, .387704, .612800},
        {.171969, .173460, .181116, .199851, .211261, .330500, .433315, .621709}};
    struct facet facets[24];
    for (int i = 0; i < 24; i++)
        facets[i] = (struct facet){indices[i / 8], angles[i % 8] * DEGREE, table[i / 8][i % 8]};
    expect_facets(a, facet_scene(24, 1), facets, 24, false, TURNER_FRESNEL_EXACT);

    /* from inside glass: up to the critical angle of 41.810°, and beyond */
    struct facet inside[] = {{1.5, 0, .04},
                             {1.5, 30 * DEGREE, .055190},
                             {1.5, 40 * DEGREE, .245291},
                             {1.5, 41.8 * DEGREE, .890766},
                             {1.5, 41.811 * DEGREE, 1},
                             {1.5, 60 * DEGREE, 1},
                             {1.5, 89 * DEGREE, 1}};
    expect_facets(a, facet_scene(7, 1), inside, 7, true, TURNER_FRESNEL_EXACT);

    /* just below critical */
    static const double below[] = {1e-3, 1e-4}, reflected[] = {.7636, .9172};
    for (int i = 0; i < 2; i++) {
        double f = analytic_fresnel(1.5, 1, asin(1 / 1.5) - below[i]);
        analytic_require(a, fabs(f - reflected[i]) < 5e-5, "the formula itself: %.6f", f);
    }
}

static void check_curve(struct analytic *a, enum turner_fresnel fresnel)
{
    enum { COUNT = 64 };
    static const double outside[] = {1.00001, 1.05, 1.333, 1.5, 2.417, 0.75};
    static const double inside[] = {1.05, 1.333, 1.5, 2.417};
    double (*curve)(double, double, double) =
        fresnel == TURNER_FRESNEL_EXACT ? analytic_fresnel : schlick;
    struct facet facets[COUNT];
    for (int i = 0; i < COUNT; i++) {
        double n = outside[i % 6], angle = 89.5 * DEGREE * i / (COUNT - 1);
        double critical = n < 1 ? asin(n) : PI;
        if (fabs(angle - critical) < 0.01)
            angle = critical + 0.01;
        facets[i] = (struct facet){n, angle, curve(1, n, angle)};
    }
    expect_facets(a, facet_scene(COUNT, 1), facets, COUNT, false, fresnel);
    for (int i = 0; i < COUNT; i++) {
        double n = inside[i % 4], angle = 89 * DEGREE * i / (COUNT - 1);
        if (fabs(angle - asin(1 / n)) < 0.01)
            angle = asin(1 / n) - 0.01;
        facets[i] = (struct facet){n, angle, curve(n, 1, angle)};
    }
    expect_facets(a, facet_scene(COUNT, 1), facets, COUNT, true, fresnel);
}

void check_fresnel_exact(struct analytic *a)
{
    check_curve(a, TURNER_FRESNEL_EXACT);
}

void check_fresnel_schlick(struct analytic *a)
{
    check_curve(a, TURNER_FRESNEL_SCHLICK);
}

/* n1 = n2: exact reflects nothing at any angle, Schlick's curve is wrong by (1 − cos)⁵. */
void check_fresnel_equal(struct analytic *a)
{
    enum { COUNT = 16 };
    struct facet exact[COUNT], curve[COUNT];
    for (int i = 0; i < COUNT; i++) {
        double angle = 89.9 * DEGREE * i / (COUNT - 1);
        exact[i] = (struct facet){1, angle, 0};
        curve[i] = (struct facet){1, angle, pow(1 - cos(angle), 5)};
    }
    expect_facets(a, facet_scene(COUNT, 1), exact, COUNT, false, TURNER_FRESNEL_EXACT);
    expect_facets(a, facet_scene(COUNT, 1), curve, COUNT, false, TURNER_FRESNEL_SCHLICK);
}

/* Schlick's largest errors from outside, as published; on facets every quarter of a degree around
 * the worst angle. */
void check_schlick_error(struct analytic *a)
{
    static const struct {
        double index, from, to, error, digits;
    } worst[] = {{1.05, 80, 89.75, .317, 5e-4},   {1.333, 80, 87, .059, 5e-4},
                 {1.5, 82, 88, .0357, 5e-5},      {1.6, 80, 88, .0319, 5e-5},
                 {2.417, 80, 89, .075, 5e-4},     {3.0, 80, 89, .125, 5e-4}};
    for (size_t w = 0; w < sizeof worst / sizeof *worst; w++) {
        int count = (int)((worst[w].to - worst[w].from) * 4) + 1;
        struct turner_image images[2];
        for (int kind = 0; kind < 2; kind++) {
            struct turner_scene *scene = facet_scene(count, 1);
            uint32_t medium = analytic_add_medium(scene, worst[w].index, GREY(0), 0);
            uint32_t material = analytic_add_material(
                scene, analytic_split(medium, kind ? TURNER_FRESNEL_SCHLICK
                                                   : TURNER_FRESNEL_EXACT));
            for (int i = 0; i < count; i++)
                analytic_add_facet(scene, i, (worst[w].from + i * 0.25) * DEGREE, false, material);
            analytic_render(a, &images[kind], scene);
            turner_scene_destroy(scene);
        }
        double largest = 0;
        for (int i = 0; images[0].rgba && images[1].rgba && i < count; i++) {
            double error = (double)analytic_pixel(&images[1], i, 0)[0] -
                           (double)analytic_pixel(&images[0], i, 0)[0];
            largest = fabs(error) > fabs(largest) ? error : largest;
        }
        analytic_require(a, fabs(largest - worst[w].error) <= worst[w].digits * 1.01,
                         "Schlick's largest error at n = %g is %.5f, expected %.4f",
                         worst[w].index, largest, worst[w].error);
        turner_image_destroy(&images[0]);
        turner_image_destroy(&images[1]);
    }
}

/* At 45° R_p = R_s² for every n; at Brewster's angle R_p = 0 and R_s = ((n² − 1)/(n² + 1))². */
void check_fresnel_identities(struct analytic *a)
{
    static const double indices[] = {1.1, 1.333, 1.5, 2, 2.417, 3};
    struct facet facets[12];
    for (int i = 0; i < 6; i++) {
        double n = indices[i], c = sqrt(0.5), ct = sqrt(n * n - 0.5);
        double s = pow((c - ct) / (c + ct), 2);
        facets[i] = (struct facet){n, 45 * DEGREE, (s + s * s) / 2};
        double b = pow((n * n - 1) / (n * n + 1), 2);
        facets[i + 6] = (struct facet){n, atan(n), b / 2};
    }
    expect_facets(a, facet_scene(12, 1), facets, 12, false, TURNER_FRESNEL_EXACT);
}

/* ---- metals ---- */

/* Fresnel's laws with a complex angle of refraction. */
static double conductor(double complex m, double i)
{
    double complex ct = csqrt(1 - sin(i) * sin(i) / (m * m));
    double s = pow(cabs((cos(i) - m * ct) / (cos(i) + m * ct)), 2);
    double p = pow(cabs((m * cos(i) - ct) / (m * cos(i) + ct)), 2);
    return (s + p) / 2;
}

/* Gold, silver, copper (eta and k of Mitsuba's spectra as RGB): the printed reflectance at 0°, and
 * the curve. In water the index of the water divides both. */
void check_conductor(struct analytic *a)
{
    static const double eta[3][3] = {{.143119, .374957, 1.442479},
                                     {.155265, .116723, .138341},
                                     {.200438, .924033, 1.102212}};
    static const double k[3][3] = {{3.983160, 2.385721, 1.603215},
                                   {4.828370, 3.122500, 2.147030},
                                   {3.912949, 2.452848, 2.142188}};
    static const double printed[3][3] = {
        {.9667, .8020, .3241}, {.9748, .9575, .9063}, {.9520, .6198, .5106}};
    enum { ANGLES = 10 };
    for (int wet = 0; wet < 2; wet++) {
        struct turner_scene *scene = facet_scene(3 * ANGLES, 1);
        double index = wet ? 1.333 : 1;
        if (wet) {
            scene->camera.inside[0] = analytic_add_medium(scene, index, GREY(0), 0);
            scene->camera.inside_count = 1;
        }
        for (int m = 0; m < 3; m++) {
            struct turner_material metal = analytic_plain();
            metal.k_r = GREY(1);
            metal.conductor = true;
            metal.fresnel = TURNER_FRESNEL_EXACT;
            metal.eta = V3(eta[m][0], eta[m][1], eta[m][2]);
            metal.k = V3(k[m][0], k[m][1], k[m][2]);
            uint32_t material = analytic_add_material(scene, metal);
            for (int i = 0; i < ANGLES; i++)
                analytic_add_facet(scene, m * ANGLES + i, i * 9.9 * DEGREE, false, material);
        }
        struct turner_image image;
        if (analytic_render(a, &image, scene)) {
            for (int i = 0; i < 9 * ANGLES; i++) {
                int m = i / 3 / ANGLES, c = i % 3;
                double angle = (i / 3 % ANGLES) * 9.9 * DEGREE;
                double got = (double)analytic_pixel(&image, i / 3, 0)[c];
                double complex ratio = CMPLX(eta[m][c], k[m][c]) / index;
                analytic_expect(a, got, conductor(ratio, angle), 3, "metal %d, channel %d, %.1f°",
                                m, c, angle / DEGREE);
                if (angle == 0 && !wet)
                    analytic_require(a, fabs(got - printed[m][c]) < 2e-4,
                                     "metal %d at 0°: %.5f, printed %.4f", m, got, printed[m][c]);
            }
        }
        turner_image_destroy(&image);
        turner_scene_destroy(scene);
    }
}

/* A metal given by its reflectance: k_r + (1 − k_r)(1 − c)⁵. And a plain mirror: k_r. */
void check_mirror_schlick(struct analytic *a)
{
    enum { COUNT = 16 };
    struct turner_scene *scene = facet_scene(2 * COUNT, 1);
    struct turner_material metal = analytic_plain();
    metal.k_r = V3(.9, .3, 0);
    uint32_t plain = analytic_add_material(scene, metal);
    metal.fresnel = TURNER_FRESNEL_SCHLICK;
    uint32_t bright = analytic_add_material(scene, metal);
    for (int i = 0; i < 2 * COUNT; i++)
        analytic_add_facet(scene, i, i / 2 * 5.9 * DEGREE, false, i % 2 ? plain : bright);
    struct turner_image image;
    if (analytic_render(a, &image, scene)) {
        for (int i = 0; i < 2 * COUNT; i++) {
            double rise = i % 2 ? 0 : pow(1 - cos(i / 2 * 5.9 * DEGREE), 5);
            for (int c = 0; c < 3; c++) {
                double r0 = (double[]){.9, .3, 0}[c];
                analytic_expect(a, (double)analytic_pixel(&image, i, 0)[c], r0 + (1 - r0) * rise,
                                5, "mirror at %.1f°, channel %d", i / 2 * 5.9, c);
            }
        }
    }
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
}
