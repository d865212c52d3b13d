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

/* Where the primitives of a group come from. */
struct turner_flat_mesh {
    uint32_t first;      /* its first triangle among those of the group */
    uint32_t material;   /* as primitives hold it */
    uint32_t attributes; /* of its first triangle */
};

struct turner_flat_source {
    const struct turner_group *group;
    const struct turner_scene *scene;
    struct turner_flat_mesh *meshes; /* mesh_count */
};

/* Appends what the group's meshes have of corners, normals and uvs to arrays of `flat` that are
 * large enough. Free the source with free(source->meshes). */
void turner_flat_source_create(struct turner_flat_source *source, struct turner_flat *flat,
                               const struct turner_scene *scene, size_t group, bool patterned);

/* Primitive `index` of the group: spheres, cones, triangles in mesh order. */
struct turner_gpu_primitive turner_flat_primitive(const struct turner_flat_source *source,
                                                  uint32_t index);

/* Fills items with the bounds of the group's primitives, in their order but, for `triangles_first`,
 * with the triangles before the rest, and sets the bounds of flat_group. TURNER_BAD_INPUT. */
enum turner_result turner_flat_measure(struct turner_bvh_item *items,
                                       struct turner_flat_group *flat_group,
                                       const struct turner_flat_source *source,
                                       bool triangles_first);

/* Writes the primitive of every item, in the items' order. */
void turner_flat_place(struct turner_gpu_primitive *primitives,
                       const struct turner_flat_source *source, const struct turner_bvh_item *items,
                       uint32_t count);

/* Appends the top level to flat->nodes, over instances whose bounds are `items`: leaves of one
 * instance, named by its index, because instances stay in the order of the scene, which decides ties.
 * Returns its levels. */
uint32_t turner_flat_top(struct turner_flat *flat, struct turner_bvh_item *items, uint32_t count);

/* Fills flat->instances and instance_groups, and items with the bounds in the world of those that
 * are not empty, in their order; *used says how many. A group's bounds are rounded outwards by what
 * transforming in floats may err. TURNER_BAD_INPUT when something does not fit a float. */
enum turner_result turner_flat_instances(struct turner_flat *flat, const struct turner_scene *scene,
                                         struct turner_bvh_item *items, uint32_t *used);

#endif
