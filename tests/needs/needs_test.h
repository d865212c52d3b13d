/* Scenes from text, for tests of what they need. No device. */
#ifndef TURNER_TESTS_NEEDS_TEST_H
#define TURNER_TESTS_NEEDS_TEST_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "scene/readers.h"

#define SPHERE "{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, \"material\": \"m\"}"

/* "{version, camera at (0, 0, 5), " + rest + "}". */
static struct turner_scene *scene_of(const char *format, ...) TURNER_PRINTF(1, 2);
static struct turner_scene *scene_of(const char *format, ...)
{
    char rest[4096], text[8192];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(rest, sizeof rest, format, arguments);
    va_end(arguments);
    snprintf(text, sizeof text, "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": "
                                "[0, 0, 0]}, %s}", rest);
    struct turner_scene *scene;
    if (turner_scene_parse(&scene, text, strlen(text), "test.json") != TURNER_OK)
        fail_msg("%s: %s", text, turner_message());
    return scene;
}

#endif
