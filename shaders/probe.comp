#version 460
// Single rays through the code that draws pictures, for measurements: what a given ray meets and
// what a ray sent on from there meets, or the radiance it brings.
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

layout(local_size_x = TURNER_WORKGROUP * TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer probe_array
{
    turner_gpu_probe at[];
};

void main()
{
    scene = scene_block(dispatch.scene).the;
    uint index = gl_GlobalInvocationID.x;
    bool busy = index < dispatch.tile_width;
    probe_array probes = probe_array(dispatch.pixels);
    turner_gpu_probe probe = probes.at[busy ? index : 0u];
    ray_t ray = ray_t(real3(probe.origin), real3(probe.direction), INFINITY, 0.0);
#ifdef TURNER_PROBE_RADIANCE
    turner_gpu_counters counts;
    for (uint kind = 0u; kind < TURNER_COUNTS; kind++)
        counts.low[kind] = 0u;
    counts.largest_depth = 0u;
    vec4 radiance = whitted(ray, busy, counts);
    probe.radiance = radiance.rgb;
    probe.pruned = radiance.a;
#else
    probe.t[0] = probe.t[1] = INFINITY;
    bool tracing = busy;
    for (uint turn = 0u; turn < 2u && goes_on(tracing); turn++) {
        if (!tracing)
            ray.t_max = -1.0;
        search_t search = trace(ray, false);
        tracing = tracing && search.found;
        if (tracing) {
#ifdef TURNER_F64 // float(t) and the rest: Mesa 25 takes the difference for 0
            real head = packDouble2x32(uvec2(0u, unpackDouble2x32(search.hit.t).y));
            probe.t[turn] = float(head);
            probe.t_rest[turn] = float(search.hit.t - head);
#else
            probe.t[turn] = search.hit.t;
            probe.t_rest[turn] = 0.0;
#endif
            probe.id[turn] = search.hit.id;
            probe.instance[turn] = search.hit.instance;
            tracing = probe.leaving != vec3(0.0);
            if (tracing)
                ray = spawn_ray(surface_of(ray, search.hit), real3(probe.leaving), INFINITY);
        }
    }
#endif
    if (busy)
        probes.at[index] = probe;
}
