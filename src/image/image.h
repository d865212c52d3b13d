/* Linear float pictures: files, encoding, comparison. */
#ifndef TURNER_IMAGE_IMAGE_H
#define TURNER_IMAGE_IMAGE_H

#include "base/result.h"
#include "turner.h"

/* A metadata entry written into the file (UTF-8; a key is at most 79 bytes). */
struct turner_image_text {
    const char *key, *value;
};

/* A channel beside RGB, of as many pixels as the picture: pixel i has values[i * stride], floats
 * or, when `whole`, uint32_t. */
struct turner_image_channel {
    char name[32]; /* "layer.channel" */
    const void *values;
    size_t stride;
    bool whole;
};

struct turner_image_encoding {
    double exposure; /* stops; 8/16-bit formats only */
    bool linear;     /* 8/16-bit formats: no sRGB curve */
    const struct turner_image_text *texts;
    size_t text_count;
    const struct turner_image_channel *channels; /* EXR only */
    size_t channel_count;
};

/* Writes RGB; the ending (in either case) says the format: .exr .tif .tiff (float, linear), .hdr
 * (shared exponent, linear), .png .jpg .jpeg .ppm (8 bit), .16.png (16 bit). Written aside as
 * "<name>.<pid>.part" in the same folder, then renamed: the file appears whole or not at all. A
 * symbolic link is followed. No date or other varying text is written: same picture, same bytes.
 * Texts go into EXR (attributes), PNG (text chunks) and TIFF (lines "key: value" of the
 * ImageDescription); the other formats have no place for them.
 * Non-finite values are written as they are to EXR and TIFF and as 0 to the others.
 * TURNER_OUTPUT with the reason and what to do, TURNER_USAGE for an unknown ending, or for channels
 * in another format than EXR. */
enum turner_result turner_image_write(const struct turner_image *image, const char *path,
                                      const struct turner_image_encoding *encoding);

/* Whether the ending of `path` says a format that has room for channels beside RGB; TURNER_USAGE
 * when not. */
enum turner_result turner_image_check_channels(const char *path);

/* Bits a channel that the format of `path` holds: 8, 16, or 32 for floats; 0 for an unknown one. */
int turner_image_bits(const char *path);

/* Fails as turner_image_write would, before any work is done: unknown ending, folder missing or
 * not writable, path is a folder or another thing that is no ordinary file. Tries it out by making
 * and removing the file aside. */
enum turner_result turner_image_check_writable(const char *path);

/* Reads any format OpenImageIO knows (the first picture of a file that has several). Pictures of
 * integers (8/16-bit) are decoded from sRGB to linear when `srgb` is true, else their values are
 * taken as they are, scaled to [0,1]; floats are always taken as they are. Grey is spread to RGB;
 * alpha is dropped, without multiplying by it (the fourth float is 0). TURNER_BAD_INPUT with the
 * reason, TURNER_DEVICE when it does not fit into memory or OpenImageIO is not there. Free with
 * turner_image_destroy, also after a failure. */
enum turner_result turner_image_read(struct turner_image *image, const char *path, bool srgb);

/* Removes the file aside of a write that is under way, in whatever thread; async-signal-safe, to
 * be called by a signal handler that then ends the process. */
void turner_image_abandon(void);

/* What turner_image_compare finds. Sums, means and `largest` are over the channels that are finite
 * in both pictures (all 0 when none is); the others are counted. */
struct turner_comparison {
    double rmse;          /* root mean square over pixels and channels of a − b */
    double relative_mse;  /* mean of (a−b)²/(b² + .01), b is the reference */
    double largest;       /* largest |a − b| of a channel */
    int largest_x, largest_y; /* the first pixel that has it, −1 when nothing differs */
    uint64_t pixels_over; /* pixels with a channel off by more than both thresholds */
    uint64_t pixels;
    uint64_t nonfinite_a, nonfinite_b; /* pixels with a NaN or an infinity */
    int nonfinite_x, nonfinite_y; /* first one in either, −1 when none */
};

/* A pixel counts as over when |a−b| > absolute and |a−b| > relative·|b| in a channel, or when
 * either is not finite (the fourth channel is not looked at). TURNER_DIFFERS, with `comparison`
 * zeroed, when sizes differ; TURNER_OK otherwise, whatever the differences: the judgement is the
 * caller's. */
enum turner_result turner_image_compare(struct turner_comparison *comparison,
                                        const struct turner_image *a, const struct turner_image *b,
                                        double absolute, double relative);

/* |a−b| per pixel (largest channel) as false colour: black 0, red a third of `full`, yellow two
 * thirds, white `full` and above; non-finite pixels magenta. The values are meant for the screen as
 * they are: write them with `linear`. Same size as a; TURNER_DIFFERS when b has another. */
enum turner_result turner_image_heatmap(struct turner_image *heatmap, const struct turner_image *a,
                                        const struct turner_image *b, double full);

/* The curve of IEC 61966-2-1, odd outside [0,1] too (f(−v) = −f(v)); NaN stays NaN. */
double turner_srgb_to_linear(double v);
double turner_linear_to_srgb(double v);

#endif
