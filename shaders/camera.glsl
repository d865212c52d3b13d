// The pinhole camera: `position` in pixels from the picture's top left corner.
ray_t camera_ray(vec2 position)
{
    vec3 direction = scene.corner + position.x * scene.right + position.y * scene.down;
    return ray_t(scene.eye, normalize(direction), INFINITY);
}
