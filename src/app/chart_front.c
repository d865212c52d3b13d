/* What is best of what was measured. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/chart.h"

static int compare_reals(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void turner_chart_quartiles(double quartiles[3], const double *seconds, int count)
{
    double sorted[TURNER_CHART_MAX_RUNS];
    memcpy(sorted, seconds, (size_t)count * sizeof *sorted);
    qsort(sorted, (size_t)count, sizeof *sorted, compare_reals);
    for (int i = 0; i < 3; i++) {
        double at = (count - 1) * (i + 1) / 4.0;
        int below = (int)at;
        double above = sorted[below + 1 < count ? below + 1 : below];
        quartiles[i] = sorted[below] + (at - below) * (above - sorted[below]);
    }
}

static double time_of(const struct turner_chart_point *point)
{
    return point->quartiles[1];
}

static bool counts(const struct turner_chart_point *point, enum turner_chart_metric metric)
{
    return point->runs > 0 && isfinite(point->errors[metric]) && !point->twin[metric];
}

void turner_chart_mark_twins(struct turner_chart_point *points, size_t count,
                             enum turner_chart_metric metric)
{
    const double margin = 1.01;
    for (size_t i = 0; i < count; i++) {
        struct turner_chart_point *p = &points[i];
        p->twin[metric] = false;
        for (size_t k = 0; k < count && !p->twin[metric]; k++) {
            const struct turner_chart_point *plain = &points[k];
            p->twin[metric] = p->runs && plain->runs && plain->departures < p->departures &&
                              plain->quartiles[0] <= p->quartiles[2] &&
                              plain->errors[metric] <= margin * p->errors[metric];
        }
    }
}

/* At least as good in both, and better in one. */
static bool beats(const struct turner_chart_point *a, const struct turner_chart_point *b,
                  enum turner_chart_metric metric)
{
    double error_a = a->errors[metric], error_b = b->errors[metric];
    return time_of(a) <= time_of(b) && error_a <= error_b &&
           (time_of(a) < time_of(b) || error_a < error_b);
}

static bool equals(const struct turner_chart_point *a, const struct turner_chart_point *b,
                   enum turner_chart_metric metric)
{
    return time_of(a) == time_of(b) && a->errors[metric] == b->errors[metric];
}

void turner_chart_mark_front(struct turner_chart_point *points, size_t count,
                             enum turner_chart_metric metric)
{
    for (size_t i = 0; i < count; i++) {
        bool front = counts(&points[i], metric);
        for (size_t k = 0; k < count && front; k++) {
            if (!counts(&points[k], metric))
                continue;
            front = !beats(&points[k], &points[i], metric) &&
                    !(k < i && equals(&points[k], &points[i], metric));
        }
        points[i].front[metric] = front;
    }
}

size_t turner_chart_best_error(const struct turner_chart_point *points, size_t count,
                               enum turner_chart_metric metric, double seconds)
{
    size_t best = TURNER_CHART_NO_POINT;
    for (size_t i = 0; i < count; i++) {
        const struct turner_chart_point *p = &points[i];
        if (!counts(p, metric) || !(time_of(p) <= seconds))
            continue;
        const struct turner_chart_point *b = best == TURNER_CHART_NO_POINT ? NULL : &points[best];
        if (!b || p->errors[metric] < b->errors[metric] ||
            (p->errors[metric] == b->errors[metric] && time_of(p) < time_of(b)))
            best = i;
    }
    return best;
}

size_t turner_chart_least_time(const struct turner_chart_point *points, size_t count,
                               enum turner_chart_metric metric, double error)
{
    size_t best = TURNER_CHART_NO_POINT;
    for (size_t i = 0; i < count; i++) {
        const struct turner_chart_point *p = &points[i];
        if (!counts(p, metric) || !(p->errors[metric] <= error))
            continue;
        const struct turner_chart_point *b = best == TURNER_CHART_NO_POINT ? NULL : &points[best];
        if (!b || time_of(p) < time_of(b) ||
            (time_of(p) == time_of(b) && p->errors[metric] < b->errors[metric]))
            best = i;
    }
    return best;
}

/* ---- round limits ---- */

/* 1, 2, 5, 10, 20 … of a count that starts at 10 to the power of −12. */
static double round_number(int i)
{
    static const double steps[] = {1, 2, 5};
    return steps[i % 3] * pow(10, i / 3 - 12);
}
enum { ROUND_NUMBERS = 3 * 20 };

size_t turner_chart_time_limits(double limits[TURNER_CHART_MAX_LIMITS],
                                const struct turner_chart_point *points, size_t count,
                                enum turner_chart_metric metric)
{
    size_t found = 0, before = TURNER_CHART_NO_POINT;
    for (int i = 0; i < ROUND_NUMBERS; i++) {
        size_t best = turner_chart_best_error(points, count, metric, round_number(i));
        if (best != before)
            limits[found++] = round_number(i);
        before = best;
    }
    return found;
}

bool turner_chart_has_8_bits(enum turner_chart_metric metric)
{
    return metric == TURNER_CHART_RMSE || metric == TURNER_CHART_LARGEST;
}

size_t turner_chart_error_limits(double limits[TURNER_CHART_MAX_LIMITS],
                                 const struct turner_chart_point *points, size_t count,
                                 enum turner_chart_metric metric)
{
    size_t found = 0, before = TURNER_CHART_NO_POINT;
    bool wanted = turner_chart_has_8_bits(metric); /* the step of 8 bits, once, in its place */
    for (int i = 0; i < ROUND_NUMBERS; i++) {
        bool special = wanted && round_number(i) > 1 / 255.0;
        double limit = special ? 1 / 255.0 : round_number(i);
        size_t best = turner_chart_least_time(points, count, metric, limit);
        if (best != before || (special && best != TURNER_CHART_NO_POINT))
            limits[found++] = limit;
        before = best;
        wanted = wanted && !special;
        i -= special; /* the round number's turn is still to come */
    }
    for (size_t i = 0; i < found / 2; i++) {
        double swapped = limits[i];
        limits[i] = limits[found - 1 - i];
        limits[found - 1 - i] = swapped;
    }
    return found;
}
