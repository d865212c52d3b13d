/* Rays and the four primitives. Everything here is in the space of the primitive's group; `t` is
 * measured in lengths of the ray's direction, which instances do not renormalise, so that t means
 * the same in every space.
 *
 * No epsilon keeps a ray from meeting the surface that it leaves: the ray knows which primitive
 * that is (`leaves`), and each intersection routine rules out the point of departure by logic. */
#ifndef TURNER_REFERENCE_GEOMETRY_H
#define TURNER_REFERENCE_GEOMETRY_H

#include <stdint.h>

#include "reference/vector.h"
#include "scene/scene.h"

#define TURNER_INSTANCE_PLANES (-1) /* planes belong to no group; they rank before all */
#define TURNER_INSTANCE_WORLD 0     /* group 0; scene->instances[i] is i + 1 */

enum turner_part { TURNER_PART_SIDE, TURNER_PART_BASE_CAP, TURNER_PART_APEX_CAP };

/* Which surface: ranked by (instance, primitive). Primitives of a group are numbered spheres,
 * cones, triangles. */
struct turner_place {
    int64_t instance;
    uint32_t primitive;
    enum turner_part part; /* of a cone */
};

struct turner_departure {
    bool from_surface; /* false: a camera ray */
    struct turner_place place;
    bool outward; /* to the side that the geometric normal points to */
};

struct turner_ray {
    turner_vector origin, direction;
    struct turner_departure leaves;
};

struct turner_hit {
    turner_real t;
    struct turner_place place;
    turner_real b[3]; /* barycentric coordinates, triangles only */
};

/* What shading needs to know of a hit. */
struct turner_surface {
    turner_vector p;
    turner_vector ng, ns; /* unit, outward as the geometry gives them */
    turner_real u, v;
    turner_real magnitude; /* of the numbers p was computed from: its error is some ulps of it */
    uint32_t material;
    struct turner_place place;
};

/* Each intersects one primitive: true, with hit->t and what else belongs to it, for the nearest
 * t > 0. `self` is NULL unless the ray leaves this very primitive. */
bool turner_sphere_intersect(struct turner_hit *hit, const struct turner_sphere *sphere,
                             const struct turner_ray *ray, const struct turner_departure *self);
bool turner_cone_intersect(struct turner_hit *hit, const struct turner_cone *cone,
                           const struct turner_ray *ray, const struct turner_departure *self);
bool turner_plane_intersect(struct turner_hit *hit, const struct turner_plane *plane,
                            const struct turner_ray *ray, const struct turner_departure *self);
bool turner_triangle_intersect(struct turner_hit *hit, const struct turner_mesh *mesh,
                               uint32_t index, const struct turner_ray *ray,
                               const struct turner_departure *self);

/* Each fills p, ng, ns, u, v, magnitude of a hit; p is put back onto the primitive. */
void turner_sphere_surface(struct turner_surface *surface, const struct turner_sphere *sphere,
                           const struct turner_ray *ray, const struct turner_hit *hit);
void turner_cone_surface(struct turner_surface *surface, const struct turner_cone *cone,
                         const struct turner_ray *ray, const struct turner_hit *hit);
void turner_plane_surface(struct turner_surface *surface, const struct turner_plane *plane,
                          const struct turner_ray *ray, const struct turner_hit *hit);
void turner_triangle_surface(struct turner_surface *surface, const struct turner_mesh *mesh,
                             uint32_t index, const struct turner_ray *ray,
                             const struct turner_hit *hit);

#endif
