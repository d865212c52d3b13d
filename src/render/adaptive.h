/* Pictures whose pixels get as many samples as they need. docs/model.md, "Camera". */
#ifndef TURNER_RENDER_ADAPTIVE_H
#define TURNER_RENDER_ADAPTIVE_H

#include "render/renderer.h"

bool turner_adaptive_wanted(const struct turner_settings *settings);

/* As turner_renderer_draw, for settings that want it: the same bytes whatever the tile. */
enum turner_result turner_adaptive_draw(struct turner_renderer *renderer,
                                        struct turner_image *image,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics);

#endif
