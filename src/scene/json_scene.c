/* The root of a scene file, and what stands there once: settings, camera, background. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/methods.h"
#include "scene/readers.h"

static const char *const shadings[] = {"phong", "energy_conserving", NULL};
static const char *const shadow_kinds[] = {"opaque", "tinted", NULL};
static const char *const transfers[] = {"srgb", "linear", NULL};

/* ---- settings ---- */

#define SETTING(member) offsetof(struct turner_settings, member)

static const struct json_key settings_keys[] = {
    JSON_KEY_ANY("size", false),
    JSON_KEY_IN("depth", JSON_INTEGER, false, SETTING(depth), JSON_FROM_TO(0, TURNER_MAX_DEPTH)),
    JSON_KEY_IN("cutoff", JSON_NUMBER, false, SETTING(cutoff), JSON_NOT_NEGATIVE),
    JSON_KEY_IN("error", JSON_NUMBER, false, SETTING(error), JSON_NOT_NEGATIVE),
    JSON_KEY_IN("spp", JSON_INTEGER, false, SETTING(spp), JSON_FROM_TO(1, TURNER_MAX_SPP)),
    JSON_KEY_CHOICE("shading", false, SETTING(shading), shadings),
    JSON_KEY_CHOICE("shadows", false, SETTING(shadows), shadow_kinds),
    JSON_KEY_IN("exposure", JSON_NUMBER, false, SETTING(exposure), JSON_UNBOUNDED),
    JSON_KEY_CHOICE("transfer", false, SETTING(transfer), transfers),
    JSON_KEY("spd_rays", JSON_BOOLEAN, false, SETTING(spd_rays)),
    JSON_KEY("spd_grid", JSON_BOOLEAN, false, SETTING(spd_grid)),
    JSON_KEY_ANY("methods", false),
};
const struct json_table json_table_settings = JSON_TABLE("settings", settings_keys);

/* `depth` and `cutoff` have keys of their own above. */
static const struct json_key methods_keys[] = {
    JSON_KEY_ANY("sphere", false),         JSON_KEY_ANY("triangle", false),
    JSON_KEY_ANY("offset", false),         JSON_KEY_ANY("fresnel_cosine", false),
    JSON_KEY_ANY("fresnel", false),        JSON_KEY_ANY("schlick_side", false),
    JSON_KEY_ANY("precision", false),      JSON_KEY_ANY("aa", false),
    JSON_KEY_ANY("traversal", false),
};
const struct json_table json_table_methods = JSON_TABLE("methods", methods_keys);

static enum turner_result read_methods(struct json_reader *reader, const struct json_value *value)
{
    struct turner_settings *settings = &reader->scene->settings;
    struct json_object object;
    TURNER_TRY(json_read_object(&object, NULL, reader, value, &json_table_methods));
    for (size_t i = 0; i < object.table->count; i++) {
        const char *name = object.table->keys[i].name, *text;
        const struct json_value *member = json_member(&object, name);
        if (!member)
            continue;
        TURNER_TRY(json_read_string(&text, reader, member));
        if (turner_method_set(settings, name, text) != TURNER_OK)
            return json_fail_within(reader, member);
    }
    return TURNER_OK;
}

static enum turner_result read_settings(struct json_reader *reader, const struct json_value *value)
{
    struct turner_settings *settings = &reader->scene->settings;
    struct json_object object;
    TURNER_TRY(json_read_object(&object, settings, reader, value, &json_table_settings));
    settings->depth_asked = json_member(&object, "depth") != NULL;
    const struct json_value *size = json_member(&object, "size");
    if (size) {
        const struct json_range range = JSON_FROM_TO(1, TURNER_MAX_SIZE);
        double unused[2];
        TURNER_TRY(json_read_numbers(unused, 2, reader, size));
        struct json_value width = json_first(size), height = json_next(width);
        TURNER_TRY(json_read_integer(&settings->width, reader, &width, range));
        TURNER_TRY(json_read_integer(&settings->height, reader, &height, range));
    }
    const struct json_value *methods = json_member(&object, "methods");
    if (methods)
        TURNER_TRY(read_methods(reader, methods));
    const struct json_value *grid = json_member(&object, "spd_grid");
    if (settings->spd_grid && settings->height <= 2)
        return json_fail(reader, grid, "\"spd_grid\" needs a picture of at least 3 rows");
    return TURNER_OK;
}

/* ---- camera ---- */

#define CAMERA(member) offsetof(struct turner_camera, member)

static const struct json_key camera_keys[] = {
    JSON_KEY("from", JSON_POINT, true, CAMERA(from)),
    JSON_KEY("at", JSON_POINT, true, CAMERA(at)),
    JSON_KEY("up", JSON_DIRECTION, false, CAMERA(up)),
    JSON_KEY_IN("vfov", JSON_DEGREES, false, CAMERA(vfov), JSON_BETWEEN(0, 180)),
    JSON_KEY_ANY("inside", false),
};
const struct json_table json_table_camera = JSON_TABLE("a camera", camera_keys);

enum turner_result json_read_camera(struct turner_camera *camera, struct json_reader *reader,
                                    const struct json_value *value)
{
    struct json_object object;
    TURNER_TRY(json_read_object(&object, camera, reader, value, &json_table_camera));
    const struct json_value *inside = json_member(&object, "inside");
    const struct json_value *up = json_member(&object, "up");
    switch (turner_camera_check(camera)) {
    case TURNER_CAMERA_GOOD:
        break;
    case TURNER_CAMERA_NO_DIRECTION:
        return json_fail(reader, json_member(&object, "at"),
                         "\"at\" is where \"from\" is; the camera has no direction");
    case TURNER_CAMERA_UP_PARALLEL:
        return json_fail(reader, up ? up : &object.self, "\"up\" %slies along the view; choose "
                         "another", up ? "" : "(0, 1, 0 by default) ");
    }
    if (!inside)
        return TURNER_OK;
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, inside, TURNER_MEDIA_NESTING));
    for (struct json_value e = json_first(inside); e.item; e = json_next(e))
        TURNER_TRY(json_find_name(&camera->inside[e.index], reader, &e, &reader->media));
    camera->inside_count = (uint32_t)count;
    return TURNER_OK;
}

static enum turner_result read_camera(struct json_reader *reader, const struct json_value *value)
{
    return json_read_camera(&reader->scene->camera, reader, value);
}

static enum turner_result read_cameras(struct json_reader *reader, const struct json_value *value)
{
    struct turner_scene *scene = reader->scene;
    const struct turner_camera plain = {.up = {0, 1, 0}, .vfov = scene->camera.vfov};
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_CAMERAS));
    scene->cameras = turner_calloc(count, sizeof *scene->cameras);
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct turner_camera *camera = &scene->cameras[scene->camera_count];
        *camera = plain;
        TURNER_TRY(json_read_camera(camera, reader, &e));
        scene->camera_count++;
    }
    return TURNER_OK;
}

/* ---- background ---- */

struct background_json {
    struct turner_background background;
    const char *file;
};

#define BACKGROUND(member) offsetof(struct background_json, member)

static const char *const background_types[] = {"constant", "gradient", "environment", NULL};
static const struct json_key constant_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("color", JSON_COLOR, true, BACKGROUND(background.color)),
};
static const struct json_key gradient_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("bottom", JSON_COLOR, true, BACKGROUND(background.color)),
    JSON_KEY("top", JSON_COLOR, true, BACKGROUND(background.top)),
    JSON_KEY("up", JSON_DIRECTION, false, BACKGROUND(background.up)),
};
static const struct json_key environment_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("file", JSON_STRING, true, BACKGROUND(file)),
    JSON_KEY_IN("rotation", JSON_DEGREES, false, BACKGROUND(background.rotation), JSON_UNBOUNDED),
    JSON_KEY("scale", JSON_COLOR, false, BACKGROUND(background.scale)),
};
const struct json_table json_tables_background[3] = {
    JSON_TABLE("a constant background", constant_keys),
    JSON_TABLE("a gradient background", gradient_keys),
    JSON_TABLE("an environment background", environment_keys),
};

static enum turner_result read_background(struct json_reader *reader,
                                          const struct json_value *value)
{
    struct background_json b = {.background = reader->scene->background};
    if (!cJSON_IsObject(value->item)) {
        TURNER_TRY(json_read_color(&b.background.color, reader, value));
        reader->scene->background = b.background;
        return TURNER_OK;
    }
    int kind;
    TURNER_TRY(json_read_type(&kind, reader, value, background_types));
    struct json_object object;
    TURNER_TRY(json_read_object(&object, &b, reader, value, &json_tables_background[kind]));
    static const enum turner_background_kind kinds[] = {
        TURNER_BACKGROUND_CONSTANT, TURNER_BACKGROUND_GRADIENT, TURNER_BACKGROUND_ENVIRONMENT};
    b.background.kind = kinds[kind];
    if (b.file)
        TURNER_TRY(json_read_texture(&b.background.image, reader, json_member(&object, "file")));
    reader->scene->background = b.background;
    return TURNER_OK;
}

/* ---- params ---- */

/* Any names: the shaders know which there are. Values are kept as the command line writes them. */
static enum turner_result read_param(struct json_reader *reader, const struct json_value *value)
{
    char text[128];
    const char *string = text;
    double n[3];
    if (cJSON_IsString(value->item)) {
        TURNER_TRY(json_read_string(&string, reader, value));
    } else if (cJSON_IsBool(value->item)) {
        snprintf(text, sizeof text, "%s", cJSON_IsTrue(value->item) ? "true" : "false");
    } else if (cJSON_IsNumber(value->item)) {
        TURNER_TRY(json_read_number(n, reader, value, (struct json_range)JSON_UNBOUNDED));
        snprintf(text, sizeof text, "%.17g", n[0]);
    } else if (cJSON_IsArray(value->item)) {
        TURNER_TRY(json_read_numbers(n, 3, reader, value));
        snprintf(text, sizeof text, "%.17g,%.17g,%.17g", n[0], n[1], n[2]);
    } else {
        return json_fail(reader, value, "a parameter's value is a number, true or false, a string, "
                                        "or a colour [r, g, b]");
    }
    turner_scene_set_param(reader->scene, value->item->string, string);
    return TURNER_OK;
}

static enum turner_result read_params(struct json_reader *reader, const struct json_value *value)
{
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, value, 1024));
    for (struct json_value m = json_first(value); m.item; m = json_next(m))
        TURNER_TRY(read_param(reader, &m));
    return TURNER_OK;
}

/* ---- the root ---- */

struct scene_json {
    const char *description, *shaders;
    struct turner_vec3 ambient;
};

static const struct json_key scene_keys[] = {
    JSON_KEY_ANY("$schema", false),
    JSON_KEY_ANY("version", true),
    JSON_KEY("description", JSON_STRING, false, offsetof(struct scene_json, description)),
    JSON_KEY("shaders", JSON_STRING, false, offsetof(struct scene_json, shaders)),
    JSON_KEY_ANY("params", false),
    JSON_KEY_ANY("settings", false),
    JSON_KEY_ANY("camera", true),
    JSON_KEY_ANY("cameras", false),
    JSON_KEY("ambient", JSON_COLOR, false, offsetof(struct scene_json, ambient)),
    JSON_KEY_ANY("background", false),
    JSON_KEY_ANY("media", false),
    JSON_KEY_ANY("materials", false),
    JSON_KEY_ANY("meshes", false),
    JSON_KEY_ANY("primitives", false),
    JSON_KEY_ANY("groups", false),
    JSON_KEY_ANY("instances", false),
    JSON_KEY_ANY("lights", false),
};
const struct json_table json_table_scene = JSON_TABLE("a scene", scene_keys);

/* First of all, so that a file of another version is not blamed for its keys. */
static enum turner_result check_version(const struct json_reader *reader,
                                        const struct json_value *root)
{
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, root, SIZE_MAX));
    for (struct json_value m = json_first(root); m.item; m = json_next(m)) {
        if (strcmp(m.item->string, "version") != 0)
            continue;
        int version;
        TURNER_TRY(json_read_integer(&version, reader, &m,
                                     (struct json_range)JSON_FROM_TO(1, HUGE_VAL)));
        if (version != 1)
            return json_fail(reader, &m, "version %d is not known; this turner reads version 1",
                             version);
        return TURNER_OK;
    }
    return json_fail(reader, root, "missing key \"version\" of a scene; write \"version\": 1");
}

/* A depth above TURNER_MAX_BRANCH_DEPTH is for scenes whose rays never split. */
static enum turner_result check_depth(const struct json_reader *reader,
                                      const struct json_object *root)
{
    const struct turner_scene *scene = reader->scene;
    if (scene->settings.depth <= TURNER_MAX_BRANCH_DEPTH)
        return TURNER_OK;
    for (size_t i = 0; i < scene->material_count; i++) {
        if (!turner_material_branches(&scene->materials[i], &scene->settings))
            continue;
        struct json_value m = json_first(json_member(root, "settings"));
        while (strcmp(m.item->string, "depth") != 0)
            m = json_next(m);
        char quoted[JSON_QUOTE];
        json_quote(quoted, scene->materials[i].name);
        return json_fail(reader, &m, "depth %d is too much where a material both reflects and "
                         "transmits, as \"%s\" does; %d is the limit then",
                         scene->settings.depth, quoted, TURNER_MAX_BRANCH_DEPTH);
    }
    return TURNER_OK;
}

static enum turner_result read_scene(struct json_reader *reader, const struct json_value *root)
{
    struct turner_scene *scene = reader->scene;
    TURNER_TRY(check_version(reader, root));
    struct scene_json s = {0};
    struct json_object object;
    TURNER_TRY(json_read_object(&object, &s, reader, root, &json_table_scene));
    scene->description = s.description ? turner_strdup(s.description) : NULL;
    scene->shaders = s.shaders ? turner_path_beside(reader->path, s.shaders) : NULL;
    scene->ambient = s.ambient;

    const struct json_value *media = json_member(&object, "media");
    const struct json_value *materials = json_member(&object, "materials");
    const struct json_value *meshes = json_member(&object, "meshes");
    const struct json_value *groups = json_member(&object, "groups");
    TURNER_TRY(json_collect_names(&reader->media, reader, media, TURNER_MAX_MEDIA));
    TURNER_TRY(json_collect_names(&reader->materials, reader, materials, TURNER_MAX_MATERIALS));
    TURNER_TRY(json_collect_names(&reader->meshes, reader, meshes, TURNER_MAX_INSTANCES));
    TURNER_TRY(json_collect_names(&reader->groups, reader, groups, TURNER_MAX_INSTANCES));

    static const struct {
        const char *key;
        enum turner_result (*read)(struct json_reader *reader, const struct json_value *value);
    } parts[] = {
        {"params", read_params},             {"settings", read_settings},
        {"media", json_read_media},
        {"cameras", read_cameras}, /* before the camera, so that they have the same defaults */
        {"camera", read_camera},
        {"background", read_background},     {"materials", json_read_materials},
        {"meshes", json_read_meshes},        {"primitives", json_read_world},
        {"groups", json_read_groups},        {"instances", json_read_instances},
        {"lights", json_read_lights},
    };
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const struct json_value *value = json_member(&object, parts[i].key);
        if (value)
            TURNER_TRY(parts[i].read(reader, value));
    }
    return check_depth(reader, &object);
}

enum turner_result turner_scene_read_json(struct turner_scene *scene, const char *text,
                                          size_t length, const char *path)
{
    size_t start, values;
    TURNER_TRY(json_check_text(&start, &values, text, length, path));
    cJSON *tree;
    TURNER_TRY(json_parse(&tree, text + start, length - start, values, path));

    struct json_reader reader = {
        .scene = scene,
        .text = text,
        .length = length,
        .path = path,
        .materials = {.kind = "material"},
        .media = {.kind = "medium"},
        .meshes = {.kind = "mesh"},
        .groups = {.kind = "group"},
    };
    struct json_value root = {.item = tree};
    enum turner_result result = read_scene(&reader, &root);
    for (size_t i = 0; reader.mesh_templates && i < reader.meshes.count; i++)
        turner_mesh_destroy(&reader.mesh_templates[i]);
    free(reader.mesh_templates);
    free(reader.materials.sorted);
    free(reader.media.sorted);
    free(reader.meshes.sorted);
    free(reader.groups.sorted);
    cJSON_Delete(tree);
    return result;
}
