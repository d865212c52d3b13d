#include "render/estimate.h"

#include <math.h>
#include <stdlib.h>

#define SMOOTH 0.8f      /* of the sum of bends; a smooth function is wrong by a sixth of it */
#define REST 0.05f       /* of bends that cancel */
#define EDGE 2.2f        /* of bends that are independent: more than four deviations of 0.5 */
#define STRAIGHT 0.65f   /* of the bends along an edge that runs as the squares do */
#define STRAIGHT_LEAST 0.45f /* where squares differ, along lines */
#define STRAIGHT_AREA 0.25f  /* where they fill the pixel */
#define SHRINKS 0.35f    /* of its parent's bend: a smooth square's is a quarter */
#define EVEN 4.0f        /* times its own, that bends may reach around a smooth square */
#define STEADY 0.7f      /* of its own, that bends around a smooth square may differ from it */
#define SAFETY 1.25f     /* what the truth goes beyond all this on one pixel of a thousand */
#define LOOK 0.05f       /* of the greatest bend in the neighbours, that is worth a second look */
#define FARTHER 0.5f     /* of a bend in the pixel beyond that */
#define ROUNDING 6e-7f   /* of the radiance */
#define ROUNDING_PLACE 4e-7f /* of the picture's size, that rounding moves a ray by */

/* Of the greatest bend around, what a square of each level may hide. */
static const float hidden_share[] = {0.5f, 0.2f, 0.018f, 0.0022f};
#define HIDDEN_LEVELS 3

float turner_estimate_total(const struct turner_estimate *estimate)
{
    return estimate->sampling + estimate->hidden + estimate->cut + estimate->rounding;
}

static void bend_of(float bend[3], const struct turner_lattice *lattice,
                    const struct turner_cell *cell)
{
    float(*const v)[4] = lattice->values;
    for (int c = 0; c < 3; c++)
        bend[c] = 0.25f * ((v[cell->corner[0]][c] + v[cell->corner[1]][c]) +
                           (v[cell->corner[2]][c] + v[cell->corner[3]][c])) -
                  v[cell->center][c];
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

struct turner_surroundings turner_surroundings_of(struct turner_lattice *lattice, int x, int y)
{
    static const int ends[3][3][2] = {/* of the side shared with a neighbour */
        {{0, 0}, {0, 1}, {0, 0}}, {{0, 2}, {0, 0}, {1, 3}}, {{0, 0}, {2, 3}, {0, 0}}};
    struct turner_surroundings around = {0};
    struct turner_cell cell, other;
    float own[3], bend[3], bends[8], changes[8];
    size_t count = 0;
    turner_cells_first(&cell, lattice, x, y);
    around.own = around.most = bend_at(lattice, &cell, zero, own);
    for (int dy = -2; dy <= 2; dy++) {
        for (int dx = -2; dx <= 2; dx++) {
            turner_cells_first(&other, lattice, x + dx, y + dy);
            float far = bend_at(lattice, &other, zero, bend);
            bool next = abs(dx) < 2 && abs(dy) < 2;
            around.far = fmaxf(around.far, next ? far : FARTHER * far);
            if (!next || (dx == 0 && dy == 0))
                continue;
            bends[count] = far;
            changes[count++] = bend_at(lattice, &other, own, bend);
            const int *end = ends[dy + 1][dx + 1];
            if (dx == 0 || dy == 0)
                around.most =
                    fmaxf(around.most, bend_across(lattice, &cell, &other, cell.corner[end[0]],
                                                   cell.corner[end[1]]));
        }
    }
    qsort(bends, count, sizeof *bends, compare_floats);
    qsort(changes, count, sizeof *changes, compare_floats);
    around.median = bends[count / 2];
    around.change = changes[count / 2];
    around.most = fmaxf(around.most, around.median);
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

static bool is_smooth(const struct turner_cell *cell, const struct turner_surroundings *around)
{
    return cell->level > 0 ? cell->bend <= SHRINKS * cell->parent_bend : is_even(around);
}

static float hidden_in(int level, const struct turner_surroundings *around)
{
    return around->most * (level <= HIDDEN_LEVELS
                               ? hidden_share[level]
                               : hidden_share[HIDDEN_LEVELS] * ldexpf(1, 3 * (HIDDEN_LEVELS - level)));
}

static float look_in(int level, const struct turner_surroundings *around)
{
    return LOOK * around->far * ldexpf(1, -2 * level);
}

/* Bends of squares that an edge or disorder runs through. */
struct disorder {
    float sum, squares, area;
    int count;
};

static float error_of_disorder(const struct disorder *d)
{
    if (d->count == 0)
        return 0;
    /* 1 where all are the same, as along an edge that meets every square in the same way */
    float alike = d->sum * d->sum / ((float)d->count * d->squares);
    alike *= alike;
    float least = STRAIGHT_LEAST + d->area * (STRAIGHT_AREA - STRAIGHT_LEAST);
    return fmaxf(EDGE * sqrtf(d->squares), fmaxf(STRAIGHT * alike * alike, least) * d->sum);
}

struct turner_estimate turner_estimate_pixel(const struct turner_cells *cells,
                                             const struct turner_patch *patch,
                                             const struct turner_scale *scale)
{
    const struct turner_lattice *lattice = cells->lattice;
    const struct turner_surroundings *around = &patch->around;
    struct turner_estimate e = {0};
    struct disorder disorder = {0};
    float sum[3] = {0}, rest = 0, place = 0, value[4];
    for (size_t i = patch->first; i < patch->first + patch->count; i++) {
        struct turner_cell *cell = &cells->cells[i];
        float area = ldexpf(1, -2 * cell->level), bend[3];
        cell->bend = bend_at(lattice, cell, zero, bend);
        float part = area * cell->bend;
        for (int c = 0; c < 3; c++)
            sum[c] += area * bend[c];
        bool smooth = is_smooth(cell, around);
        float hidden = is_even(around) ? 0 : hidden_in(cell->level, around);
        if (smooth) {
            rest += part;
        } else if (part > 0) {
            disorder.sum += part;
            disorder.squares += part * part;
            disorder.area += area;
            disorder.count++;
        }
        cell->measure = fmaxf(part * (smooth ? SMOOTH : EDGE),
                              fmaxf(hidden, look_in(cell->level, around)));
        e.hidden = fmaxf(e.hidden, hidden);
        e.look = fmaxf(e.look, look_in(cell->level, around));
        place += area * slope(lattice, cell) * ldexpf(1, cell->level);
    }
    turner_cells_value(value, cells, patch);
    e.sampling = fmaxf(SMOOTH * largest(sum), error_of_disorder(&disorder)) + REST * rest;
    if (patch->count == 1) /* where one bend vanishes, others around do not */
        e.sampling += SMOOTH * around->change;
    e.sampling *= SAFETY;
    e.cut = value[3] * scale->bound;
    e.rounding = ROUNDING * largest(value) + ROUNDING_PLACE * scale->size * place;
    return e;
}
