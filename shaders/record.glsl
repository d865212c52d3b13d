// What the kernel does, noted down by the one lane that has a ray as a stream of events, which
// src/render/explain.c turns into a tree of rays. Only in kernels compiled with TURNER_RECORD;
// nothing here changes what is traced. Where the stream is full, events are counted only.

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer record_header
{
    turner_gpu_records the;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer record_array
{
    turner_gpu_record at[];
};

bool recording;           // this lane has a ray
uint recorded_place;      // of the event that is being filled
uint recorded_surface;    // of the last surface
real recorded_way;        // of the ray so far
vec3 recorded_through;    // what was left of its light on that way
vec3 recorded_fresnel;
bool recorded_has_fresnel;

#ifdef TURNER_F64
uint64_t record_bits(double v) { return packUint2x32(unpackDouble2x32(v)); }
uint64_t record_bits(float v) { return record_bits(double(v)); }
#else
uint64_t record_bits(float v) { return uint64_t(floatBitsToUint(v)); }
#endif

record_array records()
{
    return record_array(dispatch.pixels + TURNER_RECORDS_OFFSET + TURNER_RECORDS_HEADER);
}

bool record_fits(uint place)
{
    return place < record_header(dispatch.pixels + TURNER_RECORDS_OFFSET).the.capacity;
}

void record_event(uint what)
{
    if (!recording) {
        recorded_place = TURNER_NO_INDEX;
        return;
    }
    record_header header = record_header(dispatch.pixels + TURNER_RECORDS_OFFSET);
    recorded_place = header.the.count++;
    if (!record_fits(recorded_place))
        return;
    record_array all = records();
    all.at[recorded_place].what = what;
    all.at[recorded_place].flags = 0u;
    all.at[recorded_place].media = 0ul;
    for (uint i = 0u; i < TURNER_RECORD_VALUES; i++)
        all.at[recorded_place].value[i] = 0ul;
}

void record_flag(uint place, uint flag)
{
    if (record_fits(place))
        records().at[place].flags |= flag;
}

void record_value(uint i, real v)
{
    if (record_fits(recorded_place))
        records().at[recorded_place].value[i] = record_bits(v);
}

void record_value(uint i, real3 v)
{
    record_value(i, v.x);
    record_value(i + 1u, v.y);
    record_value(i + 2u, v.z);
}

#ifdef TURNER_F64
void record_value(uint i, vec3 v) { record_value(i, dvec3(v)); }
#endif

void record_media(uint64_t media)
{
    if (record_fits(recorded_place))
        records().at[recorded_place].media = media;
}

void record_hit(hit_t hit)
{
    if (!record_fits(recorded_place))
        return;
    records().at[recorded_place].id = hit.id;
    records().at[recorded_place].instance = hit.instance;
}

// A turn of the loop begins: with a new ray, or further along one.
void record_turn(bool busy, path_t path, bool shadow, uint crossings)
{
    recording = busy;
    if (crossings > 0u)
        return;
    recorded_way = 0.0;
    recorded_through = vec3(1.0);
    if (shadow)
        return; // record_shadow() has noted it
    record_event(TURNER_RECORD_RAY);
    record_value(TURNER_RECORD_ORIGIN, path.ray.origin);
    record_value(TURNER_RECORD_DIRECTION, path.ray.direction);
    record_value(TURNER_RECORD_WEIGHT, path.weight);
    record_media(path.media);
}

// It found something or nothing, that far on in the medium.
void record_search(search_t search, real way, uint64_t media)
{
    recorded_way += way;
    if (NEEDS_ANY(TURNER_NEEDS_MEDIA))
        recorded_through *= media_transmittance(media, float(way));
    if (!search.blocked)
        return;
    record_event(TURNER_RECORD_BLOCKED);
    record_hit(search.hit);
    record_value(TURNER_RECORD_T, recorded_way);
}

void record_crossing(hit_t hit, meeting_t met, bool shadow)
{
    if (shadow && met.crossing.boundary)
        recorded_through *= met.material.k_t;
    record_event(TURNER_RECORD_CROSSING);
    record_hit(hit);
    record_value(TURNER_RECORD_T, recorded_way);
    if (met.crossing.boundary)
        record_flag(recorded_place, TURNER_RECORD_BOUNDARY);
}

// The ray leaves the scene, or the shadow ray arrives.
void record_end(bool shadow, ray_t ray, vec3 weight)
{
    record_event(shadow ? TURNER_RECORD_LIT : TURNER_RECORD_BACKGROUND);
    vec3 radiance = shadow ? vec3(1.0) : user_background(vec3(ray.direction));
    record_value(TURNER_RECORD_THROUGH, recorded_through);
    record_value(TURNER_RECORD_RADIANCE, radiance);
    record_value(TURNER_RECORD_CONTRIBUTION, shadow ? weight : weight * radiance);
}

void record_surface(hit_t hit, meeting_t met, shading_t shading)
{
    vec3 radiance = met.material.k_e + met.material.k_a * scene.ambient;
    record_event(TURNER_RECORD_SURFACE);
    recorded_surface = recorded_place;
    recorded_has_fresnel = false;
    record_hit(hit);
    if (record_fits(recorded_place))
        records().at[recorded_place].material = met.surface.material;
    record_value(TURNER_RECORD_T, recorded_way);
    record_value(TURNER_RECORD_THROUGH, recorded_through);
    record_value(TURNER_RECORD_RADIANCE, radiance);
    record_value(TURNER_RECORD_CONTRIBUTION, shading.weight * radiance);
    record_value(TURNER_RECORD_POINT, met.surface.point);
    record_value(TURNER_RECORD_NG, shading.ng);
    record_value(TURNER_RECORD_NS, shading.N);
    record_value(TURNER_RECORD_COSINE, dot(shading.N, shading.V));
    record_value(TURNER_RECORD_N1, media_index(met.crossing.before));
    record_value(TURNER_RECORD_N2, media_index(met.crossing.after));
    record_media(met.crossing.after);
}

// The value of the formula that secondary_rays() applies.
void record_fresnel(vec3 fresnel)
{
    recorded_fresnel = fresnel;
    recorded_has_fresnel = true;
}

// What the surface just noted sends on, followed or not.
void record_secondary(secondary_t sent, meeting_t met, vec3 weight)
{
    if (sent.total)
        record_flag(recorded_place, TURNER_RECORD_TOTAL);
    if (recorded_has_fresnel) {
        record_flag(recorded_place, TURNER_RECORD_FRESNEL_KNOWN);
        record_value(TURNER_RECORD_FRESNEL, recorded_fresnel);
    }
    record_value(TURNER_RECORD_REFLECTED, sent.reflected);
    record_value(TURNER_RECORD_REFLECTED_ORIGIN,
                 spawn_ray(met.surface, sent.reflected, INFINITY).origin);
    record_value(TURNER_RECORD_W_R, weight * sent.w_r);
    record_value(TURNER_RECORD_REFRACTED, sent.refracted);
    record_value(TURNER_RECORD_REFRACTED_ORIGIN,
                 spawn_ray(met.surface, sent.refracted, INFINITY).origin);
    record_value(TURNER_RECORD_W_T, weight * sent.w_t);
}

// A light as the surface sees it; whether it is asked is not known yet.
void record_light(shading_t shading, uint light, arrival_t arrival)
{
    turner_gpu_material dull = shading.material, black = shading.material;
    dull.k_s = vec3(0.0);
    black.k_d = vec3(0.0);
    real3 L = arrival.direction;
    real n_l = dot(shading.N, L);
    record_event(TURNER_RECORD_LIGHT);
    if (record_fits(recorded_place))
        records().at[recorded_place].light = light;
    record_value(TURNER_RECORD_DIRECTION, L);
    record_value(TURNER_RECORD_T, arrival.distance);
    record_value(TURNER_RECORD_WEIGHT, shading.weight);
    record_value(TURNER_RECORD_IRRADIANCE, arrival.irradiance);
    record_value(TURNER_RECORD_N_L, n_l);
    record_value(TURNER_RECORD_R_V, dot(2.0 * n_l * shading.N - L, shading.V));
    if (n_l > 0.0) {
        record_value(TURNER_RECORD_DIFFUSE, user_brdf(dull, shading.N, shading.V, L));
        record_value(TURNER_RECORD_SPECULAR, user_brdf(black, shading.N, shading.V, L));
    }
    record_media(shading.media);
}

// The shadow ray to it.
void record_shadow(ray_t ray)
{
    record_flag(recorded_place, TURNER_RECORD_ASKED);
    record_value(TURNER_RECORD_ORIGIN, ray.origin);
}
