#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/image.h"
#include "scene/readers.h"

enum turner_result turner_scene_texture(uint32_t *image, struct turner_scene *scene,
                                        const char *path)
{
    for (size_t i = 0; i < scene->texture_image_count; i++) {
        if (strcmp(scene->texture_images[i].path, path) == 0) {
            *image = (uint32_t)i;
            return TURNER_OK;
        }
    }
    struct turner_image picture;
    TURNER_TRY(turner_image_read(&picture, path, true));
    size_t pixels = (size_t)picture.width * (size_t)picture.height;
    /* the fourth float is of no use: close the gaps in place, then give the rest back */
    for (size_t i = 0; i < pixels; i++)
        memmove(&picture.rgba[3 * i], &picture.rgba[4 * i], 3 * sizeof *picture.rgba);
    struct turner_texture_image texture = {turner_strdup(path), picture.width, picture.height,
                                           turner_realloc(picture.rgba, pixels,
                                                          3 * sizeof *picture.rgba)};
    *image = (uint32_t)scene->texture_image_count;
    *TURNER_PUSH(scene->texture_images, scene->texture_image_count,
                 scene->texture_image_capacity) = texture;
    return TURNER_OK;
}
