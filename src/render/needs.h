/* What a scene needs of the kernel, and the bounds of its loops. */
#ifndef TURNER_RENDER_NEEDS_H
#define TURNER_RENDER_NEEDS_H

#include "scene/scene.h"

struct turner_needs {
    uint32_t bits;          /* TURNER_NEEDS_… of shaders/shared.h */
    uint32_t stack;         /* rays that may wait at once, at least 1 */
    uint32_t max_steps;     /* rays traced for one sample, at most */
    uint32_t max_crossings; /* transmissive surfaces on one straight line, at most */
};

struct turner_needs turner_needs_of(const struct turner_scene *scene);

/* Name of one bit ("triangles"), for messages and statistics. */
const char *turner_needs_name(uint32_t bit);

#endif
