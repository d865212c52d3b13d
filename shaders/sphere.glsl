// Ray against sphere, the robust form of Haines, Günther and Akenine-Möller ("Precision
// improvements for ray/sphere intersection", Ray Tracing Gems, ch. 7). `direction` need not be
// unit. Returns the nearest t in (0, INFINITY), or INFINITY.
float intersect_sphere(vec3 origin, vec3 direction, vec3 center, float radius)
{
    vec3 f = origin - center;
    float a = dot(direction, direction);
    float b = -dot(f, direction);
    vec3 l = f + (b / a) * direction; // from the centre to the ray's nearest point
    float discriminant = radius * radius - dot(l, l);
    if (!(discriminant >= 0.0))
        return INFINITY;
    float q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * discriminant);
    // (|f| − r)(|f| + r) instead of f·f − r²: the sign decides whether we are inside
    float distance_to_center = sqrt(dot(f, f));
    float c = (distance_to_center - radius) * (distance_to_center + radius);
    float t0 = c / q, t1 = q / a;
    float near = min(t0, t1), far = max(t0, t1);
    return near > 0.0 ? near : far > 0.0 ? far : INFINITY;
}
