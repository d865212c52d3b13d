// Rays against boxes, for both walks of our own hierarchy. Boxes are met in floats, whatever the
// kernel computes in.
struct boxes_ray_t {
    vec3 above, below; // the origin, or two that it lies between where it is no float
    vec3 inverse; // of the direction, its components kept away from 0 so that no 0·∞ arises
};

boxes_ray_t boxes_ray_of(real3 origin, real3 direction)
{
    const float tiny = 1e-20;
    vec3 o = vec3(origin), d = vec3(direction);
    d = mix(d, vec3(tiny), lessThan(abs(d), vec3(tiny)));
#ifdef TURNER_F64
    float pad = 2.4e-7 * largest(abs(o)); // of the origin's rounding, and the direction's
    return boxes_ray_t(o + pad, o - pad, 1.0 / d);
#else
    return boxes_ray_t(o, o, 1.0 / d);
#endif
}

// The bits of a float that is not below t.
int bits_of(real t)
{
#ifdef TURNER_F64
    return floatBitsToInt(float(t) * 1.0000002);
#else
    return floatBitsToInt(t);
#endif
}

// Entry of the ray into a box as the bits of a float ≥ 0, or −1. Floats are compared as integers:
// right wherever the result matters, since all that is below 0 becomes 0 or a miss, and cheaper.
// The far side is padded by 1 + 2γ₃ (Ize, "Robust BVH ray traversal", JCGT 2, 2013), 7 ulp at most.
int enter_box(boxes_ray_t ray, vec3 lo, vec3 hi, int t_max)
{
    vec3 t_lo = (lo - ray.above) * ray.inverse, t_hi = (hi - ray.below) * ray.inverse;
    ivec3 a = floatBitsToInt(t_lo), b = floatBitsToInt(t_hi);
    ivec3 near = min(a, b), far = max(a, b);
    int enter = max(max(near.x, near.y), max(near.z, 0));
    int leave = min(min(far.x, far.y), far.z) + 7;
    return enter <= min(leave, t_max) ? enter : -1;
}
