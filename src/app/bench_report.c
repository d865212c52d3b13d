/* What was measured, as a table, CSV and JSON. */
#include <cjson/cJSON.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/bench.h"
#include "app/plot.h"
#include "image/atomic.h"

#define COLUMN 21 /* characters */

/* Columns of a UTF-8 text. */
static int columns_of(const char *text)
{
    int columns = 0;
    for (; *text; text++)
        columns += (*text & 0xc0) != 0x80;
    return columns;
}

static void print_padded(const char *text)
{
    int columns = columns_of(text);
    printf("  %s%*s", text, columns < COLUMN ? COLUMN - columns : 0, "");
}

static void print_cell(const struct turner_bench_cell *cell)
{
    char text[64];
    if (!cell->rounds) {
        printf("  %-*s", COLUMN, *cell->left_out ? cell->left_out : "-");
        return;
    }
    double spread = 50 * (cell->high - cell->low) / cell->rate;
    int used = snprintf(text, sizeof text, "%7.2f ±%3.0f %%", 1e-6 * cell->rate, spread);
    if (!isnan(cell->ratio))
        snprintf(text + used, sizeof text - (size_t)used, " %5.2f×", cell->ratio);
    print_padded(text);
}

static void print_builds(const struct turner_bench *bench, const struct turner_bench_scene *scene)
{
    printf("%-19s", "build, ms");
    for (size_t i = 0; i < bench->tracer_count; i++) {
        const struct turner_bench_build *build = &scene->builds[i];
        char text[64] = "-";
        if (build->rounds) {
            double spread = 50 * (build->high - build->low) / build->median;
            int used = snprintf(text, sizeof text, "%7.1f ±%3.0f %%", 1e3 * build->median, spread);
            if (!isnan(build->ratio))
                snprintf(text + used, sizeof text - (size_t)used, " %5.2f×", build->ratio);
        }
        print_padded(text);
    }
    printf("\n%-19s", "bytes a primitive");
    for (size_t i = 0; i < bench->tracer_count; i++) {
        const struct turner_bench_build *build = &scene->builds[i];
        char text[64] = "-";
        if (build->rounds)
            snprintf(text, sizeof text, "%7.1f", (double)build->bytes / (double)scene->primitives);
        print_padded(text);
    }
    putchar('\n');
}

static void print_scene(const struct turner_bench *bench, const struct turner_bench_scene *scene)
{
    printf("\n%s: %zu primitives", scene->name, scene->primitives);
    if (scene->instances)
        printf(", %zu instances", scene->instances);
    printf("\n%-9s %9s", "rays", "");
    for (size_t i = 0; i < bench->tracer_count; i++)
        printf("  %-*s", COLUMN, bench->names[i]);
    putchar('\n');
    for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
        if (!bench->kinds[kind])
            continue;
        printf("%-9s %9zu", turner_bench_kind_names[kind], scene->rays[kind]);
        for (size_t i = 0; i < bench->tracer_count; i++)
            print_cell(&scene->cells[kind][i]);
        putchar('\n');
    }
    print_builds(bench, scene);
}

static void print_growth(const struct turner_bench *bench)
{
    struct turner_bench_fit fit;
    printf("\ngrowth: nanoseconds a ray among n primitives\n");
    for (size_t i = 0; i < bench->tracer_count; i++) {
        for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
            if (turner_bench_fit_log(&fit, bench, i, kind))
                printf("%-14s %-9s %+7.1f %+6.1f log2 n, every size within %.0f %%\n",
                       bench->names[i], turner_bench_kind_names[kind], fit.a, fit.b,
                       100 * fit.off);
        }
    }
}

void turner_bench_print(const struct turner_bench *bench)
{
    printf("turner %s; %s, %s; %d threads of %s%s%s\n", turner_version(), bench->device,
           bench->driver, bench->threads, bench->cpu, *bench->embree ? "; " : "", bench->embree);
    if (bench->stages) {
        turner_bench_print_stages(bench);
        return;
    }
    printf("million rays a second%s, median of %d rounds ± half the distance of the quartiles; "
           "× times embree's\n", bench->processor_time ? " of processor time" : "", bench->rounds);
    for (size_t i = 0; i < bench->scene_count; i++)
        print_scene(bench, &bench->scenes[i]);
    if (bench->growth)
        print_growth(bench);
}

/* ---- files ---- */

static enum turner_result write_file(const struct turner_bench *bench, const char *name,
                                     const char *text)
{
    char path[4096];
    if ((size_t)snprintf(path, sizeof path, "%s/%s", bench->output, name) >= sizeof path)
        return turner_fail(TURNER_OUTPUT, "the name of the folder \"%s\" is too long",
                           bench->output);
    return turner_atomic_write(path, text, strlen(text));
}

static void print_csv(FILE *out, const struct turner_bench *bench)
{
    fprintf(out, "scene,primitives,instances,rays,ray_count,tracer,rounds,rays_per_second,"
                 "first_quartile,third_quartile,ratio_to_embree,checked,wrong,misnamed,left_out\n");
    for (size_t s = 0; s < bench->scene_count; s++) {
        const struct turner_bench_scene *scene = &bench->scenes[s];
        for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
            for (size_t i = 0; bench->kinds[kind] && i < bench->tracer_count; i++) {
                const struct turner_bench_cell *cell = &scene->cells[kind][i];
                fprintf(out, "\"%s\",%zu,%zu,%s,%zu,\"%s\",%d,", scene->name, scene->primitives,
                        scene->instances, turner_bench_kind_names[kind], scene->rays[kind],
                        bench->names[i], cell->rounds);
                if (cell->rounds)
                    fprintf(out, "%.6g,%.6g,%.6g,", cell->rate, cell->low, cell->high);
                else
                    fprintf(out, ",,,");
                if (cell->rounds && !isnan(cell->ratio))
                    fprintf(out, "%.4f", cell->ratio);
                fprintf(out, ",%zu,%zu,%zu,\"%s\"\n", cell->checked, cell->wrong, cell->misnamed,
                        cell->left_out);
            }
        }
    }
}

static void print_build_csv(FILE *out, const struct turner_bench *bench)
{
    fprintf(out, "scene,primitives,instances,tracer,rounds,seconds,first_quartile,third_quartile,"
                 "ratio_to_embree,bytes\n");
    for (size_t s = 0; s < bench->scene_count; s++) {
        const struct turner_bench_scene *scene = &bench->scenes[s];
        for (size_t i = 0; i < bench->tracer_count; i++) {
            const struct turner_bench_build *build = &scene->builds[i];
            if (!build->rounds)
                continue;
            fprintf(out, "\"%s\",%zu,%zu,\"%s\",%d,%.6g,%.6g,%.6g,", scene->name,
                    scene->primitives, scene->instances, bench->names[i], build->rounds,
                    build->median, build->low, build->high);
            if (!isnan(build->ratio))
                fprintf(out, "%.4f", build->ratio);
            fprintf(out, ",%llu\n", (unsigned long long)build->bytes);
        }
    }
}

static cJSON *build_json(const struct turner_bench_build *build, const char *tracer)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "tracer", tracer);
    cJSON_AddNumberToObject(object, "seconds", build->median);
    cJSON_AddNumberToObject(object, "first_quartile", build->low);
    cJSON_AddNumberToObject(object, "third_quartile", build->high);
    if (!isnan(build->ratio))
        cJSON_AddNumberToObject(object, "ratio_to_embree", build->ratio);
    cJSON_AddNumberToObject(object, "bytes", (double)build->bytes);
    return object;
}

static cJSON *cell_json(const struct turner_bench_cell *cell, const char *tracer)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "tracer", tracer);
    cJSON_AddNumberToObject(object, "checked", (double)cell->checked);
    cJSON_AddNumberToObject(object, "wrong", (double)cell->wrong);
    cJSON_AddNumberToObject(object, "misnamed", (double)cell->misnamed);
    if (!cell->rounds) {
        cJSON_AddStringToObject(object, "left_out", cell->left_out);
        return object;
    }
    cJSON_AddNumberToObject(object, "rays_per_second", cell->rate);
    cJSON_AddNumberToObject(object, "first_quartile", cell->low);
    cJSON_AddNumberToObject(object, "third_quartile", cell->high);
    if (!isnan(cell->ratio))
        cJSON_AddNumberToObject(object, "ratio_to_embree", cell->ratio);
    cJSON_AddItemToObject(object, "seconds", cJSON_CreateDoubleArray(cell->seconds, cell->rounds));
    return object;
}

static cJSON *scene_json(const struct turner_bench *bench, const struct turner_bench_scene *scene)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "scene", scene->name);
    cJSON_AddNumberToObject(object, "primitives", (double)scene->primitives);
    cJSON_AddNumberToObject(object, "instances", (double)scene->instances);
    cJSON *streams = cJSON_AddArrayToObject(object, "streams");
    for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
        if (!bench->kinds[kind])
            continue;
        cJSON *stream = cJSON_CreateObject();
        cJSON_AddStringToObject(stream, "rays", turner_bench_kind_names[kind]);
        cJSON_AddNumberToObject(stream, "count", (double)scene->rays[kind]);
        cJSON *cells = cJSON_AddArrayToObject(stream, "tracers");
        for (size_t i = 0; i < bench->tracer_count; i++)
            cJSON_AddItemToArray(cells, cell_json(&scene->cells[kind][i], bench->names[i]));
        cJSON_AddItemToArray(streams, stream);
    }
    cJSON *builds = cJSON_AddArrayToObject(object, "builds");
    for (size_t i = 0; i < bench->tracer_count; i++) {
        if (scene->builds[i].rounds)
            cJSON_AddItemToArray(builds, build_json(&scene->builds[i], bench->names[i]));
    }
    return object;
}

static cJSON *growth_json(const struct turner_bench *bench)
{
    cJSON *fits = cJSON_CreateArray();
    struct turner_bench_fit fit;
    for (size_t i = 0; i < bench->tracer_count; i++) {
        for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
            if (!turner_bench_fit_log(&fit, bench, i, kind))
                continue;
            cJSON *object = cJSON_CreateObject();
            cJSON_AddStringToObject(object, "tracer", bench->names[i]);
            cJSON_AddStringToObject(object, "rays", turner_bench_kind_names[kind]);
            cJSON_AddNumberToObject(object, "nanoseconds", fit.a);
            cJSON_AddNumberToObject(object, "nanoseconds_per_doubling", fit.b);
            cJSON_AddNumberToObject(object, "largest_distance", fit.off);
            cJSON_AddItemToArray(fits, object);
        }
    }
    return fits;
}

static enum turner_result write_json(const struct turner_bench *bench)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", turner_version());
    cJSON_AddStringToObject(root, "device", bench->device);
    cJSON_AddStringToObject(root, "driver", bench->driver);
    cJSON_AddStringToObject(root, "cpu", bench->cpu);
    cJSON_AddStringToObject(root, "embree", bench->embree);
    cJSON_AddNumberToObject(root, "threads", bench->threads);
    cJSON_AddNumberToObject(root, "rounds", bench->rounds);
    cJSON_AddStringToObject(root, "clock", bench->processor_time ? "processor" : "wall");
    cJSON *scenes = cJSON_AddArrayToObject(root, "scenes");
    for (size_t i = 0; i < bench->scene_count; i++)
        cJSON_AddItemToArray(scenes, scene_json(bench, &bench->scenes[i]));
    if (bench->growth)
        cJSON_AddItemToObject(root, "growth", growth_json(bench));
    char *text = cJSON_Print(root);
    enum turner_result result = write_file(bench, "bench.json", text);
    cJSON_free(text);
    cJSON_Delete(root);
    return result;
}

static enum turner_result write_csv(const struct turner_bench *bench, const char *name,
                                    void (*print)(FILE *out, const struct turner_bench *bench))
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return turner_fail(TURNER_OUTPUT, "no memory for the table");
    print(out, bench);
    fclose(out);
    enum turner_result result = write_file(bench, name, text);
    free(text);
    return result;
}

enum turner_result turner_bench_write(const struct turner_bench *bench)
{
    if (bench->stages)
        return write_csv(bench, "stages.csv", turner_bench_print_stages_csv);
    TURNER_TRY(write_csv(bench, "bench.csv", print_csv));
    TURNER_TRY(write_csv(bench, "build.csv", print_build_csv));
    TURNER_TRY(write_json(bench));
    return turner_plot("bench", &bench->output, 1);
}
