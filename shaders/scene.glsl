// The scene's arrays as the kernel reads them, what the scene needs, and the ray.
#include "shared.h"

layout(constant_id = TURNER_CONSTANT_NEEDS) const uint NEEDS = TURNER_NEEDS_ALL;
layout(constant_id = TURNER_CONSTANT_STACK) const uint STACK = 1;
layout(constant_id = TURNER_CONSTANT_BVH_STACK) const uint BVH_STACK = 64;

layout(constant_id = TURNER_CONSTANT_METHODS) const uint METHODS = 0u;

// True when the scene may contain the thing; folded when the kernel is made.
#define NEEDS_ANY(bits) ((NEEDS & (bits)) != 0u)

#define METHOD(bit) ((METHODS & (bit)) != 0u)

// The numbers of rays, hits, surfaces and directions. Colours and weights are floats always.
#ifdef TURNER_F64
#define real double
#define real2 dvec2
#define real3 dvec3
const real ULP = 2.220446049250313e-16LF; // spacing at 1
const real SPLIT = 134217729.0LF;         // 2^27 + 1: halves the digits (Dekker, 1971)
#else
#define real float
#define real2 vec2
#define real3 vec3
const real ULP = 1.1920929e-7;
const real SPLIT = 4097.0;
#endif

layout(push_constant, scalar) uniform dispatch_block { turner_gpu_dispatch dispatch; };

#define TURNER_ARRAY(block, type)                                                                  \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer block             \
    {                                                                                              \
        type at[];                                                                                 \
    }

TURNER_ARRAY(instance_array, turner_gpu_instance);
TURNER_ARRAY(corner_array, turner_gpu_corners);
TURNER_ARRAY(vec3_array, vec3);
TURNER_ARRAY(vec2_array, vec2);
TURNER_ARRAY(medium_array, turner_gpu_medium);
TURNER_ARRAY(image_array, turner_gpu_image);
TURNER_ARRAY(primitive_rest_array, turner_gpu_primitive_rest);
TURNER_ARRAY(instance_rest_array, turner_gpu_instance_rest);

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer scene_block
{
    turner_gpu_scene the;
};
// Read once, by main(): a load through an address is a gather.
turner_gpu_scene scene;

// Values of the parameters that //!PARAM lines declare (docs/shaders.md); what such a line becomes.
TURNER_ARRAY(param_array, uint);
int turner_param_int(uint word)
{
    return int(param_array(dispatch.params).at[word]);
}
float turner_param_float(uint word)
{
    return uintBitsToFloat(param_array(dispatch.params).at[word]);
}
vec3 turner_param_color(uint word)
{
    return vec3(turner_param_float(word), turner_param_float(word + 1u),
                turner_param_float(word + 2u));
}

#define INFINITY uintBitsToFloat(0x7f800000u)
const float PI = 3.14159265358979;

// What stands in a buffer as a float, with what rounding took from it where that counts.
#ifdef TURNER_F64
#define EXACT(T, value, rest) (T(value) + T(rest))
#else
#define EXACT(T, value, rest) (value)
#endif

#include "load.glsl"

struct ray_t {
    real3 origin;
    real3 direction;
    real t_max; // exclusive; rays start at T_MIN, exclusive
    real start; // how far in front of the surface it left the origin lies, along the ray
};

// Nearer than this nothing is met.
#define T_MIN (METHOD(TURNER_METHOD_OFFSET_TMIN) ? real(scene.tmin) : real(0.0))

// What a ray met. `id` orders hits at equal t, see shared.h.
struct hit_t {
    real t;
    uint id;
    uint primitive;   // index into the primitives (planes: into the planes)
    uint instance;    // 0 for planes
    real2 coordinates; // triangle: barycentric (b1, b2); cone: (0 side, 1 base cap, 2 apex cap; 0)
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

// The points of a primitive (turner_gpu_primitive says which).
struct shape_t {
    real3 a, b, c;
};

shape_t shape_of(turner_gpu_primitive p, uint index)
{
    return shape_t(EXACT(real3, p.a, primitive_rest_array(scene.primitive_rests).at[index].a),
                   EXACT(real3, p.b, primitive_rest_array(scene.primitive_rests).at[index].b),
                   EXACT(real3, p.c, primitive_rest_array(scene.primitive_rests).at[index].c));
}

// The maps of an instance, 3 rows of 4.
real[12] to_world_of(uint instance)
{
    return map_at(uint64_t(instance_block(scene.instances) + instance),
                  uint64_t(instance_rest_block(scene.instance_rests) + instance));
}

real[12] to_group_of(uint instance)
{
    return map_at(uint64_t(instance_block(scene.instances) + instance) + 48ul,
                  uint64_t(instance_rest_block(scene.instance_rests) + instance) + 48ul);
}

real3 transform_vector(real m[12], real3 v)
{
    return real3(m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
                 m[8] * v.x + m[9] * v.y + m[10] * v.z);
}

real3 transform_point(real m[12], real3 p)
{
    return transform_vector(m, p) + real3(m[3], m[7], m[11]);
}

// The linear part of `m` transposed: with to_group it takes normals to world coordinates.
real3 transform_transposed(real m[12], real3 v)
{
    return real3(m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z,
                 m[2] * v.x + m[6] * v.y + m[10] * v.z);
}

float largest(vec3 v)
{
    return max(max(v.x, v.y), v.z);
}

#ifdef TURNER_F64
double largest(dvec3 v)
{
    return max(max(v.x, v.y), v.z);
}
#endif
