/* A scene made ready for rays: a tree over the primitives of each group, and one over the
 * instances. */
#ifndef TURNER_REFERENCE_WORLD_H
#define TURNER_REFERENCE_WORLD_H

#include "reference/tree.h"

struct turner_world_mesh {
    const struct turner_mesh *mesh;
    uint32_t first; /* number of its first triangle among the group's primitives */
};

struct turner_world_group {
    const struct turner_group *group;
    struct turner_world_mesh *meshes;
    struct turner_tree tree; /* items are primitives: spheres, cones, triangles */
};

struct turner_world_instance {
    struct turner_map to_world, to_group;
    uint32_t group, material;
};

struct turner_world {
    const struct turner_scene *scene;
    struct turner_world_group *groups;        /* scene->group_count */
    struct turner_world_instance *instances;  /* scene->instance_count */
    struct turner_tree tree;                  /* items are instances */
};

/* The scene is kept by reference. TURNER_DEVICE when it needs more memory than there is;
 * TURNER_BAD_INPUT for a transform that flattens space. */
enum turner_result turner_world_create(struct turner_world *world,
                                       const struct turner_scene *scene);
void turner_world_destroy(struct turner_world *world);

/* The nearest hit with 0 < t < t_max. Of hits at equal t the lower place wins. */
bool turner_world_intersect(struct turner_hit *hit, const struct turner_world *world,
                            const struct turner_ray *ray, turner_real t_max);

/* True if there is any hit with 0 < t < t_max. */
bool turner_world_occluded(const struct turner_world *world, const struct turner_ray *ray,
                           turner_real t_max);

/* All about a hit, in world space. */
void turner_world_surface(struct turner_surface *surface, const struct turner_world *world,
                          const struct turner_ray *ray, const struct turner_hit *hit);

/* The ray in `direction` that starts on the outward or inward side of the surface. It starts off
 * it, along the geometric normal, by more than the rounding error of p, so that neighbours that
 * share an edge with the surface lie on the side where they belong. */
struct turner_ray turner_surface_leave(const struct turner_surface *surface,
                                       turner_vector direction, bool outward);

#endif
