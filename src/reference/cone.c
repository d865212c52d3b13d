/* The cone, truncated cone and cylinder, open or with caps. At height z above the base, measured
 * along the unit axis, its radius is r0 + k·z:
 *     |p⊥|² = (r0 + k·z)²,   0 ≤ z ≤ h,   p⊥ the part of p − base perpendicular to the axis. */
#include "reference/geometry.h"

struct frame {
    turner_vector base, axis;
    turner_real h, r0, r1, k;
};

static struct frame frame_of(const struct turner_cone *cone)
{
    turner_vector along = sub(widen(cone->apex), widen(cone->base));
    struct frame f = {.base = widen(cone->base), .h = length(along)};
    f.axis = scale(along, 1 / f.h);
    f.r0 = cone->base_radius;
    f.r1 = cone->apex_radius;
    f.k = (f.r1 - f.r0) / f.h;
    return f;
}

static turner_vector across(const struct frame *f, turner_vector v)
{
    return sub(v, scale(f->axis, dot(v, f->axis)));
}

/* The two roots on the infinite double cone, lower first; false when there are none. The ray is
 * first moved to the point nearest to the cone's middle: the quadratic then works on numbers of the
 * cone's own size, however far the ray has come. */
static bool side_roots(turner_real t[2], const struct frame *f, const struct turner_ray *ray)
{
    turner_vector d = ray->direction;
    turner_vector from_base = sub(ray->origin, f->base);
    turner_vector from_middle = sub(from_base, scale(f->axis, f->h / 2));
    turner_real shift = -dot(from_middle, d) / dot(d, d);
    turner_vector o = add(from_base, scale(d, shift));

    turner_real dz = dot(d, f->axis), radius = f->r0 + f->k * dot(o, f->axis);
    turner_vector d_across = across(f, d), o_across = across(f, o);
    turner_real a = dot(d_across, d_across) - f->k * f->k * dz * dz;
    turner_real b = f->k * dz * radius - dot(o_across, d_across);
    turner_real c = dot(o_across, o_across) - radius * radius;
    turner_real discriminant = b * b - a * c;
    if (!(discriminant >= 0))
        return false;
    turner_real root = sqrtl(discriminant);
    turner_real q = b < 0 ? b - root : b + root;
    turner_real t0 = shift + c / q, t1 = shift + q / a; /* infinite or NaN: out of range below */
    t[0] = fminl(t0, t1);
    t[1] = fmaxl(t0, t1);
    return true;
}

static void keep_nearest(struct turner_hit *hit, turner_real t, enum turner_part part)
{
    if (t > 0 && t < hit->t) {
        hit->t = t;
        hit->place.part = part;
    }
}

bool turner_cone_intersect(struct turner_hit *hit, const struct turner_cone *cone,
                           const struct turner_ray *ray, const struct turner_departure *self)
{
    if (self && self->outward) /* convex: it never comes back */
        return false;
    struct frame f = frame_of(cone);
    turner_vector from_base = sub(ray->origin, f.base);
    hit->t = INFINITY;

    turner_real t[2];
    if (side_roots(t, &f, ray)) {
        /* the root that the ray starts from is the one nearest to 0 */
        int skip = !self || self->place.part != TURNER_PART_SIDE ? -1
                   : fabsl(t[0]) < fabsl(t[1])                   ? 0
                                                                 : 1;
        for (int i = 0; i < 2; i++) {
            turner_real z = dot(add(from_base, scale(ray->direction, t[i])), f.axis);
            if (i != skip && z >= 0 && z <= f.h)
                keep_nearest(hit, t[i], TURNER_PART_SIDE);
        }
    }
    for (int end = 0; cone->capped && end < 2; end++) {
        enum turner_part part = end == 0 ? TURNER_PART_BASE_CAP : TURNER_PART_APEX_CAP;
        turner_real r = end == 0 ? f.r0 : f.r1, height = end == 0 ? 0 : f.h;
        turner_real s = (height - dot(from_base, f.axis)) / dot(ray->direction, f.axis);
        turner_vector q = across(&f, add(from_base, scale(ray->direction, s)));
        if (!(self && self->place.part == part) && dot(q, q) <= r * r)
            keep_nearest(hit, s, part);
    }
    return isfinite(hit->t);
}

/* A unit vector perpendicular to the axis, where u begins: docs/model.md, Surfaces. */
static turner_vector u_begin(turner_vector a)
{
    turner_real x = fabsl(a.x), y = fabsl(a.y), z = fabsl(a.z);
    turner_vector shortest = x <= y && x <= z ? vector(1, 0, 0)
                             : y <= z         ? vector(0, 1, 0)
                                              : vector(0, 0, 1);
    return normalize(cross(a, shortest));
}

void turner_cone_surface(struct turner_surface *surface, const struct turner_cone *cone,
                         const struct turner_ray *ray, const struct turner_hit *hit)
{
    struct frame f = frame_of(cone);
    turner_vector q = sub(add(ray->origin, scale(ray->direction, hit->t)), f.base);
    turner_vector radial = across(&f, q);
    turner_vector outward = normalize(radial);
    turner_real z = clamp(dot(q, f.axis), 0, f.h);

    if (hit->place.part == TURNER_PART_SIDE) {
        surface->p = add(f.base, add(scale(f.axis, z), scale(outward, f.r0 + f.k * z)));
        surface->ng = normalize(sub(outward, scale(f.axis, f.k)));
        surface->v = z / f.h;
    } else {
        bool apex = hit->place.part == TURNER_PART_APEX_CAP;
        surface->p = add(f.base, add(scale(f.axis, apex ? f.h : 0), radial));
        surface->ng = apex ? f.axis : negate(f.axis);
        surface->v = apex ? 1 : 0;
    }
    surface->ns = surface->ng;
    surface->magnitude = magnitude(f.base) + f.h + fmaxl(f.r0, f.r1);

    turner_vector e1 = u_begin(f.axis), e2 = cross(f.axis, e1);
    turner_real turn = atan2l(dot(radial, e2), dot(radial, e1)) / (2 * TURNER_REAL_PI);
    surface->u = turn < 0 ? turn + 1 : turn;
}
