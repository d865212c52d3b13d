// Hook: the last step on a picture. Replace it by a file user/post.glsl of your own (docs/shaders.md);
// this one does nothing, and then no step is made at all.
//
// `color` is the mean of a pixel's samples, linear radiance, before exposure and the curve of the
// picture's format; `position` the pixel's centre, from the top left corner, and `size` the picture's
// width and height, all in pixels. Returned is what is written. Layers (docs/layers.md) and the
// estimate of the error (docs/error.md) are of the picture before this step.
//
// A pure function of one pixel: it sees no other.
vec3 user_post(vec3 color, vec2 position, vec2 size)
{
    return color;
}
