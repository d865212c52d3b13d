// One ray against the whole scene; with t_max −1 it meets nothing. There is a single call of trace()
// in the kernel: the traversal is inlined where it is called, and the ray-query kind keeps a stack
// for each place.
//
// For shadow rays the walk may end at the first opaque surface; of transmissive ones the nearest
// is kept. `blocked` says that an opaque one was met.
#include "sphere.glsl"
#include "cone.glsl"
#include "triangle.glsl"
#include "plane.glsl"

struct search_t {
    hit_t hit;    // the nearest so far; hit.t starts as the ray's t_max
    bool found;
    bool shadow;
    bool tinted;  // shadow rays may pass transmissive surfaces
    bool blocked; // shadow ray met an opaque surface: nothing more to find
};

// Takes a candidate at t if it beats the nearest so far; equal t goes to the one that comes first.
void consider(inout search_t search, real t, uint id, uint primitive, uint instance,
              real2 coordinates, uint material)
{
    bool nearer = t < search.hit.t;
    bool tied = t == search.hit.t && search.found &&
                comes_before(instance, id, search.hit.instance, search.hit.id);
    if (!(nearer || tied) || search.blocked)
        return;
    search.hit = hit_t(t, id, primitive, instance, coordinates);
    search.found = true;
    if (search.shadow && !(search.tinted && (material & TURNER_MATERIAL_TRANSMISSIVE) != 0u))
        search.blocked = true;
}

// Whether a primitive is of this kind; where the scene has no others it is not asked.
bool may_be(uint need, uint kind, uint actual)
{
    const uint shapes = TURNER_NEEDS_SPHERES | TURNER_NEEDS_CONES | TURNER_NEEDS_TRIANGLES;
    return NEEDS_ANY(need) && (!NEEDS_ANY(shapes & ~need) || actual == kind);
}

// Intersects one primitive of a group; `origin` and `direction` are in the group's coordinates.
void intersect_primitive(inout search_t search, turner_gpu_primitive p, uint index, uint instance,
                         uint override_material, real3 origin, real3 direction, shear_t shear)
{
    uint kind = p.id >> TURNER_KIND_SHIFT;
    shape_t s = shape_of(p, index);
    real t = INFINITY;
    real2 coordinates = real2(0.0);
    if (may_be(TURNER_NEEDS_SPHERES, TURNER_KIND_SPHERE, kind))
        t = intersect_sphere(origin, direction, s.a, s.b.x);
    if (may_be(TURNER_NEEDS_CONES, TURNER_KIND_CONE, kind))
        t = intersect_cone(origin, direction, s.a, s.b, s.c.x, s.c.y, p.c.z != 0.0,
                           coordinates.x);
    if (may_be(TURNER_NEEDS_TRIANGLES, TURNER_KIND_TRIANGLE, kind))
        t = intersect_triangle(origin, direction, shear, s.a, s.b, s.c, coordinates);
    uint material = NEEDS_ANY(TURNER_NEEDS_INSTANCES) && override_material != TURNER_NO_INDEX
                        ? override_material : p.material;
    consider(search, t, p.id, index, instance, coordinates, material);
}

#ifdef TURNER_PACKET
int least_of_lanes(int v)
{
    v = min(v, subgroupShuffleXor(v, 1u));
    v = min(v, subgroupShuffleXor(v, 2u));
    return min(v, subgroupShuffleXor(v, 4u));
}
#endif

// Whether a lane that has work, or has none, goes where it is done, as to the loop that calls trace()
// again: in a packet all lanes do while one has.
bool goes_on(bool work)
{
#ifdef TURNER_PACKET
    return least_of_lanes(work ? 0 : 1) == 0;
#else
    return work;
#endif
}

#ifdef TURNER_RAY_QUERY
#include "ray_query.glsl"
#elif defined(TURNER_PACKET)
#include "packet.glsl"
#else
#include "bvh.glsl"
#endif

void intersect_planes(inout search_t search, ray_t ray)
{
    for (uint i = 0; i < scene.plane_count && !search.blocked; i++) {
        turner_gpu_plane plane = plane_of(i);
        real t = intersect_plane(ray.origin, ray.direction, plane);
        consider(search, t, (TURNER_KIND_PLANE << TURNER_KIND_SHIFT) | i, i, 0u, real2(0.0),
                 plane.material);
    }
}

search_t trace(ray_t ray, bool shadow)
{
    search_t search;
    search.hit = hit_t(ray.t_max, 0u, 0u, 0u, real2(0.0));
    search.found = false;
    search.shadow = shadow;
    search.tinted = NEEDS_ANY(TURNER_NEEDS_TINTED) && scene.shadows_tinted != 0u;
    search.blocked = false;
    if (NEEDS_ANY(TURNER_NEEDS_PLANES))
        intersect_planes(search, ray);
#ifndef TURNER_PACKET // its lanes stay together
    if (!search.blocked)
#endif
        traverse(search, ray);
    return search;
}
