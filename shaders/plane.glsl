// Ray against infinite plane; t > 0 or INFINITY. A ray inside the plane misses it.
float intersect_plane(vec3 origin, vec3 direction, vec3 point, vec3 normal)
{
    float t = dot(point - origin, normal) / dot(direction, normal);
    return t > 0.0 && t < INFINITY ? t : INFINITY;
}
