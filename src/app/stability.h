/* The stability suite: every place where methods are known to fail, as a sweep over the parameter
 * that makes them, each method against the extended-precision reference. docs/stability.md.
 *
 * One file a subject defines its sweeps; stability.c is what they measure with,
 * stability_result.c judges, stability_write.c and stability_html.c report. */
#ifndef TURNER_APP_STABILITY_H
#define TURNER_APP_STABILITY_H

#include <math.h>

#include "image/image.h"
#include "reference/world.h"
#include "render/probe.h"
#include "scene/methods.h"

#define TURNER_UNMEASURED ((double)NAN)

struct turner_stability;
struct turner_sweep;

/* One line of a sweep: a way to compute, what is expected of it, and what is to be said of it. */
struct turner_sweep_method {
    const char *name;
    const char *assign;  /* "sphere=textbook depth=4", as turner_method_assign takes them */
    int variant;         /* what the sweep makes of it; 0 for the scene as it stands */
    double holds[2];     /* from where to where the error must stay within the bound */
    double fails;        /* where it must not: not-a-number for nowhere */
    const char *note;    /* why it fails and what to do, where a default does; or NULL */
};
#define TURNER_HOLDS .holds = {-INFINITY, INFINITY}, .fails = NAN
#define TURNER_HOLDS_TO(end) .holds = {-INFINITY, end}, .fails = NAN
#define TURNER_HOLDS_FROM(begin) .holds = {begin, INFINITY}, .fails = NAN
#define TURNER_HOLDS_TO_FAILS(end, at) .holds = {-INFINITY, end}, .fails = at
#define TURNER_HOLDS_FROM_FAILS(begin, at) .holds = {begin, INFINITY}, .fails = at
#define TURNER_FAILS(at) .holds = {INFINITY, -INFINITY}, .fails = at
#define TURNER_SHOWN .holds = {INFINITY, -INFINITY}, .fails = NAN /* nothing is expected */
#define TURNER_POVRAY "povray" /* name of a method: POV-Ray, where it is installed */

#define TURNER_SWEEP_METHODS 8
#define TURNER_SWEEP_VALUES 24

/* The error of one method at one value. What cannot be measured here (no POV-Ray, no ray queries,
 * no doubles) is not-a-number with TURNER_OK. */
typedef enum turner_result (*turner_sweep_measure)(double *error, struct turner_stability *s,
                                                   const struct turner_sweep *sweep, double value,
                                                   const struct turner_sweep_method *method);

/* The scene of a sweep of pictures; the settings' methods are put in by the suite. */
typedef struct turner_scene *(*turner_sweep_scene)(double value, int variant);

struct turner_sweep {
    const char *name, *section, *question;
    const char *parameter, *unit_of_error; /* what stands on the axes */
    double values[TURNER_SWEEP_VALUES];    /* ascending; ends with a NAN, or at the array's end */
    const char *const *labels;             /* cases in place of values: 0, 1, 2…; or NULL */
    struct turner_sweep_method methods[TURNER_SWEEP_METHODS]; /* the first is the default */
    turner_sweep_measure measure;
    turner_sweep_scene scene; /* of pictures: measure is turner_stability_picture */
    double tolerance;         /* of pictures: a pixel is wrong that is off by more in a channel, or
                                 by more than that share of one that is brighter than 1 */
    /* What float input allows at best; NULL: not drawn (pictures: the reference's picture of the
     * scene rounded to floats). */
    double (*limit)(double value);
    double (*bound)(double value, double limit); /* what counts as holding */
    const char *bound_words;                     /* the same for a reader */
    const char *published;                       /* figures from the literature; or NULL */
};

/* One list a subject; each ends with a name of NULL. */
extern const struct turner_sweep *const turner_sweeps_sphere, *const turner_sweeps_ground,
    *const turner_sweeps_leave, *const turner_sweeps_triangle, *const turner_sweeps_fresnel,
    *const turner_sweeps_phong, *const turner_sweeps_place, *const turner_sweeps_recursion,
    *const turner_sweeps_aa;

/* ---- what a sweep measures with ---- */
struct turner_stability {
    struct turner_gpu gpu;
    struct turner_kernel *kernels; /* compiled so far */
    size_t kernel_count, kernel_capacity;
    const char *povray; /* folder for POV-Ray's files; NULL: no POV-Ray */
    /* the last truth of a picture and the limit that goes with it */
    const struct turner_sweep *truth_sweep;
    double truth_value, truth_limit;
    int truth_variant;
    struct turner_image truth;
};

/* Opens the device (NULL: the best one). */
enum turner_result turner_stability_create(struct turner_stability *s, const char *device);
void turner_stability_destroy(struct turner_stability *s);

/* Sets the methods named in `assign` (may be NULL). */
enum turner_result turner_stability_assign(struct turner_scene *scene, const char *assign);

/* Traces probes through the scene with its settings; `kind` is TURNER_PROBE_HITS or …_RADIANCE.
 * False in *possible when the device lacks what the methods need. */
enum turner_result turner_stability_probe(struct turner_gpu_probe *probes, size_t count,
                                          struct turner_stability *s,
                                          const struct turner_scene *scene,
                                          enum turner_kernel_kind kind, bool *possible);

/* What the rays meet, against the reference. */
struct turner_stability_hits {
    double wrong;  /* share of rays with a hit for a miss or a miss for a hit */
    double mean_t; /* mean |t − truth| of the others that hit */
};
enum turner_result turner_stability_count_hits(struct turner_stability_hits *hits,
                                               struct turner_stability *s,
                                               const struct turner_scene *scene,
                                               struct turner_gpu_probe *probes, size_t count,
                                               bool *possible);

/* Draws the scene on the device. `statistics` may be NULL. */
enum turner_result turner_stability_draw(struct turner_image *image, struct turner_stability *s,
                                         const struct turner_scene *scene,
                                         struct turner_statistics *statistics, bool *possible);

/* Share of pixels of sweep->scene that are off the reference's by more than sweep->tolerance. */
enum turner_result turner_stability_picture(double *error, struct turner_stability *s,
                                            const struct turner_sweep *sweep, double value,
                                            const struct turner_sweep_method *method);

/* ---- stages: what scenes of sweeps are built of ---- */
#define TURNER_GREY(x) turner_vec3_of(x, x, x)
struct turner_scene *turner_stage_create(int size, struct turner_vec3 from, struct turner_vec3 at,
                                         double vfov);
uint32_t turner_stage_material(struct turner_scene *scene, struct turner_material material);
uint32_t turner_stage_lamp(struct turner_scene *scene, double k_e);
uint32_t turner_stage_glass(struct turner_scene *scene, double index, int priority,
                            struct turner_vec3 absorption, enum turner_fresnel fresnel);
void turner_stage_sphere(struct turner_scene *scene, struct turner_vec3 center, double radius,
                         uint32_t material);
void turner_stage_plane(struct turner_scene *scene, struct turner_vec3 point,
                        struct turner_vec3 normal, uint32_t material);
/* A mesh of zeros to be filled in; stays where it is until the next mesh comes. */
struct turner_mesh *turner_stage_mesh(struct turner_scene *scene, uint32_t vertices,
                                      uint32_t triangles, uint32_t material);
void turner_stage_light(struct turner_scene *scene, struct turner_light light);
/* All that is a place, a length or a direction, to the nearest float. */
void turner_stage_round(struct turner_scene *scene);

/* ---- numbers ---- */
double turner_stage_random(uint64_t *state); /* in [0,1) */
struct turner_vec3 turner_stage_direction(uint64_t *state); /* on the unit sphere */
struct turner_gpu_probe turner_stage_probe(struct turner_vec3 origin,
                                           struct turner_vec3 direction);
/* The ray as its floats are. */
struct turner_ray turner_stage_ray(const struct turner_gpu_probe *probe);
double turner_stage_t(const struct turner_gpu_probe *probe, int turn);

/* ---- results ---- */
struct turner_stability_cell {
    bool asked;   /* measured, or tried */
    double error; /* not-a-number: cannot be measured here */
    double bound, limit;
};

struct turner_stability_row {
    const struct turner_sweep *sweep;
    struct turner_stability_cell cells[TURNER_SWEEP_METHODS][TURNER_SWEEP_VALUES];
};

int turner_sweep_value_count(const struct turner_sweep *sweep);
int turner_sweep_method_count(const struct turner_sweep *sweep);
/* Value i as a number, and for a reader ("1e+05", or the case's name). */
double turner_sweep_value(const struct turner_sweep *sweep, int i);
void turner_sweep_value_text(char text[64], const struct turner_sweep *sweep, int i);

/* Measures one cell. */
enum turner_result turner_stability_measure(struct turner_stability_row *row, int method,
                                            int value, struct turner_stability *s);

/* Within the bound; not-a-number is not. */
bool turner_stability_holds(const struct turner_stability_cell *cell);

struct turner_stability_verdict {
    bool measured;
    bool expected;  /* it holds where it must and fails where it must */
    char text[256]; /* "holds", "fails at 1e5, 1e6", and what was expected when it is not so */
};
struct turner_stability_verdict turner_stability_judge(const struct turner_stability_row *row,
                                                       int method);

struct turner_stability_report {
    const struct turner_stability_row *rows;
    size_t count;
    const char *device, *driver;
};

/* Writes text as a file of the folder. TURNER_OUTPUT, as the next two. */
enum turner_result turner_stability_write_file(const char *folder, const char *name,
                                               const char *text);
/* Writes stability.csv and stability.json into `folder`. */
enum turner_result turner_stability_write(const struct turner_stability_report *report,
                                          const char *folder);
/* Writes index.html, which shows the pictures NAME.png that stand beside it. */
enum turner_result turner_stability_write_html(const struct turner_stability_report *report,
                                               const char *folder);

#endif
