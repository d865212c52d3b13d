/* A scene as flat arrays the GPU reads (shaders/shared.h), with or without bounding volume
 * hierarchies of our own. No Vulkan here. */
#ifndef TURNER_BVH_FLAT_H
#define TURNER_BVH_FLAT_H

#include "scene/scene.h"

#include "../shaders/shared.h"

enum turner_order {
    TURNER_ORDER_SAH,   /* binned-SAH BVH2 over each group and over the instances; primitives lie
                           in leaf order, groups one after another */
    TURNER_ORDER_WIDE,  /* the same with four children a node, for packets */
    TURNER_ORDER_MEDIAN /* no nodes; each group's triangles, then its spheres and cones, each in
                           median-split order: what lavapipe's builder makes good trees of */
};

/* The primitives of one group among turner_flat.primitives. */
struct turner_flat_group {
    uint32_t root;                      /* SAH, WIDE: node; an empty group has an empty node */
    uint32_t triangles, triangle_count; /* MEDIAN: the range of its triangles */
    uint32_t boxes, box_count;          /* MEDIAN: the range of its spheres and cones */
    float lo[3], hi[3];                 /* bounds, rounded outwards; lo > hi when empty */
};

/* Counts are of elements. corners, normals and uvs are empty where no mesh has them; then both
 * normals and uvs have vertex_count elements if any mesh has the one or the other (zeros where a
 * mesh lacks it). */
struct turner_flat {
    struct turner_gpu_node *nodes;     /* SAH */
    struct turner_gpu_wide_node *wide; /* WIDE */
    struct turner_gpu_primitive *primitives;
    struct turner_gpu_instance *instances; /* [0] is the world */
    struct turner_gpu_corners *corners;
    float (*normals)[3];
    float (*uvs)[2];
    struct turner_flat_group *groups; /* scene->group_count */
    uint32_t *instance_groups;        /* instance_count: group of each instance */
    size_t node_count; /* of nodes or wide */
    size_t primitive_count, instance_count, corner_count, vertex_count;
    enum turner_order order;
    uint32_t root;       /* top level's root node; the nodes from here to the end are those of the top */
    size_t node_room;    /* that a device is to have, so that turner_flat_move has some to spare */
    uint32_t max_depth;  /* SAH: entries a traversal stack needs that pushes one child a node: the
                            levels of the top tree, 1 sentinel, the levels of the deepest group;
                            WIDE: entries of either level that wait at once, with that of the end */
    uint32_t group_depth; /* SAH: of these, those of the groups */
    uint64_t max_visits; /* SAH, WIDE: nodes and instances one ray can visit, at most */
};

/* Flattens a valid scene; the same scene gives the same bytes. TURNER_DEVICE when memory does not
 * suffice (computed before it is taken), TURNER_BAD_INPUT when a coordinate or a transform does not
 * fit single precision. After a failure the flat scene is zeroed. */
enum turner_result turner_flat_create(struct turner_flat *flat, const struct turner_scene *scene,
                                      enum turner_order order);
void turner_flat_destroy(struct turner_flat *flat);

/* The instances and the top level again, after turner_flat_release, of a scene that differs in where
 * instances stand: fills `instances` and, from `root` on, `nodes` or `wide`, and sets node_count; the
 * groups stay as they are, and so does max_depth. Release it once more. `fits` gets false when it is
 * another scene, or would take more room than node_room or deeper stacks: build it anew then.
 * TURNER_BAD_INPUT as above. */
enum turner_result turner_flat_move(struct turner_flat *flat, const struct turner_scene *scene,
                                    bool *fits);

/* Frees the arrays that a device has copies of; counts, groups and instance_groups stay. */
void turner_flat_release(struct turner_flat *flat);

/* What rounding took from flat->primitives and flat->instances (rest.c), in their order: with it
 * 48 binary digits of a number stand. */
void turner_flat_primitive_rests(struct turner_gpu_primitive_rest *rests,
                                 const struct turner_flat *flat, const struct turner_scene *scene);
void turner_flat_instance_rests(struct turner_gpu_instance_rest *rests,
                                const struct turner_flat *flat, const struct turner_scene *scene);

/* Bounds of a primitive in its group, rounded outwards and then by two ulps of the largest
 * coordinate, so that every float intersection that the shaders accept lies inside. Infinite where
 * they do not fit a float. A cone's are exact: its discs reach r·sqrt(1 − n_i²) along axis i. */
void turner_primitive_bounds(float lo[3], float hi[3],
                             const struct turner_gpu_primitive *primitive);

#endif
