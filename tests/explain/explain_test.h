/* Scenes and rays for the tests of explaining. */
#ifndef TURNER_TESTS_EXPLAIN_TEST_H
#define TURNER_TESTS_EXPLAIN_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/ray_tree.h"
#include "scene/readers.h"

#define SCENES                                                                                     \
    "absorption", "attenuation", "bubble", "environment", "fresnel", "instances", "lights",        \
        "mesh", "metals", "mirrors", "phong_terms", "prism", "shadows", "sphereflake",             \
        "underwater", "water_glass", "whitted1980"

static inline struct turner_scene *must_parse(const char *text)
{
    struct turner_scene *scene;
    if (turner_scene_parse(&scene, text, strlen(text), "test.json") != TURNER_OK)
        fail_msg("%s", turner_message());
    return scene;
}

/* One of scenes/, small. */
static inline struct turner_scene *must_load(const char *name)
{
    struct turner_scene *scene;
    char path[4096];
    snprintf(path, sizeof path, "%s/scenes/%s.json", TURNER_SOURCE_DIR, name);
    if (turner_scene_load(&scene, path) != TURNER_OK)
        fail_msg("%s", turner_message());
    scene->settings.width = 24;
    scene->settings.height = 18;
    scene->settings.spp = 1;
    return scene;
}

/* One glass ball in the dark, seen straight through its middle; nothing is cut for its weight. */
#define GLASS_BALL                                                                                 \
    "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]},"                       \
    "\"settings\": {\"size\": [1, 1], \"depth\": 2, \"cutoff\": 0}, \"background\": 1,"            \
    "\"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5}},"                        \
    "\"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1,"                \
    "\"material\": \"glass\"}]}"

#endif
