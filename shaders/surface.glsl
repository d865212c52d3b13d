// From a hit to the surface there: point, normals, texture coordinates, and how far a ray that
// leaves must start from it.

struct surface_t {
    real3 point;    // world
    real clearance; // rays that leave start this far from the tangent plane: the point's error
    real3 ng;       // unit geometric normal as the geometry has it (outward)
    real3 ns;       // unit interpolated normal, not yet flipped
    real2 uv;
    uint material;
    bool transmissive;
};

const uint UNKNOWN_UV = TURNER_NEEDS_CHECKER | TURNER_NEEDS_IMAGES;

// How many spacings of numbers a point may lie off its surface. Points are put back onto their
// surface below, so the error is that of a few operations on numbers of the size of the point. The
// largest coordinate counts whatever the normal: the triangle test makes t from the axis along which
// the ray is longest, and must not find t > 0 for the surface that was left.
const real CLEARANCE_ULPS = 8.0;

void surface_of_sphere(inout surface_t surface, shape_t sphere, real3 p, real3 direction)
{
    // One step of Newton's along the ray, where it is not grazing, takes away the error of t; what
    // is left of the distance to the sphere goes along the normal.
    real3 f = p - sphere.a;
    real rise = dot(f, direction);
    if (rise * rise > 0.01 * dot(f, f) * dot(direction, direction))
        f -= ((length(f) - sphere.b.x) * length(f) / rise) * direction;
    real3 n = normalize(f);
    surface.point = sphere.a + sphere.b.x * n;
    surface.ng = n;
    if (NEEDS_ANY(UNKNOWN_UV))
        surface.uv = longitude_latitude(vec3(n));
}

void surface_of_cone(inout surface_t surface, shape_t cone, real3 p, real part)
{
    real3 axis = cone.b - cone.a;
    real axis_length = length(axis);
    real3 n = axis / axis_length;
    real h = part == CONE_BASE ? 0.0 : part == CONE_APEX ? axis_length
              : clamp(dot(p - cone.a, n), 0.0, axis_length);
    real3 side = (p - cone.a) - dot(p - cone.a, n) * n;
    real side_length = length(side);
    if (part == CONE_SIDE) {
        real m = (cone.c.y - cone.c.x) / axis_length;
        real3 outward = side_length > 0.0 ? side / side_length : real3(0.0);
        surface.point = cone.a + h * n + (cone.c.x + m * h) * outward;
        // at the very tip there is no side: the normal is the axis, pointing out
        surface.ng = side_length > 0.0 ? normalize(outward - m * n) : m < 0.0 ? n : -n;
    } else {
        surface.point = cone.a + h * n + side;
        surface.ng = part == CONE_BASE ? -n : n;
    }
    if (NEEDS_ANY(UNKNOWN_UV)) {
        real3 a = abs(n);
        real3 shortest = a.x <= a.y && a.x <= a.z ? real3(1, 0, 0)
                        : a.y <= a.z ? real3(0, 1, 0) : real3(0, 0, 1);
        real3 e1 = normalize(cross(n, shortest));
        float angle = turn(float(dot(side, cross(n, e1))), float(dot(side, e1)));
        surface.uv = real2(angle < 0.0 ? angle + 1.0 : angle, h / axis_length);
    }
}

void surface_of_triangle(inout surface_t surface, shape_t triangle, uint attributes, real2 b)
{
    real b0 = 1.0 - b.x - b.y;
    surface.point = b0 * triangle.a + b.x * triangle.b + b.y * triangle.c;
    surface.ng = normalize(cross(triangle.b - triangle.a, triangle.c - triangle.a));
    surface.ns = surface.ng;
    surface.uv = b;
    if (!NEEDS_ANY(TURNER_NEEDS_SMOOTH | UNKNOWN_UV) || attributes == TURNER_NO_INDEX)
        return;
    turner_gpu_corners corners =
        corner_array(scene.corners).at[attributes & TURNER_ATTRIBUTES_MASK];
    if (NEEDS_ANY(TURNER_NEEDS_SMOOTH) && (attributes & TURNER_ATTRIBUTES_NORMALS) != 0u) {
        vec3_array normals = vec3_array(scene.normals);
        real3 n = b0 * normals.at[corners.vertex[0]] + b.x * normals.at[corners.vertex[1]] +
                 b.y * normals.at[corners.vertex[2]];
        surface.ns = dot(n, n) > 0.0 ? normalize(n) : surface.ng;
    }
    if (NEEDS_ANY(UNKNOWN_UV) && (attributes & TURNER_ATTRIBUTES_UVS) != 0u) {
        vec2_array uvs = vec2_array(scene.uvs);
        surface.uv = b0 * uvs.at[corners.vertex[0]] + b.x * uvs.at[corners.vertex[1]] +
                     b.y * uvs.at[corners.vertex[2]];
    }
}

surface_t surface_of_plane(ray_t ray, hit_t hit)
{
    turner_gpu_plane plane = plane_of(hit.primitive);
    real3 point = EXACT(real3, plane.point, plane.point_rest);
    real3 normal = EXACT(real3, plane.normal, plane.normal_rest);
    real3 tangent = EXACT(real3, plane.tangent, plane.tangent_rest);
    surface_t surface;
    real3 p = ray.origin + hit.t * ray.direction;
    surface.point = p - dot(p - point, normal) * normal;
    surface.ng = surface.ns = normal;
    real3 across = surface.point - point;
    surface.uv = real2(dot(across, tangent), dot(across, cross(normal, tangent)));
    real size = largest(abs(surface.point)) + largest(abs(point));
    surface.clearance = CLEARANCE_ULPS * ULP * size;
    surface.material = plane.material & TURNER_MATERIAL_MASK;
    surface.transmissive = (plane.material & TURNER_MATERIAL_TRANSMISSIVE) != 0u;
    return surface;
}

surface_t surface_of(ray_t ray, hit_t hit)
{
    uint kind = hit.id >> TURNER_KIND_SHIFT;
    if (NEEDS_ANY(TURNER_NEEDS_PLANES) && kind == TURNER_KIND_PLANE)
        return surface_of_plane(ray, hit);

    surface_t surface;
    turner_gpu_primitive primitive = primitive_of(hit.primitive);
    shape_t shape = shape_of(primitive, hit.primitive);
    uint material = primitive.material;
    real3 origin = ray.origin, direction = ray.direction;
    if (NEEDS_ANY(TURNER_NEEDS_INSTANCES)) {
        real[12] to_group = to_group_of(hit.instance);
        origin = transform_point(to_group, origin);
        direction = transform_vector(to_group, direction);
        uint override_material = instance_array(scene.instances).at[hit.instance].material;
        if (override_material != TURNER_NO_INDEX)
            material = override_material;
    }
    real3 p = origin + hit.t * direction;
    real size = 0.0; // of the numbers the point is computed from, in group units
    if (NEEDS_ANY(TURNER_NEEDS_SPHERES) && kind == TURNER_KIND_SPHERE) {
        surface_of_sphere(surface, shape, p, direction);
        size = largest(abs(shape.a)) + shape.b.x;
    }
    if (NEEDS_ANY(TURNER_NEEDS_CONES) && kind == TURNER_KIND_CONE) {
        surface_of_cone(surface, shape, p, hit.coordinates.x);
        size = largest(max(abs(shape.a), abs(shape.b))) + max(shape.c.x, shape.c.y);
    }
    if (NEEDS_ANY(TURNER_NEEDS_TRIANGLES) && kind == TURNER_KIND_TRIANGLE) {
        surface_of_triangle(surface, shape, primitive.attributes, hit.coordinates);
        size = largest(max(max(abs(shape.a), abs(shape.b)), abs(shape.c)));
    } else {
        surface.ns = surface.ng;
    }
    surface.clearance = CLEARANCE_ULPS * ULP * size;
    if (NEEDS_ANY(TURNER_NEEDS_INSTANCES) && hit.instance != 0u) {
        real[12] to_world = to_world_of(hit.instance), to_group = to_group_of(hit.instance);
        size += instance_array(scene.instances).at[hit.instance].spawn_scale;
        real3 clear = transform_vector(to_world, (CLEARANCE_ULPS * ULP * size) * surface.ng);
        surface.point = transform_point(to_world, surface.point);
        surface.ng = normalize(transform_transposed(to_group, surface.ng));
        surface.ns = normalize(transform_transposed(to_group, surface.ns));
        surface.clearance = dot(clear, surface.ng);
    }
    surface.material = material & TURNER_MATERIAL_MASK;
    surface.transmissive = (material & TURNER_MATERIAL_TRANSMISSIVE) != 0u;
    return surface;
}

// Ray Tracing Gems, ch. 6 (Wächter and Binder): so many float spacings along the normal, or a
// constant near the origin of the world.
vec3 offset_by_ulps(vec3 p, vec3 n)
{
    ivec3 steps = ivec3(256.0 * n);
    vec3 moved = intBitsToFloat(floatBitsToInt(p) + mix(steps, -steps, lessThan(p, vec3(0.0))));
    return mix(moved, p + n / 65536.0, lessThan(abs(p), vec3(1.0 / 32.0)));
}

// The one way a ray leaves a surface: it starts off the tangent plane on the side it leaves to, by a
// bound of the error of the point, taken in the space where that was computed. No scene-scale
// epsilon. The bound is pbrt's ("Managing Rounding Error") for points put back onto their surfaces.
// The start moves along the ray itself, which costs the picture nothing, as far as that goes: a
// grazing ray would have to go too far and moves along the normal for the rest. `distance` is from
// the surface.
ray_t spawn_ray(surface_t surface, real3 direction, real distance)
{
    real c = dot(direction, surface.ng);
    if (METHOD(TURNER_METHOD_OFFSET_NONE | TURNER_METHOD_OFFSET_TMIN))
        return ray_t(surface.point, direction, distance, 0.0);
    if (METHOD(TURNER_METHOD_OFFSET_ULP)) {
        vec3 n = vec3(c > 0.0 ? surface.ng : -surface.ng);
        return ray_t(real3(offset_by_ulps(vec3(surface.point), n)), direction, distance, 0.0);
    }
    real side = c > 0.0 ? surface.clearance : -surface.clearance;
    real along = min(surface.clearance / abs(c), 16.0 * surface.clearance);
    real3 origin = surface.point + (along * direction + (side - along * c) * surface.ng);
    return ray_t(origin, direction, distance - along, along);
}
