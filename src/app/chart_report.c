/* chart.json and chart.csv. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "app/app.h"
#include "app/chart.h"
#include "image/atomic.h"

static const char *const againsts[] = {"pixel", "samples", "arithmetic"};

const char *turner_chart_against_name(enum turner_chart_against against)
{
    return againsts[against];
}

/* ---- JSON ---- */

/* What is not known is null. */
static void add_real(cJSON *object, const char *key, double value)
{
    cJSON_AddItemToObject(object, key,
                          isfinite(value) ? cJSON_CreateNumber(value) : cJSON_CreateNull());
}

static void add_errors(cJSON *object, const double errors[TURNER_CHART_METRICS])
{
    cJSON *all = cJSON_AddObjectToObject(object, "error");
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        add_real(all, turner_chart_metric_name((enum turner_chart_metric)i), errors[i]);
}

static cJSON *methods_object(const struct turner_settings *settings)
{
    cJSON *object = cJSON_CreateObject();
    for (size_t i = 0; i < turner_method_count; i++) {
        char text[TURNER_METHOD_TEXT];
        turner_method_text(text, settings, turner_methods_list[i].name);
        cJSON_AddStringToObject(object, turner_methods_list[i].name, text);
    }
    return object;
}

static void add_times(cJSON *object, const struct turner_chart_point *point)
{
    cJSON *seconds = cJSON_AddObjectToObject(object, "seconds");
    cJSON_AddItemToObject(seconds, "trace",
                          cJSON_CreateDoubleArray(point->seconds, point->runs));
    cJSON_AddNumberToObject(seconds, "first_quartile", point->quartiles[0]);
    cJSON_AddNumberToObject(seconds, "median", point->quartiles[1]);
    cJSON_AddNumberToObject(seconds, "third_quartile", point->quartiles[2]);
    cJSON_AddNumberToObject(seconds, "first_draw", point->seconds_first);
    cJSON_AddNumberToObject(seconds, "compile", point->seconds_compile);
    cJSON_AddNumberToObject(seconds, "build", point->seconds_build);
    cJSON_AddNumberToObject(seconds, "upload", point->seconds_upload);
}

static cJSON *point_object(const struct turner_chart_point *point)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "label", point->label);
    cJSON_AddItemToObject(object, "methods", methods_object(&point->settings));
    if (!point->runs) {
        cJSON_AddStringToObject(object, "left_out", point->left_out);
        return object;
    }
    cJSON_AddStringToObject(object, "traversal", point->traversal);
    add_times(object, point);
    cJSON_AddNumberToObject(object, "rays", point->rays);
    cJSON_AddNumberToObject(object, "kernel_words", point->kernel_words);
    add_errors(object, point->errors);
    if (point->nonfinite > 0)
        cJSON_AddNumberToObject(object, "nonfinite_pixels", point->nonfinite);
    if (point->largest_x >= 0 && isfinite(point->errors[TURNER_CHART_LARGEST])) {
        int at[] = {point->largest_x, point->largest_y};
        cJSON_AddItemToObject(object, "largest_at", cJSON_CreateIntArray(at, 2));
    }
    cJSON *front = cJSON_AddArrayToObject(object, "front");
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        if (point->front[i])
            cJSON_AddItemToArray(front, cJSON_CreateString(turner_chart_metric_name(
                                            (enum turner_chart_metric)i)));
    }
    char picture[40];
    snprintf(picture, sizeof picture, "points/%s.exr", point->name);
    cJSON_AddStringToObject(object, "picture", picture);
    return object;
}

static void add_table(cJSON *tables, const struct turner_chart *chart,
                      enum turner_chart_metric metric, bool by_time)
{
    double limits[TURNER_CHART_MAX_LIMITS];
    const struct turner_chart_point *points = chart->points;
    size_t count = by_time ? turner_chart_time_limits(limits, points, chart->point_count, metric)
                           : turner_chart_error_limits(limits, points, chart->point_count, metric);
    cJSON *table =
        cJSON_AddArrayToObject(tables, by_time ? "best_error_within" : "least_time_within");
    for (size_t i = 0; i < count; i++) {
        size_t best = by_time
                          ? turner_chart_best_error(points, chart->point_count, metric, limits[i])
                          : turner_chart_least_time(points, chart->point_count, metric, limits[i]);
        cJSON *row = cJSON_CreateObject();
        cJSON_AddNumberToObject(row, by_time ? "seconds" : "error", limits[i]);
        cJSON_AddStringToObject(row, "label", points[best].label);
        cJSON_AddNumberToObject(row, by_time ? "error" : "seconds",
                                by_time ? points[best].errors[metric] : points[best].quartiles[1]);
        cJSON_AddItemToArray(table, row);
    }
}

static void add_truth(cJSON *object, const struct turner_chart *chart)
{
    cJSON *truth = cJSON_AddObjectToObject(object, "reference");
    cJSON_AddStringToObject(truth, "against", turner_chart_against_name(chart->against));
    if (chart->against == TURNER_CHART_PIXEL)
        cJSON_AddNumberToObject(truth, "spp", chart->reference_spp);
    if (chart->against != TURNER_CHART_ARITHMETIC) {
        cJSON_AddNumberToObject(truth, "depth", chart->truth_depth);
        cJSON_AddNumberToObject(truth, "cutoff", chart->truth_cutoff);
        cJSON_AddNumberToObject(truth, "pruned", chart->truth_pruned);
    }
    cJSON_AddNumberToObject(truth, "rms", chart->truth_rms);
    add_errors(truth, chart->truth_errors);
}

static cJSON *chart_object(const struct turner_chart *chart)
{
    cJSON *object = cJSON_CreateObject();
    const struct turner_scene *scene = chart->scene;
    cJSON_AddStringToObject(object, "version", turner_version());
    cJSON_AddStringToObject(object, "scene", scene->path ? scene->path : "");
    int size[] = {scene->settings.width, scene->settings.height};
    cJSON_AddItemToObject(object, "size", cJSON_CreateIntArray(size, 2));
    cJSON_AddStringToObject(object, "device", chart->device);
    cJSON_AddStringToObject(object, "driver", chart->driver);
    cJSON_AddStringToObject(object, "cpu", chart->cpu);
    cJSON_AddNumberToObject(object, "threads", chart->threads);
    cJSON_AddNumberToObject(object, "runs", chart->runs);
    cJSON_AddNumberToObject(object, "seconds_kernels", chart->seconds_kernels);
    cJSON_AddItemToObject(object, "methods", methods_object(&scene->settings));
    add_truth(object, chart);
    if (*chart->flip_missing)
        cJSON_AddStringToObject(object, "flip_missing", chart->flip_missing);
    cJSON *charts = cJSON_AddArrayToObject(object, "charts");
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        enum turner_chart_metric metric = (enum turner_chart_metric)i;
        if (!chart->metrics[i])
            continue;
        cJSON *one = cJSON_CreateObject();
        cJSON_AddStringToObject(one, "metric", turner_chart_metric_name(metric));
        cJSON_AddStringToObject(one, "title", turner_chart_metric_title(metric));
        add_table(one, chart, metric, true);
        add_table(one, chart, metric, false);
        cJSON_AddItemToArray(charts, one);
    }
    cJSON *points = cJSON_AddArrayToObject(object, "points");
    for (size_t i = 0; i < chart->point_count; i++)
        cJSON_AddItemToArray(points, point_object(&chart->points[i]));
    return object;
}

/* ---- CSV ---- */

/* A field in quotes, those in it doubled (RFC 4180). */
static void put_quoted(FILE *file, const char *field)
{
    fputc('"', file);
    for (; *field; field++)
        fprintf(file, *field == '"' ? "\"\"" : "%c", *field);
    fputc('"', file);
}

/* What is not known is empty. */
static void put_cell(FILE *file, double value)
{
    if (isfinite(value))
        fprintf(file, ",%.9g", value);
    else
        fputc(',', file);
}

static void put_head(FILE *file)
{
    fputs("label", file);
    for (size_t i = 0; i < turner_method_count; i++)
        fprintf(file, ",%s", turner_methods_list[i].name);
    fputs(",traced_by,runs,seconds_median,seconds_first_quartile,seconds_third_quartile,"
          "seconds_first_draw,seconds_compile,seconds_build,seconds_upload,rays,kernel_words",
          file);
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        fprintf(file, ",%s", turner_chart_metric_name((enum turner_chart_metric)i));
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        fprintf(file, ",on_front_%s", turner_chart_metric_name((enum turner_chart_metric)i));
    fputs(",nonfinite_pixels,left_out\n", file);
}

static void put_row(FILE *file, const struct turner_chart_point *p)
{
    put_quoted(file, p->label);
    for (size_t i = 0; i < turner_method_count; i++) {
        char value[TURNER_METHOD_TEXT];
        turner_method_text(value, &p->settings, turner_methods_list[i].name);
        fputc(',', file);
        put_quoted(file, value);
    }
    fprintf(file, ",%s,%d", p->traversal, p->runs);
    const double cells[] = {p->quartiles[1],   p->quartiles[0],    p->quartiles[2],
                            p->seconds_first,  p->seconds_compile, p->seconds_build,
                            p->seconds_upload, p->rays,            p->kernel_words};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; i++)
        put_cell(file, p->runs ? cells[i] : (double)NAN);
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        put_cell(file, p->errors[i]);
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        fprintf(file, ",%d", p->front[i]);
    put_cell(file, p->runs ? p->nonfinite : (double)NAN);
    fputc(',', file);
    put_quoted(file, p->left_out);
    fputc('\n', file);
}

static enum turner_result write_csv(const struct turner_chart *chart)
{
    char path[PATH_MAX], *text = NULL;
    size_t length = 0;
    TURNER_TRY(turner_chart_path(path, chart->folder, "chart.csv"));
    FILE *file = open_memstream(&text, &length);
    if (!file)
        return turner_fail(TURNER_DEVICE, "no memory for the table of points");
    put_head(file);
    for (size_t i = 0; i < chart->point_count; i++)
        put_row(file, &chart->points[i]);
    fclose(file);
    enum turner_result result = turner_atomic_write(path, text, length);
    free(text);
    return result;
}

enum turner_result turner_chart_write_data(const struct turner_chart *chart)
{
    char path[PATH_MAX];
    TURNER_TRY(turner_chart_path(path, chart->folder, "chart.json"));
    cJSON *object = chart_object(chart);
    char *json = cJSON_Print(object);
    cJSON_Delete(object);
    enum turner_result result = turner_atomic_write(path, json, strlen(json));
    cJSON_free(json);
    return result == TURNER_OK ? write_csv(chart) : result;
}
