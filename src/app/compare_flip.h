/* FLIP, the difference an eye sees when it flips between two pictures, by NVIDIA's own program. */
#ifndef TURNER_APP_COMPARE_FLIP_H
#define TURNER_APP_COMPARE_FLIP_H

#include "image/image.h"

/* The mean FLIP error of `a` against `reference` into `*mean`, and into `*kind` which FLIP it is:
 * "LDR" when all values lie in [0,1], else "HDR". Runs python3 with the package flip-evaluator.
 * Pictures of equal size, all values finite. TURNER_BAD_INPUT when python3 or the package is not
 * there or fails.
 * Andersson et al., FLIP: A Difference Evaluator for Alternating Images, 2020; for HDR: Visualizing
 * and Communicating Errors in Rendered Images, 2021. */
enum turner_result turner_compare_flip(const struct turner_image *a,
                                       const struct turner_image *reference, double *mean,
                                       const char **kind);

#endif
