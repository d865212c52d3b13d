/* Pixels divided into four cells, and those again where it pays: the samples of a cell are its corners
 * and its centre. Whitted, An Improved Illumination Model, CACM 23 (1980), section 5, has squares.
 * Jittered cells are quadrilaterals: an edge is divided not in its middle but near it, nobody knows
 * where. Edges of what is seen then meet no two cells in the same way, and errors are independent. */
#ifndef TURNER_RENDER_CELLS_H
#define TURNER_RENDER_CELLS_H

#include "render/lattice.h"

#define TURNER_CELL_SAMPLES 5 /* of one cell */
#define TURNER_CELL_PAST 3 /* levels that a cell remembers */
#define TURNER_CELL_SPLIT 8   /* that a division counts: four edges' middles, four centres */

struct turner_cell {
    uint32_t corner[4]; /* samples: top left, top right, bottom left, bottom right */
    uint32_t center;    /* of gravity */
    float area;         /* in pixels */
    float weight[4];    /* of the corners; their sum is 1, their mean the centre */
    uint16_t x, y;      /* from the pixel's top left, as if it were a square of 2^−level pixels, in
                           its edge lengths */
    uint8_t level;
    bool split;         /* to be divided next */
    float measure;      /* for whoever decides */
    float bend;         /* how far the mean of the corners is from the centre (estimate.c) */
    float older_bends[TURNER_CELL_PAST]; /* of the cell that it was part of, of what that was part
                                            of …, for the same area; 0 where there was none */
};

/* What the pixels around tell of one (surroundings.h). Bends. */
struct turner_surroundings {
    float crowd;   /* of a pixel, that at least a few of the 5×5 pixels around it have */
    float hidden;  /* of a cell of a quarter pixel, that may be there though none has it */
    float methods; /* no bend: what approximate methods change in a sample, at most */
};

/* A pixel that is not finished. */
struct turner_patch {
    int x, y;
    int samples;         /* so far; those shared with neighbouring cells count twice */
    size_t first, count; /* its cells */
    struct turner_surroundings around; /* where an error is asked for */
};

/* Patches and their cells; cells of one patch lie together, in the order of their divisions. */
struct turner_cells {
    struct turner_lattice *lattice; /* not owned */
    bool jittered;
    struct turner_patch *patches;
    struct turner_cell *cells, *next;
    size_t patch_count, patch_capacity, cell_count, cell_capacity, next_count, next_capacity;
};

void turner_cells_destroy(struct turner_cells *cells);

/* Begins a pixel as one square; its samples are in the lattice then, not yet traced. */
void turner_cells_begin(struct turner_cells *cells, int x, int y);

/* A pixel as one square, in no patch: its samples are in the lattice then. */
void turner_cells_first(struct turner_cell *cell, struct turner_lattice *lattice, int x, int y);

/* Divides every cell with `split`; patches without one are finished and left out. */
void turner_cells_divide(struct turner_cells *cells);

/* The picture's value there: over the pixel, of the means of each cell's centre and the weighted mean
 * of its corners. */
void turner_cells_value(float value[4], const struct turner_cells *cells,
                        const struct turner_patch *patch);

#endif
