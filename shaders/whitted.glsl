// Whitted's recursion without recursion: one loop in which every turn traces one ray, be it a
// camera, reflected, refracted or shadow ray. A hit is shaded in as many turns as it has lights to
// ask; the rays it sends on wait meanwhile, the first beside, the second on a stack.
#include "meeting.glsl"
#include "trace.glsl"

struct path_t { // a ray that carries light to the picture
    ray_t ray;
    vec3 weight; // what its radiance counts in the pixel
    uint depth;
    uint64_t media;
};

// A path on the stack, in words of 64 bits: each part of an array's element is stored for every lane
// by itself. t_max is left out, as those that wait go on for ever.
#ifdef TURNER_F64
#define waiting_t path_t
#define put_away(path) path
#define take_up(path) path
#else
struct waiting_t {
    uint64_t a, b, c, d, e, media;
    uint depth;
};

uint64_t both(float x, float y)
{
    return packUint2x32(floatBitsToUint(vec2(x, y)));
}

vec2 apart(uint64_t word)
{
    return uintBitsToFloat(unpackUint2x32(word));
}

waiting_t put_away(path_t path)
{
    vec3 o = path.ray.origin, d = path.ray.direction, w = path.weight;
    return waiting_t(both(o.x, o.y), both(o.z, path.ray.start), both(d.x, d.y), both(d.z, w.x),
                     both(w.y, w.z), path.media, path.depth);
}

path_t take_up(waiting_t w)
{
    vec2 b = apart(w.b), d = apart(w.d);
    return path_t(ray_t(vec3(apart(w.a), b.x), vec3(apart(w.c), d.x), INFINITY, b.y),
                  vec3(d.y, apart(w.e)), w.depth, w.media);
}
#endif

struct secondary_t { // what a surface sends on
    real3 reflected, refracted; // directions
    vec3 w_r, w_t;              // weights relative to the ray that came
    bool total;                 // total internal reflection
};

#ifdef TURNER_RECORD
#include "record.glsl"
#endif

// W_r, W_t and directions, docs/model.md "Secondary rays".
secondary_t secondary_rays(turner_gpu_material material, bool transmissive, real3 ng, real3 N,
                           real3 V, uint64_t before, uint64_t after)
{
    secondary_t s;
    real c_direction = dot(N, V);
    real c = clamp(c_direction, 0.0, 1.0);
    s.reflected = 2.0 * c_direction * N - V;
    real below = dot(s.reflected, ng);
    if (below < 0.0)
        s.reflected -= 2.0 * below * ng;
    s.reflected = normalize(s.reflected);
    s.refracted = -V;
    s.w_r = material.k_r;
    s.w_t = vec3(0.0);
    s.total = false;

    if (NEEDS_ANY(TURNER_NEEDS_TRANSMISSION) && transmissive) {
        real n1 = media_index(before), n2 = media_index(after);
        real eta = n1 / n2;
        // 1 − η²(1 − c²) cancels for η near 1
        real cos2_t = METHOD(TURNER_METHOD_COSINE_NAIVE)
                          ? 1.0 - eta * eta * (1.0 - c_direction * c_direction)
                          : (1.0 - eta) * (1.0 + eta) + eta * eta * c_direction * c_direction;
        s.total = cos2_t < 0.0;
        if (s.total) {
            RECORD(record_fresnel(vec3(1.0)));
            if (material.fresnel == TURNER_FRESNEL_KIND_NONE)
                s.w_r += material.k_t;
            return s;
        }
        real c_t = sqrt(cos2_t);
        s.refracted = -eta * V + (eta * c_direction - c_t) * N;
        real above = dot(s.refracted, ng);
        if (above > 0.0)
            s.refracted -= 2.0 * above * ng;
        s.refracted = normalize(s.refracted);
        s.w_t = material.k_t;
        if (NEEDS_ANY(TURNER_NEEDS_EXACT) && material.fresnel == TURNER_FRESNEL_KIND_EXACT) {
            float f = float(fresnel_exact(n1, n2, c, c_t));
            RECORD(record_fresnel(vec3(f)));
            s.w_r *= f;
            s.w_t *= 1.0 - f;
        }
        if (NEEDS_ANY(TURNER_NEEDS_SCHLICK) && material.fresnel == TURNER_FRESNEL_KIND_SCHLICK) {
            float f = float(fresnel_schlick(n1, n2, c, c_t));
            RECORD(record_fresnel(vec3(f)));
            s.w_r *= f;
            s.w_t *= 1.0 - f;
        }
        return s;
    }
    if (NEEDS_ANY(TURNER_NEEDS_SCHLICK) && material.fresnel == TURNER_FRESNEL_KIND_SCHLICK &&
        material.k_r != vec3(0.0)) {
        s.w_r = fresnel_schlick_metal(material.k_r, float(c));
        RECORD(record_fresnel(s.w_r));
    }
    if (NEEDS_ANY(TURNER_NEEDS_CONDUCTOR) && material.fresnel == TURNER_FRESNEL_KIND_CONDUCTOR) {
        float n = NEEDS_ANY(TURNER_NEEDS_MEDIA) ? float(media_index(before)) : 1.0;
        s.w_r *= fresnel_conductor(material.eta / n, material.k / n, float(c));
        RECORD(record_fresnel(fresnel_conductor(material.eta / n, material.k / n, float(c))));
    }
    return s;
}

// Whether a ray is to be followed; if not, what is cut goes to `pruned`.
bool follow(vec3 weight, uint depth, uint turn, bool always, inout float pruned)
{
    float w = largest(weight);
    if (depth > scene.max_depth || w < scene.cutoff || turn >= scene.max_sent) {
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
// All lanes of a subgroup come here together, those without a ray with `busy` false.
vec4 whitted(ray_t camera, bool busy, inout turner_gpu_counters counts)
{
    sum_t radiance = sum_t(vec3(0.0), vec3(0.0));
    float pruned = 0.0;
    path_t path = path_t(camera, vec3(1.0), 0u, scene.inside);
    path_t next;
    bool has_next = false;
    waiting_t stack[STACK];
    uint height = 0u;

    shading_t shading;
    shading.light = scene.light_count;
    bool shadow = false; // this turn's ray is a shadow ray
    path_t to_light;     // it; its weight is what arrives in the pixel from the light
    uint crossings = 0u;
    bool unfinished = false;
    if (busy)
        counts.low[TURNER_COUNT_CAMERA]++;

    for (uint turn = 0u; turn < scene.max_steps && goes_on(busy); turn++) {
        path_t current = path;
        if (shadow)
            current = to_light;
        ray_t ray = current.ray;
        if (!busy)
            ray.t_max = -1.0;
        RECORD(record_turn(busy, current, shadow, crossings));
        search_t search = trace(ray, shadow);

        meeting_t met;
        met.crossing = crossing_t(current.media, current.media, true);
        bool any = search.found && !search.blocked;
        if (any)
            met = meet(ray, search.hit, current.media);
        if (NEEDS_ANY(TURNER_NEEDS_MEDIA))
            current.weight *= media_transmittance(met.crossing.before,
                                                  float(ray.start + search.hit.t));
        RECORD(record_search(search, ray.start + search.hit.t, met.crossing.before));

        bool straight = any && (shadow || !met.crossing.boundary);
        if (straight) {
            // ---- on through it, unless nothing is left of the light ----
            crossings++;
            RECORD(record_crossing(search.hit, met, shadow));
            current.ray = spawn_ray(met.surface, ray.direction, ray.t_max - search.hit.t);
            current.media = met.crossing.after;
            if (shadow && met.crossing.boundary)
                current.weight *= met.material.k_t;
            straight = !shadow || current.weight != vec3(0.0);
            if (shadow)
                to_light = current;
            else
                path = current;
        } else if (any) {
            // ---- emission, ambient, and what is sent on; the lights come below ----
            vec3 weight = current.weight;
            shading = shading_of(met, -ray.direction, weight);
            RECORD(record_surface(search.hit, met, shading));
            add(radiance, weight * (met.material.k_e + met.material.k_a * scene.ambient));
            if (path.depth == 0u)
                counts.low[TURNER_COUNT_CAMERA_HITS]++;

            if (NEEDS_ANY(TURNER_NEEDS_REFLECTION | TURNER_NEEDS_TRANSMISSION)) {
                secondary_t sent = secondary_rays(met.material, met.surface.transmissive,
                                                  shading.ng, shading.N, shading.V,
                                                  met.crossing.before, met.crossing.after);
                RECORD(record_secondary(sent, met, weight));
                uint depth = path.depth + 1u;
                // the SPD's counts take every glass for a mirror too, and know no weight
                bool spd = scene.spd_rays != 0u;
                bool spd_r = spd && (met.surface.transmissive || sent.w_r != vec3(0.0));
                bool spd_t = spd && sent.w_t != vec3(0.0);
                if (follow(weight * sent.w_r, depth, turn, spd_r, pruned)) {
                    next = path_t(spawn_ray(met.surface, sent.reflected, INFINITY),
                                  weight * sent.w_r, depth, met.crossing.before);
                    has_next = true;
                    RECORD(record_flag(recorded_surface, TURNER_RECORD_REFLECTS));
                    counts.low[TURNER_COUNT_REFLECTED]++;
                    if (sent.total)
                        counts.low[TURNER_COUNT_TIR]++;
                }
                if (NEEDS_ANY(TURNER_NEEDS_TRANSMISSION) &&
                    follow(weight * sent.w_t, depth, turn, spd_t, pruned)) {
                    path_t beyond = path_t(spawn_ray(met.surface, sent.refracted, INFINITY),
                                           weight * sent.w_t, depth, met.crossing.after);
                    RECORD(record_flag(recorded_surface, TURNER_RECORD_REFRACTS));
                    counts.low[TURNER_COUNT_REFRACTED]++;
                    if (!has_next)
                        next = beyond;
                    else if (NEEDS_ANY(TURNER_NEEDS_BRANCHING))
                        stack[height++] = put_away(beyond);
                    has_next = true;
                }
            }
        } else if (busy && !search.blocked) {
            RECORD(record_end(shadow, ray, current.weight));
            add(radiance, shadow ? current.weight
                                 : current.weight * user_background(vec3(ray.direction)));
        }

        if (busy && !straight) {
            crossings = 0u;
            shadow = next_light(shading, to_light.ray, to_light.weight);
            if (shadow) {
                to_light.media = shading.media;
                counts.low[TURNER_COUNT_SHADOW]++;
            } else if (has_next) {
                path = next;
                has_next = false;
            } else if (NEEDS_ANY(TURNER_NEEDS_BRANCHING) && height > 0u) {
                path = take_up(stack[--height]);
            } else {
                busy = false;
            }
            counts.largest_depth = max(counts.largest_depth, path.depth);
        }
        if (crossings > scene.max_crossings) {
            unfinished = true;
            busy = false;
            crossings = 0u;
        }
    }
    if (busy || unfinished) {
        RECORD(record_event(TURNER_RECORD_UNFINISHED));
        counts.low[TURNER_COUNT_UNFINISHED]++;
    }
    return vec4(radiance.value, pruned);
}
