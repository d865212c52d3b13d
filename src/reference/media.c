#include "reference/media.h"

static void insert(struct turner_media *media, uint32_t medium)
{
    uint32_t sorted[TURNER_MEDIA_NESTING + 1], count = 0, i = 0;
    while (i < media->count && media->inside[i] <= medium)
        sorted[count++] = media->inside[i++];
    sorted[count++] = medium;
    while (i < media->count)
        sorted[count++] = media->inside[i++];

    uint32_t dropped = count > TURNER_MEDIA_NESTING ? 1 : 0; /* a ninth drops the lowest */
    media->count = count - dropped;
    for (i = 0; i < media->count; i++)
        media->inside[i] = sorted[i + dropped];
}

/* Takes one away; false when there is none. */
static bool take(struct turner_media *media, uint32_t medium)
{
    uint32_t i = 0;
    while (i < media->count && media->inside[i] != medium)
        i++;
    if (i == media->count)
        return false;
    media->count--;
    for (; i < media->count; i++)
        media->inside[i] = media->inside[i + 1];
    return true;
}

struct turner_media turner_media_of_camera(const struct turner_camera *camera)
{
    struct turner_media media = {0};
    for (uint32_t i = 0; i < camera->inside_count; i++)
        insert(&media, camera->inside[i]);
    return media;
}

uint32_t turner_media_current(const struct turner_media *media)
{
    return media->count > 0 ? media->inside[media->count - 1] : TURNER_NONE;
}

turner_real turner_media_index(const struct turner_media *media, const struct turner_scene *scene)
{
    uint32_t current = turner_media_current(media);
    return current == TURNER_NONE ? 1 : scene->media[current].index;
}

void turner_media_cross(struct turner_media *after, struct turner_media *before, uint32_t medium,
                        bool entering)
{
    *after = *before;
    if (entering)
        insert(after, medium);
    else if (!take(after, medium))
        insert(before, medium);
}

/* No absorption lets all through, however far: 0·∞ must not come up. */
static turner_real transmittance(turner_real absorption, turner_real distance)
{
    return absorption > 0 ? expl(-absorption * distance) : 1;
}

turner_vector turner_media_transmittance(const struct turner_media *media,
                                         const struct turner_scene *scene, turner_real distance)
{
    uint32_t current = turner_media_current(media);
    if (current == TURNER_NONE)
        return grey(1);
    turner_vector absorption = widen(scene->media[current].absorption);
    return vector(transmittance(absorption.x, distance), transmittance(absorption.y, distance),
                  transmittance(absorption.z, distance));
}
