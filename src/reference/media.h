/* The media that a ray is inside of. docs/model.md, Media. */
#ifndef TURNER_REFERENCE_MEDIA_H
#define TURNER_REFERENCE_MEDIA_H

#include "reference/vector.h"
#include "scene/scene.h"

/* Indices into scene->media in rising order, with multiplicity: the last is the medium that the
 * ray travels in, an empty list is the outside. */
struct turner_media {
    uint32_t count;
    uint32_t inside[TURNER_MEDIA_NESTING];
};

/* The list that the camera starts with. */
struct turner_media turner_media_of_camera(const struct turner_camera *camera);

/* The medium travelled in, or TURNER_NONE. */
uint32_t turner_media_current(const struct turner_media *media);
turner_real turner_media_index(const struct turner_media *media, const struct turner_scene *scene);

/* Crosses a surface that has `medium` behind it: `after` is the list on the far side. Leaving a
 * medium that is not in the list counts as if it had been: it is then added to `before`. */
void turner_media_cross(struct turner_media *after, struct turner_media *before, uint32_t medium,
                        bool entering);

/* exp(−σ_a·distance) of the medium travelled in; `distance` may be infinite. */
turner_vector turner_media_transmittance(const struct turner_media *media,
                                         const struct turner_scene *scene, turner_real distance);

#endif
