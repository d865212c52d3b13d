/* Layers of a picture (turner_layers in turner.h): names, memory, and the channels of a file. */
#ifndef TURNER_RENDER_LAYERS_H
#define TURNER_RENDER_LAYERS_H

#include "image/image.h"
#include "scene/scene.h"

/* Channels of all layers together. */
#define TURNER_LAYER_CHANNELS 17

/* Layers that the ray through the pixel's centre decides. */
#define TURNER_LAYERS_OF_CENTER                                                                    \
    (1u << TURNER_LAYER_DEPTH | 1u << TURNER_LAYER_NORMAL | 1u << TURNER_LAYER_ALBEDO |            \
     1u << TURNER_LAYER_POSITION | 1u << TURNER_LAYER_ID)

/* Layers that every ray of the pixel adds to. */
#define TURNER_LAYERS_OF_RAYS (1u << TURNER_LAYER_RAYS | 1u << TURNER_LAYER_RECURSION)

static inline bool turner_layers_want(const struct turner_layers *layers, uint32_t mask)
{
    return layers && (layers->wanted & mask);
}

/* "normal" */
const char *turner_layer_name(enum turner_layer layer);

/* Adds the layers of a comma-separated list of names, or "all", to `*wanted`. TURNER_USAGE naming
 * the word that is none, and the nearest that is one. */
enum turner_result turner_layers_parse(uint32_t *wanted, const char *list);

/* Planes of zeros for what is wanted, `samples` filled with the settings' spp. TURNER_DEVICE when
 * they and the picture do not fit into memory, TURNER_BAD_INPUT when ids are wanted and 32 bits do
 * not suffice. After a failure there are none. */
enum turner_result turner_layers_create(struct turner_layers *layers,
                                        const struct turner_scene *scene);

/* Fills what the picture itself says: pruned and nonfinite. */
void turner_layers_inspect(struct turner_layers *layers, const struct turner_image *image);

/* The channels as files name them, "normal.X"; returns their count. They point into `layers`. */
size_t turner_layers_channels(struct turner_image_channel channels[TURNER_LAYER_CHANNELS],
                              const struct turner_layers *layers);

#endif
