/* What a scene needs of the kernel and why, and the bounds of its loops. */
#ifndef TURNER_RENDER_NEEDS_H
#define TURNER_RENDER_NEEDS_H

#include "scene/scene.h"

#define TURNER_NEEDS_COUNT 32 /* bits there may be */

struct turner_needs {
    uint32_t bits;          /* TURNER_NEEDS_… of shaders/shared.h */
    uint32_t methods;       /* TURNER_METHOD_… of the same */
    uint32_t stack;         /* rays that may wait at once, at least 1 */
    uint32_t max_steps;     /* rays traced for one sample, at most */
    uint32_t max_crossings; /* transmissive surfaces on one straight line, at most */
    bool pixel_counts;      /* rays are counted for each pixel: no scene's need, a layer's */
    bool soon;              /* what only makes large pictures quicker is left out: the caller's */
};

/* What can ask for a feature. */
enum turner_asker {
    TURNER_ASKER_SPHERE,
    TURNER_ASKER_CONE,
    TURNER_ASKER_MESH,
    TURNER_ASKER_PLANE,
    TURNER_ASKER_INSTANCE,
    TURNER_ASKER_MATERIAL,
    TURNER_ASKER_MEDIUM,
    TURNER_ASKER_LIGHT,
    TURNER_ASKER_CAMERA,
    TURNER_ASKER_SHADING, /* the setting */
    TURNER_ASKER_BACKGROUND,
};

/* Who asks for one: the first, and how many of its kind do. */
struct turner_why {
    enum turner_asker asker;
    uint32_t group, index; /* the first; group is of spheres, cones and meshes */
    uint64_t count;        /* 0: nobody */
};

struct turner_needs turner_needs_of(const struct turner_scene *scene);

/* The same, with the reason of bit i in why[i]. What no primitive, instance or light uses asks for
 * nothing. */
struct turner_needs turner_needs_explain(struct turner_why why[TURNER_NEEDS_COUNT],
                                         const struct turner_scene *scene);

/* Adds features that no thing of the scene asks for; the bounds follow. */
void turner_needs_add(struct turner_needs *needs, uint32_t bits, const struct turner_scene *scene);

/* Name of one bit ("triangles"), for messages and statistics. */
const char *turner_needs_name(uint32_t bit);

/* Features in groups, for lists. */
enum turner_feature_kind {
    TURNER_FEATURE_PRIMITIVES,
    TURNER_FEATURE_TEXTURES,
    TURNER_FEATURE_BACKGROUND,
    TURNER_FEATURE_LIGHTS,
    TURNER_FEATURE_SHADING,
    TURNER_FEATURE_SECONDARY_RAYS,
    TURNER_FEATURE_FRESNEL,
    TURNER_FEATURE_MEDIA,
    TURNER_FEATURE_OTHER,
    TURNER_FEATURE_KINDS
};

enum turner_feature_kind turner_needs_kind(uint32_t bit);
const char *turner_feature_kind_name(enum turner_feature_kind kind);

#define TURNER_WHY_TEXT 160 /* bytes that hold any reason; long names are cut */

/* `material "glass" and 2 more`, `sphere 0 of group "tree"`; "" when nobody asks. */
void turner_why_text(char text[TURNER_WHY_TEXT], const struct turner_scene *scene,
                     const struct turner_why *why);

#endif
