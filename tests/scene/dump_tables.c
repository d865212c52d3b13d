/* Prints the reader's tables of keys as JSON, for check_schema.py to compare with the schema; with
 * arguments, reads these scene files instead and prints a line for each: "ok" or the message. */
#include <stdio.h>
#include <stdlib.h>

#include "scene/json.h"
#include "scene/readers.h"

static cJSON *dump_key(const struct json_key *key)
{
    static const char *const types[] = {
        [JSON_ANY] = "any",         [JSON_NUMBER] = "number",   [JSON_INTEGER] = "integer",
        [JSON_DEGREES] = "number",  [JSON_BOOLEAN] = "boolean", [JSON_POINT] = "point",
        [JSON_DIRECTION] = "direction", [JSON_COLOR] = "color", [JSON_CHOICE] = "choice",
        [JSON_STRING] = "string",
    };
    cJSON *out = cJSON_CreateObject();
    cJSON_AddStringToObject(out, "type", types[key->type]);
    cJSON_AddBoolToObject(out, "required", key->required);
    if (key->type == JSON_NUMBER || key->type == JSON_INTEGER || key->type == JSON_DEGREES) {
        if (isfinite(key->range.lo))
            cJSON_AddNumberToObject(out, key->range.open_lo ? "exclusiveMinimum" : "minimum",
                                    key->range.lo);
        if (isfinite(key->range.hi))
            cJSON_AddNumberToObject(out, key->range.open_hi ? "exclusiveMaximum" : "maximum",
                                    key->range.hi);
    }
    if (key->choices) {
        cJSON *choices = cJSON_AddArrayToObject(out, "choices");
        for (size_t i = 0; key->choices[i]; i++)
            cJSON_AddItemToArray(choices, cJSON_CreateString(key->choices[i]));
    }
    return out;
}

static void dump_tables(cJSON *out, const struct json_table *tables, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        cJSON *table = cJSON_AddObjectToObject(out, tables[i].what);
        for (size_t j = 0; j < tables[i].count; j++)
            cJSON_AddItemToObject(table, tables[i].keys[j].name, dump_key(&tables[i].keys[j]));
    }
}

static int read_files(char **paths)
{
    for (; *paths; paths++) {
        struct turner_scene *scene;
        enum turner_result result = turner_scene_load(&scene, *paths);
        printf("%s\n", result == TURNER_OK ? "ok" : turner_message());
        turner_scene_destroy(scene);
    }
    return EXIT_SUCCESS;
}

int main(int argc, char **argv)
{
    if (argc > 1)
        return read_files(argv + 1);
    cJSON *out = cJSON_CreateObject();
    dump_tables(out, &json_table_scene, 1);
    dump_tables(out, &json_table_settings, 1);
    dump_tables(out, &json_table_methods, 1);
    dump_tables(out, &json_table_camera, 1);
    dump_tables(out, json_tables_background, 3);
    dump_tables(out, &json_table_medium, 1);
    dump_tables(out, &json_table_material, 1);
    dump_tables(out, json_tables_pattern, 2);
    dump_tables(out, &json_table_mesh, 1);
    dump_tables(out, json_tables_primitive, 6);
    dump_tables(out, &json_table_instance, 1);
    dump_tables(out, &json_table_transform, 1);
    dump_tables(out, json_tables_light, 3);
    char *text = cJSON_Print(out);
    puts(text);
    cJSON_free(text);
    cJSON_Delete(out);
    return EXIT_SUCCESS;
}
