/* What the pixels around one tell of it, that its own samples may have missed. docs/error.md */
#ifndef TURNER_RENDER_SURROUNDINGS_H
#define TURNER_RENDER_SURROUNDINGS_H

#include "render/cells.h"

struct turner_tile { /* in pixels */
    int x, y, width, height;
};

bool turner_tile_has(const struct turner_tile *tile, int x, int y);

/* For each patch of the tile, from the first cells of the 5×5 pixels around it: crowd, and methods
 * where the renderer knows more accurate ones. Those cells' samples are traced. */
enum turner_result turner_surroundings_first(struct turner_cells *cells,
                                             const struct turner_tile *tile,
                                             struct turner_renderer *renderer, float bound);

/* For each patch of the tile, from the 3×3 pixels around it: hidden. All pixels of the tile and
 * those around it are patches of 16 cells. */
void turner_surroundings_fine(struct turner_cells *cells, const struct turner_tile *tile);

#endif
