#include <math.h>

#include "app/bench.h"

bool turner_bench_fit_log(struct turner_bench_fit *fit, const struct turner_bench *bench,
                          size_t tracer, int kind)
{
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (size_t i = 0; i < bench->scene_count; i++) {
        const struct turner_bench_cell *cell = &bench->scenes[i].cells[kind][tracer];
        if (!cell->rounds)
            continue;
        double x = log2((double)bench->scenes[i].primitives), y = 1e9 / cell->rate;
        n++;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    if (n < 3)
        return false;
    fit->b = (n * sxy - sx * sy) / (n * sxx - sx * sx);
    fit->a = (sy - fit->b * sx) / n;
    fit->off = 0;
    for (size_t i = 0; i < bench->scene_count; i++) {
        const struct turner_bench_cell *cell = &bench->scenes[i].cells[kind][tracer];
        if (!cell->rounds)
            continue;
        double line = fit->a + fit->b * log2((double)bench->scenes[i].primitives);
        fit->off = fmax(fit->off, fabs(1e9 / cell->rate / line - 1));
    }
    return true;
}
