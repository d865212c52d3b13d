#include "render/estimate.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define SMOOTH 0.5f      /* of the sum of bends; a smooth function is wrong by a sixth of it */
#define REST 0.03f       /* of bends that cancel */
#define EDGE 2.0f        /* of bends that are independent; the root mean square of errors is 0.4 */
#define LEAST 0.05f      /* of that, where bends shrink though less than in a smooth cell */
#define SHRINKS 0.35f    /* to that of its parent's bend: a smooth cell's to a quarter */
#define HALVES 0.52f     /* to about that: a kink's */
#define STAYS 0.7f       /* at least that much: an edge's or disorder's */
#define SAFETY 1.3f      /* what the truth goes beyond all this on one pixel of a thousand */
#define HIDDEN 0.1f      /* of the bend suspected, that a cell of a quarter pixel may hide */
#define HIDDEN_LEVEL 2
#define LOOK 0.6f        /* of the bends in a crowd, that is worth a second look */
#define POOL 0.3f        /* of what edges add around a pixel, that its own estimate is at least */
#define POOL_WHOLE 0.12f /* the same of pixels that were not divided; see turner_estimate_shared */
#define POOL_RANK 2      /* of the eight around */
#define ROUNDING 5.5e-7f /* of the radiance */
#define ROUNDING_BLEND 3e-8f /* of what a gradient spans: half the spacing of floats below 1 */
#define ROUNDING_PLACE 4e-7f /* of the picture's size, that rounding moves a ray by */

float turner_estimate_of_samples(const struct turner_estimate *estimate)
{
    return hypotf(estimate->sampling, estimate->hidden);
}

float turner_estimate_total(const struct turner_estimate *estimate)
{
    return turner_estimate_of_samples(estimate) + estimate->cut + estimate->methods +
           estimate->rounding;
}

static float largest(const float v[3])
{
    return fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2])));
}

float turner_estimate_bend(float bend[3], const struct turner_lattice *lattice,
                           const struct turner_cell *cell)
{
    float(*const v)[4] = lattice->values;
    for (int c = 0; c < 3; c++) {
        float corners = 0;
        for (int i = 0; i < 4; i++)
            corners += cell->weight[i] * v[cell->corner[i]][c];
        bend[c] = corners - v[cell->center][c];
    }
    return largest(bend);
}

/* ---- what is beyond the sides of a cell ---- */

struct end {
    int32_t x, y; /* place in the lattice */
    uint32_t sample;
};

/* The most that samples on a side, there because the cell beyond was divided, differ from what is
 * linear along it, times the share of the side that they stand for. */
static float bend_along(const struct turner_lattice *lattice, struct end a, struct end b)
{
    float(*const v)[4] = lattice->values, (*const p)[2] = lattice->positions;
    struct end middle = {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2, 0};
    if (b.x - a.x + b.y - a.y < 2 ||
        !turner_lattice_find(lattice, middle.x, middle.y, &middle.sample))
        return 0;
    int axis = a.x == b.x;
    float t = (p[middle.sample][axis] - p[a.sample][axis]) /
              (p[b.sample][axis] - p[a.sample][axis]), bend[3];
    for (int c = 0; c < 3; c++)
        bend[c] = v[middle.sample][c] - (v[a.sample][c] + t * (v[b.sample][c] - v[a.sample][c]));
    return 0.5f * fmaxf(largest(bend), fmaxf(bend_along(lattice, a, middle),
                                             bend_along(lattice, middle, b)));
}

/* Only the sides within the pixel: what is beyond the others depends on where the tile ends. */
static float bend_beyond(const struct turner_lattice *lattice, const struct turner_patch *patch,
                         const struct turner_cell *cell)
{
    int32_t edge = 1 << (lattice->shift - cell->level), last = (1 << cell->level) - 1;
    int32_t x = patch->x * (1 << lattice->shift) + cell->x * edge;
    int32_t y = patch->y * (1 << lattice->shift) + cell->y * edge;
    const struct end ends[4] = {{x, y, cell->corner[0]},
                                {x + edge, y, cell->corner[1]},
                                {x, y + edge, cell->corner[2]},
                                {x + edge, y + edge, cell->corner[3]}};
    const struct {
        bool within;
        int from, to;
    } sides[4] = {{cell->y > 0, 0, 1}, {cell->x > 0, 0, 2}, {cell->x < last, 1, 3},
                  {cell->y < last, 2, 3}};
    float most = 0;
    for (int i = 0; i < 4; i++) {
        if (sides[i].within)
            most = fmaxf(most, bend_along(lattice, ends[sides[i].from], ends[sides[i].to]));
    }
    return most;
}

/* ---- the estimate ---- */

/* The most that a channel changes from the centre to a corner. */
static float slope(const struct turner_lattice *lattice, const struct turner_cell *cell)
{
    float(*const v)[4] = lattice->values;
    float most = 0;
    for (int c = 0; c < 3; c++) {
        for (int i = 0; i < 4; i++)
            most = fmaxf(most, fabsf(v[cell->corner[i]][c] - v[cell->center][c]));
    }
    return most;
}

static float ratio(float a, float b)
{
    return b > 0 ? a / b : INFINITY;
}

/* What is left of a bend from level to level: since the last division or, where that is less, in the
 * mean of the last three. A kink that lies near the side of a cell is hardly in its bend, and the part
 * with the kink has as much: only further back does it show that bends there halve. */
static float left_of_bend(const struct turner_cell *cell)
{
    float left = ratio(cell->bend, cell->older_bends[0]);
    if (cell->level == 2)
        left = fminf(left, sqrtf(ratio(cell->bend, cell->older_bends[1])));
    if (cell->level > 2)
        left = fminf(left, cbrtf(ratio(cell->bend, cell->older_bends[2])));
    return left;
}

float turner_estimate_roughness(const struct turner_cell *cell)
{
    if (cell->bend <= SHRINKS * cell->older_bends[0])
        return 0;
    float more = (left_of_bend(cell) - HALVES) / (STAYS - HALVES);
    return LEAST + (1 - LEAST) * fmaxf(0, fminf(1, more));
}

/* What no sample saw: a thing of half the size has an eighth of the chance. */
static float hidden_in(int level, const struct turner_surroundings *around)
{
    return HIDDEN * around->hidden * ldexpf(1, 3 * (HIDDEN_LEVEL - level));
}

static float look_in(int level, const struct turner_surroundings *around)
{
    return LOOK * around->crowd * ldexpf(1, -2 * level);
}

struct turner_estimate turner_estimate_pixel(const struct turner_cells *cells,
                                             const struct turner_patch *patch,
                                             const struct turner_scale *scale)
{
    const struct turner_lattice *lattice = cells->lattice;
    const struct turner_surroundings *around = &patch->around;
    struct turner_estimate e = {0};
    float sum[3] = {0}, squares = 0, rest = 0, place = 0, value[4];
    for (size_t i = patch->first; i < patch->first + patch->count; i++) {
        struct turner_cell *cell = &cells->cells[i];
        float area = cell->area, bend[3];
        cell->bend = fmaxf(turner_estimate_bend(bend, lattice, cell),
                           bend_beyond(lattice, patch, cell));
        float part = area * cell->bend;
        for (int c = 0; c < 3; c++)
            sum[c] += area * bend[c];
        float rough = turner_estimate_roughness(cell), hidden = hidden_in(cell->level, around);
        if (rough > 0) {
            squares += rough * part * rough * part;
        } else {
            rest += part;
            place += sqrtf(area) * slope(lattice, cell);
        }
        cell->measure = fmaxf(part * (rough > 0 ? rough * EDGE : SMOOTH),
                              fmaxf(hidden, look_in(cell->level, around)));
        e.hidden = fmaxf(e.hidden, hidden);
        e.look = fmaxf(e.look, look_in(cell->level, around));
    }
    turner_cells_value(value, cells, patch);
    e.edges = SAFETY * EDGE * sqrtf(squares);
    e.sampling = SAFETY * (fmaxf(SMOOTH * largest(sum), EDGE * sqrtf(squares)) + REST * rest);
    e.cut = value[3] * scale->bound;
    e.methods = SAFETY * around->methods;
    e.rounding = ROUNDING * largest(value) + ROUNDING_BLEND * scale->blend +
                 ROUNDING_PLACE * scale->size * place + FLT_MIN;
    return e;
}

/* The few cells of a pixel that was not divided cannot tell a kink beside a cell's side from an edge,
 * and count it as one; and a kink hides nothing. */
float turner_estimate_shared(const struct turner_estimate *estimate, bool divided)
{
    return (divided ? POOL : POOL_WHOLE) * hypotf(estimate->edges, estimate->hidden) +
           POOL * estimate->methods;
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

void turner_estimate_pool(float *pooled, const float *errors, const float *shared, int width,
                          int height)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            float around[8];
            int count = 0;
            for (int i = 0; i < 9; i++) {
                int column = x + i % 3 - 1, row = y + i / 3 - 1;
                if (i != 4 && column >= 0 && column < width && row >= 0 && row < height)
                    around[count++] = shared[(size_t)row * (size_t)width + (size_t)column];
            }
            qsort(around, (size_t)count, sizeof *around, compare_floats);
            size_t at = (size_t)y * (size_t)width + (size_t)x;
            pooled[at] = count < POOL_RANK ? errors[at]
                                           : fmaxf(errors[at], around[count - POOL_RANK]);
        }
    }
}
