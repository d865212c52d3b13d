/* Times. A warm-up of each point, in which the driver compiles, then rounds: every point once a
 * round, in another order each time, so that whatever else the machine does, and what a point
 * leaves behind for the next, falls on all of them alike. Each run is kept at once. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/chart.h"
#include "app/machine.h"
#include "base/hash.h"
#include "base/memory.h"
#include "render/renderer.h"

struct bench {
    struct turner_chart *chart;
    struct turner_gpu gpu;
    struct turner_kernel kernels[TURNER_KERNEL_KINDS];
    bool compiled[TURNER_KERNEL_KINDS];
    struct turner_progress_bar bar;
    double done, all; /* seconds of work, as far as is known */
};

/* A point on the device, ready to be drawn. */
struct station {
    struct turner_chart_point *point;
    struct turner_chart_identity identity;
    struct turner_renderer renderer;
    struct turner_scene scene; /* shares all but the settings with the chart's */
};

/* ---- what these times are of ---- */

/* The program itself: a changed build measures anew. Where it cannot be read, its version. */
static uint64_t build_hash(void)
{
    FILE *file = fopen("/proc/self/exe", "rb");
    uint64_t hash = turner_hash_text(TURNER_HASH_START, turner_version());
    char bytes[1 << 16];
    for (size_t size; file && (size = fread(bytes, 1, sizeof bytes, file));)
        hash = turner_hash_bytes(hash, bytes, size);
    if (file)
        fclose(file);
    return hash;
}

static void describe(struct turner_chart *chart, const struct turner_gpu_info *info)
{
    snprintf(chart->device, sizeof chart->device, "%s", info->name);
    snprintf(chart->driver, sizeof chart->driver, "%s", info->driver);
    chart->threads = (int)turner_gpu_cpu_threads();
    turner_machine_cpu(chart->cpu, sizeof chart->cpu);
}

/* ---- kernels ---- */

static enum turner_result kernel_of(const struct turner_kernel **kernel, struct bench *bench,
                                    const struct turner_methods *methods)
{
    unsigned kind;
    struct turner_chart *chart = bench->chart;
    TURNER_TRY(turner_choose_kernel(&kind, &bench->gpu.info, methods, TURNER_TRAVERSAL_AUTO));
    *kernel = &bench->kernels[kind];
    if (bench->compiled[kind])
        return TURNER_OK;
    double start = turner_seconds();
    TURNER_TRY(turner_kernel_create(&bench->kernels[kind], kind, &chart->render));
    bench->compiled[kind] = true;
    chart->seconds_kernels += turner_seconds() - start;
    return TURNER_OK;
}

static enum turner_result identify(struct station *station, struct bench *bench, uint64_t build)
{
    struct turner_chart_point *point = station->point;
    const struct turner_kernel *kernel;
    TURNER_TRY(kernel_of(&kernel, bench, &point->settings.methods));
    station->identity = (struct turner_chart_identity){
        .device = bench->gpu.info.name,
        .driver = bench->gpu.info.driver,
        .threads = bench->chart->threads,
        .build = build,
        .kernel = turner_hash_bytes(TURNER_HASH_START, kernel->spirv.words,
                                    kernel->spirv.count * sizeof *kernel->spirv.words),
        .scene = bench->chart->scene_hash,
    };
    return TURNER_OK;
}

/* ---- one run ---- */

static bool progress(double share, void *user)
{
    struct bench *bench = user;
    (void)share;
    return turner_progress_show(bench->all > 0 ? bench->done / bench->all : 0, &bench->bar);
}

static enum turner_result draw(double *seconds, struct turner_image *picture,
                               struct station *station, struct bench *bench)
{
    struct turner_statistics statistics = {0};
    struct turner_render_options options = bench->chart->render;
    options.progress = progress;
    options.user = bench;
    bench->bar.what = station->point->label;
    progress(0, bench);
    TURNER_TRY(turner_renderer_draw(&station->renderer, picture, &options, &statistics));
    *seconds = statistics.seconds_trace;
    station->point->rays = (double)(statistics.camera_rays + statistics.reflected_rays +
                                    statistics.refracted_rays + statistics.shadow_rays);
    return TURNER_OK;
}

/* Makes the station and draws once. */
static enum turner_result warm_up(struct station *station, struct bench *bench)
{
    struct turner_chart_point *point = station->point;
    const struct turner_kernel *kernel;
    struct turner_statistics statistics = {0};
    struct turner_image picture = {0};
    enum turner_result result;
    station->scene = *bench->chart->scene;
    station->scene.settings = point->settings;
    TURNER_TRY(kernel_of(&kernel, bench, &point->settings.methods));
    TURNER_TRY(turner_renderer_create(&station->renderer, &bench->gpu, kernel, &station->scene,
                                      &bench->chart->render, &statistics));
    point->seconds_build = statistics.seconds_build;
    point->seconds_compile = statistics.seconds_compile;
    point->seconds_upload = statistics.seconds_upload;
    point->kernel_words = (double)statistics.kernel_words;
    snprintf(point->traversal, sizeof point->traversal, "%s",
             turner_traversal_name(kernel->kind));
    TURNER_TRY_DONE(turner_image_create(&picture, point->settings.width, point->settings.height));
    TURNER_TRY_DONE(draw(&point->seconds_first, &picture, station, bench));
    result = turner_chart_picture_write(point, bench->chart, &picture);
done:
    turner_image_destroy(&picture);
    return result;
}

static enum turner_result run(struct station *station, struct bench *bench)
{
    struct turner_chart_point *point = station->point;
    struct turner_image picture = {0};
    double seconds;
    TURNER_TRY(turner_image_create(&picture, point->settings.width, point->settings.height));
    enum turner_result result = draw(&seconds, &picture, station, bench);
    bool same = result != TURNER_OK || turner_chart_picture_hash(&picture) == point->picture_hash;
    turner_image_destroy(&picture);
    TURNER_TRY(result);
    if (!same)
        return turner_fail(TURNER_DEVICE, "%s: two runs drew different pictures on \"%s\"; update "
                                          "its driver, and report this", point->label,
                           bench->gpu.info.name);
    point->seconds[point->runs++] = seconds;
    bench->done += point->seconds_first;
    return turner_chart_point_save(point, bench->chart, &station->identity);
}

/* ---- all of them ---- */

/* As many stations as memory allows are warm at once: the first tells how much one takes. */
static size_t stations_at_once(const struct bench *bench, size_t count)
{
    uint64_t one = bench->gpu.memory_used + (1u << 20);
    uint64_t budget = turner_memory_available() / 4;
    uint64_t fit = budget / one;
    return fit < 1 ? 1 : fit < count ? (size_t)fit : count;
}

static void finish(struct station *stations, size_t count)
{
    for (size_t i = 0; i < count; i++)
        turner_renderer_destroy(&stations[i].renderer);
}

/* Every number below `count` once, in an order that looks like chance and is that of the round
 * (Fisher and Yates). */
static void shuffle(size_t *order, size_t count, int round)
{
    uint64_t bits = turner_hash_bytes(TURNER_HASH_START, &round, sizeof round);
    for (size_t i = 0; i < count; i++) {
        bits = turner_hash_bytes(bits, &i, sizeof i);
        size_t k = (size_t)(bits >> 32) % (i + 1);
        order[i] = order[k];
        order[k] = i;
    }
}

/* The rounds of those that are warm. */
static enum turner_result run_rounds(struct station *stations, size_t count, struct bench *bench)
{
    int runs = bench->chart->runs;
    bench->all = bench->done = 0;
    for (size_t i = 0; i < count; i++)
        bench->all += (runs - stations[i].point->runs) * stations[i].point->seconds_first;
    turner_progress_end(&bench->bar);
    turner_progress_begin(&bench->bar, bench->chart->quiet);
    size_t *order = turner_calloc(count, sizeof *order);
    enum turner_result result = TURNER_OK;
    for (int round = 0; round < runs && result == TURNER_OK; round++) {
        shuffle(order, count, round);
        for (size_t i = 0; i < count && result == TURNER_OK; i++) {
            struct station *station = &stations[order[i]];
            if (!*station->point->left_out && station->point->runs <= round)
                result = run(station, bench);
        }
    }
    free(order);
    return result;
}

static enum turner_result measure(struct station *stations, size_t count, struct bench *bench)
{
    enum turner_result result = TURNER_OK;
    size_t at_once = count, warm = 0;
    for (size_t first = 0; first < count; first += warm) {
        bench->all = (double)count;
        for (warm = 0; warm < at_once && first + warm < count; warm++) {
            struct station *station = &stations[first + warm];
            bench->done = (double)(first + warm);
            result = warm_up(station, bench);
            if (result == TURNER_DEVICE || result == TURNER_USAGE) /* not on this device */
                snprintf(station->point->left_out, sizeof station->point->left_out, "%s",
                         turner_message());
            else if (result != TURNER_OK)
                goto done;
            if (first + warm == 0)
                at_once = stations_at_once(bench, count);
        }
        TURNER_TRY_DONE(run_rounds(stations + first, warm, bench));
        finish(stations + first, warm);
    }
done:
    finish(stations, count);
    return result;
}

/* The stations of points that still want runs. */
static enum turner_result find_work(struct station *stations, size_t *count, struct bench *bench)
{
    struct turner_chart *chart = bench->chart;
    uint64_t build = build_hash();
    for (size_t i = 0; i < chart->point_count; i++) {
        struct turner_chart_point *point = &chart->points[i];
        struct station *station = &stations[*count];
        station->point = point;
        enum turner_result result = identify(station, bench, build);
        if (result == TURNER_DEVICE || result == TURNER_USAGE) {
            snprintf(point->left_out, sizeof point->left_out, "%s", turner_message());
            continue;
        }
        TURNER_TRY(result);
        turner_chart_point_name(point, chart, &station->identity);
        turner_chart_point_load(point, chart, &station->identity);
        if (point->runs > chart->runs)
            point->runs = chart->runs;
        chart->reused_runs += (size_t)point->runs;
        *count += point->runs < chart->runs;
    }
    return TURNER_OK;
}

enum turner_result turner_chart_measure(struct turner_chart *chart)
{
    struct bench bench = {.chart = chart};
    struct station *stations = turner_calloc(chart->point_count, sizeof *stations);
    char folder[PATH_MAX];
    size_t count = 0;
    enum turner_result result;
    TURNER_TRY_DONE(turner_chart_path(folder, chart->folder, "points"));
    TURNER_TRY_DONE(turner_chart_make_folder(folder));
    TURNER_TRY_DONE(turner_gpu_create(&bench.gpu, chart->render.device, false));
    describe(chart, &bench.gpu.info);
    TURNER_TRY_DONE(find_work(stations, &count, &bench));
    turner_progress_begin(&bench.bar, chart->quiet);
    result = measure(stations, count, &bench);
    turner_progress_end(&bench.bar);
    for (size_t i = 0; i < chart->point_count; i++) {
        if (chart->points[i].runs)
            turner_chart_quartiles(chart->points[i].quartiles, chart->points[i].seconds,
                                   chart->points[i].runs);
    }
done:
    for (size_t i = 0; i < sizeof bench.kernels / sizeof *bench.kernels; i++)
        turner_kernel_destroy(&bench.kernels[i]);
    turner_gpu_destroy(&bench.gpu);
    free(stations);
    return result;
}
