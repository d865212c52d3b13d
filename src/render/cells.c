#include "render/cells.h"

#include <assert.h>
#include <stdlib.h>

#include "base/memory.h"

#define JITTER 0.5f /* of an edge, about its middle */

void turner_cells_destroy(struct turner_cells *cells)
{
    free(cells->patches);
    free(cells->cells);
    free(cells->next);
    *cells = (struct turner_cells){.lattice = cells->lattice, .jittered = cells->jittered};
}

static uint32_t sample_at(struct turner_lattice *lattice, int32_t x, int32_t y)
{
    float unit = 1.0f / (float)(1u << lattice->shift);
    const float position[2] = {(float)x * unit, (float)y * unit};
    return turner_lattice_at(lattice, x, y, position);
}

void turner_cells_first(struct turner_cell *cell, struct turner_lattice *lattice, int x, int y)
{
    int32_t edge = 1 << lattice->shift, left = x * edge, top = y * edge;
    *cell = (struct turner_cell){
        .center = sample_at(lattice, left + edge / 2, top + edge / 2),
        .corner = {sample_at(lattice, left, top), sample_at(lattice, left + edge, top),
                   sample_at(lattice, left, top + edge),
                   sample_at(lattice, left + edge, top + edge)},
        .area = 1,
        .weight = {0.25f, 0.25f, 0.25f, 0.25f},
    };
}

void turner_cells_begin(struct turner_cells *cells, int x, int y)
{
    struct turner_cell cell;
    turner_cells_first(&cell, cells->lattice, x, y);
    *TURNER_PUSH(cells->patches, cells->patch_count, cells->patch_capacity) =
        (struct turner_patch){.x = x, .y = y, .samples = TURNER_CELL_SAMPLES,
                              .first = cells->cell_count, .count = 1};
    *TURNER_PUSH(cells->cells, cells->cell_count, cells->cell_capacity) = cell;
}

/* From 0 to 1, and the same for whoever divides there. */
static float scatter(int32_t x, int32_t y)
{
    uint64_t mixed = ((uint64_t)(uint32_t)y << 32 | (uint32_t)x) + 0x9e3779b97f4a7c15u;
    mixed = (mixed ^ mixed >> 30) * 0xbf58476d1ce4e5b9u; /* splitmix64, Steele et al. 2014 */
    mixed = (mixed ^ mixed >> 27) * 0x94d049bb133111ebu;
    return (float)((mixed ^ mixed >> 31) >> 40) * 0x1p-24f;
}

/* The sample that divides an edge; `from` is its left or upper end. */
static uint32_t middle(const struct turner_cells *cells, int32_t x, int32_t y, uint32_t from,
                       uint32_t to)
{
    const float *a = cells->lattice->positions[from], *b = cells->lattice->positions[to];
    float share = cells->jittered ? 0.5f + JITTER * (scatter(x, y) - 0.5f) : 0.5f;
    const float position[2] = {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
    return turner_lattice_at(cells->lattice, x, y, position);
}

/* Finds area, centre of gravity (from the first corner) and the weights of the corners, with which
 * what is linear has the centre's value in their mean: the quadrilateral is four triangles about the
 * centre, and a triangle's mean is that of its corners. */
static void measure(struct turner_cell *cell, const struct turner_lattice *lattice,
                    double center[2])
{
    static const int around[4] = {0, 1, 3, 2};
    double p[4][2], area[2], triangle[4], sum = 0;
    const float *origin = lattice->positions[cell->corner[0]];
    for (int i = 0; i < 4; i++) {
        const float *at = lattice->positions[cell->corner[around[i]]];
        p[i][0] = (double)at[0] - (double)origin[0];
        p[i][1] = (double)at[1] - (double)origin[1];
    }
    for (int i = 0; i < 2; i++)
        area[i] = p[i + 1][0] * p[i + 2][1] - p[i + 1][1] * p[i + 2][0];
    assert(area[0] + area[1] > 0);
    for (int k = 0; k < 2; k++)
        center[k] = (area[0] * (p[1][k] + p[2][k]) + area[1] * (p[2][k] + p[3][k])) /
                    (3 * (area[0] + area[1]));
    for (int i = 0; i < 4; i++) {
        const double *a = p[i], *b = p[(i + 1) % 4];
        triangle[i] = (a[0] - center[0]) * (b[1] - center[1]) -
                      (a[1] - center[1]) * (b[0] - center[0]);
        sum += triangle[i];
    }
    cell->area = (float)(0.5 * sum);
    for (int i = 0; i < 4; i++)
        cell->weight[around[i]] = (float)((triangle[i] + triangle[(i + 3) % 4]) / (2 * sum));
}

static void divide(struct turner_cells *cells, const struct turner_patch *patch,
                   const struct turner_cell *cell)
{
    struct turner_lattice *lattice = cells->lattice;
    const uint32_t *corner = cell->corner;
    int32_t edge = 1 << (lattice->shift - cell->level), half = edge / 2, quarter = edge / 4;
    int32_t x = patch->x * (1 << lattice->shift) + cell->x * edge;
    int32_t y = patch->y * (1 << lattice->shift) + cell->y * edge;
    const uint32_t at[3][3] = {
        {corner[0], middle(cells, x + half, y, corner[0], corner[1]), corner[1]},
        {middle(cells, x, y + half, corner[0], corner[2]), cell->center,
         middle(cells, x + edge, y + half, corner[1], corner[3])},
        {corner[2], middle(cells, x + half, y + edge, corner[2], corner[3]), corner[3]},
    };
    struct turner_cell children[4];
    double center[4][2], area = 0;
    for (int i = 0; i < 4; i++) {
        int column = i & 1, row = i >> 1;
        children[i] = (struct turner_cell){
            .corner = {at[row][column], at[row][column + 1], at[row + 1][column],
                       at[row + 1][column + 1]},
            .x = (uint16_t)(2 * cell->x + column),
            .y = (uint16_t)(2 * cell->y + row),
            .level = (uint8_t)(cell->level + 1),
        };
        measure(&children[i], lattice, center[i]);
        area += (double)children[i].area;
    }
    for (int i = 0; i < 4; i++) {
        struct turner_cell *child = &children[i];
        float share = child->area / (float)area; /* positions are rounded */
        const float *origin = lattice->positions[child->corner[0]];
        const float position[2] = {(float)((double)origin[0] + center[i][0]),
                                   (float)((double)origin[1] + center[i][1])};
        child->area = cell->area * share;
        child->older_bends[0] = cell->bend * 4 * share;
        for (int k = 1; k < TURNER_CELL_PAST; k++)
            child->older_bends[k] = cell->older_bends[k - 1] * 4 * share;
        child->center = turner_lattice_at(lattice, x + (i & 1) * half + quarter,
                                          y + (i >> 1) * half + quarter, position);
        *TURNER_PUSH(cells->next, cells->next_count, cells->next_capacity) = *child;
    }
}

void turner_cells_divide(struct turner_cells *cells)
{
    size_t patch_count = 0;
    cells->next_count = 0;
    for (size_t p = 0; p < cells->patch_count; p++) {
        struct turner_patch patch = cells->patches[p];
        size_t first = cells->next_count;
        int splits = 0;
        for (size_t i = patch.first; i < patch.first + patch.count; i++) {
            const struct turner_cell *cell = &cells->cells[i];
            if (cell->split) {
                divide(cells, &patch, cell);
                splits++;
            } else {
                *TURNER_PUSH(cells->next, cells->next_count, cells->next_capacity) = *cell;
            }
        }
        if (splits == 0) {
            cells->next_count = first;
            continue;
        }
        patch.samples += splits * TURNER_CELL_SPLIT;
        patch.first = first;
        patch.count = cells->next_count - first;
        cells->patches[patch_count++] = patch;
    }
    cells->patch_count = patch_count;

    struct turner_cell *old = cells->cells;
    size_t old_capacity = cells->cell_capacity;
    cells->cells = cells->next;
    cells->cell_count = cells->next_count;
    cells->cell_capacity = cells->next_capacity;
    cells->next = old;
    cells->next_capacity = old_capacity;
}

void turner_cells_value(float value[4], const struct turner_cells *cells,
                        const struct turner_patch *patch)
{
    double sum[4] = {0};
    float (*const samples)[4] = cells->lattice->values;
    for (size_t i = patch->first; i < patch->first + patch->count; i++) {
        const struct turner_cell *cell = &cells->cells[i];
        for (int c = 0; c < 4; c++) {
            double corners = 0;
            for (int k = 0; k < 4; k++)
                corners += (double)cell->weight[k] * (double)samples[cell->corner[k]][c];
            sum[c] += (double)cell->area * 0.5 * ((double)samples[cell->center][c] + corners);
        }
    }
    for (int c = 0; c < 4; c++)
        value[c] = (float)sum[c];
}
