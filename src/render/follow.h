/* Tracing the samples of a lattice, each as far as the error asked for needs. */
#ifndef TURNER_RENDER_FOLLOW_H
#define TURNER_RENDER_FOLLOW_H

#include "render/lattice.h"

#define TURNER_ERROR_SAMPLES 4096 /* of a pixel, at most */
#define TURNER_ERROR_RAYS 4096    /* of a sample, after which no more are sent on */

/* Depth and first cutoff of a scene whose settings ask for an error. */
void turner_follow_settings(struct turner_settings *settings, bool branches);

/* The largest radiance of the scene's background and emission. */
float turner_follow_glow(const struct turner_scene *scene);

/* The largest difference in a channel between the ends of its background's gradient, or 0. */
float turner_follow_blend(const struct turner_scene *scene);

/* Traces what is new in the lattice. Where the settings ask for an error, samples whose cut weight
 * times `bound` is a good part of it are traced again with lower cutoffs; `cutoff_least` gets the
 * lowest. */
enum turner_result turner_follow(struct turner_lattice *lattice, struct turner_renderer *renderer,
                                 float bound, double *cutoff_least);

#endif
