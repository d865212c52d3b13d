// Whitted's recursion without recursion: one loop in which every turn traces one ray, be it a
// camera, reflected, refracted or shadow ray. A hit is shaded in as many turns as it has lights to
// ask; the rays it sends on wait meanwhile, the first beside, the second on a stack.
#include "elementary.glsl"
#include "media.glsl"
#include "trace.glsl"
#include "texture.glsl"
#include "surface.glsl"
#include "material.glsl"
#include "fresnel.glsl"
#include "light.glsl"
#include "background.glsl"

struct path_t { // a ray that carries light to the picture
    ray_t ray;
    vec3 weight; // what its radiance counts in the pixel
    uint depth;
    uint64_t media;
};

struct shading_t { // the surface being lit
    surface_t surface;
    turner_gpu_material material;
    vec3 N, V;
    vec3 weight;
    uint64_t media; // on V's side
    uint light;     // the next to ask
};

struct secondary_t { // what a surface sends on
    vec3 reflected, refracted; // directions
    vec3 w_r, w_t;             // weights relative to the ray that came
    bool total;                // total internal reflection
};

// W_r, W_t and directions, docs/model.md "Secondary rays".
secondary_t secondary_rays(turner_gpu_material material, bool transmissive, vec3 ng, vec3 N, vec3 V,
                           uint64_t before, uint64_t after)
{
    secondary_t s;
    float c_direction = dot(N, V);
    float c = clamp(c_direction, 0.0, 1.0);
    s.reflected = 2.0 * c_direction * N - V;
    float below = dot(s.reflected, ng);
    if (below < 0.0)
        s.reflected -= 2.0 * below * ng;
    s.reflected = normalize(s.reflected);
    s.refracted = -V;
    s.w_r = material.k_r;
    s.w_t = vec3(0.0);
    s.total = false;

    if (NEEDS_ANY(TURNER_NEEDS_TRANSMISSION) && transmissive) {
        float n1 = media_index(before), n2 = media_index(after);
        float eta = n1 / n2;
        // not 1 − η²(1 − c²), which cancels for η near 1
        float cos2_t = (1.0 - eta) * (1.0 + eta) + eta * eta * c_direction * c_direction;
        s.total = cos2_t < 0.0;
        if (s.total) {
            if (material.fresnel == TURNER_FRESNEL_KIND_NONE)
                s.w_r += material.k_t;
            return s;
        }
        float c_t = sqrt(cos2_t);
        s.refracted = -eta * V + (eta * c_direction - c_t) * N;
        float above = dot(s.refracted, ng);
        if (above > 0.0)
            s.refracted -= 2.0 * above * ng;
        s.refracted = normalize(s.refracted);
        s.w_t = material.k_t;
        if (NEEDS_ANY(TURNER_NEEDS_EXACT) && material.fresnel == TURNER_FRESNEL_KIND_EXACT) {
            float f = fresnel_exact(n1, n2, c, c_t);
            s.w_r *= f;
            s.w_t *= 1.0 - f;
        }
        if (NEEDS_ANY(TURNER_NEEDS_SCHLICK) && material.fresnel == TURNER_FRESNEL_KIND_SCHLICK) {
            float f = fresnel_schlick(n1, n2, c, c_t);
            s.w_r *= f;
            s.w_t *= 1.0 - f;
        }
        return s;
    }
    if (NEEDS_ANY(TURNER_NEEDS_SCHLICK) && material.fresnel == TURNER_FRESNEL_KIND_SCHLICK &&
        material.k_r != vec3(0.0))
        s.w_r = fresnel_schlick_metal(material.k_r, c);
    if (NEEDS_ANY(TURNER_NEEDS_CONDUCTOR) && material.fresnel == TURNER_FRESNEL_KIND_CONDUCTOR) {
        float n = NEEDS_ANY(TURNER_NEEDS_MEDIA) ? media_index(before) : 1.0;
        s.w_r *= fresnel_conductor(material.eta / n, material.k / n, c);
    }
    return s;
}

// Whether a ray is to be followed; if not, what is cut goes to `pruned`.
bool follow(vec3 weight, uint depth, bool always, inout float pruned)
{
    float w = largest(weight);
    if (depth > scene.max_depth || w < scene.cutoff) {
        pruned += w;
        return false;
    }
    return w > 0.0 || always;
}

// A sum of many terms, a thousand lights' say, with what rounding takes from it (Kahan, 1965).
struct sum_t {
    vec3 value, lost;
};

void add(inout sum_t sum, vec3 term)
{
    precise vec3 mended = term - sum.lost;
    precise vec3 value = sum.value + mended;
    precise vec3 lost = (value - sum.value) - mended;
    sum = sum_t(value, lost);
}

// Radiance along the camera ray, and the sum of the weights that were cut in the fourth component.
vec4 whitted(ray_t camera, inout turner_gpu_counters counts)
{
    sum_t radiance = sum_t(vec3(0.0), vec3(0.0));
    float pruned = 0.0;
    path_t path = path_t(camera, vec3(1.0), 0u, scene.inside);
    path_t next;
    bool has_next = false;
    path_t stack[STACK];
    uint height = 0u;

    shading_t shading;
    shading.light = scene.light_count;
    bool shadow = false;  // this turn's ray is a shadow ray
    ray_t shadow_ray;
    vec3 light;           // what arrives in the pixel if nothing is in the way
    uint64_t shadow_media = 0ul;
    uint crossings = 0u;
    counts.low[TURNER_COUNT_CAMERA]++;

    for (uint turn = 0u; turn < scene.max_steps; turn++) {
        ray_t ray = path.ray;
        uint64_t media = path.media;
        if (shadow) {
            ray = shadow_ray;
            media = shadow_media;
        }
        search_t search = trace(ray, shadow);

        // ---- what the ray met; a transmissive surface may be none ----
        surface_t surface;
        turner_gpu_material material;
        bool met = search.found && !(shadow && search.blocked);
        bool real = met;
        crossing_t crossing = crossing_t(media, media, true);
        if (met) {
            surface = surface_of(ray, search.hit);
            material = material_at(surface);
            if (NEEDS_ANY(TURNER_NEEDS_MEDIA) && surface.transmissive) {
                crossing = media_cross(media, material.medium + 1u,
                                       dot(ray.direction, surface.ng) < 0.0);
                real = crossing.real;
            }
        }
        vec3 travelled = vec3(1.0);
        if (NEEDS_ANY(TURNER_NEEDS_MEDIA))
            travelled = media_transmittance(crossing.before, ray.start + search.hit.t);
        if (met && (shadow || !real) && ++crossings > scene.max_crossings)
            break;

        if (shadow) {
            light *= travelled;
            if (met && real)
                light *= material.k_t;
            if (search.blocked) {
                shadow = false;
            } else if (met && light != vec3(0.0)) {
                shadow_media = crossing.after;
                shadow_ray = spawn_ray(surface, ray.direction, ray.t_max - search.hit.t);
                continue;
            } else {
                add(radiance, light);
                shadow = false;
            }
        } else {
            path.weight *= travelled;
            if (met && !real) {
                path.media = crossing.after;
                path.ray = spawn_ray(surface, ray.direction, INFINITY);
                continue;
            }
            if (!met)
                add(radiance, path.weight * background(ray.direction));
            if (met) {
                // ---- shade: emission, ambient, and what is sent on; the lights come below ----
                if (path.depth == 0u)
                    counts.low[TURNER_COUNT_CAMERA_HITS]++;
                counts.largest_depth = max(counts.largest_depth, path.depth);
                vec3 V = -ray.direction;
                vec3 ng = dot(surface.ng, V) < 0.0 ? -surface.ng : surface.ng;
                vec3 N = dot(surface.ns, ng) < 0.0 ? -surface.ns : surface.ns;
                add(radiance, path.weight * (material.k_e + material.k_a * scene.ambient));
                shading = shading_t(surface, material, N, V, path.weight, crossing.before, 0u);
                if (material.k_d == vec3(0.0) && material.k_s == vec3(0.0))
                    shading.light = scene.light_count;

                if (NEEDS_ANY(TURNER_NEEDS_REFLECTION | TURNER_NEEDS_TRANSMISSION)) {
                    secondary_t sent = secondary_rays(material, surface.transmissive, ng, N, V,
                                                      crossing.before, crossing.after);
                    vec3 w_r = path.weight * sent.w_r, w_t = path.weight * sent.w_t;
                    uint depth = path.depth + 1u;
                    // the SPD's counts take every glass for a mirror too, and know no weight
                    bool spd = scene.spd_rays != 0u;
                    bool spd_r = spd && (surface.transmissive || sent.w_r != vec3(0.0));
                    bool spd_t = spd && sent.w_t != vec3(0.0);
                    if (follow(w_r, depth, spd_r, pruned)) {
                        next = path_t(spawn_ray(surface, sent.reflected, INFINITY), w_r, depth,
                                      crossing.before);
                        has_next = true;
                        counts.low[TURNER_COUNT_REFLECTED]++;
                        if (sent.total)
                            counts.low[TURNER_COUNT_TIR]++;
                    }
                    if (NEEDS_ANY(TURNER_NEEDS_TRANSMISSION) && follow(w_t, depth, spd_t, pruned)) {
                        path_t beyond = path_t(spawn_ray(surface, sent.refracted, INFINITY), w_t,
                                               depth, crossing.after);
                        counts.low[TURNER_COUNT_REFRACTED]++;
                        if (!has_next)
                            next = beyond;
                        else if (NEEDS_ANY(TURNER_NEEDS_BRANCHING))
                            stack[height++] = beyond;
                        has_next = true;
                    }
                }
            }
        }

        // ---- the next light that reaches the surface from the front ----
        for (; !shadow && shading.light < scene.light_count; shading.light++) {
            turner_gpu_light source = light_array(scene.lights).at[shading.light];
            arrival_t arrival = light_arrival(source, shading.surface.point);
            if (!(dot(shading.N, arrival.direction) > 0.0) || arrival.irradiance == vec3(0.0))
                continue;
            light = shading.weight * arrival.irradiance *
                    local_illumination(shading.material, shading.N, shading.V, arrival.direction);
            shadow_ray = spawn_ray(shading.surface, arrival.direction, arrival.distance);
            shadow_media = shading.media;
            crossings = 0u;
            shadow = true;
            counts.low[TURNER_COUNT_SHADOW]++;
        }
        if (shadow)
            continue;

        // ---- the next ray that carries light ----
        crossings = 0u;
        if (has_next) {
            path = next;
            has_next = false;
        } else if (NEEDS_ANY(TURNER_NEEDS_BRANCHING) && height > 0u) {
            path = stack[--height];
        } else {
            return vec4(radiance.value, pruned);
        }
        counts.largest_depth = max(counts.largest_depth, path.depth);
    }
    counts.low[TURNER_COUNT_UNFINISHED]++;
    return vec4(radiance.value, pruned);
}
