/* Linear float pictures: files (through OpenImageIO), encoding, comparison. */
#ifndef TURNER_IMAGE_IMAGE_H
#define TURNER_IMAGE_IMAGE_H

#include "base/result.h"
#include "turner.h"

/* A metadata entry written into the file (EXR and TIFF attribute, PNG text chunk). */
struct turner_image_text {
    const char *key, *value;
};

struct turner_image_encoding {
    double exposure; /* stops; 8/16-bit formats only */
    bool linear;     /* 8/16-bit formats: no sRGB curve */
    const struct turner_image_text *texts;
    size_t text_count;
};

/* Writes RGB; the ending says the format: .exr .hdr .pfm .tif (float, linear), .png (8 bit),
 * .png with `:16` asked for by ending .16.png (16 bit), .jpg, .ppm. Written aside as
 * "<name>.<pid>.part" in the same folder, then renamed: the file appears whole or not at all.
 * No date or other varying text is written. TURNER_OUTPUT with the reason and what to do,
 * TURNER_USAGE for an unknown ending. Non-finite values are written as they are to float formats
 * and as 0 to the others. */
enum turner_result turner_image_write(const struct turner_image *image, const char *path,
                                      const struct turner_image_encoding *encoding);

/* Fails as turner_image_write would, before any work is done: unknown ending, folder missing or
 * not writable, path is a folder. */
enum turner_result turner_image_check_writable(const char *path);

/* Reads any format OpenImageIO knows. 8/16-bit pictures are decoded from sRGB to linear when
 * `srgb` is true, else values are taken as they are, scaled to [0,1]. Grey is spread to RGB;
 * alpha is dropped (the fourth float is 0). TURNER_BAD_INPUT with the reason. */
enum turner_result turner_image_read(struct turner_image *image, const char *path, bool srgb);

/* Removes what an interrupted write left behind; async-signal-safe. */
void turner_image_abandon(void);

struct turner_comparison {
    double rmse;          /* root mean square over pixels and channels of a − b */
    double relative_mse;  /* mean of (a−b)²/(b² + .01), b is the reference */
    double largest;       /* largest |a − b| of a channel */
    int largest_x, largest_y;
    uint64_t pixels_over; /* pixels with a channel off by more than both thresholds */
    uint64_t pixels;
    uint64_t nonfinite_a, nonfinite_b;
    int nonfinite_x, nonfinite_y; /* first one in either, −1 when none */
};

/* A pixel counts as over when |a−b| > absolute and |a−b| > relative·|b| in a channel, or when
 * either is not finite. TURNER_DIFFERS when sizes differ. */
enum turner_result turner_image_compare(struct turner_comparison *comparison,
                                        const struct turner_image *a, const struct turner_image *b,
                                        double absolute, double relative);

/* |a−b| per pixel (largest channel) as false colour, black 0 to white `full`; non-finite pixels
 * magenta. Same size as a. */
enum turner_result turner_image_heatmap(struct turner_image *heatmap, const struct turner_image *a,
                                        const struct turner_image *b, double full);

double turner_srgb_to_linear(double v);
double turner_linear_to_srgb(double v);

#endif
