/* turner bench: the same rays through every tracer there is, in turn (docs/performance.md). */
#ifndef TURNER_APP_BENCH_H
#define TURNER_APP_BENCH_H

#include <stdio.h>

#include "app/app.h"
#include "app/bench_embree.h"
#include "reference/world.h"
#include "render/rays.h"

#define TURNER_BENCH_TRACERS 12
#define TURNER_BENCH_ROUNDS 101

/* A scene of a file, or one of bench's own, "sphereflake:4" or "mesh:100000". Its settings are made
 * fit for measuring: one sample, opaque shadows, width × height; and it has a light. */
enum turner_result turner_bench_scene(struct turner_scene **scene, const char *name, int width,
                                      int height);

/* ---- streams of rays ---- */
enum turner_bench_kind {
    TURNER_BENCH_CAMERA,
    TURNER_BENCH_SHADOW,
    TURNER_BENCH_MIRROR1, /* from where the camera's rays end, 2 from where those end, … */
    TURNER_BENCH_MIRROR2,
    TURNER_BENCH_MIRROR3,
    TURNER_BENCH_RANDOM,  /* from where the camera's rays end, scattered by the cosine */
    TURNER_BENCH_KINDS
};

extern const char *const turner_bench_kind_names[TURNER_BENCH_KINDS + 1]; /* NULL at the end */

struct turner_bench_stream {
    struct turner_gpu_ray *rays; /* all of one kind */
    size_t count;                /* may be 0 */
    bool coherent;               /* neighbours go the same way */
};

/* ---- tracers ---- */
struct turner_bench_tracer {
    char name[64];                  /* "bvh", "ray_query", "embree", "embree robust", … */
    struct turner_kernel kernel;    /* turner's: */
    struct turner_renderer renderer;
    struct turner_embree_scene *embree; /* Embree's: */
    int width;                          /* rays at once, 1 or 8 */
    bool owns_embree;               /* destroys it; a tracer after it may share it */
};

/* What a tracer made of a stream. */
struct turner_bench_cell {
    int rounds;                            /* 0: not measured, and why: */
    char left_out[128];
    double seconds[TURNER_BENCH_ROUNDS];   /* of one pass */
    double rate, low, high; /* rays a second: median and quartiles */
    double ratio;           /* median over the rounds of the rate by that of "embree"; or NAN */
    size_t checked, wrong;  /* rays compared with the reference, and where it says otherwise; */
    size_t misnamed;        /* the distance is right, and the primitive another */
};

/* Building what a tracer walks, from the scene's arrays in memory. */
struct turner_bench_build {
    int rounds;                          /* 0: not measured */
    double seconds[TURNER_BENCH_ROUNDS];
    double median, low, high, ratio;     /* seconds; ratio of "embree"'s to it, as above */
    uint64_t bytes;                      /* that it takes, with the primitives */
};

struct turner_bench_scene {
    const char *name;
    size_t primitives, instances;
    struct turner_bench_build builds[TURNER_BENCH_TRACERS];
    size_t rays[TURNER_BENCH_KINDS];
    struct turner_bench_cell cells[TURNER_BENCH_KINDS][TURNER_BENCH_TRACERS];
};

#define TURNER_BENCH_STAGES 24

/* turner render on one scene, with empty [0] and full [1] caches. */
struct turner_bench_stages {
    const char *name;
    size_t count;
    char names[TURNER_BENCH_STAGES][24];
    double seconds[2][TURNER_BENCH_STAGES]; /* medians */
    double wall[2][3];                      /* of the whole process: quartiles */
};

struct turner_bench {
    /* settings */
    int width, height, rounds, threads;
    size_t check;             /* rays of each stream to check by the reference, at least */
    bool kinds[TURNER_BENCH_KINDS];
    bool processor_time;      /* rates by it, not by the clock on the wall */
    bool growth;              /* the scenes are one, in growing sizes */
    char *const *with;        /* shader folders to measure beside ours, up to a NULL */
    char *const *tracers;     /* names to measure, up to a NULL; NULL: all */
    const char *output;       /* folder, or NULL */
    const char *wanted;       /* device, or NULL */
    /* what it runs on */
    char device[256], driver[512], cpu[128], embree[64]; /* the last says why there is none */
    char names[TURNER_BENCH_TRACERS][64];
    size_t tracer_count;
    struct turner_bench_scene *scenes;  /* or */
    struct turner_bench_stages *stages;
    size_t scene_count;
    struct turner_progress_bar bar;
};

/* The place of a tracer in every list of them, new if need be; -1 when it is not to be measured. */
int turner_bench_slot(struct turner_bench *bench, const char *name);

/* Measures `name` into *scene with the device that is open; `done` and `share` say which part of
 * the progress bar this is. */
enum turner_result turner_bench_measure(struct turner_bench *bench,
                                        struct turner_bench_scene *scene, struct turner_gpu *gpu,
                                        struct turner_embree *embree, double done, double share);

/* The builders alone (bench_build.c). */
enum turner_result turner_bench_measure_builds(struct turner_bench *bench,
                                               struct turner_bench_scene *result,
                                               struct turner_gpu *gpu,
                                               struct turner_embree *embree,
                                               const struct turner_scene *scene);

/* bench->stages (bench_stages.c), and their tables. Not while a device is open. */
enum turner_result turner_bench_measure_stages(struct turner_bench *bench);
void turner_bench_print_stages(const struct turner_bench *bench);
void turner_bench_print_stages_csv(FILE *out, const struct turner_bench *bench);

/* Of n rounds: the median of yardstick's by one's own. */
double turner_bench_ratio(const double *yardstick, const double *own, int n);

/* ---- checks (bench_check.c) ---- */

/* Compares what tracers[0 … n − 1] say of a stream with the reference: on `check` rays spread
 * evenly, and wherever two of them disagree. Fills checked, wrong and misnamed of cells[0 … n − 1];
 * a tracer whose hits are NULL is passed over. */
void turner_bench_check(struct turner_bench_cell *cells, struct turner_gpu_hit *const *hits,
                        size_t n, const struct turner_bench_stream *stream,
                        const struct turner_world *world, size_t check);

/* Whether so few rays are wrong that the time counts. */
bool turner_bench_right(const struct turner_bench_cell *cell, size_t rays);

/* ---- results (bench_report.c) ---- */
void turner_bench_print(const struct turner_bench *bench);
/* With bench.growth: a + b·log₂ n through the times of a ray, by least squares. */
struct turner_bench_fit {
    double a, b;     /* nanoseconds, and for each doubling of n */
    double off;      /* largest distance of a size from it, as a share */
};
/* False when there are fewer than three sizes. */
bool turner_bench_fit_log(struct turner_bench_fit *fit, const struct turner_bench *bench,
                          size_t tracer, int kind);

/* bench.csv, bench.json and the pictures; not while a device is open. */
enum turner_result turner_bench_write(const struct turner_bench *bench);

#endif
