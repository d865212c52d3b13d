// What a ray sees that meets nothing. `direction` is unit.
vec3 background(vec3 direction)
{
    if (NEEDS_ANY(TURNER_NEEDS_ENVIRONMENT) &&
        scene.background == TURNER_BACKGROUND_KIND_ENVIRONMENT) {
        // −z is the middle of the picture, +x to its right
        vec2 uv = longitude_latitude(vec3(direction.xy, -direction.z));
        uv.x += scene.background_turn;
        return scene.background_scale * sample_image(scene.background_image, uv, true);
    }
    if (NEEDS_ANY(TURNER_NEEDS_GRADIENT) && scene.background == TURNER_BACKGROUND_KIND_GRADIENT)
        return mix(scene.background_color, scene.background_top,
                   0.5 * (dot(direction, scene.background_up) + 1.0));
    return scene.background_color;
}
