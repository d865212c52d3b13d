// Marble: veins where a sine along x meets turbulence, after Perlin (An Image Synthesizer, SIGGRAPH
// 1985), with noise interpolated between random numbers at whole places.

//!PARAM stone material marble "the material that is marble"
//!PARAM vein color #2a3540 "colour of the veins"
//!PARAM scale float 4 0.5 20 "veins per metre, about"
//!PARAM strength float 1.5 0 5 "how far turbulence bends the veins"
//!PARAM octaves const int 5 1 8 "how fine the turbulence is"

// A number in [0, 1) for each place of whole coordinates (the mixing of PCG, O'Neill 2014).
float random_at(ivec3 place)
{
    uint state = uint(place.x) * 73856093u ^ uint(place.y) * 19349663u ^ uint(place.z) * 83492791u;
    state = state * 747796405u + 2891336453u;
    state = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return float(((state >> 22u) ^ state) >> 8u) / 16777216.0;
}

float noise(vec3 p)
{
    ivec3 i = ivec3(floor(p));
    vec3 f = fract(p);
    f = f * f * (3.0 - 2.0 * f);
    vec4 low = vec4(random_at(i), random_at(i + ivec3(1, 0, 0)), random_at(i + ivec3(0, 1, 0)),
                    random_at(i + ivec3(1, 1, 0)));
    vec4 high = vec4(random_at(i + ivec3(0, 0, 1)), random_at(i + ivec3(1, 0, 1)),
                     random_at(i + ivec3(0, 1, 1)), random_at(i + ivec3(1, 1, 1)));
    vec4 near = mix(low, high, f.z);
    return mix(mix(near.x, near.y, f.x), mix(near.z, near.w, f.x), f.y);
}

float turbulence(vec3 p)
{
    float sum = 0.0, weight = 1.0;
    for (int octave = 0; octave < octaves; octave++) {
        sum += weight * abs(2.0 * noise(p) - 1.0);
        p *= 2.0;
        weight *= 0.5;
    }
    return sum;
}

void user_surface(inout turner_gpu_material material, inout real3 ns, surface_t surface)
{
    if (surface.material != stone)
        return;
    vec3 p = scale * vec3(surface.point);
    float wave = 0.5 + 0.5 * sin(p.x + strength * turbulence(p));
    material.k_d = mix(vein, material.k_d, sqrt(wave));
}
