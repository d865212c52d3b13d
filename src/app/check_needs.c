#include "app/check_needs.h"

#include <stdio.h>
#include <string.h>

#include "render/depth.h"
#include "render/precision.h"

enum { FORMATS = 3 };
static const int format_bits[FORMATS] = {8, 16, 32};

enum turner_result turner_kernel_set_get(const struct turner_sized_kernel **kernel,
                                         struct turner_kernel_set *set,
                                         const struct turner_gpu_info *info,
                                         const struct turner_scene *scene,
                                         enum turner_traversal wanted)
{
    static const struct turner_render_options defaults;
    const struct turner_needs everything = {
        .bits = TURNER_NEEDS_ALL, .stack = 1, .methods = turner_needs_of(scene).methods};
    unsigned kind;
    TURNER_TRY(turner_choose_kernel(&kind, info, &scene->settings.methods, wanted));
    struct turner_sized_kernel *entry = &set->at[kind];
    if (!entry->kernel.spirv.words)
        TURNER_TRY(turner_kernel_create(&entry->kernel, kind, &defaults));
    if (!entry->ready || entry->methods != everything.methods)
        TURNER_TRY(turner_kernel_size(&entry->everything, &entry->kernel, &everything));
    entry->methods = everything.methods;
    entry->ready = true;
    *kernel = entry;
    return TURNER_OK;
}

void turner_kernel_set_destroy(struct turner_kernel_set *set)
{
    for (int kind = 0; kind < TURNER_KERNEL_KINDS; kind++)
        turner_kernel_destroy(&set->at[kind].kernel);
}

static void depth_text(char *text, size_t size, const struct turner_scene *scene,
                       const struct turner_depth *depth)
{
    const struct turner_settings *settings = &scene->settings;
    char material[TURNER_WHY_TEXT];
    struct turner_why why = {TURNER_ASKER_MATERIAL, 0, depth->material, depth->weight > 0};
    turner_why_text(material, scene, &why);
    if (depth->weight == 0)
        snprintf(text, size, "nothing reflects or transmits");
    else if (depth->useful < TURNER_DEPTH_UNBOUNDED)
        snprintf(text, size, "%s sends on %g of the light at most, the cutoff is %g", material,
                 depth->weight, settings->cutoff);
    else if (settings->cutoff == 0)
        snprintf(text, size, "the cutoff is 0, so every ray is followed");
    else if (depth->weight < 1)
        snprintf(text, size, "%s sends on %g of the light", material, depth->weight);
    else
        snprintf(text, size, "%s loses nothing at some angle (a lossless mirror or glass, or a "
                             "metal at grazing incidence)", material);
}

/* ---- for people ---- */

static void print_line(const char *kind, const char *text)
{
    printf("  %-15s %s\n", kind, text);
}

static void print_features(const struct turner_scene *scene, const struct turner_needs *needs,
                           const struct turner_why *why)
{
    for (int kind = 0; kind < TURNER_FEATURE_KINDS; kind++) {
        const char *head = turner_feature_kind_name((enum turner_feature_kind)kind);
        for (int i = 0; i < TURNER_NEEDS_COUNT; i++) {
            uint32_t bit = 1u << i;
            char reason[TURNER_WHY_TEXT], line[TURNER_WHY_TEXT + 64];
            if (!(needs->bits & bit) || (int)turner_needs_kind(bit) != kind)
                continue;
            turner_why_text(reason, scene, &why[i]);
            snprintf(line, sizeof line, "%s: %s", turner_needs_name(bit), reason);
            print_line(head, line);
            head = "";
        }
    }
}

static void print_depth(const struct turner_scene *scene)
{
    struct turner_depth depth = turner_depth_of(scene);
    char reason[256], line[320];
    depth_text(reason, sizeof reason, scene, &depth);
    if (depth.useful < TURNER_DEPTH_UNBOUNDED)
        snprintf(line, sizeof line, "%d is the deepest useful one, the setting is %d: %s",
                 depth.useful, scene->settings.depth, reason);
    else
        snprintf(line, sizeof line, "no bound but the setting, %d: %s", scene->settings.depth,
                 reason);
    print_line("depth", line);
}

static void print_precision(const struct turner_scene *scene)
{
    static const char *const names[FORMATS] = {"8-bit", "16-bit", "float"};
    struct turner_f32_error error = turner_f32_error_of(scene);
    bool bent = turner_depth_of(scene).weight > 0 && scene->settings.depth > 0;
    char object[TURNER_WHY_TEXT], line[320];
    turner_why_text(object, scene, &error.object);
    size_t length = (size_t)snprintf(
        line, sizeof line, "%s; f32 moves edges by up to %.2g of a pixel%s%s%s",
        scene->settings.methods.precision == TURNER_PRECISION_F64 ? "f64" : "f32",
        fmax(error.pixels, error.shape), *object ? " (" : "", object, *object ? ")" : "");
    if (bent)
        length += (size_t)snprintf(line + length, sizeof line - length,
                                   ", more behind what reflects or transmits");
    length += (size_t)snprintf(line + length, sizeof line - length, "; f64 can show more in ");
    const char *separator = "";
    for (int i = 0; i < FORMATS; i++) {
        if (!turner_f64_can_show(scene, format_bits[i]))
            continue;
        length += (size_t)snprintf(line + length, sizeof line - length, "%s%s", separator,
                                   names[i]);
        separator = ", ";
    }
    snprintf(line + length, sizeof line - length, "%s pictures", *separator ? "" : "no");
    print_line("precision", line);
}

static void print_left_out(const struct turner_needs *needs)
{
    char line[1024] = "";
    size_t length = 0;
    for (uint32_t bit = 1; bit & TURNER_NEEDS_ALL; bit <<= 1) {
        if (!(needs->bits & bit))
            length += (size_t)snprintf(line + length, sizeof line - length, "%s%s",
                                       length ? ", " : "", turner_needs_name(bit));
    }
    print_line("left out", length ? line : "nothing");
}

enum turner_result turner_needs_print(const struct turner_scene *scene, const char *path,
                                      const struct turner_sized_kernel *kernel)
{
    struct turner_why why[TURNER_NEEDS_COUNT];
    struct turner_needs needs = turner_needs_explain(why, scene);
    size_t bytes;
    TURNER_TRY(turner_kernel_size(&bytes, &kernel->kernel, &needs));
    printf("%s\n", path);
    print_features(scene, &needs, why);
    print_depth(scene);
    print_precision(scene);
    print_left_out(&needs);
    char line[160];
    snprintf(line, sizeof line, "%zu bytes of SPIR-V (%s), %.0f %% of the %zu with everything",
             bytes, turner_traversal_name(kernel->kernel.kind),
             100.0 * (double)bytes / (double)kernel->everything, kernel->everything);
    print_line("kernel", line);
    return TURNER_OK;
}

/* ---- for programs ---- */

static void list_features(cJSON *object, const struct turner_scene *scene)
{
    struct turner_why why[TURNER_NEEDS_COUNT];
    struct turner_needs needs = turner_needs_explain(why, scene);
    cJSON *present = cJSON_AddArrayToObject(object, "needs");
    cJSON *absent = cJSON_AddArrayToObject(object, "left_out");
    for (int i = 0; i < TURNER_NEEDS_COUNT; i++) {
        uint32_t bit = 1u << i;
        char reason[TURNER_WHY_TEXT];
        if (!(needs.bits & bit)) {
            if (bit & TURNER_NEEDS_ALL)
                cJSON_AddItemToArray(absent, cJSON_CreateString(turner_needs_name(bit)));
            continue;
        }
        turner_why_text(reason, scene, &why[i]);
        cJSON *feature = cJSON_CreateObject();
        cJSON_AddStringToObject(feature, "feature", turner_needs_name(bit));
        cJSON_AddStringToObject(feature, "kind",
                                turner_feature_kind_name(turner_needs_kind(bit)));
        cJSON_AddStringToObject(feature, "why", reason);
        cJSON_AddNumberToObject(feature, "count", (double)why[i].count);
        cJSON_AddItemToArray(present, feature);
    }
}

static void list_depth(cJSON *object, const struct turner_scene *scene)
{
    struct turner_depth depth = turner_depth_of(scene);
    char reason[256];
    depth_text(reason, sizeof reason, scene, &depth);
    cJSON *item = cJSON_AddObjectToObject(object, "depth");
    cJSON_AddNumberToObject(item, "setting", scene->settings.depth);
    if (depth.useful < TURNER_DEPTH_UNBOUNDED)
        cJSON_AddNumberToObject(item, "useful", depth.useful);
    else
        cJSON_AddNullToObject(item, "useful");
    cJSON_AddNumberToObject(item, "largest_weight", depth.weight);
    cJSON_AddStringToObject(item, "why", reason);
}

static void list_precision(cJSON *object, const struct turner_scene *scene)
{
    static const char *const keys[FORMATS] = {"bits_8", "bits_16", "float"};
    struct turner_f32_error error = turner_f32_error_of(scene);
    char reason[TURNER_WHY_TEXT];
    turner_why_text(reason, scene, &error.object);
    cJSON *item = cJSON_AddObjectToObject(object, "precision");
    cJSON_AddStringToObject(item, "setting",
                            scene->settings.methods.precision == TURNER_PRECISION_F64 ? "f64"
                                                                                      : "f32");
    cJSON_AddNumberToObject(item, "f32_moves_edges_pixels", error.pixels);
    cJSON_AddNumberToObject(item, "f32_misshapes", error.shape);
    cJSON_AddStringToObject(item, "why", reason);
    cJSON *shows = cJSON_AddObjectToObject(item, "f64_can_show");
    for (int i = 0; i < FORMATS; i++)
        cJSON_AddBoolToObject(shows, keys[i], turner_f64_can_show(scene, format_bits[i]));
}

enum turner_result turner_needs_list(cJSON *list, const struct turner_scene *scene,
                                     const char *path, const struct turner_sized_kernel *kernel)
{
    struct turner_needs needs = turner_needs_of(scene);
    size_t bytes;
    TURNER_TRY(turner_kernel_size(&bytes, &kernel->kernel, &needs));
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "scene", path);
    list_features(object, scene);
    list_depth(object, scene);
    list_precision(object, scene);
    cJSON *size = cJSON_AddObjectToObject(object, "kernel");
    cJSON_AddStringToObject(size, "traversal", turner_traversal_name(kernel->kernel.kind));
    cJSON_AddNumberToObject(size, "spirv_bytes", (double)bytes);
    cJSON_AddNumberToObject(size, "spirv_bytes_everything", (double)kernel->everything);
    cJSON_AddItemToArray(list, object);
    return TURNER_OK;
}
