// Ray against triangle, watertight: Woop, Benthin and Wald (JCGT 2, 2013). The ray becomes the z
// axis by a permutation, a shear and a scale that depend on the ray alone, so that two triangles
// with a common edge compute the very same numbers for it. A float difference of products has the
// right sign or is 0; where it is 0 the rounding errors of the products decide, exactly (the paper
// goes to double there).

struct shear_t {
    ivec3 axes; // x, y, z of ray space among the axes; z is where the direction is longest
    real3 s;    // shear in x and y, scale in z
};

shear_t shear_of(real3 direction)
{
    real3 d = abs(direction);
    int z = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    int x = z == 2 ? 0 : z + 1;
    int y = x == 2 ? 0 : x + 1;
    shear_t shear;
    shear.axes = ivec3(x, y, z);
    real inverse = 1.0 / direction[z];
    shear.s = real3(direction[x] * inverse, direction[y] * inverse, inverse);
    return shear;
}

// a·b = product + the returned error, exactly (Dekker, 1971) barring over- and underflow.
real product_error(real a, real b, real product)
{
    precise real ca = SPLIT * a, cb = SPLIT * b;
    precise real a_high = ca - (ca - a), b_high = cb - (cb - b);
    precise real a_low = a - a_high, b_low = b - b_high;
    precise real error =
        ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return error;
}

// a·b − c·d with the right sign.
real edge_function(real a, real b, real c, real d)
{
    precise real ab = a * b, cd = c * d;
    precise real difference = ab - cd;
    if (difference == 0.0)
        difference = product_error(a, b, ab) - product_error(c, d, cd);
    return difference;
}

// Möller and Trumbore ("Fast, minimum storage ray-triangle intersection", JGT 2, 1997): each triangle
// computes its edges its own way, so that a ray can slip between two.
real intersect_moller_trumbore(real3 origin, real3 direction, real3 v0, real3 v1, real3 v2,
                               out real2 b)
{
    real3 e1 = v1 - v0, e2 = v2 - v0, s = origin - v0;
    real3 p = cross(direction, e2), q = cross(s, e1);
    real determinant = dot(e1, p);
    b = real2(dot(s, p), dot(direction, q)) / determinant;
    real t = dot(e2, q) / determinant;
    bool inside = b.x >= 0.0 && b.y >= 0.0 && b.x + b.y <= 1.0;
    return inside && t > T_MIN && t < INFINITY ? t : INFINITY;
}

// Whether one of them is below 0 and another above.
bool has_both_signs(real u, real v, real w)
{
#ifdef TURNER_F64
    return (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0);
#else
    ivec3 bits = floatBitsToInt(vec3(u, v, w)); // none is −0
    return (bits.x | bits.y | bits.z) < 0 && max(max(bits.x, bits.y), bits.z) > 0;
#endif
}

// t > T_MIN and the barycentric coordinates of corners 1 and 2, or INFINITY. Both sides are hit.
real intersect_triangle(real3 origin, real3 direction, shear_t shear, real3 v0, real3 v1, real3 v2,
                        out real2 b)
{
    if (METHOD(TURNER_METHOD_MOLLER_TRUMBORE))
        return intersect_moller_trumbore(origin, direction, v0, v1, v2, b);
    real3 p0 = v0 - origin, p1 = v1 - origin, p2 = v2 - origin;
    real z0 = p0[shear.axes.z], z1 = p1[shear.axes.z], z2 = p2[shear.axes.z];
    precise real2 a0 = real2(p0[shear.axes.x], p0[shear.axes.y]) - shear.s.xy * z0;
    precise real2 a1 = real2(p1[shear.axes.x], p1[shear.axes.y]) - shear.s.xy * z1;
    precise real2 a2 = real2(p2[shear.axes.x], p2[shear.axes.y]) - shear.s.xy * z2;
    real u = edge_function(a2.x, a1.y, a2.y, a1.x);
    real v = edge_function(a0.x, a2.y, a0.y, a2.x);
    real w = edge_function(a1.x, a0.y, a1.y, a0.x);
    if (has_both_signs(u, v, w))
        return INFINITY;
    real determinant = u + v + w;
    real t = shear.s.z * (u * z0 + v * z1 + w * z2) / determinant;
    b = real2(v, w) / determinant;
    return determinant != 0.0 && t > T_MIN && t < INFINITY ? t : INFINITY;
}
