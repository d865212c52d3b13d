// Hook: how the light of one source arrives at a point. Replace it by a file user/light.glsl of your
// own (docs/shaders.md); this one is the scene's light (light.glsl).
//
// `light` is the scene's light number `index`, `point` in the world, metres. Returned is direction,
// unit, from the point to the light; distance along it, metres, or INFINITY: what lies nearer throws a
// shadow; irradiance on a surface that faces the light, before shadows, 0 or more in each channel.
// Where it is 0 in all of them no shadow ray is traced.
//
// A pure function, called for each light at each surface: a light that is out of reach should return
// early. `real` is float, or double with precision=f64.
arrival_t user_light(turner_gpu_light light, uint index, real3 point)
{
    return light_arrival(light, point);
}
