/* From linear floats to what a file holds, and back. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "image/codec.h"

/* IEC 61966-2-1:1999, 5.2 and 5.3, with the constants of its amendment 1. */
double turner_srgb_to_linear(double v)
{
    double m = fabs(v);
    return copysign(m <= 0.04045 ? m / 12.92 : pow((m + 0.055) / 1.055, 2.4), v);
}

double turner_linear_to_srgb(double v)
{
    double m = fabs(v);
    return copysign(m <= 0.0031308 ? m * 12.92 : 1.055 * pow(m, 1 / 2.4) - 0.055, v);
}

/* Longer endings first. */
static const struct turner_format formats[] = {
    {".16.png", "png", TURNER_SAMPLE_U16, false, false, turner_encode_png},
    {".png", "png", TURNER_SAMPLE_U8, false, false, turner_encode_png},
    {".exr", "openexr", TURNER_SAMPLE_FLOAT, true, true, turner_encode_exr},
    {".hdr", "hdr", TURNER_SAMPLE_FLOAT, false, false, NULL},
    {".tif", "tiff", TURNER_SAMPLE_FLOAT, true, false, NULL},
    {".tiff", "tiff", TURNER_SAMPLE_FLOAT, true, false, NULL},
    {".jpg", "jpeg", TURNER_SAMPLE_U8, false, false, NULL},
    {".jpeg", "jpeg", TURNER_SAMPLE_U8, false, false, NULL},
    {".ppm", "pnm", TURNER_SAMPLE_U8, false, false, NULL},
};

const struct turner_format *turner_format_find(const char *path)
{
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; i++) {
        size_t ending = strlen(formats[i].ending);
        /* something must stand before the ending: ".png" is a hidden file without one */
        if (length > ending && path[length - ending - 1] != '/' &&
            strcasecmp(path + length - ending, formats[i].ending) == 0)
            return &formats[i];
    }
    turner_fail(TURNER_USAGE,
                "%s: the ending says no picture format that can be written; use .exr .hdr .tif "
                "(linear floats), .png .jpg .ppm (8 bit) or .16.png (16 bit)", path);
    return NULL;
}

static double encode(float radiance, double scale, bool linear)
{
    double v = (double)radiance * scale;
    if (!isfinite(v))
        v = isfinite(radiance) ? (radiance > 0 ? 1 : 0) : 0; /* overflow of the exposure is white */
    v = v < 0 ? 0 : v > 1 ? 1 : v;
    return linear ? v : turner_linear_to_srgb(v);
}

size_t turner_format_pixel(const struct turner_format *format)
{
    static const size_t sizes[] = {1, 2, sizeof(float)}; /* by turner_sample */
    return 3 * sizes[format->sample];
}

static int quantise(float radiance, double scale, bool linear, int most)
{
    return (int)(encode(radiance, scale, linear) * most + .5);
}

/* The least float ≥ 0 that becomes `sample` or more, by halving the floats' bit patterns, which are
 * in their order; infinite when none does. */
static float least_of(int sample, double scale, bool linear)
{
    uint32_t below = 0, bits;
    float least = FLT_MAX, middle;
    if (quantise(least, scale, linear, 255) < sample)
        return INFINITY;
    memcpy(&bits, &least, sizeof bits);
    while (bits - below > 1) {
        uint32_t half = below + (bits - below) / 2;
        memcpy(&middle, &half, sizeof middle);
        if (quantise(middle, scale, linear, 255) < sample)
            below = half;
        else
            bits = half;
    }
    memcpy(&least, &bits, sizeof least);
    return least;
}

void turner_packer_create(struct turner_packer *packer, const struct turner_format *format,
                          const struct turner_image *image,
                          const struct turner_image_encoding *encoding)
{
    *packer = (struct turner_packer){
        .format = format, .image = image, .scale = exp2(encoding->exposure),
        .linear = encoding->linear};
    if (format->sample != TURNER_SAMPLE_U8)
        return;
    for (int i = 1; i < 256; i++)
        packer->least[i] = least_of(i, packer->scale, packer->linear);
    packer->least[256] = INFINITY;
    unsigned sample = 0;
    for (uint32_t i = 0; i < sizeof packer->first; i++) {
        float v;
        memcpy(&v, &(uint32_t){i << 16}, sizeof v);
        while (v >= packer->least[sample + 1])
            sample++;
        packer->first[i] = (uint8_t)sample;
    }
}

/* The same as quantise to 255 in a fraction of the time: looked up by exponent and seven more bits,
 * between which lie two steps at most, but for denormal floats. Whether the first two are taken
 * nobody could foretell, so these are no branches. */
static uint8_t find_sample(const struct turner_packer *packer, float v)
{
    if (!(v > 0 && v <= FLT_MAX)) /* infinite and NaN: as encode does */
        return 0;
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    unsigned sample = packer->first[bits >> 16];
    sample += v >= packer->least[sample + 1];
    sample += v >= packer->least[sample + 1];
    while (v >= packer->least[sample + 1])
        sample++;
    return (uint8_t)sample;
}

struct packing {
    const struct turner_packer *packer;
    uint8_t *samples;
    int first; /* row */
};

static void pack_row(void *user, uint32_t row)
{
    const struct packing *packing = user;
    const struct turner_packer *packer = packing->packer;
    const struct turner_image *image = packer->image;
    size_t pixels = (size_t)image->width, size = pixels * turner_format_pixel(packer->format);
    const float *rgba = image->rgba + ((size_t)packing->first + row) * pixels * 4;
    void *samples = packing->samples + row * size;
    for (size_t i = 0; i < pixels; i++) {
        for (size_t c = 0; c < 3; c++) {
            float v = rgba[i * 4 + c];
            switch (packer->format->sample) {
            case TURNER_SAMPLE_U8:
                ((uint8_t *)samples)[i * 3 + c] = find_sample(packer, v);
                break;
            case TURNER_SAMPLE_U16:
                ((uint16_t *)samples)[i * 3 + c] =
                    (uint16_t)quantise(v, packer->scale, packer->linear, 65535);
                break;
            case TURNER_SAMPLE_FLOAT:
                ((float *)samples)[i * 3 + c] = isfinite(v) || packer->format->nonfinite ? v : 0;
                break;
            }
        }
    }
}

void turner_packer_rows(void *samples, const struct turner_packer *packer, int row, int rows)
{
    struct packing packing = {packer, samples, row};
    if (rows > 1)
        turner_parallel_for((uint32_t)rows, pack_row, &packing);
    else
        pack_row(&packing, 0);
}

enum turner_result turner_image_check_channels(const char *path)
{
    const struct turner_format *format = turner_format_find(path);
    if (!format)
        return TURNER_USAGE;
    return format->channels ? TURNER_OK
                            : turner_fail(TURNER_USAGE,
                                          "%s: layers can only be written to OpenEXR; let the "
                                          "picture's name end in .exr, or ask for no layers", path);
}

enum turner_result turner_image_write(const struct turner_image *image, const char *path,
                                      const struct turner_image_encoding *encoding)
{
    const struct turner_format *format = turner_format_find(path);
    if (!format)
        return TURNER_USAGE;
    if (encoding->channel_count)
        TURNER_TRY(turner_image_check_channels(path));
    return turner_codec_write(path, format, image, encoding);
}

int turner_image_bits(const char *path)
{
    const struct turner_format *format = turner_format_find(path);
    if (!format)
        return 0;
    return format->sample == TURNER_SAMPLE_U8 ? 8 : format->sample == TURNER_SAMPLE_U16 ? 16 : 32;
}

enum turner_result turner_image_check_writable(const char *path)
{
    return turner_format_find(path) ? turner_atomic_check(path) : TURNER_USAGE;
}

/* Takes the sRGB curve off integers. A table is ten times as fast as the curve, and exact: values
 * are multiples of 1/steps. (More than 16 bits are rounded to 16.) */
static void decode(struct turner_image *image, int channels, int steps)
{
    float *table = turner_calloc((size_t)steps + 1, sizeof *table);
    for (int i = 0; i <= steps; i++)
        table[i] = (float)turner_srgb_to_linear((double)i / steps);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        for (int c = 0; c < channels; c++) {
            float *v = image->rgba + i * 4 + c;
            float index = *v * (float)steps + .5f;
            *v = table[index > 0 ? index < (float)steps ? (int)index : steps : 0];
        }
    }
    free(table);
}

enum turner_result turner_image_read(struct turner_image *image, const char *path, bool srgb)
{
    int channels, steps;
    TURNER_TRY(turner_codec_read(image, path, &channels, &steps));
    if (steps && srgb)
        decode(image, channels, steps);
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; channels == 1 && i < pixels; i++)
        image->rgba[i * 4 + 1] = image->rgba[i * 4 + 2] = image->rgba[i * 4];
    return TURNER_OK;
}
