/* The runner: tolerances, counting, printing. */
#include "analytic/analytic.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "analytic/checks.h"

struct analytic {
    analytic_renderer render;
    double tolerance;
    int failures, comparisons;
    double worst; /* error over what is allowed */
    char where[160];
};

#define FAILURES_SHOWN 5

static void fail(struct analytic *a, const char *message)
{
    if (a->failures++ < FAILURES_SHOWN)
        printf("    %s\n", message);
}

void analytic_expect(struct analytic *a, double got, double want, double conditioning,
                     const char *format, ...)
{
    char what[96], message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    double allowed = a->tolerance * conditioning, error = fabs(got - want);
    a->comparisons++;
    if (!(error <= allowed * a->worst)) {
        a->worst = error / allowed;
        snprintf(a->where, sizeof a->where, "%s", what);
    }
    if (!(error <= allowed)) {
        snprintf(message, sizeof message, "%s: %.9g, expected %.9g ± %.2g", what, got, want,
                 allowed);
        fail(a, message);
    }
}

void analytic_require(struct analytic *a, bool condition, const char *format, ...)
{
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    a->comparisons++;
    if (!condition)
        fail(a, message);
}

bool analytic_render(struct analytic *a, struct turner_image *image,
                     const struct turner_scene *scene)
{
    *image = (struct turner_image){0};
    enum turner_result result = turner_scene_validate(scene);
    if (result == TURNER_OK)
        result = a->render(image, scene);
    if (result != TURNER_OK)
        fail(a, turner_message());
    return result == TURNER_OK;
}

int analytic_run(analytic_renderer render, enum analytic_precision precision, const char *filter)
{
    int failed = 0;
    for (const struct analytic_check *check = analytic_checks; check->name; check++) {
        if (filter && !strstr(check->name, filter))
            continue;
        struct analytic a = {
            .render = render,
            .tolerance = precision == ANALYTIC_EXTENDED ? check->extended : check->single};
        check->run(&a);
        if (a.comparisons == 0)
            fail(&a, "nothing was compared");
        printf("%-28s %s  %6d values, worst error %.2g of the tolerance %.1g%s%s\n", check->name,
               a.failures == 0 ? "ok    " : "FAILED", a.comparisons, a.worst, a.tolerance,
               a.where[0] ? " at " : "", a.where);
        if (a.failures > FAILURES_SHOWN)
            printf("    … %d failures in all\n", a.failures);
        fflush(stdout);
        failed += a.failures > 0;
    }
    return failed;
}
