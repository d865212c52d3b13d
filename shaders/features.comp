#version 460
// What the ray through the centre of each pixel meets: the layers that no light decides
// (docs/layers.md). A kernel of its own, so that pictures without layers pay nothing for them.
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
#include "whitted.glsl"
#include "camera.glsl"

layout(local_size_x = TURNER_WORKGROUP, local_size_y = TURNER_WORKGROUP) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer feature_array
{
    turner_gpu_feature at[];
};

// As whitted() does it, a surface with the same medium on both sides is none.
turner_gpu_feature feature_of(ray_t camera, bool busy)
{
    ray_t ray = camera;
    turner_gpu_feature feature;
    feature.normal = feature.albedo = feature.position = vec3(0.0);
    feature.depth = INFINITY;
    feature.id = TURNER_NO_INDEX;
    feature.instance = 0u;
    uint64_t media = scene.inside;
    for (uint crossings = 0u; crossings <= scene.max_crossings && goes_on(busy); crossings++) {
        if (!busy)
            ray.t_max = -1.0;
        search_t search = trace(ray, false);
        busy = search.found;
        if (search.found) {
            meeting_t met = meet(ray, search.hit, media);
            if (met.crossing.boundary) {
                feature.normal = vec3(shading_of(met, -ray.direction, vec3(1.0)).N);
                feature.albedo = met.material.k_d;
                feature.position = vec3(met.surface.point);
                // t is known less well than the point that was put back onto its surface
                feature.depth = float(distance(met.surface.point, camera.origin));
                feature.id = search.hit.id;
                feature.instance = search.hit.instance;
                busy = false;
            }
            ray = spawn_ray(met.surface, ray.direction, INFINITY);
            media = met.crossing.after;
        }
    }
    return feature;
}

void main()
{
    scene = scene_block(dispatch.scene).the;
    uvec2 pixel = gl_GlobalInvocationID.xy;
    bool inside = pixel.x < dispatch.tile_width && pixel.y < dispatch.tile_height;
    vec2 center = vec2(uvec2(dispatch.tile_x, dispatch.tile_y) + pixel) + 0.5;
    turner_gpu_feature feature = feature_of(camera_ray(center), inside);
    if (inside)
        feature_array(dispatch.pixels).at[pixel.y * dispatch.tile_width + pixel.x] = feature;
}
