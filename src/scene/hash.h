/* One number for what a scene shows. */
#ifndef TURNER_SCENE_HASH_H
#define TURNER_SCENE_HASH_H

#include "scene/scene.h"

/* Over the data as loaded, textures and meshes included: whatever decides a pixel, but for the
 * settings, which are the caller's to change. Names, paths and descriptions do not count. */
uint64_t turner_scene_hash(const struct turner_scene *scene);

#endif
