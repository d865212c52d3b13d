// The pinhole camera: `position` in pixels from the picture's top left corner.
ray_t camera_ray(vec2 position)
{
    vec2 from_center = position - scene.center; // small numbers round least
    real3 direction = EXACT(real3, scene.forward, scene.forward_rest) +
                      (from_center.x * EXACT(real3, scene.right, scene.right_rest) +
                       from_center.y * EXACT(real3, scene.down, scene.down_rest));
    return ray_t(EXACT(real3, scene.eye, scene.eye_rest), normalize(direction), INFINITY, 0.0);
}
