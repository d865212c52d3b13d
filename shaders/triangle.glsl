// Ray against triangle, watertight: Woop, Benthin and Wald (JCGT 2, 2013). The ray becomes the z
// axis by a permutation, a shear and a scale that depend on the ray alone, so that two triangles
// with a common edge compute the very same numbers for it. A float difference of products has the
// right sign or is 0; where it is 0 the rounding errors of the products decide, exactly (the paper
// goes to double there).

struct shear_t {
    ivec3 axes; // x, y, z of ray space among the axes; z is where the direction is longest
    vec3 s;     // shear in x and y, scale in z
};

shear_t shear_of(vec3 direction)
{
    vec3 d = abs(direction);
    int z = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    int x = z == 2 ? 0 : z + 1;
    int y = x == 2 ? 0 : x + 1;
    shear_t shear;
    shear.axes = ivec3(x, y, z);
    float inverse = 1.0 / direction[z];
    shear.s = vec3(direction[x] * inverse, direction[y] * inverse, inverse);
    return shear;
}

// a·b = product + the returned error, exactly (Dekker, 1971) barring over- and underflow.
float product_error(float a, float b, float product)
{
    precise float ca = 4097.0 * a, cb = 4097.0 * b;
    precise float a_high = ca - (ca - a), b_high = cb - (cb - b);
    precise float a_low = a - a_high, b_low = b - b_high;
    precise float error =
        ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    return error;
}

// a·b − c·d with the right sign.
float edge_function(float a, float b, float c, float d)
{
    precise float ab = a * b, cd = c * d;
    precise float difference = ab - cd;
    if (difference == 0.0)
        difference = product_error(a, b, ab) - product_error(c, d, cd);
    return difference;
}

// t > 0 and the barycentric coordinates of corners 1 and 2, or INFINITY. Both sides are hit.
float intersect_triangle(vec3 origin, shear_t shear, vec3 v0, vec3 v1, vec3 v2, out vec2 b)
{
    vec3 p0 = v0 - origin, p1 = v1 - origin, p2 = v2 - origin;
    float z0 = p0[shear.axes.z], z1 = p1[shear.axes.z], z2 = p2[shear.axes.z];
    precise vec2 a0 = vec2(p0[shear.axes.x], p0[shear.axes.y]) - shear.s.xy * z0;
    precise vec2 a1 = vec2(p1[shear.axes.x], p1[shear.axes.y]) - shear.s.xy * z1;
    precise vec2 a2 = vec2(p2[shear.axes.x], p2[shear.axes.y]) - shear.s.xy * z2;
    float u = edge_function(a2.x, a1.y, a2.y, a1.x);
    float v = edge_function(a0.x, a2.y, a0.y, a2.x);
    float w = edge_function(a1.x, a0.y, a1.y, a0.x);
    if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0))
        return INFINITY;
    float determinant = u + v + w;
    float t = shear.s.z * (u * z0 + v * z1 + w * z2) / determinant;
    b = vec2(v, w) / determinant;
    return determinant != 0.0 && t > 0.0 && t < INFINITY ? t : INFINITY;
}
