// Hook: what a surface makes of the light that reaches it. Replace it by a file user/brdf.glsl of
// your own (docs/shaders.md); this one is the scene's shading (light.glsl).
//
// N, V and L are unit and point away from the surface: the normal on the side of V, the way to the
// viewer, the way to the light. dot(N, L) > 0 always, dot(N, V) may be a little below 0 at a
// silhouette. `material` has its patterns applied. Returned is the radiance that leaves towards V for
// an irradiance of 1 on a surface that faces the light, in each channel: 0 or more, finite. The
// cosine of N and L is part of it. Ambient light, emission, mirrors and glass are not.
//
// A pure function. A surface with k_d and k_s both 0 asks no light, and this function neither.
// `real` is float, or double with precision=f64: write vec3(N) for numbers that need no more.
vec3 user_brdf(turner_gpu_material material, real3 N, real3 V, real3 L)
{
    return local_illumination(material, N, V, L);
}
