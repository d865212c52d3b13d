/* PNG through libpng, row after row, of which many are packed at once. */
#include <png.h>
#include <setjmp.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/codec.h"

/* With these a picture of 512 × 512 is written in half the time of libpng's own choice (level 6, all
 * filters tried on every row), in files 5 to 25 % larger. */
#define LEVEL 1
#define FILTER PNG_FILTER_SUB
#define CHUNK ((size_t)1 << 20) /* bytes of the file written at once, at most */
#define BAND ((size_t)4 << 20)  /* bytes of rows packed at once, at most, but for one row */

struct output {
    struct turner_atomic *file;
    uint64_t size; /* written so far */
};

static void append(png_structp png, png_bytep bytes, size_t size)
{
    struct output *output = png_get_io_ptr(png);
    if (!turner_atomic_put(output->file, bytes, size, output->size))
        png_error(png, "writing failed"); /* turner_atomic_end has the reason */
    output->size += size;
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
                      const struct turner_image_encoding *encoding,
                      const struct turner_packer *packer, uint8_t *band, int rows)
{
    size_t size = (size_t)image->width * turner_format_pixel(format);
    if (setjmp(png_jmpbuf(png)))
        return false;
    describe(png, info, format, image, encoding);
    png_set_compression_level(png, LEVEL);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, FILTER);
    png_set_compression_buffer_size(png, CHUNK);
    png_write_info(png, info);
    if (format->sample == TURNER_SAMPLE_U16)
        png_set_swap(png); /* the file's order is big-endian */
    for (int y = 0; y < image->height; y++) {
        if (y % rows == 0)
            turner_packer_rows(band, packer, y, image->height - y < rows ? image->height - y : rows);
        png_write_row(png, band + (size_t)(y % rows) * size);
    }
    png_write_end(png, info);
    return true;
}

enum turner_result turner_encode_png(struct turner_atomic *file, const struct turner_format *format,
                                     const struct turner_image *image,
                                     const struct turner_image_encoding *encoding)
{
    struct fault fault = {"no memory"};
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &fault, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    struct output output = {.file = file};
    bool written = false;
    if (info) {
        png_set_write_fn(png, &output, append, stay);
        png_set_user_limits(png, 0x7fffffff, 0x7fffffff);
        size_t size = (size_t)image->width * turner_format_pixel(format);
        int rows = size < BAND ? (int)(BAND / size) : 1;
        uint8_t *band = turner_calloc((size_t)(rows < image->height ? rows : image->height), size);
        struct turner_packer packer;
        turner_packer_create(&packer, format, image, encoding);
        written = write_all(png, info, format, image, encoding, &packer, band, rows);
        free(band);
    }
    png_destroy_write_struct(&png, &info);
    if (!written)
        return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; use another ending", file->path,
                           fault.reason);
    return TURNER_OK;
}
