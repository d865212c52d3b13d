// Elementary functions to about 2 ulps, after Cephes (Moshier): GLSL leaves its own some slack, and
// lavapipe's exp and pow are off by 1e-5, atan and asin by a visible share of a texel.

float exponential(float x) // of x ≤ 88; 0 below −87
{
    if (!(x > -87.0))
        return 0.0;
    float n = floor(1.44269504 * x + 0.5);
    x = (x - n * 0.693359375) + n * 2.12194440e-4; // ln 2 in two parts
    float y = ((((1.9875691500e-4 * x + 1.3981999507e-3) * x + 8.3334519073e-3) * x +
                4.1665795894e-2) * x + 1.6666665459e-1) * x + 5.0000001201e-1;
    return (y * x * x + x + 1.0) * intBitsToFloat((int(n) + 127) << 23);
}

float logarithm(float x) // of normal x > 0
{
    int bits = floatBitsToInt(x);
    float e = float((bits >> 23) - 126);
    float m = intBitsToFloat((bits & 0x7fffff) | 0x3f000000); // in [½, 1)
    if (m < 0.707106781) {
        e -= 1.0;
        m = m + m;
    }
    m -= 1.0;
    float z = m * m;
    float y = ((((((((7.0376836292e-2 * m - 1.1514610310e-1) * m + 1.1676998740e-1) * m -
                    1.2420140846e-1) * m + 1.4249322787e-1) * m - 1.6668057665e-1) * m +
                 2.0000714765e-1) * m - 2.4999993993e-1) * m + 3.3333331174e-1) * m * z;
    y -= 2.12194440e-4 * e;
    return (y - 0.5 * z) + m + 0.693359375 * e;
}

float power(float x, float n) // 0 < x ≤ 1, n ≥ 0
{
    return exponential(n * logarithm(x));
}

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
