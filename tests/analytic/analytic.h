/* Checks of pictures against closed forms and published numbers, for any renderer of the model.
 *
 * A check builds small scenes, has them rendered, and compares pixels with a number from a formula
 * of its own, in double. The scenes are chosen so that the formula is exact at every pixel centre:
 * what is left is the rounding of the renderer, which the check's two tolerances state. */
#ifndef TURNER_TESTS_ANALYTIC_H
#define TURNER_TESTS_ANALYTIC_H

#include "base/memory.h"
#include "image/image.h"
#include "scene/scene.h"

typedef enum turner_result (*analytic_renderer)(struct turner_image *image,
                                                const struct turner_scene *scene);

enum analytic_precision {
    ANALYTIC_EXTENDED, /* only the picture itself is in 32-bit float */
    ANALYTIC_SINGLE    /* all is in 32-bit float: scene, rays, shading */
};

struct analytic;

struct analytic_check {
    const char *name;
    void (*run)(struct analytic *a);
    /* Largest difference at conditioning 1 (see analytic_expect), in units of radiance. */
    double extended, single;
};

/* Runs every check (those whose name contains `filter`, if it is not NULL); prints a line for each
 * with its worst error. The number of checks that failed. */
int analytic_run(analytic_renderer render, enum analytic_precision precision, const char *filter);

/* ---- inside a check ---- */

/* Renders; on failure of the renderer the check has failed and `image` is empty. */
bool analytic_render(struct analytic *a, struct turner_image *image,
                     const struct turner_scene *scene);

/* |got − want| ≤ tolerance · conditioning, or the check has failed; not-a-number always fails.
 * `conditioning` says how strongly the value reacts to rounding where it was measured: 1 for a
 * value that passes on an error of its inputs as it is. */
void analytic_expect(struct analytic *a, double got, double want, double conditioning,
                     const char *format, ...) TURNER_PRINTF(5, 6);

/* A plain condition. */
void analytic_require(struct analytic *a, bool condition, const char *format, ...)
    TURNER_PRINTF(3, 4);

const float *analytic_pixel(const struct turner_image *image, int x, int y);

/* ---- scenes ---- */

#define PI 3.14159265358979323846
#define V3(x, y, z) turner_vec3_of((x), (y), (z))
#define GREY(v) turner_vec3_of((v), (v), (v))

/* A picture of that size seen from the origin along −z with +y up, `spacing` between pixels at
 * distance 1; cutoff 0, black background, no lights. */
struct turner_scene *analytic_scene(int width, int height, double spacing, int depth);

void analytic_look(struct turner_scene *scene, struct turner_vec3 from, struct turner_vec3 at,
                   struct turner_vec3 up);

/* The unit direction through the centre of pixel (x, y). */
struct turner_vec3 analytic_direction(const struct turner_scene *scene, int x, int y);

/* A black material without secondary rays, to be changed and added. */
struct turner_material analytic_plain(void);
/* One that lets everything through into `medium`, bent but not weakened. */
struct turner_material analytic_clear(uint32_t medium);
/* One with k_r = (1, 0, 1), k_t = (0, 1, 1): a white surrounding then shows (F, 1 − F, 1). */
struct turner_material analytic_split(uint32_t medium, enum turner_fresnel fresnel);

uint32_t analytic_add_material(struct turner_scene *scene, struct turner_material material);
uint32_t analytic_add_lamp(struct turner_scene *scene, struct turner_vec3 k_e);
/* Media must be added in rising order of priority. */
uint32_t analytic_add_medium(struct turner_scene *scene, double index,
                             struct turner_vec3 absorption, int priority);
void analytic_add_sphere(struct turner_scene *scene, struct turner_vec3 center, double radius,
                         uint32_t material);
void analytic_add_plane(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, struct turner_vec3 tangent, uint32_t material);
void analytic_add_box(struct turner_scene *scene, struct turner_vec3 low, struct turner_vec3 high,
                      uint32_t material);
void analytic_add_cone(struct turner_scene *scene, struct turner_cone cone);
/* Two triangles a, b, c and a, c, d, counter-clockwise from outside. */
void analytic_add_quad(struct turner_scene *scene, const struct turner_vec3 corners[4],
                       uint32_t material);
void analytic_add_light(struct turner_scene *scene, struct turner_light light);

/* For a picture of one row: a triangle across the ray of pixel x, four units away, whose normal
 * makes `angle` with the way back to the eye. It is tilted about the horizontal, so that all rays
 * stay in the pixel's own vertical plane and meet no other facet. With `behind` the eye looks at
 * its inside. */
void analytic_add_facet(struct turner_scene *scene, int x, double angle, bool behind,
                        uint32_t material);

/* For a picture of one row: a small triangle around the ray of pixel x, four units away, with that
 * unit normal. */
void analytic_add_tile(struct turner_scene *scene, int x, struct turner_vec3 normal,
                       uint32_t material);

/* A wall that shows where it was met: a plane whose radiance is ((u + reach)/2reach,
 * (v + reach)/2reach, 0) at |u|, |v| < reach metres from `point` along `tangent` and
 * normal × tangent. */
void analytic_add_ruler(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, struct turner_vec3 tangent, double reach);
/* What a pixel says of u (channel 0) or v (1). */
double analytic_ruler(const float *pixel, int channel, double reach);

/* Makes the background (d·up + 1)/2. */
void analytic_compass(struct turner_scene *scene, struct turner_vec3 up);

/* ---- formulas ---- */

/* Share of unpolarised light reflected at angle `i` (radians), by Fresnel's sine and tangent laws;
 * 1 past the critical angle. */
double analytic_fresnel(double n1, double n2, double i);
/* The angle behind the interface; not-a-number past the critical angle. */
double analytic_snell(double n1, double n2, double i);

#endif
