/* Where a scene asks for more than its picture can show. Only what is certain. */
#ifndef TURNER_RENDER_ADVICE_H
#define TURNER_RENDER_ADVICE_H

#include "scene/scene.h"

/* One turner_warn each:
 * - a depth setting beyond the useful depth (render/depth.h), other than the default of the reader;
 * - a transmissive material that nothing tells from empty space: at each boundary it can make both
 *   media have the same index, it lets everything through, and its medium absorbs nothing;
 * - one whose k_r never shows, because its exact Fresnel is 0 between equal indices;
 * - more than one sample per pixel of a picture that is a constant background;
 * - `precision` f64 where turner_f64_can_show says no for `bits` a channel, 0 if not known.
 * `name` of the scene comes first in each. */
void turner_advise(const struct turner_scene *scene, const char *name, int bits);

#endif
