#include "image/codec.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/atomic.h"
#include "image/oiio.h"

void turner_bytes_reserve(struct turner_bytes *bytes, size_t capacity)
{
    if (capacity <= bytes->capacity)
        return;
    size_t more = bytes->capacity + bytes->capacity / 2;
    bytes->capacity = capacity > more ? capacity : more;
    bytes->at = turner_realloc(bytes->at, bytes->capacity, 1);
}

static void take(void *user, const void *file, size_t size)
{
    struct turner_bytes *bytes = user;
    turner_bytes_reserve(bytes, size);
    memcpy(bytes->at, file, size);
    bytes->size = size;
}

static enum turner_result encode(struct turner_bytes *bytes, const char *path,
                                 const struct turner_format *format,
                                 const struct turner_image *image,
                                 const struct turner_image_encoding *encoding)
{
    const struct turner_oiio *oiio = turner_oiio_load();
    if (!oiio)
        return turner_fail_within(TURNER_DEVICE, "cannot write %s", path);
    void *samples = turner_format_pack(format, image, encoding);
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
    enum turner_oiio_result result = oiio->encode(&picture, take, bytes, reason);
    free(samples);
    if (result != TURNER_OIIO_OK)
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", path, reason);
    return TURNER_OK;
}

enum turner_result turner_codec_write(const char *path, const struct turner_format *format,
                                      const struct turner_image *image,
                                      const struct turner_image_encoding *encoding)
{
    struct turner_bytes bytes = {0};
    enum turner_result result =
        (format->encode ? format->encode : encode)(&bytes, path, format, image, encoding);
    if (result == TURNER_OK)
        result = turner_atomic_write(path, bytes.at, bytes.size);
    free(bytes.at);
    return result;
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
