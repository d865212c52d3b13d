/* The steps of turner_flat_create; only src/bvh includes this. */
#ifndef TURNER_BVH_FLATTEN_H
#define TURNER_BVH_FLATTEN_H

#include "bvh/build.h"

/* The index of a material and its flags, as primitives, planes and instances hold it. */
uint32_t turner_flat_material(const struct turner_scene *scene, uint32_t material);

/* Whether the group's mesh needs its uvs: there are some and a pattern may look at them.
 * `patterned` says that an instance of the group brings a material with a pattern. */
bool turner_flat_needs_uvs(const struct turner_scene *scene, const struct turner_mesh *mesh,
                           bool patterned);

/* Writes the group's primitives to primitives[first…] in group order (spheres, cones, triangles in
 * mesh order), and appends what its meshes have of corners, normals and uvs to arrays that are
 * large enough. */
void turner_flat_group(struct turner_flat *flat, const struct turner_scene *scene, size_t group,
                       size_t first, bool patterned);

/* Fills the transforms and spawn_scale of an instance, and the bounds in the world of what has the
 * bounds `box` in the group, rounded outwards by what transforming in floats may err. False when
 * something does not fit a float. */
bool turner_flat_instance(struct turner_gpu_instance *instance, struct turner_bvh_bounds *world,
                          const struct turner_affine *to_world,
                          const struct turner_bvh_bounds *box);

#endif
