// Angles for texture coordinates. GLSL's atan and asin may be off by 4096 ulps, a visible share of a
// texel; this is Cephes' atanf (Moshier), good to 2 ulps, over the whole circle.

float arctangent(float x) // of x ≥ 0
{
    float offset = 0.0;
    if (x > 2.41421356) { // tan 3π/8
        offset = 0.5 * PI;
        x = -1.0 / x;
    } else if (x > 0.414213562) { // tan π/8
        offset = 0.25 * PI;
        x = (x - 1.0) / (x + 1.0);
    }
    float z = x * x;
    float p = ((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z -
              3.33329491539e-1;
    return offset + (p * z * x + x);
}

// The angle of the point (x, y) as a share of the whole circle, in (−½, ½]; 0 at the origin.
float turn(float y, float x)
{
    if (x == 0.0 && y == 0.0)
        return 0.0;
    float a = arctangent(abs(y) / abs(x)) / (2.0 * PI);
    a = x < 0.0 ? 0.5 - a : a;
    return y < 0.0 ? -a : a;
}

// Longitude from +z towards +x and latitude from −y to +y of a unit vector, both as shares in [0,1].
vec2 longitude_latitude(vec3 n)
{
    return vec2(0.5 + turn(n.x, n.z), 0.5 + 2.0 * turn(n.y, sqrt(n.x * n.x + n.z * n.z)));
}
