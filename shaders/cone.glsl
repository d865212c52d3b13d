// Ray against cone, truncated cone or cylinder, open or capped.
// With n the unit axis, h the height above the base and m the slope of the radius, the side is
// |p⊥|² = (r0 + m·h)², 0 ≤ h ≤ L: a quadratic A·t² + 2B·t + C in the ray's parameter.

const float CONE_SIDE = 0.0;
const float CONE_BASE = 1.0;
const float CONE_APEX = 2.0;

// Nearest t in (0, INFINITY) and which part, or INFINITY.
float intersect_cone(vec3 origin, vec3 direction, vec3 base, vec3 apex, float r0, float r1,
                     bool capped, out float part)
{
    vec3 axis = apex - base;
    float axis_length = length(axis);
    vec3 n = axis / axis_length;
    float m = (r1 - r0) / axis_length;
    float a_unit = dot(direction, direction);
    float size = axis_length + max(r0, r1);

    // From far away the quadratic is solved about the ray's point nearest to the base, as for the
    // sphere: distance then costs no digits. Near by, C must know exactly where the ray starts.
    vec3 f = origin - base;
    float shift = dot(f, f) > 16.0 * size * size ? -dot(f, direction) / a_unit : 0.0;
    vec3 o = f + shift * direction;

    float height = dot(o, n), rise = dot(direction, n);
    vec3 o_side = o - height * n, d_side = direction - rise * n;
    float radius = r0 + m * height, widening = m * rise;
    float A = dot(d_side, d_side) - widening * widening;
    float B = dot(o_side, d_side) - radius * widening;
    float o_length = length(o_side);
    float C = (o_length - radius) * (o_length + radius);

    float best = INFINITY;
    part = CONE_SIDE;
    float discriminant = B * B - A * C;
    if (discriminant >= 0.0) {
        float q = -(B + (B < 0.0 ? -1.0 : 1.0) * sqrt(discriminant));
        for (int root = 0; root < 2; root++) {
            float s = root == 0 ? C / q : q / A;
            float t = shift + s;
            float h = height + s * rise;
            if (t > 0.0 && t < best && h >= 0.0 && h <= axis_length)
                best = t;
        }
    }
    if (capped) {
        for (int cap = 0; cap < 2; cap++) {
            float s = ((cap == 0 ? 0.0 : axis_length) - height) / rise;
            float t = shift + s;
            vec3 p = o_side + s * d_side;
            float r = cap == 0 ? r0 : r1;
            if (t > 0.0 && t < best && dot(p, p) <= r * r) {
                best = t;
                part = cap == 0 ? CONE_BASE : CONE_APEX;
            }
        }
    }
    return best;
}
