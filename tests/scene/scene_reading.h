/* Scenes from text, for tests. */
#ifndef TESTS_SCENE_READING_H
#define TESTS_SCENE_READING_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/readers.h"

/* What every JSON scene needs, to be followed by ", …}" or "}". */
#define HEAD "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}"

static inline struct turner_scene *must_parse(const char *text)
{
    struct turner_scene *scene;
    if (turner_scene_parse(&scene, text, strlen(text), "t.json") != TURNER_OK)
        fail_msg("%s", turner_message());
    return scene;
}

static inline void same(struct turner_vec3 v, double x, double y, double z)
{
    if (!(fabs(v.x - x) < 1e-12 && fabs(v.y - y) < 1e-12 && fabs(v.z - z) < 1e-12))
        fail_msg("(%.17g, %.17g, %.17g) instead of (%.17g, %.17g, %.17g)", v.x, v.y, v.z, x, y, z);
}

#endif
