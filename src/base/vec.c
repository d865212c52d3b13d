#include "base/vec.h"

struct turner_vec3 turner_vec3_perpendicular(struct turner_vec3 axis)
{
    double x = fabs(axis.x), y = fabs(axis.y), z = fabs(axis.z);
    struct turner_vec3 shortest = x <= y && x <= z ? turner_vec3_of(1, 0, 0)
                                  : y <= z         ? turner_vec3_of(0, 1, 0)
                                                   : turner_vec3_of(0, 0, 1);
    return turner_vec3_normalize(turner_vec3_cross(axis, shortest));
}

struct turner_vec3 turner_affine_vector(const struct turner_affine *a, struct turner_vec3 v)
{
    return turner_vec3_of(a->m[0][0] * v.x + a->m[0][1] * v.y + a->m[0][2] * v.z,
                          a->m[1][0] * v.x + a->m[1][1] * v.y + a->m[1][2] * v.z,
                          a->m[2][0] * v.x + a->m[2][1] * v.y + a->m[2][2] * v.z);
}

struct turner_vec3 turner_affine_point(const struct turner_affine *a, struct turner_vec3 p)
{
    return turner_vec3_add(turner_affine_vector(a, p),
                           turner_vec3_of(a->m[0][3], a->m[1][3], a->m[2][3]));
}

struct turner_affine turner_affine_multiply(const struct turner_affine *a,
                                            const struct turner_affine *b)
{
    struct turner_affine c;
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 4; column++) {
            c.m[row][column] = a->m[row][0] * b->m[0][column] + a->m[row][1] * b->m[1][column] +
                               a->m[row][2] * b->m[2][column];
        }
        c.m[row][3] += a->m[row][3];
    }
    return c;
}

bool turner_affine_invert(struct turner_affine *inverse, const struct turner_affine *a)
{
    const double(*m)[4] = a->m;
    double c00 = m[1][1] * m[2][2] - m[1][2] * m[2][1];
    double c10 = m[1][2] * m[2][0] - m[1][0] * m[2][2];
    double c20 = m[1][0] * m[2][1] - m[1][1] * m[2][0];
    double determinant = m[0][0] * c00 + m[0][1] * c10 + m[0][2] * c20;
    double s = 1 / determinant;
    if (determinant == 0 || !isfinite(determinant) || !isfinite(s))
        return false;
    struct turner_affine r = {{
        {c00 * s, (m[0][2] * m[2][1] - m[0][1] * m[2][2]) * s,
         (m[0][1] * m[1][2] - m[0][2] * m[1][1]) * s, 0},
        {c10 * s, (m[0][0] * m[2][2] - m[0][2] * m[2][0]) * s,
         (m[0][2] * m[1][0] - m[0][0] * m[1][2]) * s, 0},
        {c20 * s, (m[0][1] * m[2][0] - m[0][0] * m[2][1]) * s,
         (m[0][0] * m[1][1] - m[0][1] * m[1][0]) * s, 0},
    }};
    struct turner_vec3 moved =
        turner_affine_vector(&r, turner_vec3_of(m[0][3], m[1][3], m[2][3]));
    r.m[0][3] = -moved.x;
    r.m[1][3] = -moved.y;
    r.m[2][3] = -moved.z;
    *inverse = r;
    return true;
}
