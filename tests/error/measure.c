/* How well the estimate of --error holds, against the truth of truth.h, and what it costs beside
 * fixed settings:
 *
 *   error_measure SCENE WIDTH HEIGHT ERROR [--truth FILE] [--every N] [--fixed] [--share S]
 *                 [--tight T] [--method NAME=VALUE] [--list FILE]
 *
 * --truth keeps the truth in a file (.exr) for the next time. --every looks at one pixel in N
 * across and down. --fixed looks for the smallest regular setting that is as close to the truth on
 * as many pixels, and says how long that takes. --list writes a line for each pixel looked at: x, y,
 * true error, estimate, samples, the picture's red, green and blue, the truth's. Prints one line
 * about the pixels looked at; exit status 1 when the estimate is a bound on less than the share S
 * of them (0.999), or more than T times (10) the true error, or the spacing of floats there, on the
 * median pixel. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/layers.h"
#include "render/renderer.h"
#include "scene/methods.h"
#include "truth.h"

#define SHARE 0.999
#define SPP_LEAST 4 /* of the grid of fixed settings */
#define TRUTH_TOLERANCE 0.0025 /* of the error asked for, that a square of the truth may be off by */

struct arguments {
    const char *scene, *truth, *method, *list;
    int width, height, every;
    double error, share, tight;
    bool fixed;
};

static void require(enum turner_result result)
{
    if (result == TURNER_OK)
        return;
    fprintf(stderr, "%s\n", turner_message());
    exit(result == TURNER_DEVICE ? 77 : 1);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The value that `share` of them do not exceed; sorts. */
static double quantile(double *values, size_t count, double share)
{
    qsort(values, count, sizeof *values, compare_doubles);
    size_t at = (size_t)ceil(share * (double)count);
    return values[at > 0 ? at - 1 : 0];
}

/* The picture's pixel that is the i-th of the truth. */
static size_t pixel_of(const struct truth *truth, const struct turner_image *image, size_t i)
{
    size_t every = (size_t)truth->every, width = (size_t)truth->width;
    return (i / width * every + every / 2) * (size_t)image->width + i % width * every + every / 2;
}

static double true_error(const struct truth *truth, const struct turner_image *image, size_t i)
{
    const float *pixel = image->rgba + 4 * pixel_of(truth, image, i);
    double worst = 0;
    for (int c = 0; c < 3; c++)
        worst = fmax(worst, fabs((double)pixel[c] - truth->radiance[i][c]));
    return worst;
}

/* Spacing of floats at the pixel's largest channel. */
static double resolution(const struct truth *truth, size_t i)
{
    const double *v = truth->radiance[i];
    double largest = fmax(v[0], fmax(v[1], v[2]));
    return ldexp(1, -23) * fmax(largest, 1e-30);
}

struct result {
    double bound, tightness; /* share of pixels; median of estimate / true error */
    double worst, most;      /* true error: largest, and that of 99.9 % */
    double estimate_mean, estimate_most, samples;
    size_t missed; /* estimates above what was asked for */
    double seconds;
};

static void list_pixel(FILE *list, const struct truth *truth, const struct turner_image *image,
                       const struct turner_layers *layers, size_t i)
{
    size_t at = pixel_of(truth, image, i), width = (size_t)image->width;
    const float *pixel = image->rgba + 4 * at;
    const double *true_pixel = truth->radiance[i];
    fprintf(list, "%zu %zu %.6g %.6g %u %.7g %.7g %.7g %.7g %.7g %.7g\n", at % width, at / width,
            true_error(truth, image, i), (double)layers->real[TURNER_LAYER_ERROR][at],
            (unsigned)layers->whole[TURNER_LAYER_SAMPLES][at], (double)pixel[0], (double)pixel[1],
            (double)pixel[2], true_pixel[0], true_pixel[1], true_pixel[2]);
}

static void write_list(const char *path, const struct truth *truth,
                       const struct turner_image *image, const struct turner_layers *layers)
{
    FILE *list = fopen(path, "w");
    for (size_t i = 0; list && i < (size_t)truth->width * (size_t)truth->height; i++)
        list_pixel(list, truth, image, layers, i);
    if (!list || fclose(list)) {
        perror(path);
        exit(1);
    }
}

static struct result measure(const struct turner_scene *scene, const struct truth *truth,
                             const char *list)
{
    struct turner_layers layers = {.wanted = 1u << TURNER_LAYER_ERROR | 1u << TURNER_LAYER_SAMPLES};
    const struct turner_render_options options = {.layers = &layers};
    struct turner_image image;
    struct turner_statistics statistics = {0};
    struct result r = {0};
    require(turner_render(&image, scene, &options, &statistics));
    size_t count = (size_t)truth->width * (size_t)truth->height, bounded = 0;
    double *errors = turner_calloc(count, sizeof *errors);
    double *ratios = turner_calloc(count, sizeof *ratios);
    for (size_t i = 0; i < count; i++) {
        size_t at = pixel_of(truth, &image, i);
        double estimate = (double)layers.real[TURNER_LAYER_ERROR][at];
        errors[i] = true_error(truth, &image, i);
        bounded += errors[i] <= estimate;
        ratios[i] = estimate / fmax(errors[i], resolution(truth, i));
        r.estimate_mean += estimate / (double)count;
        r.estimate_most = fmax(r.estimate_most, estimate);
        r.missed += estimate > scene->settings.error;
        r.samples += (double)layers.whole[TURNER_LAYER_SAMPLES][at] / (double)count;
    }
    if (list)
        write_list(list, truth, &image, &layers);
    r.bound = (double)bounded / (double)count;
    r.tightness = quantile(ratios, count, 0.5);
    r.most = quantile(errors, count, SHARE);
    r.worst = errors[count - 1];
    r.seconds = statistics.seconds_trace;
    free(errors);
    free(ratios);
    turner_layers_destroy(&layers);
    turner_image_destroy(&image);
    return r;
}

/* ---- beside fixed settings ---- */

struct fixed {
    int spp, depth;
    double cutoff, most, seconds;
    bool reached;
};

static struct fixed measure_fixed(const struct turner_scene *scene, const struct truth *truth,
                                  struct fixed fixed)
{
    struct turner_scene copy = *scene;
    struct turner_statistics statistics = {0};
    struct turner_image image;
    size_t count = (size_t)truth->width * (size_t)truth->height;
    double *errors = turner_calloc(count, sizeof *errors);
    copy.settings.error = copy.settings.aa_threshold = 0;
    copy.settings.spp = fixed.spp;
    copy.settings.depth = fixed.depth;
    copy.settings.cutoff = fixed.cutoff;
    if (fixed.spp == SPP_LEAST) { /* has the driver compile the kernel */
        require(turner_render(&image, &copy, NULL, &statistics));
        turner_image_destroy(&image);
    }
    require(turner_render(&image, &copy, NULL, &statistics));
    for (size_t i = 0; i < count; i++)
        errors[i] = true_error(truth, &image, i);
    fixed.most = quantile(errors, count, SHARE);
    fixed.seconds = statistics.seconds_trace;
    turner_image_destroy(&image);
    free(errors);
    return fixed;
}

/* The first setting of a grid, in the order of samples, that is off by no more than `most` on 99.9 %
 * of the pixels; gives up where one takes longer than `patience`. */
static struct fixed find_fixed(const struct turner_scene *scene, const struct truth *truth,
                               double most, double patience)
{
    static const struct {
        int depth;
        double cutoff;
    } ends[] = {{8, 1.0 / 512}, {64, 1e-4}};
    struct fixed fixed = {0};
    for (int spp = SPP_LEAST; spp <= TURNER_MAX_SPP && fixed.seconds <= patience; spp *= 4) {
        for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
            fixed.spp = spp;
            fixed.depth = ends[i].depth;
            fixed.cutoff = ends[i].cutoff;
            fixed = measure_fixed(scene, truth, fixed);
            fixed.reached = fixed.most <= most;
            if (fixed.reached)
                return fixed;
        }
    }
    return fixed;
}

int main(int argc, char **argv)
{
    struct arguments a = {.every = 1, .share = SHARE, .tight = 10};
    if (argc < 5) {
        fprintf(stderr, "usage: error_measure SCENE WIDTH HEIGHT ERROR [--truth FILE] [--fixed]\n");
        return 2;
    }
    a.scene = argv[1];
    a.width = atoi(argv[2]);
    a.height = atoi(argv[3]);
    a.error = atof(argv[4]);
    for (int i = 5; i < argc; i++) {
        if (strcmp(argv[i], "--truth") == 0 && i + 1 < argc)
            a.truth = argv[++i];
        else if (strcmp(argv[i], "--every") == 0 && i + 1 < argc)
            a.every = atoi(argv[++i]);
        else if (strcmp(argv[i], "--method") == 0 && i + 1 < argc)
            a.method = argv[++i];
        else if (strcmp(argv[i], "--share") == 0 && i + 1 < argc)
            a.share = atof(argv[++i]);
        else if (strcmp(argv[i], "--tight") == 0 && i + 1 < argc)
            a.tight = atof(argv[++i]);
        else if (strcmp(argv[i], "--list") == 0 && i + 1 < argc)
            a.list = argv[++i];
        else
            a.fixed = strcmp(argv[i], "--fixed") == 0;
    }
    struct turner_scene *scene;
    struct truth truth;
    require(turner_scene_load(&scene, a.scene));
    scene->settings.width = a.width;
    scene->settings.height = a.height;
    scene->settings.error = a.error;
    require(truth_create(&truth, scene, a.every, TRUTH_TOLERANCE * a.error, a.truth));
    if (a.method)
        require(turner_method_assign(&scene->settings, a.method));
    if (a.fixed)
        measure(scene, &truth, NULL); /* has the driver compile the kernel */
    struct result r = measure(scene, &truth, a.list);
    printf("%s: bound on %.2f %%, median estimate %.1f times the error; true error %.2g on 99.9 %%, "
           "%.2g at most; estimate %.2g on average, %.2g at most, %zu pixels missed; %.1f samples, "
           "%.2f s\n", a.scene, 100 * r.bound, r.tightness, r.most, r.worst, r.estimate_mean,
           r.estimate_most, r.missed, r.samples, r.seconds);
    if (a.fixed) {
        struct fixed f = find_fixed(scene, &truth, r.most, 1.5 * r.seconds);
        fflush(stdout);
        printf("    fixed: %s%d samples, depth %d, cutoff %.2g: 99.9 %% %.2e, %.2f s, %s\n",
               f.reached ? "" : "not reached by ", f.spp, f.depth, f.cutoff, f.most, f.seconds,
               f.seconds > r.seconds ? "slower" : "faster");
    }
    truth_destroy(&truth);
    turner_scene_destroy(scene);
    return r.bound >= a.share && r.tightness <= a.tight ? 0 : 1;
}
