#include <stdlib.h>

#include "app/app.h"
#include "image/image.h"
#include "render/layers.h"
#include "scene/scene.h"

enum turner_result turner_picture_write(const char *path, const struct turner_scene *scene,
                                        const struct turner_image *image,
                                        const struct turner_statistics *statistics,
                                        const struct turner_layers *layers)
{
    static const struct turner_layers none;
    char *settings = turner_settings_json(scene);
    struct turner_image_text texts[] = {
        {"turner:version", turner_version()},
        {"turner:device", statistics->device},
        {"turner:traversal", statistics->traversal},
        {"turner:settings", settings},
    };
    struct turner_image_channel channels[TURNER_LAYER_CHANNELS];
    struct turner_image_encoding encoding = {
        .exposure = scene->settings.exposure,
        .linear = scene->settings.transfer == TURNER_TRANSFER_LINEAR,
        .texts = texts,
        .text_count = sizeof texts / sizeof *texts,
        .channels = channels,
        .channel_count = turner_layers_channels(channels, layers ? layers : &none),
    };
    enum turner_result result = turner_image_write(image, path, &encoding);
    free(settings);
    return result;
}
