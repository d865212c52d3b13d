/* The readers of the scene module, one a format, and what they share. Only src/scene includes
 * this.
 *
 * `path` names the file in messages, and relative file names in it are taken from its folder. The
 * text comes from memory so that fuzzers can call a reader; it need not end in NUL. A reader fills
 * a scene that turner_scene_create made, with numbers it has checked; turner_scene_load does the
 * rest (default camera, sorted media, turner_scene_validate). On failure the scene is half filled
 * and still to be destroyed. */
#ifndef TURNER_SCENE_READERS_H
#define TURNER_SCENE_READERS_H

#include "scene/scene.h"

enum turner_result turner_scene_read_json(struct turner_scene *scene, const char *text,
                                          size_t length, const char *path);
enum turner_result turner_scene_read_nff(struct turner_scene *scene, const char *text,
                                         size_t length, const char *path);

/* Reads a mesh file through assimp: all meshes of the file in one, node transforms applied,
 * material 0. `smooth`: 1 makes vertex normals where the file has none, 0 drops the file's, −1
 * leaves it to the file. TURNER_BAD_INPUT with the path and the reason; `mesh` is then zeroed. */
enum turner_result turner_mesh_read_file(struct turner_mesh *mesh, const char *path, int smooth);

/* Replaces the normals by angle-weighted vertex normals (Thürmer and Wüthrich 1998); vertices at
 * the same position share one, so seams in the uvs do not show. A vertex without area gets its
 * triangle's normal, or +y where that has none. */
void turner_mesh_smooth(struct turner_mesh *mesh);

/* Frees the arrays and zeroes the mesh. */
void turner_mesh_destroy(struct turner_mesh *mesh);

/* Joins vertices that are equal in everything, drops those that no triangle uses, and numbers the
 * rest in the order of their use. */
void turner_mesh_join(struct turner_mesh *mesh);

/* The index in scene->texture_images of the picture at `path` (as it is to be opened), which is
 * read on first use; 8-bit pictures are decoded from sRGB, float pictures taken as linear.
 * TURNER_BAD_INPUT with the path and the reason. */
enum turner_result turner_scene_texture(uint32_t *image, struct turner_scene *scene,
                                        const char *path);

/* Appends instances like `like`, one for each transform in the file: 3 rows of 4 little-endian
 * 32-bit floats each, and nothing else. TURNER_BAD_INPUT with the path and the reason. */
enum turner_result turner_scene_add_instances(struct turner_scene *scene,
                                              const struct turner_instance *like, const char *path);

/* The path of `name` as written in the file `path`: relative names start at its folder. The caller
 * frees it. */
char *turner_path_beside(const char *path, const char *name);

/* Appends the mesh to the group, which owns its arrays from now on; `mesh` is zeroed. */
void turner_group_add_mesh(struct turner_group *group, struct turner_mesh *mesh);

/* The index of a new, empty group; `name` is copied. */
uint32_t turner_scene_add_group(struct turner_scene *scene, const char *name);

/* ---- checks that readers make where they can point at the place; turner_scene_validate makes
 * them for all ---- */

enum turner_camera_state {
    TURNER_CAMERA_GOOD,
    TURNER_CAMERA_NO_DIRECTION, /* from = at */
    TURNER_CAMERA_UP_PARALLEL   /* to the view, or zero */
};
enum turner_camera_state turner_camera_check(const struct turner_camera *camera);

/* May a hit on the material send two rays, so that their number doubles with each level? */
bool turner_material_branches(const struct turner_material *material,
                              const struct turner_settings *settings);

/* Finite, also as 32-bit floats, and invertible. */
bool turner_affine_usable(const struct turner_affine *affine);

/* No channel negative, each finite also as a 32-bit float. */
bool turner_color_usable(struct turner_vec3 color);

/* A scene from text that is in memory: picks the reader by the ending of `path`, then does what
 * turner_scene_load does after reading. `*scene` is NULL after a failure. */
enum turner_result turner_scene_parse(struct turner_scene **scene, const char *text, size_t length,
                                      const char *path);

#endif
