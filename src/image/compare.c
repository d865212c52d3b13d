/* How much two pictures differ, as numbers and as a picture. No comparison here may pass a NaN:
 * thresholds are met with !(difference <= threshold). */
#include <math.h>

#include "image/image.h"

static bool same_size(const struct turner_image *a, const struct turner_image *b)
{
    if (a->width == b->width && a->height == b->height)
        return true;
    turner_fail(TURNER_DIFFERS, "the sizes differ: %d×%d and %d×%d pixels; pictures of unequal "
                                "size cannot be compared", a->width, a->height, b->width, b->height);
    return false;
}

static bool finite_pixel(const float *p)
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

enum turner_result turner_image_compare(struct turner_comparison *comparison,
                                        const struct turner_image *a, const struct turner_image *b,
                                        double absolute, double relative)
{
    struct turner_comparison *c = comparison;
    *c = (struct turner_comparison){
        .largest_x = -1, .largest_y = -1, .nonfinite_x = -1, .nonfinite_y = -1};
    if (!same_size(a, b)) {
        *c = (struct turner_comparison){0};
        return TURNER_DIFFERS;
    }
    double squares = 0, relative_squares = 0;
    uint64_t channels = 0;
    c->pixels = (uint64_t)a->width * (uint64_t)a->height;
    for (uint64_t i = 0; i < c->pixels; i++) {
        const float *p = a->rgba + i * 4, *q = b->rgba + i * 4;
        int x = (int)(i % (uint64_t)a->width), y = (int)(i / (uint64_t)a->width);
        bool finite_a = finite_pixel(p), finite_b = finite_pixel(q);
        bool over = !finite_a || !finite_b;
        if (over && c->nonfinite_x < 0) {
            c->nonfinite_x = x;
            c->nonfinite_y = y;
        }
        c->nonfinite_a += !finite_a;
        c->nonfinite_b += !finite_b;
        for (int k = 0; k < 3; k++) {
            if (!isfinite(p[k]) || !isfinite(q[k]))
                continue;
            double reference = (double)q[k], d = fabs((double)p[k] - reference);
            squares += d * d;
            relative_squares += d * d / (reference * reference + .01);
            channels++;
            if (d > c->largest) {
                c->largest = d;
                c->largest_x = x;
                c->largest_y = y;
            }
            if (!(d <= absolute) && !(d <= relative * fabs(reference)))
                over = true;
        }
        c->pixels_over += over;
    }
    if (channels) {
        c->rmse = sqrt(squares / (double)channels);
        c->relative_mse = relative_squares / (double)channels;
    }
    return TURNER_OK;
}

/* `t` clamped to [0,1]. */
static float unit(double t)
{
    return t < 0 ? 0.f : t > 1 ? 1.f : (float)t;
}

enum turner_result turner_image_heatmap(struct turner_image *heatmap, const struct turner_image *a,
                                        const struct turner_image *b, double full)
{
    *heatmap = (struct turner_image){0};
    if (!same_size(a, b))
        return TURNER_DIFFERS;
    TURNER_TRY(turner_image_create(heatmap, a->width, a->height));
    size_t pixels = (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = a->rgba + i * 4, *q = b->rgba + i * 4;
        float *colour = heatmap->rgba + i * 4;
        if (!finite_pixel(p) || !finite_pixel(q)) {
            colour[0] = colour[2] = 1;
            continue;
        }
        double largest = 0;
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fabs((double)p[k] - (double)q[k]));
        double t = largest == 0 ? 0 : largest / full; /* full = 0 makes any difference white */
        colour[0] = unit(3 * t);
        colour[1] = unit(3 * t - 1);
        colour[2] = unit(3 * t - 2);
    }
    return TURNER_OK;
}
