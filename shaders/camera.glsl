// The pinhole camera: `position` in pixels from the picture's top left corner.
ray_t camera_ray(vec2 position)
{
    vec2 from_center = position - scene.center; // small numbers round least
    vec3 direction = scene.forward + (from_center.x * scene.right + from_center.y * scene.down);
    return ray_t(scene.eye, normalize(direction), INFINITY, 0.0);
}
