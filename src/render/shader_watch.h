/* The files that went into a kernel, and those that would if they were there: a file put into a
 * folder that is searched earlier takes the place of another. */
#ifndef TURNER_RENDER_SHADER_WATCH_H
#define TURNER_RENDER_SHADER_WATCH_H

#include "base/watch.h"
#include "gpu/include.h"
#include "render/shader_path.h"

/* Watches every file of `source` in each of the folders, and the one that was missing where it could
 * not be read to its end. `since` is the time before it was read. */
void turner_shader_watch_add(struct turner_watch *watch, const struct turner_shader_source *source,
                             const struct turner_shader_path *path, struct timespec since);

/* Whether the scene's folder of shaders is there. */
void turner_shader_watch_folder(struct turner_watch *watch, const struct turner_scene *scene,
                                struct timespec since);

/* All that goes into the pictures of a scene with these options (their own folders, not yet those of
 * turner_shader_path_create): for those who draw them whole, as turner render --watch does. */
void turner_shader_watch_all(struct turner_watch *watch,
                             const struct turner_render_options *options,
                             const struct turner_scene *scene, struct timespec since);

#endif
