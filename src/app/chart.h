/* turner chart: a grid of settings, each timed and compared with the truth.
 *
 * The parts, in the order they work: grid (which points), measure (times and pictures, kept in the
 * chart's folder), truth (reference pictures, kept in a cache), error (points against truth), front
 * (what is best), report (files for people and programs). */
#ifndef TURNER_APP_CHART_H
#define TURNER_APP_CHART_H

#include <limits.h>

#include "base/result.h"
#include "image/image.h"
#include "scene/methods.h"
#include "scene/scene.h"

#define TURNER_CHART_MAX_POINTS 1000
#define TURNER_CHART_MAX_METHODS 32
#define TURNER_CHART_MIN_RUNS 5
#define TURNER_CHART_MAX_RUNS 101

enum turner_chart_metric {
    TURNER_CHART_RMSE,
    TURNER_CHART_RELATIVE_MSE,
    TURNER_CHART_LARGEST,
    TURNER_CHART_FLIP,
    TURNER_CHART_METRICS
};

/* What a picture is compared with, and so what counts as its error. */
enum turner_chart_against {
    TURNER_CHART_PIXEL,     /* the mean over each pixel's square: everything counts */
    TURNER_CHART_SAMPLES,   /* the same sample positions: all but anti-aliasing counts */
    TURNER_CHART_ARITHMETIC /* the same positions, depth, cutoff and Fresnel: rounding counts */
};

struct turner_chart_point {
    struct turner_settings settings;
    char label[256]; /* "aa=4 depth=2": the samples, and what differs from the scene */
    char name[20];   /* of its files */
    int departures;  /* methods in which it leaves the scene */
    /* measured */
    double seconds[TURNER_CHART_MAX_RUNS]; /* of tracing, one a run */
    int runs;
    double seconds_first; /* of the run before those, in which the driver compiles */
    double seconds_build, seconds_compile, seconds_upload;
    double rays;          /* of one run, all kinds */
    double kernel_words;
    uint64_t picture_hash;
    char traversal[16];
    char left_out[512];   /* why there is nothing of the above; "" otherwise */
    /* derived */
    double quartiles[3];  /* of seconds */
    double errors[TURNER_CHART_METRICS]; /* NAN: not known */
    int largest_x, largest_y; /* where the largest error is, or −1 */
    double nonfinite;     /* pixels; when there are any, no error is known */
    bool twin[TURNER_CHART_METRICS];  /* of a plainer point, see below */
    bool front[TURNER_CHART_METRICS];
};

struct turner_chart {
    struct turner_scene *scene; /* its settings are those that a point does not choose */
    uint64_t scene_hash;
    const char *folder, *cache;
    enum turner_chart_against against;
    int runs, reference_spp;
    bool metrics[TURNER_CHART_METRICS]; /* those that are charted */
    bool quiet;
    struct turner_render_options render;

    struct turner_chart_point *points;
    size_t point_count, point_capacity;

    char device[256], driver[512], cpu[128];
    int threads;            /* that the device (software) or the reference has */
    double seconds_kernels; /* compiling shaders, for all points together */
    size_t reused_runs;     /* that an earlier chart left in the folder */

    /* how far the truth is from itself; NAN where that is not known */
    double truth_errors[TURNER_CHART_METRICS];
    double truth_rms;       /* of its values */
    double truth_pruned;    /* weight that it left out, mean over pixels */
    int truth_depth;
    double truth_cutoff;
    size_t truths_made, truths_cached;
    char flip_missing[512]; /* why there is no FLIP; "" otherwise */
};

const char *turner_chart_metric_name(enum turner_chart_metric metric);  /* "relative_mse" */
const char *turner_chart_metric_title(enum turner_chart_metric metric); /* "relative MSE" */
const char *turner_chart_against_name(enum turner_chart_against against);

/* ---- grid (chart_grid.c, chart_default.c) ---- */

/* Adds the points of a grid file's text to a chart whose scene is set; each once. TURNER_BAD_INPUT
 * with file, line, column and what to do. */
enum turner_result turner_chart_read_grid(struct turner_chart *chart, const char *text,
                                          size_t length, const char *path);

/* The text of the grid for this scene when there is no file; free it. */
char *turner_chart_default_grid(const struct turner_scene *scene);

/* ---- measure (chart_measure.c, chart_store.c) ---- */

/* Draws every point `runs` times; what an earlier run of the same build, scene, device and settings
 * left in the folder counts. Points that the device cannot draw are left out. */
enum turner_result turner_chart_measure(struct turner_chart *chart);

/* What has to agree for times to be used again; all but the settings. */
struct turner_chart_identity {
    const char *device, *driver;
    int threads;
    uint64_t build, kernel, scene;
};

/* Names the files of a point after the identity and its settings. */
void turner_chart_point_name(struct turner_chart_point *point, const struct turner_chart *chart,
                             const struct turner_chart_identity *identity);

/* Fills what was measured if it was kept, is whole and has the identity; otherwise runs = 0. */
void turner_chart_point_load(struct turner_chart_point *point, const struct turner_chart *chart,
                             const struct turner_chart_identity *identity);
enum turner_result turner_chart_point_save(const struct turner_chart_point *point,
                                           const struct turner_chart *chart,
                                           const struct turner_chart_identity *identity);

/* The picture of a point, and the number by which it is known to be whole. */
enum turner_result turner_chart_picture_write(struct turner_chart_point *point,
                                              const struct turner_chart *chart,
                                              const struct turner_image *picture);
enum turner_result turner_chart_picture_read(struct turner_image *picture,
                                             const struct turner_chart *chart,
                                             const struct turner_chart_point *point);

/* ---- truth (chart_truth.c, chart_cache.c) ---- */

/* A reference picture of the scene with these settings, from the cache if it is there and whole,
 * else traced and put there. `pruned` is the mean weight that was cut off. `what` is shown beside
 * the progress bar. The caller destroys the picture, also after a failure. */
enum turner_result turner_chart_reference(struct turner_image *picture, double *pruned,
                                          struct turner_chart *chart,
                                          const struct turner_settings *settings,
                                          uint32_t pattern, const char *what);

/* The truths of a chart; the first is that of the whole pixel, or there is one for each choice of
 * sample positions (and depth and so on) among the points. */
struct turner_chart_truth {
    struct turner_settings settings;
    struct turner_image picture;
};

struct turner_chart_truths {
    struct turner_chart_truth *items;
    size_t count, capacity;
    struct turner_image half; /* an independent half of the first, or nothing */
};

enum turner_result turner_chart_truths_create(struct turner_chart_truths *truths,
                                              struct turner_chart *chart);
void turner_chart_truths_destroy(struct turner_chart_truths *truths);

/* The one that a point is compared with. */
const struct turner_image *turner_chart_truth_of(const struct turner_chart_truths *truths,
                                                 const struct turner_chart *chart,
                                                 const struct turner_chart_point *point);

/* ---- error (chart_error.c) ---- */

/* Fills the errors of all points and of the truth itself. Where FLIP is wanted and cannot be had it
 * is taken out of the metrics, and the reason is left in the chart. */
enum turner_result turner_chart_compare(struct turner_chart *chart,
                                        const struct turner_chart_truths *truths);

/* ---- front (chart_front.c): only points with runs and a finite error count, and no twins ---- */

/* First quartile, median and third, with linear interpolation between runs. */
void turner_chart_quartiles(double quartiles[3], const double *seconds, int count);

/* Marks twins: points that cannot be told from one with fewer departures, whose quartiles are not
 * all above theirs and whose error is at most 1 % more. What wins by chance is no advice. */
void turner_chart_mark_twins(struct turner_chart_point *points, size_t count,
                             enum turner_chart_metric metric);

/* Marks the points that no other beats in both time and error (or equals in one and beats in the
 * other); of points equal in both, the first. */
void turner_chart_mark_front(struct turner_chart_point *points, size_t count,
                             enum turner_chart_metric metric);

#define TURNER_CHART_NO_POINT SIZE_MAX

/* The point of least error within `seconds`; the quickest within `error`. Ties go to the better in
 * the other, then to the first. */
size_t turner_chart_best_error(const struct turner_chart_point *points, size_t count,
                               enum turner_chart_metric metric, double seconds);
size_t turner_chart_least_time(const struct turner_chart_point *points, size_t count,
                               enum turner_chart_metric metric, double error);

#define TURNER_CHART_MAX_LIMITS 64

/* Is it in the units of radiance, where one step of 8 bits is 1/255? */
bool turner_chart_has_8_bits(enum turner_chart_metric metric);

/* The round limits (1, 2 and 5 times powers of ten) for a table of answers, rising for times,
 * falling for errors: of those with the same answer the tightest, and 1/255. Returns how many. */
size_t turner_chart_time_limits(double limits[TURNER_CHART_MAX_LIMITS],
                                const struct turner_chart_point *points, size_t count,
                                enum turner_chart_metric metric);
size_t turner_chart_error_limits(double limits[TURNER_CHART_MAX_LIMITS],
                                 const struct turner_chart_point *points, size_t count,
                                 enum turner_chart_metric metric);

/* ---- report (chart_report.c, chart_text.c) ---- */

/* chart.csv and chart.json in the folder. */
enum turner_result turner_chart_write_data(const struct turner_chart *chart);

/* Tables and caption as Markdown into chart.md, and the same for a terminal on stdout. */
enum turner_result turner_chart_write_text(const struct turner_chart *chart);

/* ---- files (chart_file.c) ---- */

/* "folder/name". TURNER_USAGE when that is too long. */
enum turner_result turner_chart_path(char path[PATH_MAX], const char *folder, const char *name);

/* The folder, with those above it. TURNER_OUTPUT. */
enum turner_result turner_chart_make_folder(const char *folder);

/* A whole file as text that ends with 0; free it. TURNER_BAD_INPUT, also when it is larger than
 * 16 MiB. */
enum turner_result turner_chart_read_file(char **text, size_t *length, const char *path);

/* The colours of a picture, as a number (base/hash.h). */
uint64_t turner_chart_picture_hash(const struct turner_image *picture);

#endif
