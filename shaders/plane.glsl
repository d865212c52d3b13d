// Ray against infinite plane; t > T_MIN or INFINITY. A ray inside the plane misses it.
real intersect_plane(real3 origin, real3 direction, turner_gpu_plane plane)
{
    real3 point = EXACT(real3, plane.point, plane.point_rest);
    real3 normal = EXACT(real3, plane.normal, plane.normal_rest);
    real t = dot(point - origin, normal) / dot(direction, normal);
    return t > T_MIN && t < INFINITY ? t : INFINITY;
}
