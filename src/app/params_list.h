/* turner params for a scene or a folder of shaders. */
#ifndef TURNER_APP_PARAMS_LIST_H
#define TURNER_APP_PARAMS_LIST_H

#include "app/scene_options.h"

/* Prints the parameters of the shaders that `scene` is drawn with, with their values; with `json` as
 * a list of objects. */
enum turner_result turner_params_list(const struct turner_scene_options *options,
                                      struct turner_scene *scene, bool json);

#endif
