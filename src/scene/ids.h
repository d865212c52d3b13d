/* Numbers of what can be seen, for the layer `id`: 0 is the background, 1 the first plane; then come
 * the things of group 0, then those of each instance's group, instance by instance; in a group the
 * spheres, the cones, the meshes. A mesh is one thing, and so is a box. */
#ifndef TURNER_SCENE_IDS_H
#define TURNER_SCENE_IDS_H

#include "scene/scene.h"

struct turner_ids {
    const struct turner_scene *scene;
    uint32_t *first;    /* number of the first thing of group 0, then of each instance */
    uint32_t **before;  /* for each group, mesh by mesh: how many triangles lie before it */
};

/* Keeps the scene by reference. TURNER_BAD_INPUT when 32 bits do not suffice. Free with
 * turner_ids_destroy, not after a failure. */
enum turner_result turner_ids_create(struct turner_ids *ids, const struct turner_scene *scene);
void turner_ids_destroy(struct turner_ids *ids);

/* What holds `primitive`, a number in the order spheres, cones, triangles, of the group that
 * `instance` shows: 0 is group 0 itself, then come scene->instances. (Plane i is 1 + i.) */
uint32_t turner_id_of(const struct turner_ids *ids, uint32_t instance, uint32_t primitive);

#endif
