#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/bench.h"
#include "app/chart.h"
#include "base/memory.h"

#define LEAST_SECONDS 0.03 /* that a measurement takes: passes are added up to that */
#define LEAST_RAYS 1000    /* of a stream that says something about speed */

const char *const turner_bench_kind_names[] = {"camera",   "shadow",   "mirror 1", "mirror 2",
                                               "mirror 3", "random", NULL};

/* While one scene is measured. */
struct stage {
    struct turner_bench *bench;
    struct turner_bench_scene *result;
    struct turner_gpu *gpu;
    struct turner_embree *embree;
    struct turner_scene *scene;
    struct turner_world world;
    struct turner_bench_stream streams[TURNER_BENCH_KINDS];
    struct turner_bench_tracer tracers[TURNER_BENCH_TRACERS]; /* as many as bench->tracer_count */
    double done, share; /* of the progress bar */
};

/* ---- streams ---- */

static void keep(struct stage *stage, enum turner_bench_kind kind,
                 const struct turner_gpu_ray *rays, size_t count)
{
    struct turner_bench_stream *stream = &stage->streams[kind];
    stream->rays = turner_calloc(count + 1, sizeof *rays);
    memcpy(stream->rays, rays, count * sizeof *rays);
    stream->count = count;
    stream->coherent = kind == TURNER_BENCH_CAMERA || kind == TURNER_BENCH_SHADOW;
    stage->result->rays[kind] = count;
}

/* `from` the camera's rays, or a bounce's. */
static enum turner_result send(struct stage *stage, struct turner_renderer *renderer,
                               enum turner_bench_kind to, uint32_t what,
                               enum turner_bench_kind from)
{
    const struct turner_bench_stream *stream = &stage->streams[from];
    size_t count = what == TURNER_SEND_CAMERA
                       ? turner_camera_ray_count(stage->bench->width, stage->bench->height)
                       : stream->count;
    struct turner_gpu_ray *rays = turner_calloc(count + 1, sizeof *rays);
    if (what != TURNER_SEND_CAMERA)
        memcpy(rays, stream->rays, count * sizeof *rays);
    enum turner_result result = turner_rays_send(rays, &count, what, renderer);
    if (result == TURNER_OK)
        keep(stage, to, rays, count);
    free(rays);
    return result;
}

static enum turner_result send_all(struct stage *stage, struct turner_renderer *renderer)
{
    TURNER_TRY(send(stage, renderer, TURNER_BENCH_CAMERA, TURNER_SEND_CAMERA,
                    TURNER_BENCH_CAMERA));
    TURNER_TRY(send(stage, renderer, TURNER_BENCH_SHADOW, TURNER_SEND_SHADOW,
                    TURNER_BENCH_CAMERA));
    TURNER_TRY(send(stage, renderer, TURNER_BENCH_RANDOM, TURNER_SEND_RANDOM,
                    TURNER_BENCH_CAMERA));
    for (int bounce = 0; bounce < 3; bounce++)
        TURNER_TRY(send(stage, renderer, (enum turner_bench_kind)(TURNER_BENCH_MIRROR1 + bounce),
                        TURNER_SEND_MIRROR,
                        bounce ? (enum turner_bench_kind)(TURNER_BENCH_MIRROR1 + bounce - 1)
                               : TURNER_BENCH_CAMERA));
    return TURNER_OK;
}

static enum turner_result open_kernel(struct turner_kernel *kernel,
                                      struct turner_renderer *renderer, struct stage *stage,
                                      enum turner_traversal traversal, unsigned more,
                                      const char *with)
{
    const struct turner_render_options options = {.traversal = traversal,
                                                  .shader_dirs = &with,
                                                  .shader_dir_count = with != NULL,
                                                  .tile = TURNER_WORKGROUP};
    struct turner_statistics statistics = {0};
    unsigned kind;
    TURNER_TRY(turner_choose_kernel(&kind, &stage->gpu->info, &stage->scene->settings.methods,
                                    traversal));
    TURNER_TRY(turner_kernel_create_from(kernel, "rays.comp", kind | more, &options));
    return turner_renderer_create(renderer, stage->gpu, kernel, stage->scene, &options,
                                  &statistics);
}

static enum turner_result make_streams(struct stage *stage)
{
    struct turner_kernel kernel = {0};
    struct turner_renderer renderer = {0};
    enum turner_result result = open_kernel(&kernel, &renderer, stage, TURNER_TRAVERSAL_BVH,
                                            TURNER_RAYS_SEND, NULL);
    if (result == TURNER_OK)
        result = send_all(stage, &renderer);
    turner_renderer_destroy(&renderer);
    turner_kernel_destroy(&kernel);
    return result;
}

/* ---- tracers ---- */

static bool wanted(const struct turner_bench *bench, const char *name)
{
    for (char *const *tracer = bench->tracers; tracer; tracer++) {
        if (!*tracer)
            return false;
        if (strcmp(*tracer, name) == 0)
            break;
    }
    return true;
}

int turner_bench_slot(struct turner_bench *bench, const char *name)
{
    size_t i = 0;
    if (!wanted(bench, name))
        return -1;
    while (i < bench->tracer_count && strcmp(bench->names[i], name) != 0)
        i++;
    if (i == TURNER_BENCH_TRACERS)
        return -1;
    if (i == bench->tracer_count)
        snprintf(bench->names[bench->tracer_count++], sizeof *bench->names, "%s", name);
    return (int)i;
}

/* In the order of columns; those that are not there leave theirs empty. */
static void make_slots(struct turner_bench *bench)
{
    static const char *const rest[] = {"ray_query", "embree", "embree 8", "embree robust"};
    char name[64];
    turner_bench_slot(bench, "bvh");
    for (char *const *with = bench->with; with && *with; with++) {
        snprintf(name, sizeof name, "bvh %.58s", *with);
        turner_bench_slot(bench, name);
    }
    for (size_t i = 0; i < sizeof rest / sizeof *rest; i++)
        turner_bench_slot(bench, rest[i]);
}

static struct turner_bench_tracer *place(struct stage *stage, const char *name)
{
    int slot = turner_bench_slot(stage->bench, name);
    return slot < 0 ? NULL : &stage->tracers[slot];
}

static enum turner_result add_own(struct stage *stage, const char *name,
                                  enum turner_traversal traversal, const char *with)
{
    struct turner_bench_tracer *tracer = place(stage, name);
    return tracer ? open_kernel(&tracer->kernel, &tracer->renderer, stage, traversal, 0, with)
                  : TURNER_OK;
}

static enum turner_result add_embree(struct stage *stage)
{
    struct turner_bench_tracer *one = place(stage, "embree"), *eight = place(stage, "embree 8"),
                               *robust = place(stage, "embree robust");
    double seconds;
    if (!stage->embree || !turner_embree_can(stage->scene))
        return TURNER_OK;
    struct turner_bench_tracer *plain = one ? one : eight;
    if (plain) {
        TURNER_TRY(turner_embree_scene_create(&plain->embree, stage->embree, stage->scene, false,
                                              &seconds));
        plain->owns_embree = true;
    }
    if (one)
        one->width = 1;
    if (eight) {
        eight->embree = plain->embree;
        eight->width = 8;
    }
    if (robust) {
        TURNER_TRY(turner_embree_scene_create(&robust->embree, stage->embree, stage->scene, true,
                                              &seconds));
        robust->owns_embree = true;
        robust->width = 1;
    }
    return TURNER_OK;
}

static enum turner_result open_tracers(struct stage *stage)
{
    char name[64];
    TURNER_TRY(add_own(stage, "bvh", TURNER_TRAVERSAL_BVH, NULL));
    for (char *const *with = stage->bench->with; with && *with; with++) {
        snprintf(name, sizeof name, "bvh %.58s", *with);
        TURNER_TRY(add_own(stage, name, TURNER_TRAVERSAL_BVH, *with));
    }
    if (stage->gpu->info.ray_query &&
        stage->scene->settings.methods.precision == TURNER_PRECISION_F32)
        TURNER_TRY(add_own(stage, "ray_query", TURNER_TRAVERSAL_RAY_QUERY, NULL));
    return add_embree(stage);
}

static bool present(const struct turner_bench_tracer *tracer)
{
    return tracer->embree || tracer->renderer.gpu;
}

/* Of all threads of the process, the share of one. */
static double processor_seconds(const struct turner_bench *bench)
{
    struct timespec used;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return ((double)used.tv_sec + 1e-9 * (double)used.tv_nsec) / bench->threads;
}

static enum turner_result trace(double *seconds, struct turner_gpu_hit *hits,
                                const struct stage *stage, struct turner_bench_tracer *tracer,
                                struct turner_ray_list *list,
                                const struct turner_bench_stream *stream, int passes)
{
    double start = processor_seconds(stage->bench);
    enum turner_result result =
        tracer->embree ? turner_embree_trace(seconds, hits, tracer->embree, stream->rays,
                                             stream->count, passes, tracer->width,
                                             stream->coherent)
                       : turner_ray_list_trace(seconds, list, passes, &tracer->renderer);
    if (stage->bench->processor_time)
        *seconds = processor_seconds(stage->bench) - start;
    return result;
}

/* ---- one stream ---- */

double turner_bench_ratio(const double *yardstick, const double *own, int n)
{
    double ratios[TURNER_BENCH_ROUNDS], quartiles[3];
    for (int i = 0; i < n; i++)
        ratios[i] = yardstick[i] / own[i];
    turner_chart_quartiles(quartiles, ratios, n);
    return quartiles[1];
}

static void sum_up(struct turner_bench_cell *cell, const struct turner_bench_cell *yardstick,
                   size_t rays)
{
    double quartiles[3];
    cell->ratio = NAN;
    if (!cell->rounds)
        return;
    turner_chart_quartiles(quartiles, cell->seconds, cell->rounds);
    cell->rate = (double)rays / quartiles[1];
    cell->low = (double)rays / quartiles[2];
    cell->high = (double)rays / quartiles[0];
    if (yardstick && yardstick->rounds)
        cell->ratio = turner_bench_ratio(yardstick->seconds, cell->seconds, cell->rounds);
}

/* The first pass compiles; what it finds is checked. Returns in passes[] how many to measure. */
static enum turner_result try_out(int *passes, struct stage *stage, enum turner_bench_kind kind,
                                  struct turner_ray_list *list, struct turner_gpu_hit **hits)
{
    const struct turner_bench_stream *stream = &stage->streams[kind];
    struct turner_bench_cell *cells = stage->result->cells[kind];
    size_t n = stage->bench->tracer_count;
    for (size_t i = 0; i < n; i++) {
        struct turner_bench_tracer *tracer = &stage->tracers[i];
        double seconds;
        if (!present(tracer)) {
            snprintf(cells[i].left_out, sizeof cells[i].left_out, "-");
            continue;
        }
        hits[i] = turner_calloc(stream->count, sizeof **hits);
        TURNER_TRY(trace(&seconds, hits[i], stage, tracer, list, stream, 1));
        TURNER_TRY(trace(&seconds, hits[i], stage, tracer, list, stream, 1));
        if (!tracer->embree)
            TURNER_TRY(turner_ray_list_hits(hits[i], list, stage->gpu));
        passes[i] = (int)fmin(1000, 1 + LEAST_SECONDS / fmax(seconds, 1e-6));
    }
    turner_bench_check(cells, hits, n, stream, &stage->world, stage->bench->check);
    for (size_t i = 0; i < n; i++) {
        if (!hits[i] || turner_bench_right(&cells[i], stream->count))
            continue;
        snprintf(cells[i].left_out, sizeof cells[i].left_out, "%zu of %zu rays wrong",
                 cells[i].wrong + cells[i].misnamed, stream->count);
        turner_warn("%s, %s rays: %s meets other things than the reference, %s",
                    stage->result->name, turner_bench_kind_names[kind], stage->bench->names[i],
                    cells[i].left_out);
    }
    return TURNER_OK;
}

static enum turner_result measure_rounds(const int *passes, struct stage *stage,
                                         enum turner_bench_kind kind,
                                         struct turner_ray_list *list,
                                         struct turner_gpu_hit **hits)
{
    const struct turner_bench_stream *stream = &stage->streams[kind];
    struct turner_bench *bench = stage->bench;
    struct turner_bench_cell *cells = stage->result->cells[kind];
    for (int round = 0; round < bench->rounds; round++) {
        double done = (kind + (round + 1.0) / (bench->rounds + 1)) / TURNER_BENCH_KINDS;
        turner_progress_show(stage->done + stage->share * done, &bench->bar);
        for (size_t i = 0; i < bench->tracer_count; i++) {
            double seconds;
            if (!hits[i] || *cells[i].left_out)
                continue;
            TURNER_TRY(trace(&seconds, hits[i], stage, &stage->tracers[i], list, stream,
                             passes[i]));
            cells[i].seconds[cells[i].rounds++] = seconds / passes[i];
        }
    }
    const struct turner_bench_cell *yardstick = NULL;
    for (size_t i = 0; i < bench->tracer_count; i++) {
        if (strcmp(bench->names[i], "embree") == 0)
            yardstick = &cells[i];
    }
    for (size_t i = 0; i < bench->tracer_count; i++)
        sum_up(&cells[i], yardstick, stream->count);
    return TURNER_OK;
}

static enum turner_result measure_stream(struct stage *stage, enum turner_bench_kind kind)
{
    const struct turner_bench_stream *stream = &stage->streams[kind];
    struct turner_gpu_hit *hits[TURNER_BENCH_TRACERS] = {0};
    int passes[TURNER_BENCH_TRACERS];
    struct turner_ray_list list;
    if (stream->count < LEAST_RAYS) {
        for (size_t i = 0; i < stage->bench->tracer_count; i++)
            snprintf(stage->result->cells[kind][i].left_out, 128, "too few rays");
        return TURNER_OK;
    }
    TURNER_TRY(turner_ray_list_create(&list, stage->gpu, stream->rays, stream->count));
    enum turner_result result = try_out(passes, stage, kind, &list, hits);
    if (result == TURNER_OK)
        result = measure_rounds(passes, stage, kind, &list, hits);
    turner_ray_list_destroy(stage->gpu, &list);
    for (size_t i = 0; i < TURNER_BENCH_TRACERS; i++)
        free(hits[i]);
    return result;
}

/* ---- one scene ---- */

static void close_stage(struct stage *stage)
{
    for (size_t i = TURNER_BENCH_TRACERS; i-- > 0;) {
        struct turner_bench_tracer *tracer = &stage->tracers[i];
        turner_renderer_destroy(&tracer->renderer);
        turner_kernel_destroy(&tracer->kernel);
        if (tracer->owns_embree)
            turner_embree_scene_destroy(tracer->embree);
    }
    for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++)
        free(stage->streams[kind].rays);
    turner_world_destroy(&stage->world);
    turner_scene_destroy(stage->scene);
}

static enum turner_result measure(struct stage *stage)
{
    struct turner_bench_scene *result = stage->result;
    struct turner_bench *bench = stage->bench;
    TURNER_TRY(turner_bench_scene(&stage->scene, result->name, bench->width, bench->height));
    for (size_t i = 0; i < stage->scene->group_count; i++)
        result->primitives += turner_group_primitive_count(&stage->scene->groups[i]);
    result->primitives += stage->scene->plane_count;
    result->instances = stage->scene->instance_count;
    TURNER_TRY(turner_bench_measure_builds(bench, result, stage->gpu, stage->embree,
                                           stage->scene));
    TURNER_TRY(turner_world_create(&stage->world, stage->scene));
    TURNER_TRY(make_streams(stage));
    TURNER_TRY(open_tracers(stage));
    for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
        if (bench->kinds[kind])
            TURNER_TRY(measure_stream(stage, (enum turner_bench_kind)kind));
    }
    return TURNER_OK;
}

enum turner_result turner_bench_measure(struct turner_bench *bench,
                                        struct turner_bench_scene *scene, struct turner_gpu *gpu,
                                        struct turner_embree *embree, double done, double share)
{
    struct stage *stage = turner_calloc(1, sizeof *stage);
    *stage = (struct stage){.bench = bench, .result = scene, .gpu = gpu, .embree = embree,
                            .done = done, .share = share};
    make_slots(bench);
    bench->bar.what = scene->name;
    turner_progress_show(done, &bench->bar);
    enum turner_result result = measure(stage);
    close_stage(stage);
    free(stage);
    return result;
}
