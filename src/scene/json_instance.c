/* Instances: of which group, where, and many at once from a file of matrices. */
#include <stdlib.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/readers.h"

/* ---- transforms ---- */

struct transform_json {
    struct turner_vec3 translate, axis;
    double angle;
};

#define TRANSFORM(member) offsetof(struct transform_json, member)

static const struct json_key transform_keys[] = {
    JSON_KEY("translate", JSON_POINT, false, TRANSFORM(translate)),
    JSON_KEY_ANY("scale", false),
    JSON_KEY_IN("rotate", JSON_DEGREES, false, TRANSFORM(angle), JSON_UNBOUNDED),
    JSON_KEY("axis", JSON_DIRECTION, false, TRANSFORM(axis)),
    JSON_KEY_ANY("matrix", false),
};
const struct json_table json_table_transform = JSON_TABLE("a transform", transform_keys);

/* Rodrigues' formula; right-handed about the unit axis. */
static struct turner_affine rotation(struct turner_vec3 a, double angle)
{
    double c = cos(angle), s = sin(angle), t = 1 - c;
    return (struct turner_affine){{
        {t * a.x * a.x + c, t * a.x * a.y - s * a.z, t * a.x * a.z + s * a.y, 0},
        {t * a.x * a.y + s * a.z, t * a.y * a.y + c, t * a.y * a.z - s * a.x, 0},
        {t * a.x * a.z - s * a.y, t * a.y * a.z + s * a.x, t * a.z * a.z + c, 0},
    }};
}

static enum turner_result read_scale(struct turner_affine *step, const struct json_reader *reader,
                                     const struct json_value *value)
{
    double s[3];
    if (cJSON_IsNumber(value->item)) {
        TURNER_TRY(json_read_number(&s[0], reader, value, (struct json_range)JSON_UNBOUNDED));
        s[1] = s[2] = s[0];
    } else {
        TURNER_TRY(json_read_numbers(s, 3, reader, value));
    }
    for (int i = 0; i < 3; i++)
        step->m[i][i] = s[i];
    return TURNER_OK;
}

static enum turner_result read_step(struct turner_affine *step, const struct json_reader *reader,
                                    const struct json_value *value)
{
    static const char *const kinds[] = {"translate", "scale", "rotate", "matrix", NULL};
    struct transform_json t = {0};
    struct json_object object;
    int kind;
    TURNER_TRY(json_read_object(&object, &t, reader, value, &json_table_transform));
    TURNER_TRY(json_one_of(&kind, reader, &object, kinds));
    const struct json_value *axis = json_member(&object, "axis");
    const struct json_value *given = json_member(&object, kinds[kind]);
    if (axis && kind != 2)
        return json_fail_key(reader, axis, "\"axis\" goes with \"rotate\"");
    if (!axis && kind == 2)
        return json_fail(reader, value, "missing key \"axis\" of a rotation");
    *step = TURNER_AFFINE_IDENTITY;
    switch (kind) {
    case 0:
        step->m[0][3] = t.translate.x;
        step->m[1][3] = t.translate.y;
        step->m[2][3] = t.translate.z;
        break;
    case 1:
        TURNER_TRY(read_scale(step, reader, given));
        break;
    case 2:
        *step = rotation(t.axis, t.angle);
        break;
    default:
        TURNER_TRY(json_read_numbers(step->m[0], 12, reader, given));
        break;
    }
    if (!turner_affine_usable(step))
        return json_fail(reader, given, "this flattens space (its determinant is 0)");
    return TURNER_OK;
}

static enum turner_result read_transform(struct turner_affine *transform,
                                         const struct json_reader *reader,
                                         const struct json_value *value)
{
    if (cJSON_IsObject(value->item))
        return read_step(transform, reader, value);
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, SIZE_MAX));
    *transform = TURNER_AFFINE_IDENTITY;
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct turner_affine step;
        TURNER_TRY(read_step(&step, reader, &e));
        *transform = turner_affine_multiply(&step, transform);
    }
    if (!turner_affine_usable(transform))
        return json_fail(reader, value,
                         "together these steps flatten space or leave the range of "
                         "numbers");
    return TURNER_OK;
}

/* ---- instances ---- */

static const struct json_key instance_keys[] = {
    JSON_KEY_ANY("group", true),
    JSON_KEY_ANY("transform", false),
    JSON_KEY_ANY("transforms", false),
    JSON_KEY_ANY("material", false),
};
const struct json_table json_table_instance = JSON_TABLE("an instance", instance_keys);

/* As many instances like `like` as the file that `value` names has transforms. */
static enum turner_result read_many(struct json_reader *reader, const struct turner_instance *like,
                                    const struct json_value *value)
{
    char *path;
    TURNER_TRY(json_read_file_name(&path, reader, value));
    enum turner_result result = turner_scene_add_instances(reader->scene, like, path);
    free(path);
    return result == TURNER_OK ? result : json_fail_file(reader, value, result);
}

static enum turner_result read_instance(struct json_reader *reader, const struct json_value *value)
{
    struct turner_scene *scene = reader->scene;
    struct turner_instance instance = {.material = TURNER_NONE,
                                       .transform = TURNER_AFFINE_IDENTITY};
    struct json_object object;
    TURNER_TRY(json_read_object(&object, NULL, reader, value, &json_table_instance));
    const struct json_value *transform = json_member(&object, "transform");
    const struct json_value *transforms = json_member(&object, "transforms");
    const struct json_value *material = json_member(&object, "material");
    TURNER_TRY(
        json_find_name(&instance.group, reader, json_member(&object, "group"), &reader->groups));
    instance.group++; /* group 0 is the world */
    if (material)
        TURNER_TRY(json_find_name(&instance.material, reader, material, &reader->materials));
    if (transform && transforms)
        return json_fail_key(reader, transforms,
                             "an instance has only one of \"transform\" and "
                             "\"transforms\"");
    if (transforms)
        return read_many(reader, &instance, transforms);
    if (transform)
        TURNER_TRY(read_transform(&instance.transform, reader, transform));
    if (scene->instance_count == TURNER_MAX_INSTANCES)
        return json_fail(reader, value, "more than %u instances", TURNER_MAX_INSTANCES);
    *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) = instance;
    return TURNER_OK;
}

enum turner_result json_read_instances(struct json_reader *reader, const struct json_value *value)
{
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_INSTANCES));
    for (struct json_value e = json_first(value); e.item; e = json_next(e))
        TURNER_TRY(read_instance(reader, &e));
    return TURNER_OK;
}
