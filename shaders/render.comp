#version 460
// The renderer's only kernel: one sample of every pixel of a tile, or samples wherever a list says.
// Read on in whitted.glsl.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference2 : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#ifdef TURNER_RAY_QUERY
#extension GL_EXT_ray_query : require
#endif
#ifdef TURNER_PACKET
#extension GL_KHR_shader_subgroup_shuffle : require
#endif

#include "scene.glsl"
#include "whitted.glsl"
#include "camera.glsl"
#include "work.glsl"

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

// Place of a lane in its 8×8 block along a Morton curve: neighbours in a subgroup are neighbours in
// the picture.
uvec2 morton(uint i)
{
    return uvec2((i & 1u) | ((i >> 1) & 2u) | ((i >> 2) & 4u),
                 ((i >> 1) & 1u) | ((i >> 2) & 2u) | ((i >> 3) & 4u));
}

const turner_gpu_counters NO_COUNTS =
    turner_gpu_counters(uint[](0u, 0u, 0u, 0u, 0u, 0u, 0u), uint[](0u, 0u, 0u, 0u, 0u, 0u, 0u), 0u,
                        0u);

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

// Whether their sum over the lanes will soon not fit. To add them up more often than need be is a
// tenth of a picture's time.
bool are_many(turner_gpu_counters counts)
{
    return goes_on(((counts.low[TURNER_COUNT_REFLECTED] | counts.low[TURNER_COUNT_REFRACTED] |
                     counts.low[TURNER_COUNT_SHADOW]) >> 24) != 0u);
}

// a / b for what is below 2^22: a quotient of integers is made lane by lane.
uint quotient(uint a, uint b)
{
    return uint((float(a) + 0.5) / float(b));
}

// Sample `item`, or false where there is none: its place in the picture and in `pixels`.
bool find_sample(uint item, out vec2 position, out uint index)
{
    position = vec2(0.0);
    if (dispatch.positions != 0ul) {
        index = item;
        if (index >= dispatch.count)
            return false;
        position = position_array(dispatch.positions).at[index];
        return true;
    }
    uint width = (dispatch.tile_width + TURNER_WORKGROUP - 1u) / TURNER_WORKGROUP;
    uint row = quotient(item / GROUP, width);
    uvec2 pixel = uvec2(item / GROUP - row * width, row) * TURNER_WORKGROUP + morton(item % GROUP);
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
    turner_gpu_counters counts = NO_COUNTS;
    uint item = 0u;
    for (bool first = true;; first = false) {
        bool more = take_work(first, item);
        if (!more || PIXEL_COUNTS || are_many(counts)) {
            add_counts(counts);
            counts = NO_COUNTS;
        }
        if (!more)
            break;
        vec2 position;
        uint index;
        bool sampled = find_sample(item, position, index);
        vec4 result = whitted(camera_ray(position), sampled, counts);
        if (sampled) {
            pixel_array pixels = pixel_array(dispatch.pixels);
            pixels.at[index] = dispatch.first != 0u ? result : pixels.at[index] + result;
            if (PIXEL_COUNTS)
                count_pixel(index, counts);
        }
    }
}
