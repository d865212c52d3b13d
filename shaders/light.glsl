// The lights, and what a surface makes of their light.

struct arrival_t {
    real3 direction; // unit, from the point to the light (L)
    real distance;   // INFINITY for directional lights
    vec3 irradiance; // on a surface that faces the light, before shadows (E)
};

arrival_t light_arrival(turner_gpu_light light, real3 point)
{
    real3 axis = EXACT(real3, light.direction, light.direction_rest);
    arrival_t arrival = arrival_t(-axis, INFINITY, light.power);
    if (!NEEDS_ANY(TURNER_NEEDS_POINT) ||
        (NEEDS_ANY(TURNER_NEEDS_DIRECTIONAL) && light.kind == TURNER_LIGHT_KIND_DIRECTIONAL))
        return arrival;
    real3 to_light = EXACT(real3, light.position, light.position_rest) - point;
    real d = length(to_light);
    if (!(d > 0.0))
        return arrival_t(real3(0.0), 0.0, vec3(0.0));
    arrival.direction = to_light / d;
    arrival.distance = d;
    if (light.inverse_square != 0u)
        arrival.irradiance /= float(d * d);
    if (NEEDS_ANY(TURNER_NEEDS_SPOT) && light.kind == TURNER_LIGHT_KIND_SPOT) {
        float c = float(-dot(arrival.direction, axis));
        float s = light.cos_inner > light.cos_outer
                      ? clamp((c - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0)
                      : (c >= light.cos_outer ? 1.0 : 0.0);
        arrival.irradiance *= s * s * (3.0 - 2.0 * s);
    }
    return arrival;
}

// f(V, L) of docs/model.md, with N·L > 0: what of E leaves towards V.
vec3 local_illumination(turner_gpu_material material, real3 N, real3 V, real3 L)
{
    float cos_light = min(float(dot(N, L)), 1.0);
    bool conserving = NEEDS_ANY(TURNER_NEEDS_CONSERVING) &&
                      (!NEEDS_ANY(TURNER_NEEDS_PHONG) || scene.shading == TURNER_NEEDS_CONSERVING);
    vec3 f = conserving ? material.k_d * (cos_light / PI) : material.k_d * cos_light;
    if (NEEDS_ANY(TURNER_NEEDS_SPECULAR) && material.k_s != vec3(0.0)) {
        real3 R = 2.0 * dot(N, L) * N - L;
        float cos_highlight = min(float(dot(R, V)), 1.0);
        if (cos_highlight > 0.0) {
            float highlight = power(cos_highlight, material.exponent);
            f += material.k_s * (conserving ? highlight * cos_light * (material.exponent + 2.0) /
                                                  (2.0 * PI)
                                            : highlight);
        }
    }
    return f;
}
