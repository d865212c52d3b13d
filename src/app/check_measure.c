/* turner check --measure: what specialising the kernel to the scene is worth. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "app/app.h"
#include "app/check_needs.h"
#include "app/plot.h"
#include "base/memory.h"
#include "image/atomic.h"

enum { NEEDED, EVERYTHING, KINDS };

/* Seconds, or ratios, of several runs. */
struct spread {
    double median, least, most;
    double *runs; /* in the order they were made */
};

struct row {
    const char *path, *traversal;
    int width, height, spp, features;
    bool same;
    struct spread trace[KINDS];
    struct spread ratio; /* needed : everything, of runs one after the other: what disturbs the
                            machine disturbs both */
    double compile[KINDS]; /* seconds, until the pipeline is there; not what a driver for CPUs does
                              when it is first used */
    size_t bytes[KINDS]; /* of the kernel, as SPIR-V */
};

struct session {
    const struct turner_measure *how;
    struct turner_gpu gpu;
    struct turner_kernel_set kernels;
    struct turner_progress_bar bar;
    double done, all; /* drawings */
};

static bool show(double share, void *user)
{
    struct session *session = user;
    return turner_progress_show((session->done + share) / session->all, &session->bar);
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sum_up(struct spread *spread, int count)
{
    double *seconds = turner_calloc((size_t)count, sizeof *seconds);
    memcpy(seconds, spread->runs, (size_t)count * sizeof *seconds);
    qsort(seconds, (size_t)count, sizeof *seconds, ascending);
    spread->least = seconds[0];
    spread->most = seconds[count - 1];
    spread->median = 0.5 * (seconds[count / 2] + seconds[(count - 1) / 2]);
    free(seconds);
}

static enum turner_result draw(struct session *session, double *seconds,
                               struct turner_renderer *renderer, struct turner_image *image)
{
    const struct turner_render_options options = {.progress = show, .user = session};
    struct turner_statistics statistics = {0};
    TURNER_TRY(turner_renderer_draw(renderer, image, &options, &statistics));
    session->done++;
    *seconds = statistics.seconds_trace;
    return TURNER_OK;
}

/* Both kinds once, to warm up and to compare, then by turns. */
static enum turner_result measure_kinds(struct session *session, struct row *row,
                                        struct turner_renderer renderers[KINDS],
                                        struct turner_image images[KINDS])
{
    double unused;
    for (int kind = 0; kind < KINDS; kind++)
        TURNER_TRY(draw(session, &unused, &renderers[kind], &images[kind]));
    row->same = memcmp(images[NEEDED].rgba, images[EVERYTHING].rgba,
                       (size_t)row->width * (size_t)row->height * 4 * sizeof(float)) == 0;
    for (int run = 0; run < session->how->runs; run++) {
        for (int turn = 0; turn < KINDS; turn++) {
            int kind = (run + turn) % KINDS; /* each goes first as often */
            TURNER_TRY(draw(session, &row->trace[kind].runs[run], &renderers[kind],
                            &images[kind]));
        }
    }
    for (int kind = 0; kind < KINDS; kind++)
        sum_up(&row->trace[kind], session->how->runs);
    for (int run = 0; run < session->how->runs; run++)
        row->ratio.runs[run] = row->trace[NEEDED].runs[run] / row->trace[EVERYTHING].runs[run];
    sum_up(&row->ratio, session->how->runs);
    return TURNER_OK;
}

static int bits_set(uint32_t bits)
{
    int count = 0;
    for (; bits; bits &= bits - 1)
        count++;
    return count;
}

static enum turner_result measure_scene(struct session *session, struct row *row,
                                        struct turner_scene *scene)
{
    struct turner_settings *settings = &scene->settings;
    const struct turner_measure *how = session->how;
    if (how->width)
        settings->width = how->width, settings->height = how->height;
    if (how->spp)
        settings->spp = how->spp, settings->aa_threshold = 0;
    TURNER_TRY(turner_scene_validate(scene));
    row->width = settings->width;
    row->height = settings->height;
    row->spp = settings->spp;
    const struct turner_needs needs = turner_needs_of(scene);
    row->features = bits_set(needs.bits);
    const struct turner_sized_kernel *kernel;
    TURNER_TRY(turner_kernel_set_get(&kernel, &session->kernels, &session->gpu.info, scene,
                                     how->traversal));
    row->traversal = turner_traversal_name(kernel->kernel.kind);
    row->bytes[EVERYTHING] = kernel->everything;
    TURNER_TRY(turner_kernel_size(&row->bytes[NEEDED], &kernel->kernel, &needs));

    struct turner_renderer renderers[KINDS] = {0};
    struct turner_image images[KINDS] = {0};
    enum turner_result result;
    for (int kind = 0; kind < KINDS; kind++) {
        /* or the kernel with everything would be made once for all scenes */
        const struct turner_render_options options = {.unspecialised = kind == EVERYTHING,
                                                      .no_cache = true};
        struct turner_statistics statistics = {0};
        TURNER_TRY_DONE(turner_image_create(&images[kind], row->width, row->height));
        TURNER_TRY_DONE(turner_renderer_create(&renderers[kind], &session->gpu, &kernel->kernel,
                                               scene, &options, &statistics));
        row->compile[kind] = statistics.seconds_compile;
    }
    result = measure_kinds(session, row, renderers, images);
done:
    for (int kind = 0; kind < KINDS; kind++) {
        turner_renderer_destroy(&renderers[kind]);
        turner_image_destroy(&images[kind]);
    }
    return result;
}

static enum turner_result measure_all(struct session *session, struct row *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct turner_scene *scene;
        TURNER_TRY(turner_scene_load(&scene, rows[i].path));
        enum turner_result result = measure_scene(session, &rows[i], scene);
        turner_scene_destroy(scene);
        if (result != TURNER_OK)
            return turner_fail_within(result, "%s", rows[i].path);
    }
    return TURNER_OK;
}

/* ---- what is written ---- */

static enum turner_result write_text(const char *folder, const char *name, const char *text)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return turner_atomic_write(path, text, strlen(text));
}

static double size_ratio(const struct row *row)
{
    return (double)row->bytes[NEEDED] / (double)row->bytes[EVERYTHING];
}

static enum turner_result write_csv(const struct session *session, const struct row *rows,
                                    size_t count)
{
    static const char head[] =
        "scene,traversal,width,height,samples,features,same_bytes,runs,"
        "trace_seconds,trace_seconds_least,trace_seconds_most,"
        "trace_seconds_everything,trace_seconds_everything_least,trace_seconds_everything_most,"
        "time_ratio,time_ratio_least,time_ratio_most,spirv_bytes,spirv_bytes_everything,size_ratio,"
        "compile_seconds,compile_seconds_everything\n";
    size_t size = sizeof head, length = sizeof head - 1;
    for (size_t i = 0; i < count; i++)
        size += 2 * strlen(rows[i].path) + 512;
    char *text = turner_calloc(size, 1);
    memcpy(text, head, sizeof head);
    for (size_t i = 0; i < count; i++) {
        const struct row *r = &rows[i];
        text[length++] = '"';
        for (const char *c = r->path; *c; c++) {
            if (*c == '"')
                text[length++] = '"';
            text[length++] = *c;
        }
        length += (size_t)snprintf(
            text + length, size - length,
            "\",%s,%d,%d,%d,%d,%s,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,%.4f,%.4f,%.4f,%zu,%zu,%.4f,%.4g,%.4g\n",
            r->traversal, r->width, r->height, r->spp, r->features, r->same ? "yes" : "no",
            session->how->runs, r->trace[NEEDED].median, r->trace[NEEDED].least,
            r->trace[NEEDED].most, r->trace[EVERYTHING].median, r->trace[EVERYTHING].least,
            r->trace[EVERYTHING].most, r->ratio.median, r->ratio.least, r->ratio.most, r->bytes[NEEDED], r->bytes[EVERYTHING],
            size_ratio(r), r->compile[NEEDED], r->compile[EVERYTHING]);
    }
    enum turner_result result = write_text(session->how->folder, "needs.csv", text);
    free(text);
    return result;
}

static cJSON *kind_object(const struct row *row, int kind, int runs)
{
    const struct spread *trace = &row->trace[kind];
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "trace_seconds", trace->median);
    cJSON_AddNumberToObject(object, "trace_seconds_least", trace->least);
    cJSON_AddNumberToObject(object, "trace_seconds_most", trace->most);
    cJSON_AddItemToObject(object, "trace_seconds_runs", cJSON_CreateDoubleArray(trace->runs, runs));
    cJSON_AddNumberToObject(object, "compile_seconds", row->compile[kind]);
    cJSON_AddNumberToObject(object, "spirv_bytes", (double)row->bytes[kind]);
    return object;
}

static enum turner_result write_json(const struct session *session, const struct row *rows,
                                     size_t count)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "version", turner_version());
    cJSON_AddStringToObject(object, "device", session->gpu.info.name);
    cJSON_AddStringToObject(object, "driver", session->gpu.info.driver);
    cJSON_AddNumberToObject(object, "cores", (double)sysconf(_SC_NPROCESSORS_ONLN));
    cJSON_AddNumberToObject(object, "runs", session->how->runs);
    cJSON_AddNumberToObject(object, "features", bits_set(TURNER_NEEDS_ALL));
    cJSON *scenes = cJSON_AddArrayToObject(object, "scenes");
    for (size_t i = 0; i < count; i++) {
        const struct row *row = &rows[i];
        cJSON *scene = cJSON_CreateObject();
        int size[2] = {row->width, row->height};
        cJSON_AddStringToObject(scene, "scene", row->path);
        cJSON_AddStringToObject(scene, "traversal", row->traversal);
        cJSON_AddItemToObject(scene, "size", cJSON_CreateIntArray(size, 2));
        cJSON_AddNumberToObject(scene, "samples", row->spp);
        cJSON_AddNumberToObject(scene, "features", row->features);
        cJSON_AddBoolToObject(scene, "same_bytes", row->same);
        cJSON_AddItemToObject(scene, "needed", kind_object(row, NEEDED, session->how->runs));
        cJSON_AddItemToObject(scene, "everything",
                              kind_object(row, EVERYTHING, session->how->runs));
        cJSON_AddNumberToObject(scene, "time_ratio", row->ratio.median);
        cJSON_AddNumberToObject(scene, "time_ratio_least", row->ratio.least);
        cJSON_AddNumberToObject(scene, "time_ratio_most", row->ratio.most);
        cJSON_AddNumberToObject(scene, "size_ratio", size_ratio(row));
        cJSON_AddItemToArray(scenes, scene);
    }
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    enum turner_result result = write_text(session->how->folder, "needs.json", text);
    cJSON_free(text);
    return result;
}

static void print_rows(const struct row *rows, size_t count)
{
    printf("%-32s %8s %10s %6s %9s %9s %6s  %s\n", "scene", "needed", "everything", "time",
           "needed", "all", "size", "picture");
    for (size_t i = 0; i < count; i++) {
        const struct row *r = &rows[i];
        const char *slash = strrchr(r->path, '/');
        printf("%-32s %6.3f s %8.3f s %4.0f %% %7zu B %7zu B %4.0f %%  %s\n",
               slash ? slash + 1 : r->path, r->trace[NEEDED].median, r->trace[EVERYTHING].median,
               100 * r->ratio.median, r->bytes[NEEDED], r->bytes[EVERYTHING], 100 * size_ratio(r),
               r->same ? "the same" : "DIFFERS");
    }
}

static enum turner_result prepare_folder(const char *folder)
{
    char path[4096];
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return turner_fail(TURNER_OUTPUT, "cannot make the folder \"%s\": %s; choose another",
                           folder, strerror(errno));
    snprintf(path, sizeof path, "%s/needs.csv", folder);
    return turner_atomic_check(path);
}

static enum turner_result measure_on_device(struct session *session, struct row *rows,
                                            size_t count)
{
    enum turner_result result;
    TURNER_TRY_DONE(turner_gpu_create(&session->gpu, session->how->device, false));
    turner_progress_begin(&session->bar, session->how->quiet);
    result = measure_all(session, rows, count);
    turner_progress_end(&session->bar);
    if (result != TURNER_OK)
        goto done;
    TURNER_TRY_DONE(write_csv(session, rows, count));
    TURNER_TRY_DONE(write_json(session, rows, count));
done:
    turner_kernel_set_destroy(&session->kernels);
    turner_gpu_destroy(&session->gpu);
    return result;
}

enum turner_result turner_needs_measure(const struct turner_measure *measure,
                                        const char *const *paths, size_t count)
{
    TURNER_TRY(prepare_folder(measure->folder));
    for (size_t i = 0; i < count; i++) { /* what cannot be read is said before any work is done */
        struct turner_scene *scene;
        TURNER_TRY(turner_scene_load(&scene, paths[i]));
        turner_scene_destroy(scene);
    }
    struct session session = {.how = measure, .all = (double)count * KINDS * (measure->runs + 1)};
    struct row *rows = turner_calloc(count, sizeof *rows);
    enum turner_result result;
    for (size_t i = 0; i < count; i++) {
        rows[i].path = paths[i];
        for (int kind = 0; kind < KINDS; kind++)
            rows[i].trace[kind].runs = turner_calloc((size_t)measure->runs, sizeof(double));
        rows[i].ratio.runs = turner_calloc((size_t)measure->runs, sizeof(double));
    }
    TURNER_TRY_DONE(measure_on_device(&session, rows, count));
    if (!measure->quiet)
        print_rows(rows, count);
    TURNER_TRY_DONE(turner_plot("needs", &measure->folder, 1));
    for (size_t i = 0; i < count && result == TURNER_OK; i++) {
        if (!rows[i].same)
            result = turner_fail(TURNER_DIFFERS, "%s: the picture is not the same with everything "
                                                 "in the kernel", rows[i].path);
    }
done:
    for (size_t i = 0; i < count; i++) {
        for (int kind = 0; kind < KINDS; kind++)
            free(rows[i].trace[kind].runs);
        free(rows[i].ratio.runs);
    }
    free(rows);
    return result;
}
