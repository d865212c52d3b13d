// Pictures, looked up in exact float arithmetic (samplers interpolate with 8-bit weights).

vec3 texel(turner_gpu_image image, int x, int y)
{
    return vec3_array(image.texels).at[uint(y) * image.width + uint(x)];
}

int wrap(int i, int size)
{
    int r = i % size;
    return r < 0 ? r + size : r;
}

// Bilinear; u, v in units of the picture, v upwards, texel centres at half-integers. u is repeated,
// v repeated or clamped.
vec3 sample_image(uint index, vec2 uv, bool clamp_v)
{
    turner_gpu_image image = image_array(scene.images).at[index];
    int width = int(image.width), height = int(image.height);
    float u = uv.x - floor(uv.x);
    float v = clamp_v ? clamp(uv.y, 0.0, 1.0) : uv.y - floor(uv.y);
    float x = u * float(width) - 0.5, y = (1.0 - v) * float(height) - 0.5;
    float x_floor = floor(x), y_floor = floor(y);
    int x0 = wrap(int(x_floor), width), x1 = wrap(int(x_floor) + 1, width);
    int y0 = int(y_floor), y1 = y0 + 1;
    y0 = clamp_v ? clamp(y0, 0, height - 1) : wrap(y0, height);
    y1 = clamp_v ? clamp(y1, 0, height - 1) : wrap(y1, height);
    float fx = x - x_floor, fy = y - y_floor;
    vec3 upper = mix(texel(image, x0, y0), texel(image, x1, y0), fx);
    vec3 lower = mix(texel(image, x0, y1), texel(image, x1, y1), fx);
    return mix(upper, lower, fy);
}
