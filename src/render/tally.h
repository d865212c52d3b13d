/* What the samples of an adaptive pixel took, for the layers rays and recursion. */
#ifndef TURNER_RENDER_TALLY_H
#define TURNER_RENDER_TALLY_H

#include "render/cells.h"

/* Of the samples of a finished patch, each once though several of its squares share it; the lattice
 * has counted. What neighbours added on the border later is theirs. */
struct turner_gpu_pixel_counts turner_tally_patch(const struct turner_cells *cells,
                                                  const struct turner_patch *patch);

/* Adds what `more` took. */
void turner_tally_add(struct turner_gpu_pixel_counts *sum, struct turner_gpu_pixel_counts more);

#endif
