/* A first look at the whole picture, a sample every few pixels: what brightness is about, and where
 * there is much to see. */
#ifndef TURNER_RENDER_OVERVIEW_H
#define TURNER_RENDER_OVERVIEW_H

#include "render/renderer.h"

struct turner_overview {
    int columns, rows;
    float (*values)[4]; /* radiance and pruned weight */
    double *busy;       /* of the samples around each, the share that differ much from their neighbours */
};

/* TURNER_USAGE where rays multiply so, and lose so little, that no error can be asked for. Release
 * with turner_overview_destroy, whatever the result. */
enum turner_result turner_overview_create(struct turner_overview *overview,
                                          struct turner_renderer *renderer);
void turner_overview_destroy(struct turner_overview *overview);

/* What a ray of weight 1 may bring: the scene's glow, or the largest radiance seen. (A ray that is cut
 * may go where the camera does not look.) */
float turner_overview_bound(const struct turner_overview *overview, float glow);

/* Whether half of what is around a pixel, within the picture or not far from it, is busy. */
bool turner_overview_is_busy(const struct turner_overview *overview, int x, int y);

#endif
