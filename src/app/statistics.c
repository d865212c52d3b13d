/* Statistics and settings as JSON. */
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "image/atomic.h"
#include "render/needs.h"
#include "scene/methods.h"

static cJSON *settings_object(const struct turner_scene *scene)
{
    const struct turner_settings *settings = &scene->settings;
    cJSON *object = cJSON_CreateObject();
    int size[2] = {settings->width, settings->height};
    cJSON_AddItemToObject(object, "size", cJSON_CreateIntArray(size, 2));
    cJSON_AddNumberToObject(object, "depth", settings->depth);
    cJSON_AddNumberToObject(object, "cutoff", settings->cutoff);
    cJSON_AddNumberToObject(object, "spp", settings->spp);
    if (settings->error > 0)
        cJSON_AddNumberToObject(object, "error", settings->error);
    cJSON_AddStringToObject(object, "shading", settings->shading == TURNER_SHADING_PHONG
                                                   ? "phong" : "energy_conserving");
    cJSON_AddStringToObject(object, "shadows", settings->shadows == TURNER_SHADOWS_OPAQUE
                                                   ? "opaque" : "tinted");
    cJSON_AddNumberToObject(object, "exposure", settings->exposure);
    cJSON_AddStringToObject(object, "transfer", settings->transfer == TURNER_TRANSFER_LINEAR
                                                    ? "linear" : "srgb");
    cJSON_AddBoolToObject(object, "spd_rays", settings->spd_rays);
    cJSON_AddBoolToObject(object, "spd_grid", settings->spd_grid);
    cJSON *methods = cJSON_AddObjectToObject(object, "methods");
    for (size_t i = 0; i < turner_method_count; i++) {
        const char *name = turner_methods_list[i].name;
        char text[TURNER_METHOD_TEXT];
        if (strcmp(name, "depth") == 0 || strcmp(name, "cutoff") == 0 ||
            strcmp(name, "error") == 0)
            continue; /* stand above, as numbers */
        turner_method_text(text, settings, name);
        cJSON_AddStringToObject(methods, name, text);
    }
    cJSON *params = scene->param_count ? cJSON_AddObjectToObject(object, "params") : NULL;
    for (size_t i = 0; i < scene->param_count; i++)
        cJSON_AddStringToObject(params, scene->params[i].name, scene->params[i].value);
    if (scene->shader_hash) {
        char hash[20];
        snprintf(hash, sizeof hash, "%016llx", (unsigned long long)scene->shader_hash);
        cJSON_AddStringToObject(object, "shaders", hash);
    }
    return object;
}

char *turner_settings_json(const struct turner_scene *scene)
{
    cJSON *object = settings_object(scene);
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    return text;
}

static void add_count(cJSON *object, const char *key, uint64_t value)
{
    cJSON_AddNumberToObject(object, key, (double)value);
}

static cJSON *statistics_object(const struct turner_scene *scene,
                                const struct turner_statistics *s)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "version", turner_version());
    cJSON_AddStringToObject(object, "device", s->device);
    cJSON_AddStringToObject(object, "driver", s->driver);
    cJSON_AddStringToObject(object, "traversal", s->traversal);
    cJSON_AddStringToObject(object, "precision", s->precision);
    cJSON_AddItemToObject(object, "settings", settings_object(scene));
    add_count(object, "primitives", s->primitives);
    add_count(object, "instances", s->instances);

    cJSON *rays = cJSON_AddObjectToObject(object, "rays");
    add_count(rays, "camera", s->camera_rays);
    add_count(rays, "reflected", s->reflected_rays);
    add_count(rays, "refracted", s->refracted_rays);
    add_count(rays, "shadow", s->shadow_rays);
    add_count(rays, "total_internal_reflection", s->tir_rays);
    add_count(rays, "camera_hits", s->camera_hits);
    add_count(rays, "unfinished", s->unfinished);
    cJSON_AddNumberToObject(object, "largest_depth", s->largest_depth);

    cJSON *samples = cJSON_AddObjectToObject(object, "samples");
    cJSON_AddNumberToObject(samples, "mean", s->samples_mean);
    cJSON_AddNumberToObject(samples, "max", s->samples_max);

    if (scene->settings.error > 0) {
        cJSON *error = cJSON_AddObjectToObject(object, "error");
        cJSON_AddNumberToObject(error, "asked", scene->settings.error);
        cJSON_AddNumberToObject(error, "mean", s->error_mean);
        cJSON_AddNumberToObject(error, "max", s->error_max);
        add_count(error, "missed", s->error_missed);
        cJSON_AddNumberToObject(error, "cutoff_least", s->cutoff_least);
    }

    cJSON *pruned = cJSON_AddObjectToObject(object, "pruned");
    cJSON_AddNumberToObject(pruned, "mean", s->pruned_mean);
    cJSON_AddNumberToObject(pruned, "max", s->pruned_max);

    cJSON *nonfinite = cJSON_AddObjectToObject(object, "nonfinite");
    add_count(nonfinite, "count", s->nonfinite);
    if (s->nonfinite) {
        int first[2] = {s->nonfinite_x, s->nonfinite_y};
        cJSON_AddItemToObject(nonfinite, "first", cJSON_CreateIntArray(first, 2));
    }

    cJSON *seconds = cJSON_AddObjectToObject(object, "seconds");
    cJSON_AddNumberToObject(seconds, "start", s->seconds_start);
    cJSON_AddNumberToObject(seconds, "parse", s->seconds_parse);
    cJSON_AddNumberToObject(seconds, "device", s->seconds_device);
    cJSON_AddNumberToObject(seconds, "build", s->seconds_build);
    cJSON_AddNumberToObject(seconds, "compile", s->seconds_compile);
    cJSON_AddNumberToObject(seconds, "upload", s->seconds_upload);
    cJSON_AddNumberToObject(seconds, "layers", s->seconds_layers);
    cJSON_AddNumberToObject(seconds, "trace", s->seconds_trace);
    cJSON_AddNumberToObject(seconds, "read_back", s->seconds_read_back);
    cJSON_AddNumberToObject(seconds, "write", s->seconds_write);
    cJSON_AddNumberToObject(seconds, "whole", s->seconds_whole);

    cJSON *cached = cJSON_AddObjectToObject(object, "cached");
    cJSON_AddBoolToObject(cached, "source", s->source_cached);
    cJSON_AddBoolToObject(cached, "kernel", s->kernel_cached);
    cJSON_AddBoolToObject(cached, "driver", s->driver_cached);

    cJSON *bytes = cJSON_AddObjectToObject(object, "peak_bytes");
    add_count(bytes, "host", s->host_peak_bytes);
    add_count(bytes, "device", s->device_peak_bytes);

    cJSON *features = cJSON_AddArrayToObject(object, "features");
    for (uint32_t bit = 1; bit && bit <= s->needs; bit <<= 1) {
        if (s->needs & bit)
            cJSON_AddItemToArray(features, cJSON_CreateString(turner_needs_name(bit)));
    }
    add_count(object, "kernel_words", s->kernel_words);
    return object;
}

enum turner_result turner_statistics_write(const char *path, const struct turner_scene *scene,
                                           const struct turner_statistics *statistics)
{
    cJSON *object = statistics_object(scene, statistics);
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    size_t length = strlen(text);
    text[length] = '\n'; /* in the place of the zero: what is written has no need of it */
    enum turner_result result = TURNER_OK;
    if (strcmp(path, "-") == 0)
        fwrite(text, 1, length + 1, stdout);
    else
        result = turner_atomic_write(path, text, length + 1);
    cJSON_free(text);
    return result;
}
