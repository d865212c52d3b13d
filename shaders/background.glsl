// What a ray sees that meets nothing. `direction` is unit.
vec3 background(vec3 direction)
{
    if (NEEDS_ANY(TURNER_NEEDS_ENVIRONMENT) &&
        scene.background == TURNER_BACKGROUND_KIND_ENVIRONMENT) {
        bool pole = direction.x == 0.0 && direction.z == 0.0; // atan(0, 0) is undefined
        float u = 0.5 + (pole ? 0.0 : atan(direction.x, -direction.z)) / (2.0 * PI) +
                  scene.background_turn;
        float v = 0.5 + asin(clamp(direction.y, -1.0, 1.0)) / PI;
        return scene.background_scale * sample_image(scene.background_image, vec2(u, v), true);
    }
    if (NEEDS_ANY(TURNER_NEEDS_GRADIENT) && scene.background == TURNER_BACKGROUND_KIND_GRADIENT)
        return mix(scene.background_color, scene.background_top,
                   0.5 * (dot(direction, scene.background_up) + 1.0));
    return scene.background_color;
}
