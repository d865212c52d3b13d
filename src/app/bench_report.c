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
    int columns = 0; /* of UTF-8 */
    for (const char *c = text; *c; c++)
        columns += (*c & 0xc0) != 0x80;
    printf("  %s%*s", text, columns < COLUMN ? COLUMN - columns : 0, "");
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
}

void turner_bench_print(const struct turner_bench *bench)
{
    printf("turner %s; %s, %s; %d threads of %s; %s\n", turner_version(), bench->device,
           bench->driver, bench->threads, bench->cpu, bench->embree);
    printf("million rays a second, median of %d rounds ± half the distance of the quartiles; "
           "× times embree's\n", bench->rounds);
    for (size_t i = 0; i < bench->scene_count; i++)
        print_scene(bench, &bench->scenes[i]);
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
                 "first_quartile,third_quartile,ratio_to_embree,checked,wrong,left_out\n");
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
                fprintf(out, ",%zu,%zu,\"%s\"\n", cell->checked, cell->wrong, cell->left_out);
            }
        }
    }
}

static cJSON *cell_json(const struct turner_bench_cell *cell, const char *tracer)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "tracer", tracer);
    cJSON_AddNumberToObject(object, "checked", (double)cell->checked);
    cJSON_AddNumberToObject(object, "wrong", (double)cell->wrong);
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
    return object;
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
    cJSON *scenes = cJSON_AddArrayToObject(root, "scenes");
    for (size_t i = 0; i < bench->scene_count; i++)
        cJSON_AddItemToArray(scenes, scene_json(bench, &bench->scenes[i]));
    char *text = cJSON_Print(root);
    enum turner_result result = write_file(bench, "bench.json", text);
    cJSON_free(text);
    cJSON_Delete(root);
    return result;
}

enum turner_result turner_bench_write(const struct turner_bench *bench)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return turner_fail(TURNER_OUTPUT, "no memory for the table");
    print_csv(out, bench);
    fclose(out);
    enum turner_result result = write_file(bench, "bench.csv", text);
    free(text);
    if (result == TURNER_OK)
        result = write_json(bench);
    return result == TURNER_OK ? turner_plot("bench", &bench->output, 1) : result;
}
