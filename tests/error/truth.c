#include "truth.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "image/image.h"
#include "reference/trace.h"

#define GRID 16       /* squares across a pixel that are looked at first */
#define LEVEL_GRID 4
#define LEVEL_MOST 9
#define THREADS_MOST 16
#define FAINT_GRID 4      /* samples across a pixel that tell what fainter rays bring, at first */
#define FAINT_GRID_MOST 16
#define FAINT_STEP 16     /* from one cutoff to the next */
#define FAINT_CUT 2       /* tolerances, that what is cut at last may weigh */
#define FAINT_LEAST 1e-9

struct job {
    const struct turner_scene *scene;
    const struct turner_world *world;
    struct truth *truth;
    double tolerance;
    atomic_int next_row;
};

struct worker {
    struct job *job;
    struct turner_tracer tracer;
    turner_vector u, v, w;
    turner_real spacing;
    double samples, cut; /* sums, of all pixels; `cut`: of their mean weights that were cut */
};

static turner_vector trace_at(struct worker *worker, struct turner_tracer *tracer, double px,
                              double py)
{
    const struct turner_settings *s = &worker->job->scene->settings;
    turner_real x = ((turner_real)px - s->width / 2.0L) * worker->spacing;
    turner_real y = (s->height / 2.0L - (turner_real)py) * worker->spacing;
    turner_vector d = normalize(
        sub(add(scale(worker->u, x), scale(worker->v, y)), worker->w));
    return turner_trace_camera(tracer, widen(worker->job->scene->camera.from), d);
}

static turner_vector sample(struct worker *worker, double px, double py)
{
    worker->samples++;
    return trace_at(worker, &worker->tracer, px, py);
}

static turner_real difference(turner_vector a, turner_vector b)
{
    return fmaxl(fabsl(a.x - b.x), fmaxl(fabsl(a.y - b.y), fabsl(a.z - b.z)));
}

struct rectangle {
    double x, y, width, height;
};

/* From 0 to 1, and nobody knows where. */
static double scatter(double x, double y, double z)
{
    double mixed = sin(x * 12.9898 + y * 78.233 + z * 37.719) * 43758.5453;
    return mixed - floor(mixed);
}

/* Between 0.4 and 0.6: squares that all divide in the middle would all meet a straight edge in the
 * same way, and be wrong in the same way. */
static double near_middle(const struct rectangle *r)
{
    return 0.4 + 0.2 * scatter(r->x, r->y, r->width);
}

/* The integral over a rectangle that is the result of so many divisions, given its corners and its
 * centre. */
static turner_vector integral(struct worker *worker, struct rectangle r, int level,
                              const turner_vector corner[4], turner_vector center)
{
    double area = r.width * r.height;
    turner_vector mean =
        scale(add(add(corner[0], corner[1]), add(corner[2], corner[3])), 0.25L);
    bool fine = level >= LEVEL_MOST ||
                difference(mean, center) * area <= worker->job->tolerance;
    /* corners that cancel are no reason to stop early */
    for (int i = 0; i < 4 && level < LEVEL_GRID + 2; i++)
        fine = fine && difference(corner[i], center) * area <= 4 * worker->job->tolerance;
    if (fine)
        return scale(add(scale(center, 2.0L / 3), scale(mean, 1.0L / 3)), area);
    double u = near_middle(&r), x[3] = {r.x, r.x + u * r.width, r.x + r.width};
    double v = 1 - u, y[3] = {r.y, r.y + v * r.height, r.y + r.height};
    const turner_vector at[3][3] = {
        {corner[0], sample(worker, x[1], y[0]), corner[1]},
        {sample(worker, x[0], y[1]), sample(worker, x[1], y[1]), sample(worker, x[2], y[1])},
        {corner[2], sample(worker, x[1], y[2]), corner[3]}};
    turner_vector sum = grey(0);
    for (int i = 0; i < 4; i++) {
        int column = i & 1, row = i >> 1;
        const turner_vector corners[4] = {at[row][column], at[row][column + 1],
                                          at[row + 1][column], at[row + 1][column + 1]};
        struct rectangle part = {x[column], y[row], x[column + 1] - x[column], y[row + 1] - y[row]};
        sum = add(sum, integral(worker, part, level + 1, corners,
                                sample(worker, part.x + part.width / 2,
                                       part.y + part.height / 2)));
    }
    return sum;
}

static turner_vector pixel(struct worker *worker, int px, int py)
{
    turner_vector corner[GRID + 1][GRID + 1], sum = grey(0);
    for (int y = 0; y <= GRID; y++) {
        for (int x = 0; x <= GRID; x++)
            corner[y][x] = sample(worker, px + (double)x / GRID, py + (double)y / GRID);
    }
    for (int i = 0; i < GRID * GRID; i++) {
        int x = i % GRID, y = i / GRID;
        const turner_vector corners[4] = {corner[y][x], corner[y][x + 1], corner[y + 1][x],
                                          corner[y + 1][x + 1]};
        struct rectangle part = {px + (double)x / GRID, py + (double)y / GRID, 1.0 / GRID,
                                 1.0 / GRID};
        sum = add(sum, integral(worker, part, LEVEL_GRID, corners,
                                sample(worker, part.x + part.width / 2,
                                       part.y + part.height / 2)));
    }
    return sum;
}

/* ---- rays fainter than the cutoff ---- */

/* What rays from one cutoff to a lower one bring to a pixel. */
struct faint {
    turner_vector mean;
    double error;     /* of it, a standard deviation */
    double cut[2];    /* mean weight that each cutoff cuts */
};

/* By a jittered grid of samples, each traced with both cutoffs. The variance within a square of the
 * grid is taken as half the mean square of what neighbours differ by, which is not too little. */
static struct faint faint_rays(struct worker *worker, int px, int py, int grid,
                               const double cutoffs[2])
{
    const struct job *job = worker->job;
    struct turner_scene scenes[2] = {*job->scene, *job->scene};
    struct turner_world worlds[2] = {*job->world, *job->world};
    struct turner_tracer tracers[2] = {0};
    struct faint faint = {0};
    turner_vector above[FAINT_GRID_MOST], left = grey(0);
    double squares = 0, count = grid * grid;
    for (int k = 0; k < 2; k++) {
        scenes[k].settings.cutoff = cutoffs[k];
        worlds[k].scene = &scenes[k];
        tracers[k].world = &worlds[k];
    }
    for (int i = 0; i < grid * grid; i++) {
        int column = i % grid, row = i / grid;
        double x = px + (column + scatter(px + column, py + row, cutoffs[0])) / grid;
        double y = py + (row + scatter(px + column, py + row, cutoffs[1])) / grid;
        turner_vector more = sub(trace_at(worker, &tracers[1], x, y),
                                 trace_at(worker, &tracers[0], x, y));
        if (column > 0)
            squares += pow((double)difference(more, left), 2);
        if (row > 0)
            squares += pow((double)difference(more, above[column]), 2);
        left = above[column] = more;
        faint.mean = add(faint.mean, scale(more, 1 / (turner_real)count));
    }
    faint.error = sqrt(squares / (4.0 * grid * (grid - 1)) / count);
    for (int k = 0; k < 2; k++)
        faint.cut[k] = (double)tracers[k].pruned / count;
    return faint;
}

/* All of them, until what is still cut cannot matter or stays. Few samples do: what a step brings
 * is little, and much the same within the pixel. */
static turner_vector all_faint_rays(struct worker *worker, int px, int py)
{
    double tolerance = worker->job->tolerance;
    double cutoffs[2] = {TRUTH_CUTOFF, TRUTH_CUTOFF / FAINT_STEP};
    turner_vector sum = grey(0);
    struct faint faint;
    for (;;) {
        for (int grid = FAINT_GRID; grid <= FAINT_GRID_MOST; grid *= 2) {
            faint = faint_rays(worker, px, py, grid, cutoffs);
            if (faint.error <= tolerance)
                break;
        }
        sum = add(sum, faint.mean);
        if (faint.cut[1] <= FAINT_CUT * tolerance || faint.cut[1] > 0.5 * faint.cut[0] ||
            cutoffs[1] < FAINT_LEAST)
            break;
        cutoffs[0] = cutoffs[1];
        cutoffs[1] /= FAINT_STEP;
    }
    worker->cut += faint.cut[1];
    return sum;
}

static void *work(void *argument)
{
    struct worker *worker = argument;
    struct truth *truth = worker->job->truth;
    for (int y; (y = atomic_fetch_add(&worker->job->next_row, 1)) < truth->height;) {
        for (int x = 0; x < truth->width; x++) {
            int first = truth->every / 2;
            int px = x * truth->every + first, py = y * truth->every + first;
            turner_vector value = add(pixel(worker, px, py), all_faint_rays(worker, px, py));
            double *to = truth->radiance[(size_t)y * (size_t)truth->width + (size_t)x];
            to[0] = (double)value.x;
            to[1] = (double)value.y;
            to[2] = (double)value.z;
        }
    }
    return NULL;
}

static void trace(struct truth *truth, const struct turner_scene *scene,
                  const struct turner_world *world, double tolerance)
{
    struct job job = {.scene = scene, .world = world, .truth = truth, .tolerance = tolerance};
    const struct turner_camera *camera = &scene->camera;
    int rows = scene->settings.height - (scene->settings.spd_grid ? 2 : 0);
    struct worker workers[THREADS_MOST] = {0};
    pthread_t threads[THREADS_MOST];
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    int count = cores < 1 ? 1 : cores > THREADS_MOST ? THREADS_MOST : (int)cores;
    double cut = 0, samples = 0;
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, (size_t)16 << 20);
    for (int i = 0; i < count; i++) {
        struct worker *worker = &workers[i];
        worker->job = &job;
        worker->tracer.world = world;
        worker->w = normalize(sub(widen(camera->from), widen(camera->at)));
        worker->u = normalize(cross(widen(camera->up), worker->w));
        worker->v = cross(worker->w, worker->u);
        worker->spacing = 2 * tanl((turner_real)camera->vfov / 2) / rows;
        if (pthread_create(&threads[i], &attributes, work, worker)) {
            fprintf(stderr, "cannot start a thread\n");
            exit(1);
        }
    }
    for (int i = 0; i < count; i++) {
        pthread_join(threads[i], NULL);
        cut += workers[i].cut;
        samples += workers[i].samples;
    }
    pthread_attr_destroy(&attributes);
    truth->cut = cut / (truth->width * truth->height);
    truth->samples = samples / (truth->width * truth->height);
}

static enum turner_result read_cache(struct truth *truth, const char *path)
{
    struct turner_image image = {0};
    enum turner_result result = turner_image_read(&image, path, false);
    if (result == TURNER_OK && (image.width != truth->width || image.height != truth->height))
        result = turner_fail(TURNER_BAD_INPUT, "%s is not %d×%d pixels; give another name", path,
                             truth->width, truth->height);
    for (size_t i = 0;
         result == TURNER_OK && i < (size_t)truth->width * (size_t)truth->height; i++) {
        for (size_t c = 0; c < 3; c++)
            truth->radiance[i][c] = (double)image.rgba[4 * i + c];
    }
    turner_image_destroy(&image);
    return result;
}

static enum turner_result write_cache(const struct truth *truth, const char *path)
{
    static const struct turner_image_encoding encoding;
    struct turner_image image;
    enum turner_result result;
    TURNER_TRY_DONE(turner_image_create(&image, truth->width, truth->height));
    for (size_t i = 0; i < (size_t)truth->width * (size_t)truth->height; i++) {
        for (size_t c = 0; c < 3; c++)
            image.rgba[4 * i + c] = (float)truth->radiance[i][c];
    }
    result = turner_image_write(&image, path, &encoding);
done:
    turner_image_destroy(&image);
    return result;
}

enum turner_result truth_create(struct truth *truth, const struct turner_scene *scene, int every,
                                double tolerance, const char *cache)
{
    struct turner_scene deep = *scene;
    deep.settings.depth = TRUTH_DEPTH;
    deep.settings.cutoff = TRUTH_CUTOFF;
    struct turner_world world = {0};
    *truth = (struct truth){.width = scene->settings.width / every,
                            .height = scene->settings.height / every,
                            .every = every};
    truth->radiance =
        turner_calloc((size_t)truth->width * (size_t)truth->height, sizeof *truth->radiance);
    if (cache && access(cache, F_OK) == 0)
        return read_cache(truth, cache);
    enum turner_result result = turner_world_create(&world, &deep);
    if (result == TURNER_OK) {
        trace(truth, &deep, &world, tolerance);
        printf("truth of %s: %.1f samples a pixel, %.2g cut\n", scene->path ? scene->path : "",
               truth->samples, truth->cut);
        if (cache)
            result = write_cache(truth, cache);
    }
    turner_world_destroy(&world);
    return result;
}

void truth_destroy(struct truth *truth)
{
    free(truth->radiance);
    *truth = (struct truth){0};
}
