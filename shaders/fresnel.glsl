// How much is reflected. c is the cosine of the angle of incidence, in [0,1]; c_t that of the
// refracted direction; n1 and n2 the indices on the ray's side and beyond.

real pow5(real x)
{
    real x2 = x * x;
    return x2 * x2 * x;
}

// Unpolarised dielectric: the mean of both polarisations (Fresnel, 1823).
real fresnel_exact(real n1, real n2, real c, real c_t)
{
    if (n1 == n2 && !METHOD(TURNER_METHOD_COSINE_NAIVE))
        return 0.0; // 0/0 at grazing incidence
    real s = (n1 * c - n2 * c_t) / (n1 * c + n2 * c_t);
    real p = (n1 * c_t - n2 * c) / (n1 * c_t + n2 * c);
    return 0.5 * (s * s + p * p);
}

// Schlick (1994); seen from the dense side the angle beyond is the one to take.
real fresnel_schlick(real n1, real n2, real c, real c_t)
{
    real r = (n1 - n2) / (n1 + n2);
    real r0 = r * r;
    bool beyond = n1 > n2 && !METHOD(TURNER_METHOD_SCHLICK_INCIDENT);
    return r0 + (1.0 - r0) * pow5(1.0 - (beyond ? c_t : c));
}

vec3 fresnel_schlick_metal(vec3 r0, float c)
{
    return r0 + (1.0 - r0) * float(pow5(1.0 - c));
}

// Conductor with index eta + i·k relative to the medium in front, per channel.
vec3 fresnel_conductor(vec3 eta, vec3 k, float c)
{
    float cc = c * c;
    float ss = max(0.0, 1.0 - cc);
    vec3 t0 = eta * eta - k * k - ss;
    vec3 a2b2 = sqrt(t0 * t0 + 4.0 * eta * eta * k * k);
    vec3 a = sqrt(max(vec3(0.0), 0.5 * (a2b2 + t0)));
    vec3 r_s = (a2b2 + cc - 2.0 * a * c) / (a2b2 + cc + 2.0 * a * c);
    vec3 r_p = r_s * (cc * a2b2 + ss * ss - 2.0 * a * c * ss) /
               (cc * a2b2 + ss * ss + 2.0 * a * c * ss);
    return 0.5 * (r_s + r_p);
}
