/* PNG through libpng, into memory. */
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"

static void append(png_structp png, png_bytep bytes, size_t size)
{
    struct turner_bytes *file = png_get_io_ptr(png);
    turner_bytes_reserve(file, file->size + size);
    memcpy(file->at + file->size, bytes, size);
    file->size += size;
}

static void stay(png_structp png)
{
    (void)png;
}

struct fault {
    char reason[256];
};

static void fail(png_structp png, png_const_charp message)
{
    struct fault *fault = png_get_error_ptr(png);
    snprintf(fault->reason, sizeof fault->reason, "%s", message);
    png_longjmp(png, 1);
}

static void ignore(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

static void describe(png_structp png, png_infop info, const struct turner_format *format,
                     const struct turner_image *image, const struct turner_image_encoding *encoding)
{
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height,
                 format->sample == TURNER_SAMPLE_U16 ? 16 : 8, PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    if (!encoding->linear)
        png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    for (size_t i = 0; i < encoding->text_count; i++) {
        png_text text = {.compression = PNG_TEXT_COMPRESSION_NONE,
                         .key = (char *)encoding->texts[i].key, /* both are only read */
                         .text = (char *)encoding->texts[i].value,
                         .text_length = strlen(encoding->texts[i].value)};
        png_set_text(png, info, &text, 1);
    }
}

/* What libpng jumps back to must not have changed since: everything is made by the caller. */
static bool write_all(png_structp png, png_infop info, const struct turner_format *format,
                      const struct turner_image *image,
                      const struct turner_image_encoding *encoding, const uint8_t *samples)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    describe(png, info, format, image, encoding);
    png_write_info(png, info);
    size_t row = (size_t)image->width * (format->sample == TURNER_SAMPLE_U16 ? 6 : 3);
    if (format->sample == TURNER_SAMPLE_U16)
        png_set_swap(png); /* the file's order is big-endian */
    for (int y = 0; y < image->height; y++)
        png_write_row(png, samples + (size_t)y * row);
    png_write_end(png, info);
    return true;
}

enum turner_result turner_encode_png(struct turner_bytes *bytes, const char *path,
                                     const struct turner_format *format,
                                     const struct turner_image *image,
                                     const struct turner_image_encoding *encoding)
{
    struct fault fault = {"no memory"};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    bool written = false;
    if (info) {
        png_set_write_fn(png, bytes, append, stay);
        png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
        void *samples = turner_format_pack(format, image, encoding);
        written = write_all(png, info, format, image, encoding, samples);
        free(samples);
    }
    png_destroy_write_struct(&png, &info);
    if (!written)
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", path,
                           fault.reason);
    return TURNER_OK;
}
