// Ray against cone, truncated cone or cylinder, open or capped.
// With n the unit axis, h the height above the base and m the slope of the radius, the side is
// |p⊥|² = (r0 + m·h)², 0 ≤ h ≤ L: a quadratic A·t² + 2B·t + C in the ray's parameter.

const real CONE_SIDE = 0.0;
const real CONE_BASE = 1.0;
const real CONE_APEX = 2.0;

// Nearest t in (T_MIN, INFINITY) and which part, or INFINITY.
real intersect_cone(real3 origin, real3 direction, real3 base, real3 apex, real r0, real r1,
                     bool capped, out real part)
{
    real3 axis = apex - base;
    real axis_length = length(axis);
    real3 n = axis / axis_length;
    real m = (r1 - r0) / axis_length;
    real a_unit = dot(direction, direction);
    real size = axis_length + max(r0, r1);

    // From far away the quadratic is solved about the ray's point nearest to the base, as for the
    // sphere: distance then costs no digits. Near by, C must know exactly where the ray starts.
    real3 f = origin - base;
    real shift = dot(f, f) > 16.0 * size * size ? -dot(f, direction) / a_unit : 0.0;
    real3 o = f + shift * direction;

    real height = dot(o, n), rise = dot(direction, n);
    real3 o_side = o - height * n, d_side = direction - rise * n;
    real radius = r0 + m * height, widening = m * rise;
    real A = dot(d_side, d_side) - widening * widening;
    real B = dot(o_side, d_side) - radius * widening;
    real o_length = length(o_side);
    real C = (o_length - radius) * (o_length + radius);

    real best = INFINITY;
    part = CONE_SIDE;
    real discriminant = B * B - A * C;
    if (discriminant >= 0.0) {
        real q = -(B + (B < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
        for (int root = 0; root < 2; root++) {
            real s = root == 0 ? C / q : q / A;
            real t = shift + s;
            real h = height + s * rise;
            if (t > T_MIN && t < best && h >= 0.0 && h <= axis_length)
                best = t;
        }
    }
    if (capped) {
        for (int cap = 0; cap < 2; cap++) {
            real s = ((cap == 0 ? 0.0 : axis_length) - height) / rise;
            real t = shift + s;
            real3 p = o_side + s * d_side;
            real r = cap == 0 ? r0 : r1;
            if (t > T_MIN && t < best && dot(p, p) <= r * r) {
                best = t;
                part = cap == 0 ? CONE_BASE : CONE_APEX;
            }
        }
    }
    return best;
}
