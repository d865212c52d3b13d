#include "render/estimate.h"

#include <math.h>
#include <stdlib.h>

#define SMOOTH 0.8f      /* of the sum of bends; a smooth function is wrong by a sixth of it */
#define REST 0.05f       /* of bends that cancel */
#define EDGE 2.0f        /* of bends that are independent; the root mean square of errors is 0.4 */
#define LEAST 0.33f      /* of that, where a bend is little more than a smooth cell's */
#define SHRINKS 0.35f    /* of its parent's bend: a smooth cell's is a quarter */
#define EVEN 4.0f        /* times its own, that bends may reach around a smooth pixel */
#define STEADY 0.7f      /* of its own, that bends around a smooth pixel may differ from it */
#define SAFETY 1.25f     /* what the truth goes beyond all this on one pixel of a thousand */
#define HIDDEN 0.025f    /* of the bend suspected, that a cell of a quarter pixel may hide */
#define HIDDEN_LEVEL 2
#define LOOK 0.6f        /* of the bends in a crowd, that is worth a second look */
#define CROWD_RANK 3     /* of the 24 pixels around, whose bend counts there */
#define POOL 0.8f        /* of the estimates around a pixel, that its own is at least */
#define POOL_RANK 4      /* of the eight around */
#define ROUNDING 6e-7f   /* of the radiance */
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

static void bend_of(float bend[3], const struct turner_lattice *lattice,
                    const struct turner_cell *cell)
{
    float(*const v)[4] = lattice->values;
    for (int c = 0; c < 3; c++) {
        float corners = 0;
        for (int i = 0; i < 4; i++)
            corners += cell->weight[i] * v[cell->corner[i]][c];
        bend[c] = corners - v[cell->center][c];
    }
}

static float largest(const float v[3])
{
    return fmaxf(fabsf(v[0]), fmaxf(fabsf(v[1]), fabsf(v[2])));
}

/* ---- what is around a pixel ---- */

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return x < y ? -1 : x > y;
}

/* The bend of the square that stands on its corner, between the centres of two pixels and the ends
 * of the side they share. */
static float bend_across(const struct turner_lattice *lattice, const struct turner_cell *a,
                         const struct turner_cell *b, uint32_t end1, uint32_t end2)
{
    float(*const v)[4] = lattice->values;
    float bend[3];
    for (int c = 0; c < 3; c++)
        bend[c] = 0.5f * ((v[a->center][c] + v[b->center][c]) - (v[end1][c] + v[end2][c]));
    return largest(bend);
}

static const float zero[3];

static float bend_at(const struct turner_lattice *lattice, const struct turner_cell *cell,
                     const float less[3], float bend[3])
{
    bend_of(bend, lattice, cell);
    for (int c = 0; c < 3; c++)
        bend[c] -= less[c];
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

struct turner_surroundings turner_surroundings_of(struct turner_lattice *lattice, int x, int y)
{
    static const int ends[3][3][2] = {/* of the side shared with a neighbour */
        {{0, 0}, {0, 1}, {0, 0}}, {{0, 2}, {0, 0}, {1, 3}}, {{0, 0}, {2, 3}, {0, 0}}};
    struct turner_surroundings around = {0};
    struct turner_cell cell, other;
    float own[3], bend[3], bends[8], changes[8], all[24];
    size_t count = 0, all_count = 0;
    turner_cells_first(&cell, lattice, x, y);
    around.own = around.most = bend_at(lattice, &cell, zero, own);
    for (int dy = -2; dy <= 2; dy++) {
        for (int dx = -2; dx <= 2; dx++) {
            turner_cells_first(&other, lattice, x + dx, y + dy);
            if (dx == 0 && dy == 0)
                continue;
            float other_bend = bend_at(lattice, &other, zero, bend);
            all[all_count++] = other_bend;
            if (abs(dx) > 1 || abs(dy) > 1)
                continue;
            bends[count] = other_bend;
            changes[count++] = bend_at(lattice, &other, own, bend);
            const int *end = ends[dy + 1][dx + 1];
            if (dx == 0 || dy == 0)
                around.most = fmaxf(around.most,
                                    bend_across(lattice, &cell, &other, cell.corner[end[0]],
                                                cell.corner[end[1]]));
        }
    }
    qsort(bends, count, sizeof *bends, compare_floats);
    qsort(changes, count, sizeof *changes, compare_floats);
    qsort(all, all_count, sizeof *all, compare_floats);
    around.change = changes[count / 2];
    around.crowd = all[all_count - CROWD_RANK];
    around.most = fmaxf(around.most, bends[count / 2]);
    return around;
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

/* Whether radiance goes on around the pixel as it does in it. */
static bool is_even(const struct turner_surroundings *around)
{
    return around->most <= EVEN * around->own && around->change <= STEADY * around->own;
}

/* 0 where radiance is smooth in the cell, 1 where its bend is as large as that of the cell it was part
 * of: an edge or disorder. */
static float roughness(const struct turner_cell *cell)
{
    float smooth = SHRINKS * cell->parent_bend;
    if (cell->bend <= smooth)
        return 0;
    return fminf(1, LEAST + (1 - LEAST) * (cell->bend - smooth) / (cell->parent_bend - smooth));
}

/* What no sample saw: a thing of half the size has an eighth of the chance. */
static float hidden_in(int level, const struct turner_surroundings *around)
{
    return is_even(around) ? 0 : HIDDEN * around->most * ldexpf(1, 3 * (HIDDEN_LEVEL - level));
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
        cell->bend = fmaxf(bend_at(lattice, cell, zero, bend), bend_beyond(lattice, patch, cell));
        float part = area * cell->bend;
        for (int c = 0; c < 3; c++)
            sum[c] += area * bend[c];
        float rough = roughness(cell), hidden = hidden_in(cell->level, around);
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
    e.sampling = SAFETY * (fmaxf(SMOOTH * largest(sum), EDGE * sqrtf(squares)) + REST * rest);
    e.cut = value[3] * scale->bound;
    e.methods = SAFETY * around->methods;
    e.rounding = ROUNDING * largest(value) + ROUNDING_PLACE * scale->size * place;
    return e;
}

void turner_estimate_pool(float *pooled, const float *errors, int width, int height)
{
    for (int y = 0; y < height; y++) {
        for (int x = 0; x < width; x++) {
            float around[8];
            int count = 0;
            for (int i = 0; i < 9; i++) {
                int column = x + i % 3 - 1, row = y + i / 3 - 1;
                if (i != 4 && column >= 0 && column < width && row >= 0 && row < height)
                    around[count++] = errors[(size_t)row * (size_t)width + (size_t)column];
            }
            qsort(around, (size_t)count, sizeof *around, compare_floats);
            size_t at = (size_t)y * (size_t)width + (size_t)x;
            pooled[at] = count < POOL_RANK
                             ? errors[at]
                             : fmaxf(errors[at], POOL * around[count - POOL_RANK]);
        }
    }
}
