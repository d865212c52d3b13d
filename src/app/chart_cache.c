/* Reference pictures, kept for the next time: NAME.exr, and NAME.json which says what it is of and
 * how to tell that it is whole. The JSON is written last. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "app/app.h"
#include "app/chart.h"
#include "base/hash.h"
#include "image/atomic.h"
#include "reference/reference.h"

struct entry {
    cJSON *identity;
    char picture[PATH_MAX], description[PATH_MAX];
};

/* Settings that the reference does not look at do not count. */
static struct turner_settings relevant(const struct turner_settings *settings)
{
    struct turner_settings kept = *settings;
    kept.methods = (struct turner_methods){.fresnel = settings->methods.fresnel};
    kept.exposure = 0;
    kept.transfer = TURNER_TRANSFER_SRGB;
    return kept;
}

/* All that decides the picture. TURNER_REFERENCE_SOURCES is a hash of the tracer's source files. */
static cJSON *identity_of(const struct turner_chart *chart, const struct turner_settings *settings,
                          uint32_t pattern)
{
    struct turner_scene with = *chart->scene;
    with.settings = relevant(settings);
    char *text = turner_settings_json(&with), scene[20];
    snprintf(scene, sizeof scene, "%016llx", (unsigned long long)chart->scene_hash);
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "reference", TURNER_REFERENCE_SOURCES);
    cJSON_AddStringToObject(object, "scene", scene);
    cJSON_AddNumberToObject(object, "pattern", pattern);
    cJSON_AddItemToObject(object, "settings", cJSON_Parse(text));
    free(text);
    return object;
}

static enum turner_result open_entry(struct entry *entry, const struct turner_chart *chart,
                                     const struct turner_settings *settings, uint32_t pattern)
{
    entry->identity = identity_of(chart, settings, pattern);
    char *text = cJSON_PrintUnformatted(entry->identity), name[32];
    unsigned long long hash = turner_hash_text(TURNER_HASH_START, text);
    cJSON_free(text);
    snprintf(name, sizeof name, "%016llx.exr", hash);
    TURNER_TRY(turner_chart_path(entry->picture, chart->cache, name));
    snprintf(name, sizeof name, "%016llx.json", hash);
    return turner_chart_path(entry->description, chart->cache, name);
}

static bool is_whole(const struct turner_image *picture, const cJSON *description,
                     const struct turner_settings *settings)
{
    const char *hash =
        cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(description, "picture"));
    return picture->width == settings->width && picture->height == settings->height && hash &&
           strtoull(hash, NULL, 16) == turner_chart_picture_hash(picture);
}

/* True when the cache has it. A broken entry is worth a word. */
static bool load(struct turner_image *picture, double *pruned, const struct entry *entry,
                 const struct turner_settings *settings)
{
    char *text;
    size_t length;
    if (turner_chart_read_file(&text, &length, entry->description) != TURNER_OK)
        return false;
    cJSON *description = cJSON_Parse(text);
    free(text);
    const cJSON *weight = cJSON_GetObjectItemCaseSensitive(description, "pruned");
    bool good = cJSON_Compare(cJSON_GetObjectItemCaseSensitive(description, "identity"),
                              entry->identity, true) &&
                cJSON_IsNumber(weight) &&
                turner_image_read(picture, entry->picture, false) == TURNER_OK &&
                is_whole(picture, description, settings);
    if (good)
        *pruned = weight->valuedouble;
    else
        turner_warn("%s: the reference picture is broken and is traced again", entry->picture);
    cJSON_Delete(description);
    return good;
}

static enum turner_result store(const struct turner_image *picture, double pruned,
                                const struct entry *entry)
{
    TURNER_TRY(turner_image_write(picture, entry->picture, &(struct turner_image_encoding){0}));
    char hash[20];
    snprintf(hash, sizeof hash, "%016llx", (unsigned long long)turner_chart_picture_hash(picture));
    cJSON *description = cJSON_CreateObject();
    cJSON_AddStringToObject(description, "what", "reference picture of turner chart");
    cJSON_AddItemReferenceToObject(description, "identity", entry->identity);
    cJSON_AddStringToObject(description, "picture", hash);
    cJSON_AddNumberToObject(description, "pruned", pruned);
    char *text = cJSON_Print(description);
    enum turner_result result = turner_atomic_write(entry->description, text, strlen(text));
    cJSON_free(text);
    cJSON_Delete(description);
    return result;
}

static double mean_pruned(const struct turner_image *picture)
{
    size_t count = (size_t)picture->width * (size_t)picture->height;
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += (double)picture->rgba[4 * i + 3];
    return sum / (double)count;
}

static enum turner_result trace(struct turner_image *picture, const struct turner_chart *chart,
                                const struct turner_settings *settings, uint32_t pattern,
                                const char *what)
{
    struct turner_scene with = *chart->scene;
    struct turner_progress_bar bar;
    with.settings = relevant(settings);
    turner_progress_begin(&bar, chart->quiet);
    bar.what = what;
    enum turner_result result = turner_reference_render_pattern(
        picture, &with, pattern, chart->render.threads, NULL, turner_progress_show, &bar);
    turner_progress_end(&bar);
    return result;
}

enum turner_result turner_chart_reference(struct turner_image *picture, double *pruned,
                                          struct turner_chart *chart,
                                          const struct turner_settings *settings,
                                          uint32_t pattern, const char *what)
{
    struct entry entry;
    enum turner_result result;
    *picture = (struct turner_image){0};
    TURNER_TRY_DONE(open_entry(&entry, chart, settings, pattern));
    if (load(picture, pruned, &entry, settings)) {
        chart->truths_cached++;
        goto done;
    }
    turner_image_destroy(picture);
    TURNER_TRY_DONE(turner_chart_make_folder(chart->cache));
    TURNER_TRY_DONE(trace(picture, chart, settings, pattern, what));
    *pruned = mean_pruned(picture);
    result = store(picture, *pruned, &entry);
    chart->truths_made++;
done:
    cJSON_Delete(entry.identity);
    return result;
}
