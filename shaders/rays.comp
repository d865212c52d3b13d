#version 460
// Rays of a list through the traversal that draws pictures: what each meets. With TURNER_RAYS_SEND
// the list is replaced by the rays that are sent on from there.
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

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer ray_array
{
    turner_gpu_ray at[];
};

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer hit_array
{
    turner_gpu_hit at[];
};

// A ray that is over before it begins, for lanes without one: all of a subgroup trace together.
const turner_gpu_ray NO_RAY = turner_gpu_ray(vec3(0.0), -1.0, vec3(0.0, 0.0, 1.0), TURNER_RAY_NONE);

#ifdef TURNER_RAYS_SEND

turner_gpu_ray listed(ray_t ray, uint kind)
{
    return turner_gpu_ray(vec3(ray.origin), float(ray.t_max), vec3(ray.direction), kind);
}

turner_gpu_ray camera_ray_of(uint index)
{
    uint block = index / (TURNER_WORKGROUP * TURNER_WORKGROUP);
    uint i = index % (TURNER_WORKGROUP * TURNER_WORKGROUP);
    uint row = (dispatch.tile_width + TURNER_WORKGROUP - 1u) / TURNER_WORKGROUP;
    // Morton order in the block, as in render.comp
    uvec2 pixel = uvec2(block % row, block / row) * TURNER_WORKGROUP +
                  uvec2((i & 1u) | ((i >> 1) & 2u) | ((i >> 2) & 4u),
                        ((i >> 1) & 1u) | ((i >> 2) & 2u) | ((i >> 3) & 4u));
    if (pixel.x >= dispatch.tile_width || pixel.y >= dispatch.tile_height)
        return NO_RAY;
    return listed(camera_ray(vec2(pixel) + 0.5), TURNER_RAY_NEAREST);
}

// PCG (O'Neill, 2014) as a hash: uniform in [0,1).
float random(inout uint state)
{
    state = state * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
    return float(((word >> 22) ^ word) >> 8) / 16777216.0;
}

// The normal plus a point of the unit sphere about it is distributed by the cosine.
vec3 random_direction(vec3 n, uint seed)
{
    float z = 2.0 * random(seed) - 1.0, turn = 2.0 * PI * random(seed);
    vec3 d = n + vec3(sqrt(max(0.0, 1.0 - z * z)) * vec2(cos(turn), sin(turn)), z);
    return dot(d, d) > 1e-8 ? normalize(d) : n;
}

turner_gpu_ray sent_ray(ray_t ray, hit_t hit, uint index)
{
    surface_t surface = surface_of(ray, hit);
    real3 ng = dot(surface.ng, ray.direction) > 0.0 ? -surface.ng : surface.ng;
    if (dispatch.first == TURNER_SEND_SHADOW) {
        arrival_t light = light_arrival(light_of(0u), surface.point);
        if (!(dot(ng, light.direction) > 0.0))
            return NO_RAY;
        return listed(spawn_ray(surface, light.direction, light.distance), TURNER_RAY_ANY);
    }
    real3 direction = ray.direction - 2.0 * dot(ray.direction, ng) * ng;
    if (dispatch.first == TURNER_SEND_RANDOM)
        direction = real3(random_direction(vec3(ng), index));
    return listed(spawn_ray(surface, normalize(direction), INFINITY), TURNER_RAY_NEAREST);
}
#endif

// In words, as in load.glsl.
turner_gpu_ray ray_at(uint index)
{
    uint64_t at = dispatch.pixels + uint64_t(index) * 32ul;
    uint kind, t_max;
    vec3 origin = vector_at(at, 0u, t_max), direction = vector_at(at, 2u, kind);
    return turner_gpu_ray(origin, uintBitsToFloat(t_max), direction, kind);
}

void trace_ray(uint index)
{
    turner_gpu_ray own = NO_RAY;
#ifdef TURNER_RAYS_SEND
    bool camera = dispatch.first == TURNER_SEND_CAMERA;
#else
    bool camera = false;
#endif
    if (index < dispatch.count && !camera)
        own = ray_at(index);
    ray_t ray = ray_t(real3(own.origin), real3(own.direction), real(own.t_max), 0.0);
    search_t search = trace(ray, own.kind == TURNER_RAY_ANY);
    if (index >= dispatch.count)
        return;
#ifdef TURNER_RAYS_SEND
    if (camera)
        own = camera_ray_of(index);
    else if (search.found)
        own = sent_ray(ray, search.hit, index);
    else
        own = NO_RAY;
    ray_array(dispatch.pixels).at[index] = own;
#else
    hit_array(dispatch.hits).at[index] =
        turner_gpu_hit(search.found ? float(search.hit.t) : INFINITY, search.hit.id,
                       search.hit.instance);
#endif
}

void main()
{
    scene = scene_block(dispatch.scene).the;
    uint index = 0u;
    for (bool first = true; take_work(first, index); first = false)
        trace_ray(index);
}
