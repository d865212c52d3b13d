/* The sphere. Haines, Günther, Akenine-Möller: Precision Improvements for Ray/Sphere Intersection
 * (Ray Tracing Gems, ch. 7). */
#include "reference/geometry.h"

bool turner_sphere_intersect(struct turner_hit *hit, const struct turner_sphere *sphere,
                             const struct turner_ray *ray, const struct turner_departure *self)
{
    turner_vector d = ray->direction, f = sub(ray->origin, widen(sphere->center));
    turner_real r = sphere->radius;

    /* A ray that leaves a convex body outward never comes back to it. */
    if (self && self->outward)
        return false;

    /* l leads from the centre to the point of the line that is nearest to it. */
    turner_real a = dot(d, d), b = -dot(f, d);
    turner_vector l = add(f, scale(d, b / a));
    turner_real discriminant = r * r - dot(l, l);
    if (!(discriminant >= 0))
        return false;
    turner_real root = sqrtl(a * discriminant);
    turner_real q = b < 0 ? b - root : b + root;
    turner_real t0 = (dot(f, f) - r * r) / q, t1 = q / a;
    turner_real near = fminl(t0, t1), far = fmaxl(t0, t1);

    /* One that leaves it inward started from the nearer root. */
    hit->t = near > 0 && !self ? near : far;
    return hit->t > 0;
}

void turner_sphere_surface(struct turner_surface *surface, const struct turner_sphere *sphere,
                           const struct turner_ray *ray, const struct turner_hit *hit)
{
    turner_vector center = widen(sphere->center);
    turner_vector p = add(ray->origin, scale(ray->direction, hit->t));
    turner_vector n = normalize(sub(p, center));
    surface->p = add(center, scale(n, sphere->radius));
    surface->ng = surface->ns = n;
    surface->magnitude = magnitude(center) + sphere->radius;
    surface->u = 0.5L + atan2l(n.x, n.z) / (2 * TURNER_REAL_PI);
    surface->v = 0.5L + asinl(clamp(n.y, -1, 1)) / TURNER_REAL_PI;
}
