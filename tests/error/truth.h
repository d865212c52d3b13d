/* What pixels truly are: their means over the area, by the reference tracer. A pixel is 16×16
 * squares, each by Simpson's weights (2/3 centre, 1/12 each corner); they are divided into four
 * until bend (the mean of its corners less its centre) × area is less than `tolerance`, never quite
 * in the middle: errors along an edge are then independent. That is done with TRUTH_CUTOFF; what
 * fainter rays bring is added from one cutoff to the next, each step by as few samples as do
 * (multilevel Monte Carlo: Giles, Operations Research 56, 2008). */
#ifndef TURNER_TESTS_ERROR_TRUTH_H
#define TURNER_TESTS_ERROR_TRUTH_H

#include "scene/scene.h"
#include "turner.h"

struct truth {
    int width, height; /* of `radiance` */
    int every;         /* pixels from one to the next, the first in the middle of that many */
    double (*radiance)[3];
    double cut;     /* mean weight that was cut */
    double samples; /* mean of a pixel, those for faint rays not among them */
};

#define TRUTH_DEPTH 64
#define TRUTH_CUTOFF 3e-5

/* Of the picture in the size of the scene's settings, of one pixel in `every` across and down.
 * Reads `cache` (.exr) if there is such a file, else computes and writes it (NULL: neither), and says
 * so. */
enum turner_result truth_create(struct truth *truth, const struct turner_scene *scene, int every,
                                double tolerance, const char *cache);
void truth_destroy(struct truth *truth);

#endif
