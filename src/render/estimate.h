/* How wrong a pixel may be: what its samples, those around it and the weights that were cut tell of
 * it. docs/error.md derives each term and shows how well they hold. */
#ifndef TURNER_RENDER_ESTIMATE_H
#define TURNER_RENDER_ESTIMATE_H

#include "render/cells.h"

/* Radiance, in the channel where it is most. */
struct turner_estimate {
    float sampling; /* what the cells are wrong by */
    float edges;    /* of that, what edges and disorder are: what is linear or has a kink is not */
    float hidden;   /* what no sample saw, going by what is around */
    float look;     /* not part of it: where this is much, more samples are worth their while */
    float cut;      /* rays that were not followed */
    float methods;  /* approximations that were chosen (turner_methods_approximate) */
    float rounding;
};

/* What more samples help against: `sampling` and `hidden`, of which rarely both are there. */
float turner_estimate_of_samples(const struct turner_estimate *estimate);

float turner_estimate_total(const struct turner_estimate *estimate);

/* How far the weighted mean of a cell's corners is from its centre, each channel, and the most. */
float turner_estimate_bend(float bend[3], const struct turner_lattice *lattice,
                           const struct turner_cell *cell);

/* From 0 where radiance is smooth in a cell to 1 where bends do not shrink from level to level: an edge
 * or disorder. Its bends are known. */
float turner_estimate_roughness(const struct turner_cell *cell);

/* Of a whole picture. */
struct turner_scale {
    float bound; /* radiance that a ray of weight 1 may bring */
    float size;  /* larger edge in pixels */
    float blend; /* largest difference between the ends of a gradient that it may show */
};

/* Sets the measure of each cell of the patch to its share and estimates the pixel. */
struct turner_estimate turner_estimate_pixel(const struct turner_cells *cells,
                                             const struct turner_patch *patch,
                                             const struct turner_scale *scale);

/* What a pixel tells those beside it to count with at least: an edge that it has may go on there,
 * unmet, and so may what approximations do. Less of edges where it was not `divided` for them. */
float turner_estimate_shared(const struct turner_estimate *estimate, bool divided);

/* Estimates of all pixels of a picture (width × height) are raised to what at least two beside each
 * share (turner_estimate_shared): a pixel seldom has so much less to it. */
void turner_estimate_pool(float *pooled, const float *errors, const float *shared, int width,
                          int height);

#endif
