// Ray against sphere, `direction` need not be unit. The nearest t in (T_MIN, INFINITY), or INFINITY.

#if defined(TURNER_SPHERE_F64) || defined(TURNER_F64)
#define wide double
#define wide3 dvec3
#else
#define wide float
#define wide3 vec3
#endif

real nearest_of(wide t0, wide t1)
{
    wide near = min(t0, t1), far = max(t0, t1);
    return real(near > T_MIN ? near : far > T_MIN ? far : INFINITY);
}

// at² + bt + c = 0 as the textbooks solve it. From afar the discriminant is the difference of two
// large numbers, and so is c.
real intersect_sphere_textbook(real3 origin, real3 direction, real3 center, real radius)
{
    real3 f = origin - center;
    real a = dot(direction, direction);
    real b = 2.0 * dot(f, direction);
    real c = dot(f, f) - radius * radius;
    real discriminant = b * b - 4.0 * a * c;
    if (!(discriminant >= 0.0))
        return INFINITY;
    real root = sqrt(discriminant);
    return nearest_of((-b - root) / (2.0 * a), (-b + root) / (2.0 * a));
}

// The robust form of Haines, Günther and Akenine-Möller ("Precision improvements for ray/sphere
// intersection", Ray Tracing Gems, ch. 7).
real intersect_sphere(real3 origin, real3 direction, real3 center, real radius)
{
    if (METHOD(TURNER_METHOD_SPHERE_TEXTBOOK))
        return intersect_sphere_textbook(origin, direction, center, radius);
    wide3 f = wide3(origin) - wide3(center), d = wide3(direction);
    wide r = radius;
    wide a = dot(d, d);
    wide b = -dot(f, d);
    wide3 l = f + (b / a) * d; // from the centre to the ray's nearest point
    wide discriminant = r * r - dot(l, l);
    if (!(discriminant >= 0.0))
        return INFINITY;
    wide q = b + (b < 0.0 ? -1.0 : 1.0) * sqrt(a * discriminant);
    // (|f| − r)(|f| + r) instead of f·f − r²: the sign decides whether we are inside
    wide distance_to_center = sqrt(dot(f, f));
    wide c = (distance_to_center - r) * (distance_to_center + r);
    return nearest_of(c / q, q / a);
}
