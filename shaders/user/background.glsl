// Hook: what a ray sees that meets nothing. Replace it by a file user/background.glsl of your own
// (docs/shaders.md); this one is the scene's background (background.glsl).
//
// `direction` is unit, in the world. Returned is radiance, linear, 0 or more and finite in each
// channel. Mirrored and refracted rays come here, too. A pure function.
vec3 user_background(vec3 direction)
{
    return background(direction);
}
