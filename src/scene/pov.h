/* A scene as a POV-Ray 3.7 scene, for a second opinion by an independent ray tracer.
 * docs/scenes.md ("Export to POV-Ray") says what is carried over, and how. The formulas matched are
 * those of POV-Ray's source, version 3.7.0.10. */
#ifndef TURNER_SCENE_POV_H
#define TURNER_SCENE_POV_H

#include "scene/scene.h"

/* Writes `scene` (a valid one) to `path`, whole or not at all. What POV-Ray takes on its command
 * line is not in the file: the size of the picture (settings.width × settings.height, which the
 * camera's shape is made for) and the samples per pixel. TURNER_BAD_INPUT, naming it and what to
 * do, for what a scene uses and POV-Ray cannot say; TURNER_OUTPUT when the file cannot be
 * written. */
enum turner_result turner_pov_write(const struct turner_scene *scene, const char *path);

/* The same, but of materials and solids that POV-Ray cannot say the first is a warning: its picture
 * will be another, and take about the time that the right one would. */
enum turner_result turner_pov_write_anyway(const struct turner_scene *scene, const char *path);

#endif
