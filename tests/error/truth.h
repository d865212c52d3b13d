/* What pixels truly are: their means over the area, by the reference tracer. A pixel is 4×4 squares,
 * each by Simpson's weights (2/3 centre, 1/12 each corner). Where one of them bends (the mean of its
 * corners less its centre) by more than 4 × `tolerance`, all are divided into 16 more, and these
 * until bend × area is less than `tolerance`, never quite in the middle: errors along an edge are
 * then independent. */
#ifndef TURNER_TESTS_ERROR_TRUTH_H
#define TURNER_TESTS_ERROR_TRUTH_H

#include "scene/scene.h"
#include "turner.h"

struct truth {
    int width, height;
    double (*radiance)[3];
    double pruned;  /* mean weight that was cut */
    double samples; /* mean of a pixel */
};

#define TRUTH_DEPTH 64
#define TRUTH_CUTOFF 3e-5

/* At the size of the scene's settings; reads `cache` (.exr) if there is one of that size, else
 * computes and writes it (NULL: neither), and says so. */
enum turner_result truth_create(struct truth *truth, const struct turner_scene *scene,
                                double tolerance, const char *cache);
void truth_destroy(struct truth *truth);

#endif
