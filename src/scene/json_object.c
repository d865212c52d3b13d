/* Objects by their table of keys, and names. */
#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/nearest.h"

static const char *key_word(const void *user, size_t i)
{
    return ((const struct json_table *)user)->keys[i].name;
}

static enum turner_result fail_unknown_key(const struct json_reader *reader,
                                           const struct json_value *member,
                                           const struct json_table *table)
{
    char quoted[JSON_QUOTE], known[512] = "";
    json_quote(quoted, member->item->string);
    const char *near = turner_nearest(member->item->string, table->count, key_word, table);
    if (near)
        return json_fail_key(reader, member, "unknown key \"%s\", did you mean \"%s\"?", quoted,
                             near);
    size_t used = 0;
    for (size_t i = 0; i < table->count; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s\"%s\"", i ? ", " : "",
                                 table->keys[i].name);
    return json_fail_key(reader, member, "unknown key \"%s\"; known for %s: %s", quoted,
                         table->what, known);
}

static enum turner_result read_member(void *out, const struct json_reader *reader,
                                      const struct json_value *member, const struct json_key *key)
{
    if (key->type == JSON_ANY)
        return TURNER_OK;
    void *place = (char *)out + key->offset;
    int choice;
    switch (key->type) {
    case JSON_ANY:
        break;
    case JSON_NUMBER:
        return json_read_number(place, reader, member, key->range);
    case JSON_INTEGER:
        return json_read_integer(place, reader, member, key->range);
    case JSON_DEGREES:
        TURNER_TRY(json_read_number(place, reader, member, key->range));
        *(double *)place *= acos(-1) / 180;
        return TURNER_OK;
    case JSON_BOOLEAN:
        return json_read_boolean(place, reader, member);
    case JSON_POINT:
        return json_read_point(place, reader, member);
    case JSON_DIRECTION:
        return json_read_direction(place, reader, member);
    case JSON_COLOR:
        return json_read_color(place, reader, member);
    case JSON_STRING:
        return json_read_string(place, reader, member);
    case JSON_CHOICE:
        TURNER_TRY(json_read_choice(&choice, reader, member, key->choices));
        memcpy(place, &choice, sizeof choice); /* an enum of the scene's, which is as large */
        return TURNER_OK;
    }
    assert(!"type of key");
    return TURNER_OK;
}

enum turner_result json_read_object(struct json_object *object, void *out,
                                    const struct json_reader *reader,
                                    const struct json_value *value, const struct json_table *table)
{
    static_assert(sizeof(enum turner_fresnel) == sizeof(int), "choices are copied as int");
    assert(table->count <= JSON_MAX_KEYS);
    *object = (struct json_object){.self = *value, .table = table};
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, value, SIZE_MAX));
    for (struct json_value m = json_first(&object->self); m.item; m = json_next(m)) {
        size_t i = 0;
        while (i < table->count && strcmp(table->keys[i].name, m.item->string) != 0)
            i++;
        if (i == table->count)
            return fail_unknown_key(reader, &m, table);
        if (object->members[i].item)
            return json_fail_key(reader, &m, "the key \"%s\" is here twice", table->keys[i].name);
        object->members[i] = m;
    }
    for (size_t i = 0; i < table->count; i++) {
        if (!object->members[i].item && table->keys[i].required)
            return json_fail(reader, &object->self, "missing key \"%s\" of %s",
                             table->keys[i].name, table->what);
    }
    for (size_t i = 0; i < table->count; i++) {
        if (object->members[i].item)
            TURNER_TRY(read_member(out, reader, &object->members[i], &table->keys[i]));
    }
    return TURNER_OK;
}

const struct json_value *json_member(const struct json_object *object, const char *key)
{
    for (size_t i = 0; i < object->table->count; i++) {
        if (strcmp(object->table->keys[i].name, key) == 0)
            return object->members[i].item ? &object->members[i] : NULL;
    }
    assert(!"key of the table");
    return NULL;
}

enum turner_result json_read_type(int *kind, const struct json_reader *reader,
                                  const struct json_value *value, const char *const *types)
{
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, value, SIZE_MAX));
    for (struct json_value m = json_first(value); m.item; m = json_next(m)) {
        if (strcmp(m.item->string, "type") == 0)
            return json_read_choice(kind, reader, &m, types);
    }
    return json_fail(reader, value, "missing key \"type\"");
}

enum turner_result json_one_of(int *which, const struct json_reader *reader,
                               const struct json_object *object, const char *const *keys)
{
    char list[160] = "";
    size_t used = 0;
    for (size_t i = 0; keys[i]; i++)
        used += (size_t)snprintf(list + used, sizeof list - used, "%s\"%s\"",
                                 i == 0        ? ""
                                 : keys[i + 1] ? ", "
                                               : " or ",
                                 keys[i]);
    *which = -1;
    for (int i = 0; keys[i]; i++) {
        const struct json_value *member = json_member(object, keys[i]);
        if (member && *which >= 0)
            return json_fail_key(reader, member, "%s has only one of %s", object->table->what,
                                 list);
        if (member)
            *which = i;
    }
    if (*which < 0)
        return json_fail(reader, &object->self, "missing key: %s needs %s", object->table->what,
                         list);
    return TURNER_OK;
}

/* ---- names ---- */

static int compare_names(const void *left, const void *right)
{
    const struct json_name *a = left, *b = right;
    int order = strcmp(a->name, b->name);
    return order ? order : a->index < b->index ? -1 : a->index > b->index;
}

static int compare_text(const void *text, const void *name)
{
    return strcmp(text, ((const struct json_name *)name)->name);
}

enum turner_result json_collect_names(struct json_names *names, const struct json_reader *reader,
                                      const struct json_value *value, size_t limit)
{
    if (!value || !value->item)
        return TURNER_OK;
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, value, limit));
    names->sorted = turner_calloc(count ? count : 1, sizeof *names->sorted);
    names->count = count;
    for (struct json_value m = json_first(value); m.item; m = json_next(m)) {
        if (!*m.item->string)
            return json_fail_key(reader, &m, "this %s needs a name", names->kind);
        if (strlen(m.item->string) > JSON_MAX_NAME)
            return json_fail_key(reader, &m, "this name has %zu bytes, but %d are the limit",
                                 strlen(m.item->string), JSON_MAX_NAME);
        names->sorted[m.index] = (struct json_name){m.item->string, (uint32_t)m.index};
    }
    if (count > 0)
        qsort(names->sorted, count, sizeof *names->sorted, compare_names);
    for (size_t i = 1; i < count; i++) {
        const struct json_name *name = &names->sorted[i];
        if (strcmp(names->sorted[i - 1].name, name->name) != 0)
            continue;
        struct json_value m = json_first(value);
        while (m.index < name->index)
            m = json_next(m);
        char quoted[JSON_QUOTE];
        json_quote(quoted, name->name);
        return json_fail_key(reader, &m, "a %s named \"%s\" is here twice", names->kind, quoted);
    }
    return TURNER_OK;
}

static const char *name_word(const void *user, size_t i)
{
    return ((const struct json_names *)user)->sorted[i].name;
}

enum turner_result json_find_name(uint32_t *index, const struct json_reader *reader,
                                  const struct json_value *value, const struct json_names *names)
{
    const char *text;
    TURNER_TRY(json_read_string(&text, reader, value));
    const struct json_name *found =
        names->count ? bsearch(text, names->sorted, names->count, sizeof *names->sorted,
                               compare_text)
                     : NULL;
    if (found) {
        *index = found->index;
        return TURNER_OK;
    }
    char quoted[JSON_QUOTE], near_quoted[JSON_QUOTE] = "";
    json_quote(quoted, text);
    const char *near = turner_nearest(text, names->count, name_word, names);
    if (near)
        json_quote(near_quoted, near);
    return json_fail(reader, value, "no %s named \"%s\"%s%s%s", names->kind, quoted,
                     near ? "; did you mean \"" : "", near_quoted, near ? "\"?" : "");
}
