/* The infinite plane. */
#include "reference/geometry.h"

bool turner_plane_intersect(struct turner_hit *hit, const struct turner_plane *plane,
                            const struct turner_ray *ray, const struct turner_departure *self)
{
    if (self)
        return false;
    turner_vector n = widen(plane->normal);
    hit->t = dot(sub(widen(plane->point), ray->origin), n) / dot(ray->direction, n);
    return hit->t > 0 && isfinite(hit->t); /* parallel: infinite or not a number */
}

void turner_plane_surface(struct turner_surface *surface, const struct turner_plane *plane,
                          const struct turner_ray *ray, const struct turner_hit *hit)
{
    turner_vector n = normalize(widen(plane->normal));
    turner_vector tangent = normalize(widen(plane->tangent));
    turner_vector q =
        sub(add(ray->origin, scale(ray->direction, hit->t)), widen(plane->point));
    q = sub(q, scale(n, dot(q, n)));
    surface->p = add(widen(plane->point), q);
    surface->ng = surface->ns = n;
    surface->magnitude = magnitude(widen(plane->point)) + magnitude(q);
    surface->u = dot(q, tangent);
    surface->v = dot(q, cross(n, tangent));
}
