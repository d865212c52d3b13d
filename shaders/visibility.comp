#version 460
// What is seen directly, and by which lights: the ray through the centre of each pixel, and from
// where it ends one to each light. deferred.comp makes a picture of that in no time (a visibility
// buffer: Burns and Hunt, JCGT 2, 2013). It knows nothing of the hooks, and is good for all of them.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#ifdef TURNER_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#ifdef TURNER_PACKET
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif

#include "scene.glsl"
#include "elementary.glsl"
#include "trace.glsl"
#include "media.glsl"
#include "texture.glsl"
#include "surface.glsl"
#include "light.glsl"
#include "camera.glsl"

layout(local_size_x = TURNER_WORKGROUP, local_size_y = TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer visible_array
{
    turner_gpu_visible at[];
};

void note(inout turner_gpu_visible visible, surface_t surface, ray_t ray, float t)
{
    visible.point = vec3(surface.point);
    visible.ng = vec3(surface.ng);
    visible.ns = vec3(surface.ns);
    visible.uv = vec2(surface.uv);
    visible.material = surface.material;
    if (surface.transmissive)
        visible.material |= TURNER_MATERIAL_TRANSMISSIVE;
    uint medium = material_of(surface.material).medium;
    crossing_t crossing = media_meet(scene.inside, surface.transmissive, medium + 1u,
                                     dot(ray.direction, surface.ng) < 0.0);
    visible.weight = crossing.boundary ? media_transmittance(crossing.before, t) : vec3(0.0);
}

turner_gpu_visible visible_to(ray_t ray, bool busy)
{
    turner_gpu_visible visible;
    visible.weight = media_transmittance(scene.inside, INFINITY);
    visible.material = TURNER_NO_INDEX;
    visible.lit = 0u;
    surface_t surface;
    uint lights = min(scene.light_count, TURNER_LIT_LIGHTS);
    for (uint turn = 0u; turn <= lights && goes_on(busy); turn++) {
        if (!busy)
            ray.t_max = -1.0;
        search_t search = trace(ray, turn > 0u);
        if (turn > 0u) {
            visible.lit |= search.blocked ? 0u : 1u << (turn - 1u);
        } else if (search.found) {
            surface = surface_of(ray, search.hit);
            note(visible, surface, ray, float(search.hit.t));
        } else {
            busy = false;
        }
        if (busy && turn < lights) {
            arrival_t arrival = light_arrival(light_of(turn), surface.point);
            ray = spawn_ray(surface, arrival.direction, arrival.distance);
        }
    }
    return visible;
}

void main()
{
    scene = scene_block(dispatch.scene).the;
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inside = pixel.x < dispatch.tile_width && pixel.y < dispatch.tile_height;
    vec2 center = vec2(uvec2(dispatch.tile_x, dispatch.tile_y) + pixel) + 0.5;
    turner_gpu_visible visible = visible_to(camera_ray(center), inside);
    if (inside)
        visible_array(dispatch.pixels).at[pixel.y * dispatch.tile_width + pixel.x] = visible;
}
