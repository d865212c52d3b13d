/* The chart in words: chart.md, and what stands on stdout in the end. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/app.h"
#include "app/chart.h"
#include "image/atomic.h"

static void put_error(FILE *file, double error)
{
    if (isfinite(error))
        fprintf(file, "%.3g", error);
    else
        fputs("–", file);
}

/* ---- tables, as Markdown ---- */

static void put_limit(FILE *file, double limit)
{
    if (limit == 1 / 255.0)
        fputs("1/255", file);
    else
        fprintf(file, "%g", limit);
}

static void put_table(FILE *file, const struct turner_chart *chart,
                      enum turner_chart_metric metric, bool by_time)
{
    double limits[TURNER_CHART_MAX_LIMITS];
    const struct turner_chart_point *points = chart->points;
    size_t count = by_time ? turner_chart_time_limits(limits, points, chart->point_count, metric)
                           : turner_chart_error_limits(limits, points, chart->point_count, metric);
    const char *title = turner_chart_metric_title(metric);
    if (by_time)
        fprintf(file, "| within seconds | least %s | seconds | with |\n", title);
    else
        fprintf(file, "| %s at most | seconds | %s | with |\n", title, title);
    fputs("| ---: | ---: | ---: | --- |\n", file);
    for (size_t i = 0; i < count; i++) {
        size_t best = by_time
                          ? turner_chart_best_error(points, chart->point_count, metric, limits[i])
                          : turner_chart_least_time(points, chart->point_count, metric, limits[i]);
        double error = points[best].errors[metric], seconds = points[best].quartiles[1];
        fputs("| ", file);
        put_limit(file, limits[i]);
        fprintf(file, " | %.3g | %.3g | %s |\n", by_time ? error : seconds,
                by_time ? seconds : error, points[best].label);
    }
    fputc('\n', file);
}

static void put_tables(FILE *file, const struct turner_chart *chart)
{
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        if (!chart->metrics[i])
            continue;
        put_table(file, chart, (enum turner_chart_metric)i, true);
        put_table(file, chart, (enum turner_chart_metric)i, false);
    }
}

static void put_left_out(FILE *file, const struct turner_chart *chart)
{
    for (size_t i = 0; i < chart->point_count; i++) {
        const struct turner_chart_point *point = &chart->points[i];
        if (*point->left_out)
            fprintf(file, "Left out: %s: %s.\n\n", point->label, point->left_out);
        else if (point->nonfinite > 0)
            fprintf(file, "Not charted: %s: %.0f pixels are not finite.\n\n", point->label,
                    point->nonfinite);
    }
    if (*chart->flip_missing)
        fprintf(file, "No FLIP: %s.\n\n", chart->flip_missing);
}

/* ---- what was measured, and how ---- */

static void put_truth(FILE *file, const struct turner_chart *chart)
{
    static const char *const sentences[] = {
        [TURNER_CHART_PIXEL] = "the reference tracer's mean over each pixel's square",
        [TURNER_CHART_SAMPLES] = "the reference tracer at the same sample positions, with no "
                                 "approximation but theirs",
        [TURNER_CHART_ARITHMETIC] = "the reference tracer at the same sample positions, depth, "
                                    "cutoff and Fresnel formula: what is left is rounding",
    };
    fprintf(file, "Errors are against %s", sentences[chart->against]);
    if (chart->against == TURNER_CHART_PIXEL)
        fprintf(file, ", %d samples a pixel in two independent halves", chart->reference_spp);
    if (chart->against != TURNER_CHART_ARITHMETIC)
        fprintf(file, "; depth %d, cutoff %g, what it still cuts off weighs %.2g a pixel",
                chart->truth_depth, chart->truth_cutoff, chart->truth_pruned);
    fputs(". ", file);
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        if (!chart->metrics[i] || !isfinite(chart->truth_errors[i]))
            continue;
        fprintf(file, "Its own %s, by the difference of its halves: ",
                turner_chart_metric_title((enum turner_chart_metric)i));
        put_error(file, chart->truth_errors[i]);
        fputs(". ", file);
    }
    fputc('\n', file);
}

static void put_caption(FILE *file, const struct turner_chart *chart)
{
    const struct turner_scene *scene = chart->scene;
    fprintf(file, "%s, %d×%d, on %s, %s, %d threads", scene->path ? scene->path : "the scene",
            scene->settings.width, scene->settings.height, chart->device, chart->driver,
            chart->threads);
    fprintf(file, "%s%s, turner %s. ", *chart->cpu ? " of " : "", chart->cpu, turner_version());
    fprintf(file, "What a point does not name is as the scene says: depth %d, cutoff %.4g. ",
            scene->settings.depth, scene->settings.cutoff);
    fprintf(file, "Times are of tracing alone, medians of %d runs in turn after one that does not "
                  "count. ", chart->runs);
    put_truth(file, chart);
}

/* What the times leave out, of the points that were measured. */
static void put_apart(FILE *file, const struct turner_chart *chart)
{
    double compile = 0, build = 0, upload = 0, first = 0;
    for (size_t i = 0; i < chart->point_count; i++) {
        const struct turner_chart_point *p = &chart->points[i];
        if (!p->runs)
            continue;
        compile = fmax(compile, p->seconds_compile);
        build = fmax(build, p->seconds_build);
        upload = fmax(upload, p->seconds_upload);
        first = fmax(first, p->seconds_first - p->quartiles[1]);
    }
    fprintf(file, "Apart from that: %.2g s compiling the shaders, once; for a point at most %.2g s "
                  "specialising, %.2g s more in its first draw (the driver compiles), %.2g s "
                  "building the hierarchy, %.2g s uploading.\n", chart->seconds_kernels, compile,
            first, build, upload);
}

/* ---- the page ---- */

static void put_points(FILE *file, const struct turner_chart *chart)
{
    fputs("| point | seconds | quartiles |", file);
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        if (i != TURNER_CHART_FLIP || chart->metrics[i])
            fprintf(file, " %s |", turner_chart_metric_title((enum turner_chart_metric)i));
    }
    fputs("\n| --- | ---: | ---: |", file);
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        fputs(i != TURNER_CHART_FLIP || chart->metrics[i] ? " ---: |" : "", file);
    fputc('\n', file);
    for (size_t i = 0; i < chart->point_count; i++) {
        const struct turner_chart_point *p = &chart->points[i];
        if (!p->runs)
            continue;
        fprintf(file, "| %s | %.3g | %.3g – %.3g |", p->label, p->quartiles[1], p->quartiles[0],
                p->quartiles[2]);
        for (int k = 0; k < TURNER_CHART_METRICS; k++) {
            if (k == TURNER_CHART_FLIP && !chart->metrics[k])
                continue;
            fputc(' ', file);
            put_error(file, p->errors[k]);
            fputs(p->front[k] ? " * |" : " |", file);
        }
        fputc('\n', file);
    }
    fputs("\n\\* nothing is both quicker and nearer to the truth. Of points that cannot be told "
          "apart (quartiles overlap, errors within 1 %) only the one counts that departs least from "
          "the scene.\n\n", file);
}

static void put_page(FILE *file, const struct turner_chart *chart)
{
    const struct turner_scene *scene = chart->scene;
    fprintf(file, "# Speed against accuracy: %s\n\n", scene->path ? scene->path : "a scene");
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        const char *name = turner_chart_metric_name((enum turner_chart_metric)i);
        if (chart->metrics[i])
            fprintf(file, "![%s against time](chart-%s.png)\n\n",
                    turner_chart_metric_title((enum turner_chart_metric)i), name);
    }
    put_caption(file, chart);
    fputc('\n', file);
    put_apart(file, chart);
    fputs("\n## What to choose\n\n", file);
    put_tables(file, chart);
    put_left_out(file, chart);
    fputs("## All points\n\n", file);
    put_points(file, chart);
}

enum turner_result turner_chart_write_text(const struct turner_chart *chart)
{
    char path[PATH_MAX], *text = NULL;
    size_t length = 0;
    TURNER_TRY(turner_chart_path(path, chart->folder, "chart.md"));
    FILE *file = open_memstream(&text, &length);
    if (!file)
        return turner_fail(TURNER_DEVICE, "no memory for the report");
    put_page(file, chart);
    fclose(file);
    enum turner_result result = turner_atomic_write(path, text, length);
    free(text);
    if (result == TURNER_OK && !chart->quiet) {
        put_tables(stdout, chart);
        put_left_out(stdout, chart);
        put_caption(stdout, chart);
    }
    return result;
}
