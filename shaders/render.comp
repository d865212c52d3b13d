#version 460
// The renderer's only kernel: one sample of every pixel of a tile, or samples wherever a list says.
// Read on in whitted.glsl.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#ifdef TURNER_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#ifdef TURNER_PACKET
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif

#include "scene.glsl"
#include "whitted.glsl"
#include "camera.glsl"

layout(local_size_x = TURNER_WORKGROUP * TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer pixel_array
{
    vec4 at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer position_array
{
    vec2 at[]; // in the picture, in pixels
};

layout(constant_id = TURNER_CONSTANT_PIXEL_COUNTS) const bool PIXEL_COUNTS = false;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer pixel_count_array
{
    turner_gpu_pixel_counts at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer counter_block
{
    turner_gpu_counters the;
};

// Place of a lane in its 8×8 block along a Morton curve: neighbours in a subgroup are neighbours in
// the picture.
uvec2 morton(uint i)
{
    return uvec2((i & 1u) | ((i >> 1) & 2u) | ((i >> 2) & 4u),
                 ((i >> 1) & 1u) | ((i >> 2) & 2u) | ((i >> 3) & 4u));
}

void add_counts(turner_gpu_counters counts)
{
    counter_block total = counter_block(dispatch.counters);
    for (uint kind = 0u; kind < TURNER_COUNTS; kind++) {
        uint sum = subgroupAdd(counts.low[kind]);
        if (subgroupElect() && sum > 0u) {
            uint before = atomicAdd(total.the.low[kind], sum);
            if (before + sum < before)
                atomicAdd(total.the.high[kind], 1u);
        }
    }
    uint depth = subgroupMax(counts.largest_depth);
    if (subgroupElect())
        atomicMax(total.the.largest_depth, depth);
}

// a / b for what is below 2^22: a quotient of integers is made lane by lane.
uint quotient(uint a, uint b)
{
    return uint((float(a) + 0.5) / float(b));
}

// The place of this workgroup among all. A CPU device deals them out to its threads beforehand, in
// consecutive pieces of which one may have all the sky; so places are taken in turn for the pieces.
uvec2 workgroup_place()
{
    uint width = gl_NumWorkGroups.x, i = gl_WorkGroupID.y * width + gl_WorkGroupID.x;
    uint pieces = max(dispatch.pieces, 1u);
    uint size = quotient(width * gl_NumWorkGroups.y, pieces);
    if (i < size * pieces) {
        uint piece = quotient(i, size);
        i = (i - piece * size) * pieces + piece;
    }
    uint row = quotient(i, width);
    return uvec2(i - row * width, row);
}

// The sample of this lane, or false where there is none: its place in the picture and in `pixels`.
bool sample_of_lane(out vec2 position, out uint index)
{
    position = vec2(0.0);
    if (dispatch.positions != 0ul) {
        index = workgroup_place().x * (TURNER_WORKGROUP * TURNER_WORKGROUP) + gl_LocalInvocationIndex;
        if (index >= dispatch.count)
            return false;
        position = position_array(dispatch.positions).at[index];
        return true;
    }
    uvec2 pixel = workgroup_place() * TURNER_WORKGROUP + morton(gl_LocalInvocationIndex);
    index = pixel.y * dispatch.tile_width + pixel.x;
    position = vec2(uvec2(dispatch.tile_x, dispatch.tile_y) + pixel) +
               vec2(dispatch.sample_x, dispatch.sample_y);
    return pixel.x < dispatch.tile_width && pixel.y < dispatch.tile_height;
}

void count_pixel(uint index, turner_gpu_counters counts)
{
    pixel_count_array pixels = pixel_count_array(dispatch.pixel_counts);
    turner_gpu_pixel_counts sum = turner_gpu_pixel_counts(0u, 0u);
    if (dispatch.first == 0u)
        sum = pixels.at[index];
    uint rays = counts.low[TURNER_COUNT_CAMERA] + counts.low[TURNER_COUNT_REFLECTED] +
                counts.low[TURNER_COUNT_REFRACTED] + counts.low[TURNER_COUNT_SHADOW];
    sum.rays = sum.rays + rays < rays ? 0xffffffffu : sum.rays + rays;
    sum.recursion = max(sum.recursion, counts.largest_depth);
    pixels.at[index] = sum;
}

void main()
{
    scene = scene_block(dispatch.scene).the;
    scene.max_depth = dispatch.max_depth;
    scene.cutoff = dispatch.cutoff;
    turner_gpu_counters counts;
    for (uint kind = 0u; kind < TURNER_COUNTS; kind++)
        counts.low[kind] = 0u;
    counts.largest_depth = 0u;

    vec2 position;
    uint index;
    bool sampled = sample_of_lane(position, index);
    vec4 result = whitted(camera_ray(position), sampled, counts);
    if (sampled) {
        pixel_array pixels = pixel_array(dispatch.pixels);
        pixels.at[index] = dispatch.first != 0u ? result : pixels.at[index] + result;
        if (PIXEL_COUNTS)
            count_pixel(index, counts);
    }
    add_counts(counts);
}
