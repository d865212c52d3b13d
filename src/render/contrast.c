#include "render/contrast.h"

#include <math.h>

#define EDGE_SHARE 0.82f /* × samples^(−1/2); the worst pattern of few samples is 5's, with 0.811 */
#define ROUNDING 1e-5f   /* of the radiance */

double turner_edge_share(int samples)
{
    return fmin(0.5, (double)EDGE_SHARE / sqrt(samples));
}

static bool is_finite(const float *p)
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]) && isfinite(p[3]);
}

/* The largest difference in a channel between pixels of the 3×3 about (x, y). */
static float contrast(const struct turner_image *image, int x, int y)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int row = y > 0 ? y - 1 : 0; row <= y + 1 && row < image->height; row++) {
        for (int column = x > 0 ? x - 1 : 0; column <= x + 1 && column < image->width; column++) {
            const float *p =
                image->rgba + 4 * ((size_t)row * (size_t)image->width + (size_t)column);
            for (int c = 0; c < 3 && is_finite(p); c++) {
                low[c] = fminf(low[c], p[c]);
                high[c] = fmaxf(high[c], p[c]);
            }
        }
    }
    return fmaxf(fmaxf(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

static float brightest(const float *p)
{
    return fmaxf(p[0], fmaxf(p[1], p[2]));
}

void turner_contrast_estimate(float *error, const struct turner_image *image, int samples)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    float largest = 0, share = (float)turner_edge_share(samples);
    for (size_t i = 0; i < pixels; i++) {
        if (is_finite(image->rgba + 4 * i))
            largest = fmaxf(largest, brightest(image->rgba + 4 * i));
    }
    for (size_t i = 0; i < pixels; i++) {
        const float *p = image->rgba + 4 * i;
        int x = (int)(i % (size_t)image->width), y = (int)(i / (size_t)image->width);
        error[i] = is_finite(p) ? share * contrast(image, x, y) + p[3] * largest +
                                      ROUNDING * brightest(p)
                                : INFINITY;
    }
}
