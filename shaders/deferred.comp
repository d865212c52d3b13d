#version 460
// What visibility.comp found, as the hooks light it: the part of a picture that needs no ray. A
// driver that compiles for a CPU has it in an eighth of the time that render.comp takes.
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

// Emission, ambient light and the lights that are seen; nothing where one looks straight on, into the
// same medium.
vec3 direct_light(ray_t ray, turner_gpu_visible visible)
{
    hit_t hit = hit_t(visible.t, visible.id, visible.primitive, visible.instance,
                      real2(visible.coordinates[0], visible.coordinates[1]));
    meeting_t met = meet(ray, hit, scene.inside);
    if (!met.crossing.boundary)
        return vec3(0.0);
    shading_t shading = shading_of(met, -ray.direction,
                                   media_transmittance(met.crossing.before, visible.t));
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
    ray_t ray = camera_ray(vec2(uvec2(dispatch.tile_x, dispatch.tile_y) + pixel) + 0.5);
    turner_gpu_visible visible = visible_array(dispatch.positions).at[index];
    vec3 radiance = visible.id != TURNER_NO_INDEX
                        ? direct_light(ray, visible)
                        : user_background(vec3(ray.direction)) *
                              media_transmittance(scene.inside, INFINITY);
    pixel_array(dispatch.pixels).at[index] = vec4(radiance, 0.0);
}
