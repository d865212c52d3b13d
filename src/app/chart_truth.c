/* What points are compared with.
 *
 * The truth of whole pixels is the mean of two halves with independent sample positions; how far a
 * half is from the mean estimates how far the mean is from what it would be with endless samples.
 * Following every faint ray costs many times what the scene's own cutoff does and changes little,
 * so a half is made of two levels (Giles, Multilevel Monte Carlo, 2008): many samples with that
 * cutoff, and of a sixteenth of them what they lack, traced twice at the same positions. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/chart.h"
#include "base/memory.h"
#include "render/needs.h"

#include "../shaders/shared.h"

#define DEEP_CUTOFF 1e-5
#define DEEP_DEPTH 256 /* where each hit sends one ray; 64 where it may send two */
#define DEEP_SHARE 16 /* one in so many samples is followed to the end */

/* As far as light is worth following. */
static struct turner_settings deep_settings(const struct turner_chart *chart)
{
    struct turner_settings deep = chart->scene->settings;
    bool branching = turner_needs_of(chart->scene).bits & TURNER_NEEDS_BRANCHING;
    int most = branching ? TURNER_MAX_BRANCH_DEPTH : DEEP_DEPTH;
    deep.depth = deep.depth > most ? deep.depth : most;
    deep.cutoff = DEEP_CUTOFF;
    deep.aa_threshold = 0;
    return deep;
}

static void add_scaled(struct turner_image *sum, const struct turner_image *picture, float scale)
{
    size_t count = (size_t)sum->width * (size_t)sum->height * 4;
    for (size_t i = 0; i < count; i++)
        sum->rgba[i] += scale * picture->rgba[i];
}

/* Adds what the samples lack that are cut off early. */
static enum turner_result add_rest(struct turner_image *half, struct turner_chart *chart,
                                   struct turner_settings early, uint32_t which)
{
    struct turner_image with = {0}, without = {0};
    enum turner_result result;
    double pruned, unused;
    char what[80];
    early.spp = early.spp / DEEP_SHARE > 0 ? early.spp / DEEP_SHARE : 1;
    struct turner_settings deep = early;
    deep.cutoff = DEEP_CUTOFF;
    snprintf(what, sizeof what, "reference, half %u: light to its end", which);
    TURNER_TRY_DONE(turner_chart_reference(&with, &pruned, chart, &deep, which + 2, what));
    TURNER_TRY_DONE(turner_chart_reference(&without, &unused, chart, &early, which + 2, what));
    add_scaled(half, &with, 1);
    add_scaled(half, &without, -1);
    chart->truth_pruned += pruned / 2;
done:
    turner_image_destroy(&with);
    turner_image_destroy(&without);
    return result;
}

/* `which` is 1 or 2. */
static enum turner_result make_half(struct turner_image *half, struct turner_chart *chart,
                                    uint32_t which)
{
    struct turner_settings early = deep_settings(chart);
    double pruned;
    char what[80];
    early.spp = chart->reference_spp / 2;
    early.cutoff = fmin(fmax(chart->scene->settings.cutoff, 1.0 / 512), 1.0 / 64);
    snprintf(what, sizeof what, "reference, half %u: %d samples a pixel", which, early.spp);
    TURNER_TRY(turner_chart_reference(half, &pruned, chart, &early, which, what));
    return pruned > 0 ? add_rest(half, chart, early, which) : TURNER_OK;
}

static enum turner_result make_pixel_truth(struct turner_chart_truths *truths,
                                           struct turner_chart *chart)
{
    struct turner_chart_truth *truth = TURNER_PUSH(truths->items, truths->count, truths->capacity);
    *truth = (struct turner_chart_truth){.settings = chart->scene->settings};
    TURNER_TRY(make_half(&truth->picture, chart, 1));
    TURNER_TRY(make_half(&truths->half, chart, 2));
    size_t count = (size_t)truths->half.width * (size_t)truths->half.height * 4;
    for (size_t i = 0; i < count; i++)
        truth->picture.rgba[i] = (truth->picture.rgba[i] + truths->half.rgba[i]) / 2;
    return TURNER_OK;
}

/* ---- the same sample positions ---- */

static struct turner_settings settings_of_truth(const struct turner_chart *chart,
                                                const struct turner_chart_point *point)
{
    if (chart->against == TURNER_CHART_ARITHMETIC)
        return point->settings;
    struct turner_settings deep = deep_settings(chart);
    deep.spp = point->settings.spp;
    return deep;
}

static bool same_truth(const struct turner_settings *a, const struct turner_settings *b)
{
    return a->spp == b->spp && a->aa_threshold == b->aa_threshold && a->depth == b->depth &&
           a->cutoff == b->cutoff && a->methods.fresnel == b->methods.fresnel;
}

static struct turner_chart_truth *find(const struct turner_chart_truths *truths,
                                       const struct turner_settings *settings)
{
    for (size_t i = 0; i < truths->count; i++) {
        if (same_truth(&truths->items[i].settings, settings))
            return &truths->items[i];
    }
    return NULL;
}

/* Adaptive samples lie where the picture wants them, and the reference has none there. */
static bool leave_out_adaptive(struct turner_chart_point *point)
{
    if (!(point->settings.aa_threshold > 0) && !(point->settings.error > 0))
        return false;
    snprintf(point->left_out, sizeof point->left_out,
             "the reference has no adaptive samples to compare with; use --against pixel");
    point->runs = 0;
    return true;
}

static enum turner_result make_truths_of_points(struct turner_chart_truths *truths,
                                                struct turner_chart *chart)
{
    for (size_t i = 0; i < chart->point_count; i++) {
        struct turner_settings settings = settings_of_truth(chart, &chart->points[i]);
        double pruned;
        if (!chart->points[i].runs || leave_out_adaptive(&chart->points[i]) ||
            find(truths, &settings))
            continue;
        struct turner_chart_truth *truth =
            TURNER_PUSH(truths->items, truths->count, truths->capacity);
        *truth = (struct turner_chart_truth){.settings = settings};
        char what[320];
        snprintf(what, sizeof what, "reference for %s", chart->points[i].label);
        TURNER_TRY(turner_chart_reference(&truth->picture, &pruned, chart, &settings, 0, what));
        if (chart->against == TURNER_CHART_SAMPLES)
            chart->truth_pruned = fmax(chart->truth_pruned, pruned);
    }
    return TURNER_OK;
}

/* ---- both ---- */

enum turner_result turner_chart_truths_create(struct turner_chart_truths *truths,
                                              struct turner_chart *chart)
{
    *truths = (struct turner_chart_truths){0};
    struct turner_settings deep = deep_settings(chart);
    chart->truth_depth = deep.depth;
    chart->truth_cutoff = deep.cutoff;
    return chart->against == TURNER_CHART_PIXEL ? make_pixel_truth(truths, chart)
                                                : make_truths_of_points(truths, chart);
}

void turner_chart_truths_destroy(struct turner_chart_truths *truths)
{
    for (size_t i = 0; i < truths->count; i++)
        turner_image_destroy(&truths->items[i].picture);
    turner_image_destroy(&truths->half);
    free(truths->items);
    *truths = (struct turner_chart_truths){0};
}

const struct turner_image *turner_chart_truth_of(const struct turner_chart_truths *truths,
                                                 const struct turner_chart *chart,
                                                 const struct turner_chart_point *point)
{
    if (chart->against == TURNER_CHART_PIXEL)
        return &truths->items[0].picture;
    struct turner_settings settings = settings_of_truth(chart, point);
    return &find(truths, &settings)->picture;
}
