/* The layers that the ray through a pixel's centre decides, by a kernel of their own. */
#ifndef TURNER_RENDER_FEATURES_H
#define TURNER_RENDER_FEATURES_H

#include "render/renderer.h"

/* Fills those of TURNER_LAYERS_OF_CENTER that `layers` holds planes for. `kernel` is the one that
 * `renderer` was made of, `scene` what it shows. Adds to the times of `statistics`, not to the
 * counts. TURNER_BAD_INPUT for a broken shader, TURNER_INTERRUPTED when options->progress says so. */
enum turner_result turner_features_draw(struct turner_layers *layers,
                                        struct turner_renderer *renderer,
                                        const struct turner_kernel *kernel,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics);

#endif
