#include "render/surroundings.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/estimate.h"
#include "render/follow.h"

#define CROWD_RANK 3  /* of the 24 pixels around, whose bend counts */
#define HIDDEN_RANK 4 /* of the 8 */

bool turner_tile_has(const struct turner_tile *tile, int x, int y)
{
    return x >= tile->x && x < tile->x + tile->width && y >= tile->y && y < tile->y + tile->height;
}

static int compare_falling(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x > y ? -1 : x < y;
}

/* ---- from first cells ---- */

static float crowd_around(struct turner_lattice *lattice, int x, int y)
{
    struct turner_cell cell;
    float bends[24], bend[3];
    size_t count = 0;
    for (int i = 0; i < 25; i++) {
        if (i == 12)
            continue;
        turner_cells_first(&cell, lattice, x + i % 5 - 2, y + i / 5 - 2);
        bends[count++] = turner_estimate_bend(bend, lattice, &cell);
    }
    qsort(bends, count, sizeof *bends, compare_falling);
    return bends[CROWD_RANK - 1];
}

/* The most that a sample in the 3×3 pixels is off from what accurate methods find there. */
static float methods_around(struct turner_lattice *lattice, const float (*accurate)[4], int x,
                            int y)
{
    struct turner_cell cell;
    float most = 0;
    for (int i = 0; i < 9; i++) {
        turner_cells_first(&cell, lattice, x + i % 3 - 1, y + i / 3 - 1);
        for (int k = 0; k < TURNER_CELL_SAMPLES; k++) {
            uint32_t sample = k < 4 ? cell.corner[k] : cell.center;
            for (int c = 0; c < 3; c++)
                most = fmaxf(most, fabsf(lattice->values[sample][c] - accurate[sample][c]));
        }
    }
    return most;
}

/* Traces all samples there are again by accurate methods. */
static enum turner_result find_methods(struct turner_cells *cells, const struct turner_tile *tile,
                                       struct turner_renderer *renderer, float bound)
{
    struct turner_lattice accurate = *cells->lattice; /* the same places */
    double unused;
    accurate.counted = false;
    accurate.traced = 0;
    accurate.values = turner_calloc(accurate.count, sizeof *accurate.values);
    enum turner_result result = turner_follow(&accurate, renderer, bound, &unused);
    for (size_t i = 0; i < cells->patch_count && result == TURNER_OK; i++) {
        struct turner_patch *patch = &cells->patches[i];
        if (turner_tile_has(tile, patch->x, patch->y))
            patch->around.methods = methods_around(
                cells->lattice, (const float(*)[4])accurate.values, patch->x, patch->y);
    }
    free(accurate.values);
    return result;
}

enum turner_result turner_surroundings_first(struct turner_cells *cells,
                                             const struct turner_tile *tile,
                                             struct turner_renderer *renderer, float bound)
{
    for (size_t i = 0; i < cells->patch_count; i++) {
        struct turner_patch *patch = &cells->patches[i];
        if (turner_tile_has(tile, patch->x, patch->y))
            patch->around.crowd = crowd_around(cells->lattice, patch->x, patch->y);
    }
    return renderer->accurate ? find_methods(cells, tile, renderer->accurate, bound) : TURNER_OK;
}

/* ---- from cells of a quarter pixel ---- */

/* Of edges and disorder: where radiance is smooth, nothing is suspected. */
static float largest_bend(const struct turner_cells *cells, const struct turner_patch *patch)
{
    float most = 0, bend[3];
    for (size_t i = patch->first; i < patch->first + patch->count; i++) {
        struct turner_cell cell = cells->cells[i];
        cell.bend = turner_estimate_bend(bend, cells->lattice, &cell);
        most = fmaxf(most, turner_estimate_roughness(&cell) * cell.bend);
    }
    return most;
}

void turner_surroundings_fine(struct turner_cells *cells, const struct turner_tile *tile)
{
    int width = tile->width + 2, height = tile->height + 2;
    float *bends = turner_calloc((size_t)width * (size_t)height, sizeof *bends);
    for (size_t i = 0; i < cells->patch_count; i++) {
        const struct turner_patch *patch = &cells->patches[i];
        bends[(patch->y - tile->y + 1) * width + patch->x - tile->x + 1] =
            largest_bend(cells, patch);
    }
    for (size_t i = 0; i < cells->patch_count; i++) {
        struct turner_patch *patch = &cells->patches[i];
        if (!turner_tile_has(tile, patch->x, patch->y))
            continue;
        const float *own = bends + (patch->y - tile->y + 1) * width + patch->x - tile->x + 1;
        float around[8];
        size_t count = 0;
        for (int k = 0; k < 9; k++) {
            if (k != 4)
                around[count++] = own[(k / 3 - 1) * width + k % 3 - 1];
        }
        qsort(around, count, sizeof *around, compare_falling);
        patch->around.hidden = fmaxf(*own, around[HIDDEN_RANK - 1]);
    }
    free(bends);
}
