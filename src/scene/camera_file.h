/* Cameras as text: printed, written into a scene file, and paths of them. */
#ifndef TURNER_SCENE_CAMERA_FILE_H
#define TURNER_SCENE_CAMERA_FILE_H

#include "scene/scene.h"

/* The camera as it stands in a scene file, in one line; numbers have as many digits as they need to
 * be read back as they are. The caller frees it. */
char *turner_camera_json(const struct turner_camera *camera, const struct turner_scene *scene);

/* Writes from, at, up and vfov of the camera into the JSON scene file at `path`, in place of those of
 * its camera `number` (0: "camera", 1: the first of "cameras"). What is the same already and all
 * other text stays as it is, to the byte; the file changes whole or not at all. TURNER_BAD_INPUT
 * when that is no JSON, or has no such camera; TURNER_OUTPUT. */
enum turner_result turner_camera_store(const char *path, int number,
                                       const struct turner_camera *camera);

/* A path is a file {"version": 1, "rate": pictures a second, "cameras": [camera, …]}. */
struct turner_camera_path {
    double rate; /* > 0 */
    struct turner_camera *cameras;
    size_t count, capacity;
};

#define TURNER_PATH_CAMERAS (1u << 20) /* at most */

/* `inside` is left to the scene. TURNER_BAD_INPUT with the place; there is a camera at least. */
enum turner_result turner_camera_path_load(struct turner_camera_path *path, const char *file,
                                           const struct turner_scene *scene);
enum turner_result turner_camera_path_write(const struct turner_camera_path *path,
                                            const char *file, const struct turner_scene *scene);
void turner_camera_path_destroy(struct turner_camera_path *path);

#endif
