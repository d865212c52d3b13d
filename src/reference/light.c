#include "reference/light.h"

/* The share of a spot's intensity at an angle of that cosine from its axis. */
static turner_real spot_share(const struct turner_light *light, turner_real cosine)
{
    turner_real inner = light->cos_inner, outer = light->cos_outer;
    if (inner == outer)
        return cosine >= outer ? 1 : 0;
    turner_real s = clamp((cosine - outer) / (inner - outer), 0, 1);
    return s * s * (3 - 2 * s);
}

struct turner_illumination turner_light_arrive(const struct turner_light *light, turner_vector x)
{
    turner_vector power = widen(light->power);
    if (light->kind == TURNER_LIGHT_DIRECTIONAL) {
        return (struct turner_illumination){.direction = normalize(negate(widen(light->direction))),
                                            .distance = INFINITY,
                                            .irradiance = power};
    }
    turner_vector to_light = sub(widen(light->position), x);
    turner_real distance = length(to_light);
    if (distance == 0)
        return (struct turner_illumination){0};
    struct turner_illumination arriving = {.direction = scale(to_light, 1 / distance),
                                           .distance = distance,
                                           .irradiance = power};
    if (light->falloff == TURNER_FALLOFF_INVERSE_SQUARE)
        arriving.irradiance = scale(power, 1 / (distance * distance));
    if (light->kind == TURNER_LIGHT_SPOT) {
        turner_real cosine =
            -dot(normalize(widen(light->direction)), arriving.direction);
        arriving.irradiance = scale(arriving.irradiance, spot_share(light, cosine));
    }
    return arriving;
}

turner_vector turner_phong(const struct turner_material *material, enum turner_shading shading,
                           turner_vector color, turner_vector n, turner_vector v, turner_vector l)
{
    turner_vector k_d = mul(widen(material->k_d), color), k_s = widen(material->k_s);
    turner_real cosine = dot(n, l), exponent = material->exponent;
    turner_vector r = sub(scale(n, 2 * cosine), l); /* the mirror direction of L */
    turner_real rv = dot(r, v);
    turner_real highlight = rv > 0 ? powl(clamp(rv, 0, 1), exponent) : 0;

    if (shading == TURNER_SHADING_PHONG)
        return add(scale(k_d, cosine), scale(k_s, highlight));
    turner_real lobe = (exponent + 2) / (2 * TURNER_REAL_PI) * highlight;
    return scale(add(scale(k_d, 1 / TURNER_REAL_PI), scale(k_s, lobe)), cosine);
}
