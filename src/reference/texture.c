#include "reference/texture.h"

static turner_vector texel(const struct turner_texture_image *image, long column, long row)
{
    const float *rgb = image->rgb + 3 * ((size_t)row * (size_t)image->width + (size_t)column);
    return vector((turner_real)rgb[0], (turner_real)rgb[1], (turner_real)rgb[2]);
}

/* x − n·⌊x/n⌋ as a whole number in 0 … n − 1 */
static long repeat(turner_real x, int n)
{
    long i = (long)(x - n * floorl(x / n));
    return i >= n ? 0 : i; /* rounding may end on n */
}

static long limit(turner_real x, int n)
{
    return (long)clamp(x, 0, n - 1);
}

/* Bilinear, texel centres at half-integers; u repeats, v (upwards) repeats or is clamped. */
static turner_vector sample(const struct turner_texture_image *image, turner_real u, turner_real v,
                            bool repeat_v)
{
    turner_real x = u * image->width - 0.5L, y = (1 - v) * image->height - 0.5L;
    turner_real x0 = floorl(x), y0 = floorl(y);
    long columns[2] = {repeat(x0, image->width), repeat(x0 + 1, image->width)};
    long rows[2];
    for (int i = 0; i < 2; i++)
        rows[i] = repeat_v ? repeat(y0 + i, image->height) : limit(y0 + i, image->height);
    turner_vector upper = mix(texel(image, columns[0], rows[0]),
                              texel(image, columns[1], rows[0]), x - x0);
    turner_vector under = mix(texel(image, columns[0], rows[1]),
                              texel(image, columns[1], rows[1]), x - x0);
    return mix(upper, under, y - y0);
}

turner_vector turner_pattern_color(const struct turner_scene *scene,
                                   const struct turner_material *material, turner_real u,
                                   turner_real v)
{
    u *= material->uv_scale[0];
    v *= material->uv_scale[1];
    switch (material->pattern) {
    case TURNER_PATTERN_CHECKER: {
        bool even = fmodl(floorl(u) + floorl(v), 2) == 0;
        return widen(material->checker[even ? 0 : 1]);
    }
    case TURNER_PATTERN_IMAGE:
        return sample(&scene->texture_images[material->image], u, v, true);
    case TURNER_PATTERN_NONE:
        break;
    }
    return grey(1);
}

turner_vector turner_background_radiance(const struct turner_scene *scene, turner_vector d)
{
    const struct turner_background *background = &scene->background;
    switch (background->kind) {
    case TURNER_BACKGROUND_GRADIENT:
        return mix(widen(background->color), widen(background->top),
                   (dot(d, widen(background->up)) + 1) / 2);
    case TURNER_BACKGROUND_ENVIRONMENT: {
        turner_real u =
            0.5L + (atan2l(d.x, -d.z) + background->rotation) / (2 * TURNER_REAL_PI);
        turner_real v = 0.5L + asinl(clamp(d.y, -1, 1)) / TURNER_REAL_PI;
        return mul(widen(background->scale),
                   sample(&scene->texture_images[background->image], u, v, false));
    }
    case TURNER_BACKGROUND_CONSTANT:
        break;
    }
    return widen(background->color);
}
