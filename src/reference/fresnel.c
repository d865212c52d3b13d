#include "reference/fresnel.h"

static turner_real square(turner_real x)
{
    return x * x;
}

static turner_real fifth_power(turner_real x)
{
    return square(square(x)) * x;
}

turner_real turner_cosine2_refracted(turner_real n1, turner_real n2, turner_real c)
{
    turner_real eta = n1 / n2;
    return (1 - eta) * (1 + eta) + square(eta * c);
}

turner_real turner_fresnel_exact(turner_real n1, turner_real n2, turner_real c)
{
    c = clamp(c, 0, 1);
    if (n1 == n2) /* no interface; at grazing incidence the formulas below would be 0/0 */
        return 0;
    turner_real cosine2 = turner_cosine2_refracted(n1, n2, c);
    if (cosine2 < 0)
        return 1;
    turner_real ct = sqrtl(cosine2);
    turner_real rs = square((n1 * c - n2 * ct) / (n1 * c + n2 * ct));
    turner_real rp = square((n1 * ct - n2 * c) / (n1 * ct + n2 * c));
    return (rs + rp) / 2;
}

turner_real turner_fresnel_schlick(turner_real n1, turner_real n2, turner_real c)
{
    c = clamp(c, 0, 1);
    turner_real cosine2 = turner_cosine2_refracted(n1, n2, c);
    if (cosine2 < 0)
        return 1;
    turner_real r0 = square((n1 - n2) / (n1 + n2));
    turner_real x = n1 <= n2 ? c : sqrtl(cosine2);
    return r0 + (1 - r0) * fifth_power(1 - x);
}

turner_real turner_fresnel_conductor(turner_real eta, turner_real k, turner_real c)
{
    c = clamp(c, 0, 1);
    turner_real s2 = 1 - square(c);
    turner_real t0 = square(eta) - square(k) - s2;
    turner_real a2b2 = sqrtl(square(t0) + 4 * square(eta) * square(k)); /* a² + b² */
    turner_real a = sqrtl(fmaxl(0, (a2b2 + t0) / 2));
    turner_real rs = (a2b2 + square(c) - 2 * a * c) / (a2b2 + square(c) + 2 * a * c);
    turner_real rp = rs * (square(c) * a2b2 + square(s2) - 2 * a * c * s2) /
                     (square(c) * a2b2 + square(s2) + 2 * a * c * s2);
    return (rs + rp) / 2;
}

static struct turner_secondary opaque_weights(const struct turner_material *material,
                                              turner_real n1, turner_real c)
{
    turner_vector k_r = widen(material->k_r);
    struct turner_secondary weights = {.reflected = k_r};
    if (material->conductor) {
        turner_vector eta = scale(widen(material->eta), 1 / n1);
        turner_vector k = scale(widen(material->k), 1 / n1);
        weights.fresnel = vector(turner_fresnel_conductor(eta.x, k.x, c),
                                 turner_fresnel_conductor(eta.y, k.y, c),
                                 turner_fresnel_conductor(eta.z, k.z, c));
        weights.reflected = mul(k_r, weights.fresnel);
        weights.has_fresnel = true;
    } else if (material->fresnel == TURNER_FRESNEL_SCHLICK) { /* a metal: k_r is R0 */
        weights.reflected = weights.fresnel =
            add(k_r, scale(sub(grey(1), k_r), fifth_power(1 - clamp(c, 0, 1))));
        weights.has_fresnel = true;
    }
    return weights;
}

struct turner_secondary turner_secondary_weights(const struct turner_material *material,
                                                 enum turner_fresnel fresnel, turner_real n1,
                                                 turner_real n2, turner_real c)
{
    turner_vector k_r = widen(material->k_r), k_t = widen(material->k_t);
    if (largest(k_r) == 0 && largest(k_t) == 0)
        return (struct turner_secondary){0};
    if (largest(k_t) == 0)
        return opaque_weights(material, n1, c);

    bool total = turner_cosine2_refracted(n1, n2, c) < 0;
    if (fresnel == TURNER_FRESNEL_NONE) {
        return total ? (struct turner_secondary){.reflected = add(k_r, k_t), .fresnel = grey(1),
                                                 .has_fresnel = true, .total = true}
                     : (struct turner_secondary){.reflected = k_r, .refracted = k_t};
    }
    turner_real f = fresnel == TURNER_FRESNEL_SCHLICK ? turner_fresnel_schlick(n1, n2, c)
                                                      : turner_fresnel_exact(n1, n2, c);
    if (total)
        f = 1;
    return (struct turner_secondary){
        .reflected = scale(k_r, f), .refracted = scale(k_t, 1 - f), .fresnel = grey(f),
        .has_fresnel = true, .total = total};
}
