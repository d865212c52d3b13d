/* What was measured, in the chart's folder: points/NAME.json and points/NAME.exr. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "app/app.h"
#include "app/chart.h"
#include "base/hash.h"
#include "image/atomic.h"

static void add_hex(cJSON *object, const char *key, uint64_t value)
{
    char text[20];
    snprintf(text, sizeof text, "%016llx", (unsigned long long)value);
    cJSON_AddStringToObject(object, key, text);
}

/* All that decides the times and the picture. */
static cJSON *identity_object(const struct turner_chart_point *point,
                              const struct turner_chart *chart,
                              const struct turner_chart_identity *identity)
{
    struct turner_scene with = *chart->scene;
    with.settings = point->settings;
    char *settings = turner_settings_json(&with);
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "version", turner_version());
    add_hex(object, "build", identity->build);
    add_hex(object, "kernel", identity->kernel);
    add_hex(object, "scene", identity->scene);
    cJSON_AddStringToObject(object, "device", identity->device);
    cJSON_AddStringToObject(object, "driver", identity->driver);
    cJSON_AddNumberToObject(object, "threads", identity->threads);
    cJSON_AddItemToObject(object, "settings", cJSON_Parse(settings));
    free(settings);
    return object;
}

void turner_chart_point_name(struct turner_chart_point *point, const struct turner_chart *chart,
                             const struct turner_chart_identity *identity)
{
    cJSON *object = identity_object(point, chart, identity);
    char *text = cJSON_PrintUnformatted(object);
    snprintf(point->name, sizeof point->name, "%016llx",
             (unsigned long long)turner_hash_text(TURNER_HASH_START, text));
    cJSON_free(text);
    cJSON_Delete(object);
}

static enum turner_result point_path(char path[PATH_MAX], const struct turner_chart *chart,
                                     const struct turner_chart_point *point, const char *ending)
{
    char name[40];
    snprintf(name, sizeof name, "points/%s.%s", point->name, ending);
    return turner_chart_path(path, chart->folder, name);
}

/* ---- the picture ---- */

enum turner_result turner_chart_picture_write(struct turner_chart_point *point,
                                              const struct turner_chart *chart,
                                              const struct turner_image *picture)
{
    char path[PATH_MAX];
    TURNER_TRY(point_path(path, chart, point, "exr"));
    point->picture_hash = turner_chart_picture_hash(picture);
    return turner_image_write(picture, path, &(struct turner_image_encoding){0});
}

enum turner_result turner_chart_picture_read(struct turner_image *picture,
                                             const struct turner_chart *chart,
                                             const struct turner_chart_point *point)
{
    char path[PATH_MAX];
    *picture = (struct turner_image){0};
    TURNER_TRY(point_path(path, chart, point, "exr"));
    TURNER_TRY(turner_image_read(picture, path, false));
    if (turner_chart_picture_hash(picture) != point->picture_hash)
        return turner_fail(TURNER_BAD_INPUT, "%s: is not the picture that was drawn", path);
    return TURNER_OK;
}

/* ---- the figures ---- */

/* Members that are one number each. */
static const struct {
    const char *key;
    size_t offset;
} numbers[] = {
    {"seconds_first", offsetof(struct turner_chart_point, seconds_first)},
    {"seconds_build", offsetof(struct turner_chart_point, seconds_build)},
    {"seconds_compile", offsetof(struct turner_chart_point, seconds_compile)},
    {"seconds_upload", offsetof(struct turner_chart_point, seconds_upload)},
    {"rays", offsetof(struct turner_chart_point, rays)},
    {"kernel_words", offsetof(struct turner_chart_point, kernel_words)},
};
enum { NUMBERS = sizeof numbers / sizeof *numbers };

enum turner_result turner_chart_point_save(const struct turner_chart_point *point,
                                           const struct turner_chart *chart,
                                           const struct turner_chart_identity *identity)
{
    char path[PATH_MAX];
    TURNER_TRY(point_path(path, chart, point, "json"));
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "label", point->label);
    cJSON_AddItemToObject(object, "identity", identity_object(point, chart, identity));
    cJSON_AddStringToObject(object, "traversal", point->traversal);
    for (int i = 0; i < NUMBERS; i++) {
        double value;
        memcpy(&value, (const char *)point + numbers[i].offset, sizeof value);
        cJSON_AddNumberToObject(object, numbers[i].key, value);
    }
    cJSON_AddItemToObject(object, "seconds_trace",
                          cJSON_CreateDoubleArray(point->seconds, point->runs));
    add_hex(object, "picture", point->picture_hash);
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    enum turner_result result = turner_atomic_write(path, text, strlen(text));
    cJSON_free(text);
    return result;
}

static bool take_numbers(struct turner_chart_point *point, const cJSON *object)
{
    for (int i = 0; i < NUMBERS; i++) {
        const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, numbers[i].key);
        if (!cJSON_IsNumber(item))
            return false;
        memcpy((char *)point + numbers[i].offset, &item->valuedouble, sizeof item->valuedouble);
    }
    const cJSON *seconds = cJSON_GetObjectItemCaseSensitive(object, "seconds_trace"), *run;
    point->runs = 0;
    cJSON_ArrayForEach(run, seconds) {
        if (!cJSON_IsNumber(run) || !(run->valuedouble > 0))
            return false;
        if (point->runs < TURNER_CHART_MAX_RUNS)
            point->seconds[point->runs++] = run->valuedouble;
    }
    const char *traversal =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "traversal"));
    const char *picture =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(object, "picture"));
    if (!traversal || !picture)
        return false;
    snprintf(point->traversal, sizeof point->traversal, "%s", traversal);
    point->picture_hash = strtoull(picture, NULL, 16);
    return true;
}

static bool take(struct turner_chart_point *point, const char *text,
                 const struct turner_chart *chart, const struct turner_chart_identity *identity)
{
    cJSON *object = cJSON_Parse(text);
    cJSON *wanted = identity_object(point, chart, identity);
    bool taken =
        cJSON_Compare(cJSON_GetObjectItemCaseSensitive(object, "identity"), wanted, true) &&
        take_numbers(point, object);
    cJSON_Delete(wanted);
    cJSON_Delete(object);
    struct turner_image picture = {0};
    taken = taken && turner_chart_picture_read(&picture, chart, point) == TURNER_OK &&
            picture.width == point->settings.width && picture.height == point->settings.height;
    turner_image_destroy(&picture);
    return taken;
}

void turner_chart_point_load(struct turner_chart_point *point, const struct turner_chart *chart,
                             const struct turner_chart_identity *identity)
{
    char path[PATH_MAX], *text;
    size_t length;
    point->runs = 0;
    if (point_path(path, chart, point, "json") != TURNER_OK ||
        turner_chart_read_file(&text, &length, path) != TURNER_OK)
        return;
    if (!take(point, text, chart, identity)) {
        turner_warn("%s: what was measured before is of something else or broken, and is measured "
                    "again", path);
        point->runs = 0;
    }
    free(text);
}
