/* What src/image shares between the files that speak to the libraries of picture formats: PNG and
 * OpenEXR are written by their own, everything else and all reading is OpenImageIO's (oiio.h). */
#ifndef TURNER_IMAGE_CODEC_H
#define TURNER_IMAGE_CODEC_H

#include "image/atomic.h"
#include "image/image.h"

enum turner_sample { TURNER_SAMPLE_U8, TURNER_SAMPLE_U16, TURNER_SAMPLE_FLOAT };

/* One format turner writes. */
struct turner_format {
    const char *ending; /* of the file's name, with the dot, lower case */
    const char *codec;  /* OpenImageIO's name of the format */
    enum turner_sample sample;
    bool nonfinite; /* the format can hold NaN and infinity */
    bool channels;  /* it can hold more than RGB, each of a type of its own */
    /* Writes the file. NULL: by OpenImageIO. */
    enum turner_result (*encode)(struct turner_atomic *file, const struct turner_format *format,
                                 const struct turner_image *image,
                                 const struct turner_image_encoding *encoding);
};

enum turner_result turner_encode_png(struct turner_atomic *file, const struct turner_format *format,
                                     const struct turner_image *image,
                                     const struct turner_image_encoding *encoding);
enum turner_result turner_encode_exr(struct turner_atomic *output,
                                     const struct turner_format *format,
                                     const struct turner_image *image,
                                     const struct turner_image_encoding *encoding);

/* The format for the ending of `path`; NULL and TURNER_USAGE's message when there is none. */
const struct turner_format *turner_format_find(const char *path);

/* Bytes of a pixel's three samples. */
size_t turner_format_pixel(const struct turner_format *format);

/* What turns a picture's floats into a format's samples: exposure, curve and rounding for those of
 * integers. */
struct turner_packer {
    const struct turner_format *format;
    const struct turner_image *image;
    double scale;
    bool linear;
    float least[257];      /* 8 bit: the least float that becomes so much; of 256 infinite */
    uint8_t first[0x7f80]; /* what the least of the floats becomes that begin with these 16 bits */
};
void turner_packer_create(struct turner_packer *packer, const struct turner_format *format,
                          const struct turner_image *image,
                          const struct turner_image_encoding *encoding);

/* Rows `row` … `row` + `rows` − 1 into rows × width × 3 samples as turner_format says. */
void turner_packer_rows(void *samples, const struct turner_packer *packer, int row, int rows);

/* Encodes `image` into a file aside; OpenImageIO does so in memory first. */
enum turner_result turner_codec_write(const char *path, const struct turner_format *format,
                                      const struct turner_image *image,
                                      const struct turner_image_encoding *encoding);

/* Creates `image` and reads the first `*channels` ≤ 3 channels into its pixels; the channels beyond
 * are 0. Integers are scaled to [0,1]; `*steps` is 255 for 8 bit, 65535 for more, 0 for floats. */
enum turner_result turner_codec_read(struct turner_image *image, const char *path, int *channels,
                                     int *steps);

#endif
