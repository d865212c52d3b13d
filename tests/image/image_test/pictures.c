/* Writes the pictures run.cmake compares into the folder argv[1]. */
#include <math.h>
#include <stdio.h>

#include "image/image.h"

static bool write_picture(const char *folder, const char *name, int width, float value)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    struct turner_image image;
    bool done = turner_image_create(&image, width, 1) == TURNER_OK;
    for (int i = 0; done && i < width * 4; i++)
        image.rgba[i] = value;
    done = done && turner_image_write(&image, path, &(struct turner_image_encoding){0}) == TURNER_OK;
    turner_image_destroy(&image);
    return done;
}

int main(int argc, char **argv)
{
    const char *folder = argc == 2 ? argv[1] : ".";
    return write_picture(folder, "white.exr", 1, 1) && write_picture(folder, "grey.exr", 1, .5f) &&
                   write_picture(folder, "nan.exr", 1, NAN) &&
                   write_picture(folder, "wide.exr", 2, 1) &&
                   write_picture(folder, "white.png", 1, 1) &&
                   write_picture(folder, "white.16.png", 1, 1)
               ? 0
               : 1;
}
