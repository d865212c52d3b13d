/* What the files json_*.c share: values with their way from the root, tables of keys, names.
 *
 * Each kind of object in a scene file has one static table of its keys. json_read_object walks it:
 * it refuses unknown, doubled and missing keys, checks type and range, and writes the numbers
 * where the table says. What a table cannot say is left to the caller (JSON_ANY). */
#ifndef TURNER_SCENE_JSON_H
#define TURNER_SCENE_JSON_H

#include <cjson/cJSON.h>

#include "scene/json_text.h"
#include "scene/scene.h"

#define JSON_MAX_KEYS 20  /* in a table */
#define JSON_MAX_NAME 255 /* bytes */

/* A value and how it was reached; `item` is NULL for a key that is absent. */
struct json_value {
    const struct json_value *parent; /* NULL at the root */
    const cJSON *item;
    size_t index; /* among its siblings, for finding it in the text */
};

/* Names of one kind: first collected, then sorted, then found. */
struct json_name {
    const char *name;
    uint32_t index;
};

struct json_names {
    const char *kind; /* "material", for messages */
    struct json_name *sorted;
    size_t count;
};

struct json_reader {
    struct turner_scene *scene;
    const char *text, *path;
    size_t length;
    struct json_names materials, media, meshes, groups;
    struct turner_mesh *mesh_templates; /* one for each name in `meshes` */
    size_t primitive_count;
};

enum json_type {
    JSON_ANY, /* the caller reads it */
    JSON_NUMBER,
    JSON_INTEGER,   /* int */
    JSON_DEGREES,   /* in the file and in the range; radians in the struct */
    JSON_BOOLEAN,
    JSON_POINT,     /* struct turner_vec3 */
    JSON_DIRECTION, /* struct turner_vec3, unit */
    JSON_COLOR,     /* struct turner_vec3, channels ≥ 0 */
    JSON_CHOICE,    /* int, the place in `choices` */
    JSON_STRING     /* const char *, alive as long as the tree */
};

struct json_range {
    double lo, hi;
    bool open_lo, open_hi; /* the bound itself is outside */
};

#define JSON_UNBOUNDED {-HUGE_VAL, HUGE_VAL, false, false}
#define JSON_POSITIVE {0, HUGE_VAL, true, false}
#define JSON_NOT_NEGATIVE {0, HUGE_VAL, false, false}
#define JSON_FROM_TO(from, to) {from, to, false, false}
#define JSON_ABOVE_TO(above, to) {above, to, true, false}
#define JSON_BETWEEN(above, below) {above, below, true, true}
#define JSON_NO_RANGE {0, 0, false, false}

struct json_key {
    const char *name;
    enum json_type type;
    bool required;
    size_t offset;              /* of what it fills in the caller's struct */
    struct json_range range;    /* numbers, integers, degrees */
    const char *const *choices; /* choices; ends with NULL */
};

#define JSON_KEY(name, type, required, offset)                                                     \
    {name, type, required, offset, JSON_NO_RANGE, NULL}
#define JSON_KEY_IN(name, type, required, offset, range)                                           \
    {name, type, required, offset, range, NULL}
#define JSON_KEY_CHOICE(name, required, offset, choices)                                           \
    {name, JSON_CHOICE, required, offset, JSON_NO_RANGE, choices}
#define JSON_KEY_ANY(name, required) JSON_KEY(name, JSON_ANY, required, 0)

struct json_table {
    const char *what; /* "a material" */
    const struct json_key *keys;
    size_t count;
};

#define JSON_TABLE(what, keys) {what, keys, sizeof(keys) / sizeof *(keys)}

/* An object that has been read. */
struct json_object {
    struct json_value self;
    const struct json_table *table;
    struct json_value members[JSON_MAX_KEYS]; /* in the table's order */
};

/* Foreign text for a message: at most so many bytes with the NUL, in one line. */
#define JSON_QUOTE 64
void json_quote(char out[static JSON_QUOTE], const char *text);

/* ---- messages: "path:line:column: message (at $.way.to[0].it)" ---- */
enum turner_result json_fail(const struct json_reader *reader, const struct json_value *value,
                             const char *format, ...) TURNER_PRINTF(3, 4);
/* The same, pointing at the key. */
enum turner_result json_fail_key(const struct json_reader *reader, const struct json_value *value,
                                 const char *format, ...) TURNER_PRINTF(3, 4);
/* Puts the place before and the way after the message that a called function has left. */
enum turner_result json_fail_within(const struct json_reader *reader,
                                    const struct json_value *value);
/* The same of a function that was to read a file: what the machine lacks for it (TURNER_DEVICE)
 * stays that, and is no fault of the scene's. */
enum turner_result json_fail_file(const struct json_reader *reader,
                                  const struct json_value *value, enum turner_result result);

/* ---- reading one value; nothing is written on failure ---- */
enum turner_result json_read_number(double *out, const struct json_reader *reader,
                                    const struct json_value *value, struct json_range range);
enum turner_result json_read_numbers(double *out, size_t count, const struct json_reader *reader,
                                     const struct json_value *value);
enum turner_result json_read_integer(int *out, const struct json_reader *reader,
                                     const struct json_value *value, struct json_range range);
enum turner_result json_read_point(struct turner_vec3 *out, const struct json_reader *reader,
                                   const struct json_value *value);
enum turner_result json_read_direction(struct turner_vec3 *out, const struct json_reader *reader,
                                       const struct json_value *value);
enum turner_result json_read_boolean(bool *out, const struct json_reader *reader,
                                     const struct json_value *value);
enum turner_result json_read_color(struct turner_vec3 *out, const struct json_reader *reader,
                                   const struct json_value *value);
enum turner_result json_read_string(const char **out, const struct json_reader *reader,
                                    const struct json_value *value);
enum turner_result json_read_choice(int *out, const struct json_reader *reader,
                                    const struct json_value *value, const char *const *choices);

/* ---- objects and lists ---- */

/* Fills `object`, and `out` by the table's offsets; absent keys leave `out` as it was. */
enum turner_result json_read_object(struct json_object *object, void *out,
                                    const struct json_reader *reader,
                                    const struct json_value *value, const struct json_table *table);

/* The member, or NULL if it is absent. The key must be in the table. */
const struct json_value *json_member(const struct json_object *object, const char *key);

/* The place among `types` (ends with NULL) of the object's member "type". */
enum turner_result json_read_type(int *kind, const struct json_reader *reader,
                                  const struct json_value *value, const char *const *types);

/* Which one of `keys` (ends with NULL) the object has; none or more than one is an error. */
enum turner_result json_one_of(int *which, const struct json_reader *reader,
                               const struct json_object *object, const char *const *keys);

/* TURNER_BAD_INPUT unless the value is a list (an object) of at most `limit` things, which are
 * counted. */
enum turner_result json_expect_list(size_t *count, const struct json_reader *reader,
                                    const struct json_value *value, size_t limit);
enum turner_result json_expect_object(size_t *count, const struct json_reader *reader,
                                      const struct json_value *value, size_t limit);

/* Goes through the elements of a list or the members of an object. Usage:
 * for (struct json_value e = json_first(v); e.item; e = json_next(e)) */
struct json_value json_first(const struct json_value *parent);
struct json_value json_next(struct json_value value);

/* ---- names ---- */

/* Takes the keys of an object (`value->item` may be NULL: no names); index is the place in it.
 * Fails on doubled, empty and too long names. */
enum turner_result json_collect_names(struct json_names *names, const struct json_reader *reader,
                                      const struct json_value *value, size_t limit);
enum turner_result json_find_name(uint32_t *index, const struct json_reader *reader,
                                  const struct json_value *value, const struct json_names *names);

/* On top of what `camera` holds; json_scene.c. */
enum turner_result json_read_camera(struct turner_camera *camera, struct json_reader *reader,
                                    const struct json_value *value);

/* ---- cJSON (json_parse.c) ---- */

/* The tree of a text that json_check_text has accepted (`values` from there), whatever the locale.
 * Free with cJSON_Delete. TURNER_DEVICE when memory does not suffice. */
enum turner_result json_parse(cJSON **tree, const char *text, size_t length, size_t values,
                              const char *path);

/* ---- parts of a scene, in the order they are read (json_material.c, json_mesh.c, json_shape.c,
 * json_light.c) ---- */
enum turner_result json_read_media(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_materials(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_meshes(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_world(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_groups(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_instances(struct json_reader *reader, const struct json_value *value);
enum turner_result json_read_lights(struct json_reader *reader, const struct json_value *value);

/* The picture whose file name `value` is; an index into scene->texture_images. */
enum turner_result json_read_texture(uint32_t *image, struct json_reader *reader,
                                     const struct json_value *value);

/* The path of the file that `value` names, to be freed. */
enum turner_result json_read_file_name(char **path, const struct json_reader *reader,
                                       const struct json_value *value);

/* Fails at `value` when the scene's primitives and `more` go beyond the limit. */
enum turner_result json_count_primitives(struct json_reader *reader,
                                         const struct json_value *value, size_t more);

/* The mesh of a mesh primitive; its material is left 0. Half-built or zeroed on failure. */
enum turner_result json_use_mesh(struct turner_mesh *mesh, struct json_reader *reader,
                                 const struct json_object *object);

/* ---- the tables, for reading and for comparing scenes/schema.json with what is read ---- */
extern const struct json_table json_table_scene, json_table_settings, json_table_methods,
    json_table_camera;
extern const struct json_table json_tables_background[3], json_tables_light[3];
extern const struct json_table json_table_medium, json_table_material, json_tables_pattern[2];
extern const struct json_table json_table_mesh, json_tables_primitive[6];
extern const struct json_table json_table_instance, json_table_transform;

#endif
