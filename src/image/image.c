#include "image/image.h"

#include <stdlib.h>

#include "base/memory.h"

enum turner_result turner_image_create(struct turner_image *image, int width, int height)
{
    *image = (struct turner_image){0};
    if (width < 1 || height < 1) {
        return turner_fail(TURNER_USAGE, "a picture of %d×%d pixels is not possible; both must be "
                                         "at least 1", width, height);
    }
    size_t pixels = (size_t)width * (size_t)height, bytes = pixels * 4 * sizeof(float);
    /* calloc promises more than there is; the pages are touched later, when nobody can refuse */
    uint64_t available = turner_memory_available();
    if (bytes <= available)
        image->rgba = calloc(pixels, 4 * sizeof(float));
    if (!image->rgba) {
        return turner_fail(TURNER_DEVICE, "a picture of %d×%d pixels takes %.1f MiB, but only "
                                          "%.1f MiB of memory are free; choose a smaller size",
                           width, height, (double)bytes / 1048576, (double)available / 1048576);
    }
    turner_use_large_pages(image->rgba, bytes);
    image->width = width;
    image->height = height;
    return TURNER_OK;
}

void turner_image_destroy(struct turner_image *image)
{
    free(image->rgba);
    *image = (struct turner_image){0};
}
