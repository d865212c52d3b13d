/* Scenes that the tests of src/bvh build by hand. Materials: 0 plain, 1 transmissive, 2 with a
 * checker. */
#ifndef TESTS_BVH_SCENES_H
#define TESTS_BVH_SCENES_H

#include "bvh/flat.h"

/* A small generator (splitmix64), so that every run tests the same. */
uint64_t random_bits(uint64_t *state);
double random_in(uint64_t *state, double lo, double hi);
struct turner_vec3 random_point(uint64_t *state, double lo, double hi);

struct turner_scene *make_scene(void);
uint32_t add_group(struct turner_scene *scene);
void add_sphere(struct turner_group *group, struct turner_vec3 center, double radius,
                uint32_t material);
void add_cone(struct turner_group *group, struct turner_vec3 base, double base_radius,
              struct turner_vec3 apex, double apex_radius, bool capped, uint32_t material);
void add_instance(struct turner_scene *scene, uint32_t group, uint32_t material,
                  struct turner_affine transform);
/* A mesh of triangles that share no vertices; the caller may add normals and uvs to it. */
struct turner_mesh *add_soup(struct turner_group *group, uint64_t *state, uint32_t count,
                             double size, uint32_t material);
/* A closed, wavy ball of 2·(n − 1)² triangles. */
void add_ball(struct turner_group *group, uint32_t n, uint32_t material);
/* Spheres, cones and triangles in [−1, 1]³. */
void fill_group(struct turner_group *group, uint64_t *state, int spheres, int cones, int triangles);
/* A sphere with nine a third as large on it, and so on. */
void add_flake(struct turner_group *group, struct turner_vec3 center, double radius,
               struct turner_vec3 up, int level);
/* rotation about a skew axis, uniform scale (may be negative), translation */
struct turner_affine make_transform(double scale, struct turner_vec3 translation);

/* Up to four groups of primitives of all kinds, at most 2,047 of each, instanced at all sizes. */
struct turner_scene *make_random_scene(uint64_t *random);

#endif
