/* Where shaders are looked for, in this order: the folders of the options (--shader-dir), the
 * scene's folder of shaders, $TURNER_SHADERS, the installed ones, and last the copies in the program
 * (gpu/include.h). The scene's folder is what its "shaders" says, or else shaders/ beside the scene
 * file, where there is one. The installed ones count for the installed command alone: others may be
 * of another version. */
#ifndef TURNER_RENDER_SHADER_PATH_H
#define TURNER_RENDER_SHADER_PATH_H

#include <limits.h>

#include "scene/scene.h"

struct turner_shader_path {
    char **folders;
    size_t count, capacity;
};

/* Fills `path` and lets options->shader_dirs point at it. `scene` may be NULL. A folder that is said
 * in so many words and is not there is for the shader compiler to complain of. */
void turner_shader_path_create(struct turner_shader_path *path,
                               struct turner_render_options *options,
                               const struct turner_scene *scene);
/* The scene's folder of shaders, be it there or not; false when it has none. */
bool turner_shader_path_of_scene(char folder[PATH_MAX], const struct turner_scene *scene);
void turner_shader_path_destroy(struct turner_shader_path *path);

#endif
