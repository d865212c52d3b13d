#include "render/tally.h"

#include <stdlib.h>

#include "base/memory.h"

void turner_tally_add(struct turner_gpu_pixel_counts *sum, struct turner_gpu_pixel_counts more)
{
    sum->rays = sum->rays + more.rays < sum->rays ? UINT32_MAX : sum->rays + more.rays;
    sum->recursion = more.recursion > sum->recursion ? more.recursion : sum->recursion;
}

static int compare_indices(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

struct turner_gpu_pixel_counts turner_tally_patch(const struct turner_cells *cells,
                                                  const struct turner_patch *patch)
{
    struct turner_gpu_pixel_counts sum = {0};
    size_t count = 0;
    uint32_t *samples = turner_calloc(patch->count * TURNER_CELL_SAMPLES, sizeof *samples);
    for (size_t i = patch->first; i < patch->first + patch->count; i++) {
        samples[count++] = cells->cells[i].center;
        for (int corner = 0; corner < 4; corner++)
            samples[count++] = cells->cells[i].corner[corner];
    }
    qsort(samples, count, sizeof *samples, compare_indices);
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || samples[i] != samples[i - 1])
            turner_tally_add(&sum, cells->lattice->counts[samples[i]]);
    }
    free(samples);
    return sum;
}
