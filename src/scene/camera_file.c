#include "scene/camera_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/atomic.h"
#include "scene/json.h"
#include "scene/readers.h"

#define DEGREE (3.14159265358979323846 / 180)

/* ---- text that grows ---- */

struct text {
    char *bytes;
    size_t length, capacity;
};

static void add_bytes(struct text *text, const char *bytes, size_t length)
{
    if (text->length + length + 1 > text->capacity) {
        text->capacity = 2 * (text->length + length + 64);
        text->bytes = turner_realloc(text->bytes, text->capacity, 1);
    }
    memcpy(text->bytes + text->length, bytes, length);
    text->length += length;
    text->bytes[text->length] = 0;
}

static void add(struct text *text, const char *string)
{
    add_bytes(text, string, strlen(string));
}

/* With as few digits as are read back the same. */
static void add_number(struct text *text, double value)
{
    char digits[40];
    for (int count = 6; count <= 17; count++) {
        snprintf(digits, sizeof digits, "%.*g", count, value);
        if (strtod(digits, NULL) == value)
            break;
    }
    add(text, digits);
}

/* An angle whose radians are the same when it is read. */
static void add_degrees(struct text *text, double radians)
{
    char digits[40];
    for (int count = 4; count <= 17; count++) {
        snprintf(digits, sizeof digits, "%.*g", count, radians / DEGREE);
        if (fabs(strtod(digits, NULL) * DEGREE - radians) <= 4e-16 * radians)
            break;
    }
    add(text, digits);
}

static void add_point(struct text *text, struct turner_vec3 v)
{
    add(text, "[");
    add_number(text, v.x);
    add(text, ", ");
    add_number(text, v.y);
    add(text, ", ");
    add_number(text, v.z);
    add(text, "]");
}

static void add_inside(struct text *text, const struct turner_camera *camera,
                       const struct turner_scene *scene)
{
    add(text, ", \"inside\": [");
    for (uint32_t i = 0; i < camera->inside_count; i++) {
        const char *name = scene->media[camera->inside[i]].name;
        cJSON *string = cJSON_CreateString(name ? name : "");
        char *quoted = cJSON_PrintUnformatted(string);
        add(text, i ? ", " : "");
        add(text, quoted);
        free(quoted);
        cJSON_Delete(string);
    }
    add(text, "]");
}

char *turner_camera_json(const struct turner_camera *camera, const struct turner_scene *scene)
{
    struct text text = {0};
    add(&text, "{ \"from\": ");
    add_point(&text, camera->from);
    add(&text, ", \"at\": ");
    add_point(&text, camera->at);
    add(&text, ", \"up\": ");
    add_point(&text, camera->up);
    add(&text, ", \"vfov\": ");
    add_degrees(&text, camera->vfov);
    if (camera->inside_count)
        add_inside(&text, camera, scene);
    add(&text, " }");
    return text.bytes;
}

/* ---- into a scene file ---- */

static enum turner_result read_file(struct text *text, const char *path)
{
    char piece[65536];
    FILE *file = fopen(path, "rb");
    if (!file)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read", path);
    add(text, "");
    for (size_t got; (got = fread(piece, 1, sizeof piece, file)) > 0;)
        add_bytes(text, piece, got);
    bool failed = ferror(file) != 0;
    fclose(file);
    if (failed || text->length > TURNER_MAX_FILE_BYTES)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read", path);
    return TURNER_OK;
}

/* A camera object in the text: the place of each member and its index. */
struct place {
    size_t indices[3];
    size_t depth; /* of indices that lead to the camera */
    const cJSON *camera;
};

static const cJSON *member(const cJSON *object, const char *name, size_t *index)
{
    *index = 0;
    for (const cJSON *m = object ? object->child : NULL; m; m = m->next, ++*index) {
        if (m->string && strcmp(m->string, name) == 0)
            return m;
    }
    return NULL;
}

static enum turner_result find_camera(struct place *place, const cJSON *root, int number,
                                      const char *path)
{
    const char *key = number ? "cameras" : "camera";
    const cJSON *found = cJSON_IsObject(root) ? member(root, key, &place->indices[0]) : NULL;
    place->depth = 1;
    if (found && number) {
        place->indices[place->depth++] = (size_t)number - 1;
        found = cJSON_IsArray(found) ? cJSON_GetArrayItem(found, number - 1) : NULL;
    }
    place->camera = found;
    return cJSON_IsObject(found)
               ? TURNER_OK
               : turner_fail(TURNER_BAD_INPUT, "%s: there is no camera %d in it", path, number);
}

static bool same_point(const cJSON *list, struct turner_vec3 v)
{
    double values[3] = {v.x, v.y, v.z};
    for (int i = 0; i < 3; i++) {
        const cJSON *item = cJSON_GetArrayItem(list, i);
        if (!cJSON_IsNumber(item) || item->valuedouble != values[i])
            return false;
    }
    return cJSON_GetArraySize(list) == 3;
}

/* Directions are made unit vectors when they are read. */
static bool same_direction(const cJSON *list, struct turner_vec3 v)
{
    double values[3] = {0, 1, 0};
    for (int i = 0; list && i < 3; i++) {
        const cJSON *item = cJSON_GetArrayItem(list, i);
        values[i] = cJSON_IsNumber(item) ? item->valuedouble : 0;
    }
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_of(values[0], values[1], values[2]));
    return turner_vec3_length(turner_vec3_sub(w, turner_vec3_normalize(v))) < 1e-12;
}

static bool same_angle(const cJSON *number, double radians)
{
    double degrees = cJSON_IsNumber(number) ? number->valuedouble : 40;
    return fabs(degrees * DEGREE - radians) <= 1e-12 * radians;
}

/* What is to stand in the place of a member, or to be added to the object. */
struct change {
    const char *name;
    struct text value; /* empty: as it is */
    size_t begin, end; /* of the old value; 0, 0: there is none */
};

enum { CHANGES = 4 };

static void find_changes(struct change changes[CHANGES], struct place *place, const char *text,
                         size_t length, const struct turner_camera *camera)
{
    static const char *const names[CHANGES] = {"from", "at", "up", "vfov"};
    for (int i = 0; i < CHANGES; i++) {
        struct change *change = &changes[i];
        const cJSON *old = member(place->camera, names[i], &place->indices[place->depth]);
        *change = (struct change){.name = names[i]};
        if (i < 2 && !(old && same_point(old, i ? camera->at : camera->from)))
            add_point(&change->value, i ? camera->at : camera->from);
        if (i == 2 && !same_direction(old, camera->up))
            add_point(&change->value, camera->up);
        if (i == 3 && !same_angle(old, camera->vfov))
            add_degrees(&change->value, camera->vfov);
        if (!old)
            continue;
        change->begin = json_locate(text, length, place->indices, place->depth + 1, false);
        change->end = json_end(text, length, change->begin);
    }
}

/* In the order of the text. */
static int by_place(const void *a, const void *b)
{
    const struct change *x = a, *y = b;
    return x->begin < y->begin ? -1 : x->begin > y->begin;
}

static void apply(struct text *out, struct change changes[CHANGES], const struct text *in,
                  const struct place *place)
{
    size_t at = 0, begin = json_locate(in->bytes, in->length, place->indices, place->depth, false);
    size_t end = json_end(in->bytes, in->length, begin) - 1; /* the closing brace */
    qsort(changes, CHANGES, sizeof *changes, by_place);
    for (int i = 0; i < CHANGES; i++) {
        if (!changes[i].value.length || !changes[i].end)
            continue;
        add_bytes(out, in->bytes + at, changes[i].begin - at);
        add(out, changes[i].value.bytes);
        at = changes[i].end;
    }
    while (end > at && strchr(" \t\r\n", in->bytes[end - 1]))
        end--;
    add_bytes(out, in->bytes + at, end - at);
    for (int i = 0; i < CHANGES; i++) {
        if (!changes[i].value.length || changes[i].end)
            continue;
        add(out, in->bytes[end - 1] == '{' ? " \"" : ", \"");
        add(out, changes[i].name);
        add(out, "\": ");
        add(out, changes[i].value.bytes);
    }
    add_bytes(out, in->bytes + end, in->length - end);
}

enum turner_result turner_camera_store(const char *path, int number,
                                       const struct turner_camera *camera)
{
    struct text in = {0}, out = {0};
    struct change changes[CHANGES] = {{0}};
    struct place place = {0};
    cJSON *tree = NULL;
    size_t start, values;
    enum turner_result result;
    TURNER_TRY_DONE(read_file(&in, path));
    TURNER_TRY_DONE(json_check_text(&start, &values, in.bytes, in.length, path));
    TURNER_TRY_DONE(json_parse(&tree, in.bytes + start, in.length - start, values, path));
    TURNER_TRY_DONE(find_camera(&place, tree, number, path));
    find_changes(changes, &place, in.bytes, in.length, camera);
    apply(&out, changes, &in, &place);
    if (out.length != in.length || memcmp(out.bytes, in.bytes, in.length) != 0)
        result = turner_atomic_write(path, out.bytes, out.length);
done:
    for (int i = 0; i < CHANGES; i++)
        free(changes[i].value.bytes);
    cJSON_Delete(tree);
    free(in.bytes);
    free(out.bytes);
    return result;
}

/* ---- paths ---- */

struct path_json {
    int version;
    double rate;
};

static const struct json_key path_keys[] = {
    JSON_KEY_IN("version", JSON_INTEGER, true, offsetof(struct path_json, version),
                JSON_FROM_TO(1, 1)),
    JSON_KEY_IN("rate", JSON_NUMBER, false, offsetof(struct path_json, rate),
                JSON_ABOVE_TO(0, 1000)),
    JSON_KEY_ANY("cameras", true),
};
static const struct json_table json_table_path = JSON_TABLE("a path", path_keys);

static enum turner_result read_path(struct turner_camera_path *path, struct json_reader *reader,
                                    const struct json_value *root)
{
    struct path_json head = {1, 30};
    struct json_object object;
    TURNER_TRY(json_read_object(&object, &head, reader, root, &json_table_path));
    path->rate = head.rate;
    const struct json_value *list = json_member(&object, "cameras");
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, list, TURNER_PATH_CAMERAS));
    if (!count)
        return json_fail(reader, list, "a path has one camera at least");
    path->cameras = turner_calloc(count, sizeof *path->cameras);
    path->capacity = count;
    for (struct json_value e = json_first(list); e.item; e = json_next(e)) {
        struct turner_camera camera = reader->scene->camera;
        TURNER_TRY(json_read_camera(&camera, reader, &e));
        path->cameras[path->count++] = camera;
    }
    return TURNER_OK;
}

enum turner_result turner_camera_path_load(struct turner_camera_path *path, const char *file,
                                           const struct turner_scene *scene)
{
    *path = (struct turner_camera_path){0};
    struct turner_scene copy = *scene; /* shares all, and gets nothing */
    struct text text = {0};
    cJSON *tree = NULL;
    size_t start, values;
    enum turner_result result;
    TURNER_TRY_DONE(read_file(&text, file));
    TURNER_TRY_DONE(json_check_text(&start, &values, text.bytes, text.length, file));
    TURNER_TRY_DONE(json_parse(&tree, text.bytes + start, text.length - start, values, file));
    struct json_reader reader = {.scene = &copy, .text = text.bytes, .length = text.length,
                                 .path = file, .media = {.kind = "medium"}};
    struct json_value root = {.item = tree};
    result = read_path(path, &reader, &root);
done:
    if (result != TURNER_OK)
        turner_camera_path_destroy(path);
    cJSON_Delete(tree);
    free(text.bytes);
    return result;
}

enum turner_result turner_camera_path_write(const struct turner_camera_path *path,
                                            const char *file, const struct turner_scene *scene)
{
    struct text text = {0};
    add(&text, "{\n  \"version\": 1,\n  \"rate\": ");
    add_number(&text, path->rate);
    add(&text, ",\n  \"cameras\": [\n");
    for (size_t i = 0; i < path->count; i++) {
        struct turner_camera camera = path->cameras[i];
        camera.inside_count = 0;
        char *json = turner_camera_json(&camera, scene);
        add(&text, "    ");
        add(&text, json);
        add(&text, i + 1 < path->count ? ",\n" : "\n");
        free(json);
    }
    add(&text, "  ]\n}\n");
    enum turner_result result = turner_atomic_write(file, text.bytes, text.length);
    free(text.bytes);
    return result;
}

void turner_camera_path_destroy(struct turner_camera_path *path)
{
    free(path->cameras);
    *path = (struct turner_camera_path){0};
}
