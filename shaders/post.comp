#version 460
// Each pixel of a finished picture through user/post.glsl. Run only where that is replaced.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "scene.glsl"
#include "user/post.glsl"

layout(local_size_x = TURNER_WORKGROUP * TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer pixel_array
{
    vec4 at[];
};

// `count` pixels, the first of which is number `first` of a picture of tile_width × tile_height.
void main()
{
    uint index = gl_GlobalInvocationID.x;
    if (index >= dispatch.count)
        return;
    uint pixel = dispatch.first + index;
    vec2 position = vec2(pixel % dispatch.tile_width, pixel / dispatch.tile_width) + 0.5;
    pixel_array pixels = pixel_array(dispatch.pixels);
    pixels.at[index].rgb = user_post(pixels.at[index].rgb, position,
                                     vec2(dispatch.tile_width, dispatch.tile_height));
}
