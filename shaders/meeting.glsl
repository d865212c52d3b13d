// What a ray meets: the surface, its material as the hooks have it, and the lights it asks.
#include "elementary.glsl"
#include "media.glsl"
#include "sphere.glsl"
#include "cone.glsl"
#include "triangle.glsl"
#include "plane.glsl"
#include "texture.glsl"
#include "surface.glsl"
#include "material.glsl"
#include "fresnel.glsl"
#include "light.glsl"
#include "background.glsl"
#include "user/surface.glsl"
#include "user/brdf.glsl"
#include "user/background.glsl"
#include "user/light.glsl"

struct shading_t { // the surface being lit
    surface_t surface;
    turner_gpu_material material;
    real3 ng, N, V; // the normals on V's side
    vec3 weight;
    uint64_t media; // on V's side
    uint light;     // the next to ask
};

// For turner explain (record.glsl); otherwise these lines say nothing.
#ifdef TURNER_RECORD
#define RECORD(call) call
void record_light(shading_t shading, uint light, arrival_t arrival);
void record_shadow(ray_t ray);
#else
#define RECORD(call)
#endif

// What a ray met.
struct meeting_t {
    surface_t surface;
    turner_gpu_material material;
    crossing_t crossing; // lists of media on the ray's side and beyond
};

meeting_t meet_surface(surface_t surface)
{
    meeting_t met;
    met.surface = surface;
    met.material = material_at(met.surface);
    user_surface(met.material, met.surface.ns, met.surface);
    return met;
}

meeting_t meet(ray_t ray, hit_t hit, uint64_t media)
{
    meeting_t met = meet_surface(surface_of(ray, hit));
    met.crossing = media_meet(media, met.surface.transmissive, met.material.medium + 1u,
                              dot(ray.direction, met.surface.ng) < 0.0);
    return met;
}

// The surface as its lights see it; one that reflects no light asks none.
shading_t shading_of(meeting_t met, real3 V, vec3 weight)
{
    real3 ng = dot(met.surface.ng, V) < 0.0 ? -met.surface.ng : met.surface.ng;
    real3 N = dot(met.surface.ns, ng) < 0.0 ? -met.surface.ns : met.surface.ns;
    bool dark = met.material.k_d == vec3(0.0) && met.material.k_s == vec3(0.0);
    return shading_t(met.surface, met.material, ng, N, V, weight, met.crossing.before,
                     dark ? scene.light_count : 0u);
}

// The next light that reaches the surface from the front: the ray to it, and what arrives in the
// pixel if nothing is in the way. False when all have been asked.
bool next_light(inout shading_t shading, out ray_t ray, out vec3 light)
{
    while (shading.light < scene.light_count) {
        uint index = shading.light++;
        arrival_t arrival = user_light(light_of(index), index, shading.surface.point);
        RECORD(record_light(shading, index, arrival));
        if (!(dot(shading.N, arrival.direction) > 0.0) || arrival.irradiance == vec3(0.0))
            continue;
        light = shading.weight * arrival.irradiance *
                user_brdf(shading.material, shading.N, shading.V, arrival.direction);
        ray = spawn_ray(shading.surface, arrival.direction, arrival.distance);
        RECORD(record_shadow(ray));
        return true;
    }
    return false;
}
