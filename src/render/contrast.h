/* The layer `error` of a picture drawn with given settings: what the finished picture tells of the
 * error of its pixels. (A picture drawn to an error asked for has a better one, from its samples.) */
#ifndef TURNER_RENDER_CONTRAST_H
#define TURNER_RENDER_CONTRAST_H

#include "turner.h"

/* How much of a pixel `samples` in the pattern of turner_sample_position can be wrong about when a
 * straight edge goes through it: at least the pattern's discrepancy over half planes. */
double turner_edge_share(int samples);

/* Estimates each pixel, in the channel where it is worst: contrast with its neighbours × the share
 * above + pruned weight × the picture's largest radiance + rounding. `error` is of image->width ×
 * height. Pixels that are not finite get infinity; they are left out of their neighbours' contrast. */
void turner_contrast_estimate(float *error, const struct turner_image *image, int samples);

#endif
