#version 460
// What visibility.comp found, as the hooks light it: the part of a picture that needs no ray. A
// driver that compiles for a CPU has it in a fifteenth of the time that render.comp takes.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "scene.glsl"
#include "meeting.glsl"
#include "camera.glsl"

layout(local_size_x = TURNER_WORKGROUP, local_size_y = TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer visible_array
{
    turner_gpu_visible at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer pixel_array
{
    vec4 at[];
};

// Emission, ambient light and the lights that are seen.
vec3 direct_light(real3 direction, turner_gpu_visible visible)
{
    meeting_t met = meet_surface(surface_t(
        real3(visible.point), 0.0, real3(visible.ng), real3(visible.ns), real2(visible.uv),
        visible.material & TURNER_MATERIAL_MASK,
        (visible.material & TURNER_MATERIAL_TRANSMISSIVE) != 0u));
    met.crossing = crossing_t(OUTSIDE, OUTSIDE, true);
    shading_t shading = shading_of(met, -direction, visible.weight);
    vec3 radiance = shading.weight * (met.material.k_e + met.material.k_a * scene.ambient);
    ray_t to_light;
    vec3 light;
    while (next_light(shading, to_light, light)) {
        uint asked = shading.light - 1u;
        if (asked >= TURNER_LIT_LIGHTS || (visible.lit & 1u << asked) != 0u)
            radiance += light;
    }
    return radiance;
}

void main()
{
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= dispatch.tile_width || pixel.y >= dispatch.tile_height)
        return;
    scene = scene_block(dispatch.scene).the;
    uint index = pixel.y * dispatch.tile_width + pixel.x;
    real3 direction =
        camera_ray(vec2(uvec2(dispatch.tile_x, dispatch.tile_y) + pixel) + 0.5).direction;
    turner_gpu_visible visible = visible_array(dispatch.positions).at[index];
    vec3 radiance = visible.material != TURNER_NO_INDEX
                        ? direct_light(direction, visible)
                        : user_background(vec3(direction)) * visible.weight;
    pixel_array(dispatch.pixels).at[index] = vec4(radiance, 0.0);
}
