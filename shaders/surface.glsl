// From a hit to the surface there: point, normals, texture coordinates, and how far a ray that
// leaves must start from it.

struct surface_t {
    vec3 point;     // world
    float clearance; // rays that leave start this far from the tangent plane: the point's error
    vec3 ng;        // unit geometric normal as the geometry has it (outward)
    vec3 ns;        // unit interpolated normal, not yet flipped
    vec2 uv;
    uint material;
    bool transmissive;
};

const uint UNKNOWN_UV = TURNER_NEEDS_CHECKER | TURNER_NEEDS_IMAGES;

// How many spacings of float a point may lie off its surface. Points are put back onto their
// surface below, so the error is that of a few operations on numbers of the size of the point. The
// largest coordinate counts whatever the normal: the triangle test makes t from the axis along which
// the ray is longest, and must not find t > 0 for the surface that was left.
const float CLEARANCE_ULPS = 8.0;

void surface_of_sphere(inout surface_t surface, turner_gpu_primitive sphere, vec3 p,
                       vec3 direction)
{
    // One step of Newton's along the ray, where it is not grazing, takes away the error of t; what
    // is left of the distance to the sphere goes along the normal.
    vec3 f = p - sphere.a;
    float rise = dot(f, direction);
    if (rise * rise > 0.01 * dot(f, f) * dot(direction, direction))
        f -= ((length(f) - sphere.b.x) * length(f) / rise) * direction;
    vec3 n = normalize(f);
    surface.point = sphere.a + sphere.b.x * n;
    surface.ng = n;
    if (NEEDS_ANY(UNKNOWN_UV))
        surface.uv = longitude_latitude(n);
}

void surface_of_cone(inout surface_t surface, turner_gpu_primitive cone, vec3 p, float part)
{
    vec3 axis = cone.b - cone.a;
    float axis_length = length(axis);
    vec3 n = axis / axis_length;
    float h = part == CONE_BASE ? 0.0 : part == CONE_APEX ? axis_length
              : clamp(dot(p - cone.a, n), 0.0, axis_length);
    vec3 side = (p - cone.a) - dot(p - cone.a, n) * n;
    float side_length = length(side);
    if (part == CONE_SIDE) {
        float m = (cone.c.y - cone.c.x) / axis_length;
        vec3 outward = side_length > 0.0 ? side / side_length : vec3(0.0);
        surface.point = cone.a + h * n + (cone.c.x + m * h) * outward;
        // at the very tip there is no side: the normal is the axis, pointing out
        surface.ng = side_length > 0.0 ? normalize(outward - m * n) : m < 0.0 ? n : -n;
    } else {
        surface.point = cone.a + h * n + side;
        surface.ng = part == CONE_BASE ? -n : n;
    }
    if (NEEDS_ANY(UNKNOWN_UV)) {
        vec3 a = abs(n);
        vec3 shortest = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0)
                        : a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
        vec3 e1 = normalize(cross(n, shortest));
        float angle = turn(dot(side, cross(n, e1)), dot(side, e1));
        surface.uv = vec2(angle < 0.0 ? angle + 1.0 : angle, h / axis_length);
    }
}

void surface_of_triangle(inout surface_t surface, turner_gpu_primitive triangle, vec2 b)
{
    float b0 = 1.0 - b.x - b.y;
    surface.point = b0 * triangle.a + b.x * triangle.b + b.y * triangle.c;
    surface.ng = normalize(cross(triangle.b - triangle.a, triangle.c - triangle.a));
    surface.ns = surface.ng;
    surface.uv = b;
    if (!NEEDS_ANY(TURNER_NEEDS_SMOOTH | UNKNOWN_UV) || triangle.attributes == TURNER_NO_INDEX)
        return;
    turner_gpu_corners corners =
        corner_array(scene.corners).at[triangle.attributes & TURNER_ATTRIBUTES_MASK];
    if (NEEDS_ANY(TURNER_NEEDS_SMOOTH) && (triangle.attributes & TURNER_ATTRIBUTES_NORMALS) != 0u) {
        vec3_array normals = vec3_array(scene.normals);
        vec3 n = b0 * normals.at[corners.vertex[0]] + b.x * normals.at[corners.vertex[1]] +
                 b.y * normals.at[corners.vertex[2]];
        surface.ns = dot(n, n) > 0.0 ? normalize(n) : surface.ng;
    }
    if (NEEDS_ANY(UNKNOWN_UV) && (triangle.attributes & TURNER_ATTRIBUTES_UVS) != 0u) {
        vec2_array uvs = vec2_array(scene.uvs);
        surface.uv = b0 * uvs.at[corners.vertex[0]] + b.x * uvs.at[corners.vertex[1]] +
                     b.y * uvs.at[corners.vertex[2]];
    }
}

surface_t surface_of_plane(ray_t ray, hit_t hit)
{
    turner_gpu_plane plane = plane_array(scene.planes).at[hit.primitive];
    surface_t surface;
    vec3 p = ray.origin + hit.t * ray.direction;
    surface.point = p - dot(p - plane.point, plane.normal) * plane.normal;
    surface.ng = surface.ns = plane.normal;
    vec3 across = surface.point - plane.point;
    surface.uv = vec2(dot(across, plane.tangent), dot(across, cross(plane.normal, plane.tangent)));
    float size = largest(abs(surface.point)) + largest(abs(plane.point));
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
    turner_gpu_primitive primitive = primitive_array(scene.primitives).at[hit.primitive];
    uint material = primitive.material;
    vec3 origin = ray.origin, direction = ray.direction;
    if (NEEDS_ANY(TURNER_NEEDS_INSTANCES)) {
        turner_gpu_instance instance = instance_array(scene.instances).at[hit.instance];
        origin = transform_point(instance.to_group, origin);
        direction = transform_vector(instance.to_group, direction);
        if (instance.material != TURNER_NO_INDEX)
            material = instance.material;
    }
    vec3 p = origin + hit.t * direction;
    float size = 0.0; // of the numbers the point is computed from, in group units
    if (NEEDS_ANY(TURNER_NEEDS_SPHERES) && kind == TURNER_KIND_SPHERE) {
        surface_of_sphere(surface, primitive, p, direction);
        size = largest(abs(primitive.a)) + primitive.b.x;
    }
    if (NEEDS_ANY(TURNER_NEEDS_CONES) && kind == TURNER_KIND_CONE) {
        surface_of_cone(surface, primitive, p, hit.coordinates.x);
        size = largest(max(abs(primitive.a), abs(primitive.b))) +
               max(primitive.c.x, primitive.c.y);
    }
    if (NEEDS_ANY(TURNER_NEEDS_TRIANGLES) && kind == TURNER_KIND_TRIANGLE) {
        surface_of_triangle(surface, primitive, hit.coordinates);
        size = largest(max(max(abs(primitive.a), abs(primitive.b)), abs(primitive.c)));
    } else {
        surface.ns = surface.ng;
    }
    surface.clearance = CLEARANCE_ULPS * ULP * size;
    if (NEEDS_ANY(TURNER_NEEDS_INSTANCES) && hit.instance != 0u) {
        turner_gpu_instance instance = instance_array(scene.instances).at[hit.instance];
        size += instance.spawn_scale;
        vec3 clear = transform_vector(instance.to_world,
                                      (CLEARANCE_ULPS * ULP * size) * surface.ng);
        surface.point = transform_point(instance.to_world, surface.point);
        surface.ng = normalize(transform_transposed(instance.to_group, surface.ng));
        surface.ns = normalize(transform_transposed(instance.to_group, surface.ns));
        surface.clearance = dot(clear, surface.ng);
    }
    surface.material = material & TURNER_MATERIAL_MASK;
    surface.transmissive = (material & TURNER_MATERIAL_TRANSMISSIVE) != 0u;
    return surface;
}

// The one way a ray leaves a surface: it starts off the tangent plane on the side it leaves to, by a
// bound of the error of the point, taken in the space where that was computed. No scene-scale
// epsilon. The bound is pbrt's ("Managing Rounding Error") for points put back onto their surfaces.
// The start moves along the ray itself, which costs the picture nothing, as far as that goes: a
// grazing ray would have to go too far and moves along the normal for the rest. `distance` is from
// the surface.
ray_t spawn_ray(surface_t surface, vec3 direction, float distance)
{
    float c = dot(direction, surface.ng);
    float side = c > 0.0 ? surface.clearance : -surface.clearance;
    float along = min(surface.clearance / abs(c), 16.0 * surface.clearance);
    vec3 origin = surface.point + (along * direction + (side - along * c) * surface.ng);
    return ray_t(origin, direction, distance - along, along);
}
