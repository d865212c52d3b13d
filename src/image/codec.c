#include "image/codec.h"

#include <stdlib.h>

#include "base/memory.h"
#include "image/oiio.h"

static void take(void *user, const void *bytes, size_t size)
{
    turner_atomic_put(user, bytes, size, 0);
}

static enum turner_result encode(struct turner_atomic *file, const struct turner_format *format,
                                 const struct turner_image *image,
                                 const struct turner_image_encoding *encoding)
{
    const struct turner_oiio *oiio = turner_oiio_load();
    if (!oiio)
        return turner_fail_within(TURNER_DEVICE, "cannot write %s", file->path);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    void *samples = turner_calloc(pixels, turner_format_pixel(format));
    struct turner_packer packer;
    turner_packer_create(&packer, format, image, encoding);
    turner_packer_rows(samples, &packer, 0, image->height);
    const struct turner_oiio_picture picture = {
        .codec = format->codec,
        .width = image->width,
        .height = image->height,
        .sample = format->sample,
        .samples = samples,
        .srgb = format->sample != TURNER_SAMPLE_FLOAT && !encoding->linear,
        .texts = encoding->texts,
        .text_count = encoding->text_count,
    };
    char reason[TURNER_OIIO_REASON];
    enum turner_oiio_result result = oiio->encode(&picture, take, file, reason);
    free(samples);
    if (result != TURNER_OIIO_OK)
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", file->path,
                           reason);
    return TURNER_OK;
}

enum turner_result turner_codec_write(const char *path, const struct turner_format *format,
                                      const struct turner_image *image,
                                      const struct turner_image_encoding *encoding)
{
    struct turner_atomic file;
    TURNER_TRY(turner_atomic_begin(&file, path));
    return turner_atomic_end(
        &file, (format->encode ? format->encode : encode)(&file, format, image, encoding));
}

static float *begin(void *user, int width, int height)
{
    struct turner_image *image = user;
    return turner_image_create(image, width, height) == TURNER_OK ? image->rgba : NULL;
}

enum turner_result turner_codec_read(struct turner_image *image, const char *path, int *channels,
                                     int *steps)
{
    *image = (struct turner_image){0};
    const struct turner_oiio *oiio = turner_oiio_load();
    if (!oiio)
        return turner_fail_within(TURNER_DEVICE, "cannot read picture %s", path);
    char reason[TURNER_OIIO_REASON];
    switch (oiio->decode(path, begin, image, channels, steps, reason)) {
    case TURNER_OIIO_OK: return TURNER_OK;
    case TURNER_OIIO_REFUSED:
        return turner_fail_within(TURNER_DEVICE, "cannot read picture %s", path);
    default: return turner_fail(TURNER_BAD_INPUT, "cannot read picture %s: %s", path, reason);
    }
}
