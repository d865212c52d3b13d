#include "render/cells.h"

#include <stdlib.h>

#include "base/memory.h"

void turner_cells_destroy(struct turner_cells *cells)
{
    free(cells->patches);
    free(cells->cells);
    free(cells->next);
    *cells = (struct turner_cells){.lattice = cells->lattice};
}

static uint32_t corner(struct turner_lattice *lattice, int x, int y)
{
    return turner_lattice_at(lattice, x * (1 << lattice->shift), y * (1 << lattice->shift));
}

void turner_cells_first(struct turner_cell *cell, struct turner_lattice *lattice, int x, int y)
{
    int32_t edge = 1 << lattice->shift;
    *cell = (struct turner_cell){
        .center = turner_lattice_at(lattice, x * edge + edge / 2, y * edge + edge / 2),
        .corner = {corner(lattice, x, y), corner(lattice, x + 1, y), corner(lattice, x, y + 1),
                   corner(lattice, x + 1, y + 1)},
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

static void divide(struct turner_cells *cells, const struct turner_patch *patch,
                   const struct turner_cell *cell)
{
    struct turner_lattice *lattice = cells->lattice;
    int32_t edge = 1 << (lattice->shift - cell->level), half = edge / 2, quarter = edge / 4;
    int32_t x = patch->x * (1 << lattice->shift) + cell->x * edge;
    int32_t y = patch->y * (1 << lattice->shift) + cell->y * edge;
    const uint32_t at[3][3] = {
        {cell->corner[0], turner_lattice_at(lattice, x + half, y), cell->corner[1]},
        {turner_lattice_at(lattice, x, y + half), cell->center,
         turner_lattice_at(lattice, x + edge, y + half)},
        {cell->corner[2], turner_lattice_at(lattice, x + half, y + edge), cell->corner[3]},
    };
    for (int i = 0; i < 4; i++) {
        int column = i & 1, row = i >> 1;
        struct turner_cell child = {
            .center = turner_lattice_at(lattice, x + column * half + quarter,
                                        y + row * half + quarter),
            .corner = {at[row][column], at[row][column + 1], at[row + 1][column],
                       at[row + 1][column + 1]},
            .x = (uint16_t)(2 * cell->x + column),
            .y = (uint16_t)(2 * cell->y + row),
            .level = (uint8_t)(cell->level + 1),
            .parent_bend = cell->bend,
        };
        *TURNER_PUSH(cells->next, cells->next_count, cells->next_capacity) = child;
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
        double area = ldexp(1, -2 * cell->level);
        for (int c = 0; c < 4; c++) {
            double corners = (double)samples[cell->corner[0]][c] +
                             (double)samples[cell->corner[1]][c] +
                             (double)samples[cell->corner[2]][c] +
                             (double)samples[cell->corner[3]][c];
            sum[c] += area * (0.5 * (double)samples[cell->center][c] + 0.125 * corners);
        }
    }
    for (int c = 0; c < 4; c++)
        value[c] = (float)sum[c];
}
