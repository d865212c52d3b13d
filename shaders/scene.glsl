// The scene's arrays as the kernel reads them, what the scene needs, and the ray.
#include "shared.h"

layout(constant_id = TURNER_CONSTANT_NEEDS) const uint NEEDS = TURNER_NEEDS_ALL;
layout(constant_id = TURNER_CONSTANT_STACK) const uint STACK = 1;
layout(constant_id = TURNER_CONSTANT_BVH_STACK) const uint BVH_STACK = 64;

// True when the scene may contain the thing; folded when the kernel is made.
#define NEEDS_ANY(bits) ((NEEDS & (bits)) != 0u)

layout(push_constant, scalar) uniform dispatch_block { turner_gpu_dispatch dispatch; };

#define TURNER_ARRAY(block, type)                                                                  \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer block             \
    {                                                                                              \
        type at[];                                                                                 \
    }

TURNER_ARRAY(primitive_array, turner_gpu_primitive);
TURNER_ARRAY(instance_array, turner_gpu_instance);
TURNER_ARRAY(plane_array, turner_gpu_plane);
TURNER_ARRAY(corner_array, turner_gpu_corners);
TURNER_ARRAY(vec3_array, vec3);
TURNER_ARRAY(vec2_array, vec2);
TURNER_ARRAY(material_array, turner_gpu_material);
TURNER_ARRAY(medium_array, turner_gpu_medium);
TURNER_ARRAY(image_array, turner_gpu_image);
TURNER_ARRAY(light_array, turner_gpu_light);

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer scene_block
{
    turner_gpu_scene the;
};
// Read once, by main(): a load through an address is a gather for every lane.
turner_gpu_scene scene;

#define INFINITY uintBitsToFloat(0x7f800000u)
const float PI = 3.14159265358979;
const float ULP = 1.1920929e-7; // spacing of floats at 1

struct ray_t {
    vec3 origin;
    vec3 direction;
    float t_max; // exclusive; rays start at 0, exclusive
    float start; // how far in front of the surface it left the origin lies, along the ray
};

// What a ray met. `id` orders hits at equal t, see shared.h.
struct hit_t {
    float t;
    uint id;
    uint primitive;   // index into the primitives (planes: into the planes)
    uint instance;    // 0 for planes
    vec2 coordinates; // triangle: barycentric (b1, b2); cone: (0 side, 1 base cap, 2 apex cap; 0)
};

// Planes come before instances, instances in order, ids in order.
bool comes_before(uint instance_a, uint id_a, uint instance_b, uint id_b)
{
    bool plane_a = (id_a >> TURNER_KIND_SHIFT) == TURNER_KIND_PLANE;
    bool plane_b = (id_b >> TURNER_KIND_SHIFT) == TURNER_KIND_PLANE;
    if (plane_a != plane_b)
        return plane_a;
    return instance_a != instance_b ? instance_a < instance_b : id_a < id_b;
}

vec3 transform_vector(float m[12], vec3 v)
{
    return vec3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                m[8] * v.x + m[9] * v.y + m[10] * v.z);
}

vec3 transform_point(float m[12], vec3 p)
{
    return transform_vector(m, p) + vec3(m[3], m[7], m[11]);
}

// The linear part of `m` transposed: with to_group it takes normals to world coordinates.
vec3 transform_transposed(float m[12], vec3 v)
{
    return vec3(m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z,
                m[2] * v.x + m[6] * v.y + m[10] * v.z);
}

float largest(vec3 v)
{
    return max(max(v.x, v.y), v.z);
}
