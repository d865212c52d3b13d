/* POV-Ray, where it is installed, as a second and independent opinion. */
#ifndef TURNER_APP_POVRAY_H
#define TURNER_APP_POVRAY_H

#include "base/result.h"
#include "scene/scene.h"

/* A run that takes longer is ended. */
#define TURNER_POVRAY_SECONDS 300

/* Whether a program `povray` is in PATH. */
bool turner_povray_found(void);

/* Draws `scene` at its settings.width × settings.height by POV-Ray: writes folder/name.pov, runs
 * povray on it, and reads back folder/name.exr, linear radiance rounded to half floats (relative
 * error 2⁻¹¹, infinite above 65504), one sample in the centre of each pixel; the fourth channel is
 * 0. Both and povray's words, folder/name.log, are left there; old ones are replaced. `name` is a
 * plain file name without quotes. Free `image` with turner_image_destroy, also after a failure.
 * TURNER_BAD_INPUT as turner_pov_write, for what POV-Ray cannot say; TURNER_DEVICE when povray is
 * missing, fails, or takes more than TURNER_POVRAY_SECONDS; TURNER_OUTPUT when a file cannot be
 * written. */
enum turner_result turner_povray_render(struct turner_image *image,
                                        const struct turner_scene *scene, const char *folder,
                                        const char *name);

#endif
