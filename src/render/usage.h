/* Which parts of a scene a ray can meet: what is declared and not used needs nothing. */
#ifndef TURNER_RENDER_USAGE_H
#define TURNER_RENDER_USAGE_H

#include "scene/scene.h"

struct turner_usage {
    bool *groups;    /* group_count: the world's own, and those with an instance */
    bool *materials; /* material_count: of a primitive of those groups, or of a plane */
    bool *media;     /* media_count: behind those materials' surfaces, or around the eye */
};

void turner_usage_create(struct turner_usage *usage, const struct turner_scene *scene);
void turner_usage_destroy(struct turner_usage *usage);

#endif
