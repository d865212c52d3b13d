/* Points against truth. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/chart.h"
#include "app/compare_flip.h"

static const struct {
    const char *name, *title;
} metrics[TURNER_CHART_METRICS] = {
    [TURNER_CHART_RMSE] = {"rmse", "RMSE"},
    [TURNER_CHART_RELATIVE_MSE] = {"relative_mse", "relative MSE"},
    [TURNER_CHART_LARGEST] = {"largest", "largest error"},
    [TURNER_CHART_FLIP] = {"flip", "mean FLIP"},
};

const char *turner_chart_metric_name(enum turner_chart_metric metric)
{
    return metrics[metric].name;
}

const char *turner_chart_metric_title(enum turner_chart_metric metric)
{
    return metrics[metric].title;
}

/* FLIP of one picture; where it cannot be had, there will be none. */
static double flip(struct turner_chart *chart, const struct turner_image *picture,
                   const struct turner_image *truth)
{
    double mean;
    const char *kind;
    if (!chart->metrics[TURNER_CHART_FLIP] || *chart->flip_missing)
        return NAN;
    if (turner_compare_flip(picture, truth, &mean, &kind) == TURNER_OK)
        return mean;
    snprintf(chart->flip_missing, sizeof chart->flip_missing, "%s", turner_message());
    return NAN;
}

static void compare(double errors[TURNER_CHART_METRICS], struct turner_comparison *c,
                    struct turner_chart *chart, const struct turner_image *picture,
                    const struct turner_image *truth)
{
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        errors[i] = NAN;
    if (turner_image_compare(c, picture, truth, 0, 0) != TURNER_OK || c->nonfinite_a ||
        c->nonfinite_b)
        return;
    errors[TURNER_CHART_RMSE] = c->rmse;
    errors[TURNER_CHART_RELATIVE_MSE] = c->relative_mse;
    errors[TURNER_CHART_LARGEST] = c->largest;
    errors[TURNER_CHART_FLIP] = flip(chart, picture, truth);
}

static double rms_of(const struct turner_image *picture)
{
    size_t count = (size_t)picture->width * (size_t)picture->height * 4;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += i % 4 == 3 ? 0 : (double)picture->rgba[i] * (double)picture->rgba[i];
    return sqrt(sum / ((double)count * 3 / 4));
}

static enum turner_result compare_points(struct turner_chart *chart,
                                         const struct turner_chart_truths *truths,
                                         struct turner_progress_bar *bar)
{
    for (size_t i = 0; i < chart->point_count; i++) {
        struct turner_chart_point *point = &chart->points[i];
        struct turner_comparison comparison;
        struct turner_image picture;
        for (int k = 0; k < TURNER_CHART_METRICS; k++)
            point->errors[k] = NAN;
        if (!point->runs)
            continue;
        turner_progress_show((double)i / (double)chart->point_count, bar);
        enum turner_result result = turner_chart_picture_read(&picture, chart, point);
        if (result == TURNER_OK)
            compare(point->errors, &comparison, chart, &picture,
                    turner_chart_truth_of(truths, chart, point));
        turner_image_destroy(&picture);
        TURNER_TRY(result);
        point->nonfinite = (double)comparison.nonfinite_a;
        point->largest_x = comparison.largest_x;
        point->largest_y = comparison.largest_y;
    }
    return TURNER_OK;
}

/* FLIP that was asked for and is not there gives way to the RMSE. */
static void settle_flip(struct turner_chart *chart)
{
    if (!*chart->flip_missing)
        return;
    chart->metrics[TURNER_CHART_FLIP] = false;
    bool any = false;
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        any = any || chart->metrics[i];
    chart->metrics[TURNER_CHART_RMSE] = chart->metrics[TURNER_CHART_RMSE] || !any;
    turner_warn("no FLIP is charted: %s", chart->flip_missing);
}

enum turner_result turner_chart_compare(struct turner_chart *chart,
                                        const struct turner_chart_truths *truths)
{
    struct turner_progress_bar bar;
    struct turner_comparison unused;
    turner_progress_begin(&bar, chart->quiet);
    bar.what = "comparing";
    enum turner_result result = compare_points(chart, truths, &bar);
    for (int i = 0; i < TURNER_CHART_METRICS; i++)
        chart->truth_errors[i] = NAN;
    if (result == TURNER_OK && truths->count)
        chart->truth_rms = rms_of(&truths->items[0].picture);
    if (result == TURNER_OK && truths->half.rgba)
        compare(chart->truth_errors, &unused, chart, &truths->half, &truths->items[0].picture);
    turner_progress_end(&bar);
    settle_flip(chart);
    for (int i = 0; i < TURNER_CHART_METRICS; i++) {
        enum turner_chart_metric metric = (enum turner_chart_metric)i;
        turner_chart_mark_twins(chart->points, chart->point_count, metric);
        turner_chart_mark_front(chart->points, chart->point_count, metric);
    }
    return result;
}
