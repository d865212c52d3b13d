// Blinn's highlight in place of Phong's: the cosine is that of the normal and the vector halfway
// between light and viewer (Blinn, Models of Light Reflection, SIGGRAPH 1977), normalised as in
// Akenine-Möller, Haines and Hoffman, Real-Time Rendering (3rd edition, 2008), section 7.6.

//!PARAM sharper float 4 0.25 16 "Blinn's exponent is the material's times this"

vec3 user_brdf(turner_gpu_material material, real3 N, real3 V, real3 L)
{
    float cos_light = min(float(dot(N, L)), 1.0);
    vec3 f = material.k_d / PI;
    float cos_half = min(float(dot(N, normalize(V + L))), 1.0);
    if (cos_half > 0.0) {
        float n = sharper * material.exponent;
        f += material.k_s * ((n + 8.0) / (8.0 * PI) * pow(cos_half, n));
    }
    return f * cos_light;
}
