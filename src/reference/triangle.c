/* The triangle: Woop, Benthin, Wald: Watertight Ray/Triangle Intersection (JCGT 2013). Two
 * triangles that share an edge compute the same edge function, with opposite sign, so that no ray
 * slips between them. */
#include "reference/geometry.h"

static turner_vector corner(const struct turner_mesh *mesh, uint32_t index, int which)
{
    return widen(mesh->positions[mesh->triangles[index][which]]);
}

/* Twice the area of the triangle (0, p, q) in the plane that the ray pierces at 0. */
static turner_real edge(const turner_real p[3], const turner_real q[3])
{
    return p[0] * q[1] - p[1] * q[0];
}

bool turner_triangle_intersect(struct turner_hit *hit, const struct turner_mesh *mesh,
                               uint32_t index, const struct turner_ray *ray,
                               const struct turner_departure *self)
{
    if (self)
        return false;
    /* The coordinate axis along which the ray is longest becomes the third one; the ray is
     * sheared onto it. */
    turner_vector d = ray->direction;
    int z = fabsl(d.x) > fabsl(d.y) ? (fabsl(d.x) > fabsl(d.z) ? 0 : 2)
                                    : (fabsl(d.y) > fabsl(d.z) ? 1 : 2);
    int x = (z + 1) % 3, y = (z + 2) % 3;
    turner_real dz = coordinate(d, z);
    turner_real shear_x = coordinate(d, x) / dz, shear_y = coordinate(d, y) / dz;

    turner_real c[3][3];
    for (int i = 0; i < 3; i++) {
        turner_vector from_origin = sub(corner(mesh, index, i), ray->origin);
        turner_real height = coordinate(from_origin, z);
        c[i][0] = coordinate(from_origin, x) - shear_x * height;
        c[i][1] = coordinate(from_origin, y) - shear_y * height;
        c[i][2] = height / dz;
    }
    turner_real u = edge(c[1], c[2]), v = edge(c[2], c[0]), w = edge(c[0], c[1]);
    if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0))
        return false;
    turner_real area = u + v + w;
    if (area == 0) /* seen edge on, or without area */
        return false;
    hit->b[0] = u / area;
    hit->b[1] = v / area;
    hit->b[2] = w / area;
    hit->t = hit->b[0] * c[0][2] + hit->b[1] * c[1][2] + hit->b[2] * c[2][2];
    return hit->t > 0;
}

void turner_triangle_surface(struct turner_surface *surface, const struct turner_mesh *mesh,
                             uint32_t index, const struct turner_ray *ray,
                             const struct turner_hit *hit)
{
    (void)ray;
    const uint32_t *corners = mesh->triangles[index];
    turner_vector p0 = corner(mesh, index, 0), p1 = corner(mesh, index, 1),
                  p2 = corner(mesh, index, 2);
    surface->p = add(add(scale(p0, hit->b[0]), scale(p1, hit->b[1])), scale(p2, hit->b[2]));
    surface->magnitude = fmaxl(magnitude(p0), fmaxl(magnitude(p1), magnitude(p2)));
    surface->ng = normalize(cross(sub(p1, p0), sub(p2, p0)));

    surface->ns = grey(0);
    surface->u = mesh->uvs ? 0 : hit->b[1];
    surface->v = mesh->uvs ? 0 : hit->b[2];
    for (int i = 0; i < 3; i++) {
        if (mesh->normals) {
            const float *n = mesh->normals[corners[i]];
            surface->ns = add(surface->ns, scale(vector((turner_real)n[0], (turner_real)n[1],
                                                        (turner_real)n[2]),
                                                 hit->b[i]));
        }
        if (mesh->uvs) {
            surface->u += hit->b[i] * (turner_real)mesh->uvs[corners[i]][0];
            surface->v += hit->b[i] * (turner_real)mesh->uvs[corners[i]][1];
        }
    }
    surface->ns = normalize(surface->ns);
    if (!(length(surface->ns) > 0)) /* no normals given, or they cancel */
        surface->ns = surface->ng;
}
