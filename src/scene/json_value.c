/* Messages with their place, and the reading of single values. */
#include <assert.h>
#include <float.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "image/image.h"
#include "scene/json.h"
#include "scene/nearest.h"

/* ---- messages ---- */

/* Foreign text for a message: short, in one line, whole UTF-8 characters. */
void json_quote(char out[static JSON_QUOTE], const char *text)
{
    size_t length = strlen(text), most = JSON_QUOTE - 4;
    size_t n = length <= most ? length : most - 3;
    while (length > n && n > 0 && ((unsigned char)text[n] & 0xC0) == 0x80)
        n--;
    for (size_t i = 0; i < n; i++)
        out[i] = (unsigned char)text[i] < 0x20 || text[i] == 0x7F ? '?' : text[i];
    strcpy(out + n, length > n ? "..." : "");
}

static bool is_plain(const char *key)
{
    static const char letters[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_$0123456789";
    return *key && (*key < '0' || *key > '9') && key[strspn(key, letters)] == '\0';
}

/* Appends the way to the value; a key that is not a plain word stands in brackets. */
static void append_way(char *way, size_t size, const struct json_value *value)
{
    if (!value->parent) {
        snprintf(way, size, "$");
        return;
    }
    append_way(way, size, value->parent);
    size_t used = strlen(way);
    const char *key = value->item->string;
    char quoted[JSON_QUOTE];
    if (!key) {
        snprintf(way + used, size - used, "[%zu]", value->index);
        return;
    }
    json_quote(quoted, key);
    snprintf(way + used, size - used, is_plain(key) ? ".%s" : "[\"%s\"]", quoted);
}

static enum turner_result fail_at(const struct json_reader *reader, const struct json_value *value,
                                  bool key, const char *message)
{
    size_t indices[JSON_MAX_NESTING + 1], count = 0;
    for (const struct json_value *v = value; v->parent; v = v->parent)
        count++;
    assert(count <= JSON_MAX_NESTING);
    size_t level = count;
    for (const struct json_value *v = value; v->parent; v = v->parent)
        indices[--level] = v->index;
    size_t offset = json_locate(reader->text, reader->length, indices, count, key);
    struct json_place place = json_place_of(reader->text, offset);
    char way[1024];
    append_way(way, sizeof way, value);
    return turner_fail(TURNER_BAD_INPUT, "%s:%zu:%zu: %s (at %s)", reader->path, place.line,
                       place.column, message, way);
}

enum turner_result json_fail(const struct json_reader *reader, const struct json_value *value,
                             const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail_at(reader, value, false, message);
}

enum turner_result json_fail_key(const struct json_reader *reader, const struct json_value *value,
                                 const char *format, ...)
{
    char message[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return fail_at(reader, value, true, message);
}

enum turner_result json_fail_within(const struct json_reader *reader,
                                    const struct json_value *value)
{
    char message[1024];
    snprintf(message, sizeof message, "%s", turner_message());
    return fail_at(reader, value, false, message);
}

enum turner_result json_fail_file(const struct json_reader *reader,
                                  const struct json_value *value, enum turner_result result)
{
    enum turner_result failed = json_fail_within(reader, value);
    return result == TURNER_DEVICE ? result : failed;
}

static enum turner_result fail_type(const struct json_reader *reader,
                                    const struct json_value *value, const char *expected)
{
    const cJSON *item = value->item;
    char quoted[JSON_QUOTE];
    if (cJSON_IsString(item)) {
        json_quote(quoted, item->valuestring);
        return json_fail(reader, value, "expected %s, but here is \"%s\"", expected, quoted);
    }
    if (cJSON_IsNumber(item))
        return json_fail(reader, value, "expected %s, but here is %.10g", expected,
                         item->valuedouble);
    const char *what = cJSON_IsArray(item)    ? "a list"
                       : cJSON_IsObject(item) ? "an object"
                       : cJSON_IsTrue(item)   ? "true"
                       : cJSON_IsFalse(item)  ? "false"
                                              : "null";
    return json_fail(reader, value, "expected %s, but here is %s", expected, what);
}

/* ---- lists and objects ---- */

struct json_value json_first(const struct json_value *parent)
{
    return (struct json_value){parent, parent->item ? parent->item->child : NULL, 0};
}

struct json_value json_next(struct json_value value)
{
    return (struct json_value){value.parent, value.item->next, value.index + 1};
}

static enum turner_result expect_container(size_t *count, const struct json_reader *reader,
                                           const struct json_value *value, size_t limit)
{
    *count = 0;
    for (const cJSON *item = value->item->child; item; item = item->next)
        ++*count;
    if (*count > limit)
        return json_fail(reader, value, "%zu things here, but %zu are the limit", *count, limit);
    return TURNER_OK;
}

enum turner_result json_expect_list(size_t *count, const struct json_reader *reader,
                                    const struct json_value *value, size_t limit)
{
    if (!cJSON_IsArray(value->item))
        return fail_type(reader, value, "a list");
    return expect_container(count, reader, value, limit);
}

enum turner_result json_expect_object(size_t *count, const struct json_reader *reader,
                                      const struct json_value *value, size_t limit)
{
    if (!cJSON_IsObject(value->item))
        return fail_type(reader, value, "an object");
    return expect_container(count, reader, value, limit);
}

/* ---- numbers ---- */

static bool in_range(double number, struct json_range range)
{
    return (range.open_lo ? number > range.lo : number >= range.lo) &&
           (range.open_hi ? number < range.hi : number <= range.hi);
}

static void describe_range(char *out, size_t size, const char *noun, struct json_range range)
{
    bool lo = isfinite(range.lo), hi = isfinite(range.hi);
    const char *above = range.open_lo ? "above " : "of at least ";
    const char *below = range.open_hi ? "below " : "of at most ";
    if (lo && hi && !range.open_lo && !range.open_hi)
        snprintf(out, size, "%s from %.10g to %.10g", noun, range.lo, range.hi);
    else if (lo && hi)
        snprintf(out, size, "%s %s%.10g and %s%.10g", noun, above, range.lo, below, range.hi);
    else if (lo)
        snprintf(out, size, "%s %s%.10g", noun, above, range.lo);
    else if (hi)
        snprintf(out, size, "%s %s%.10g", noun, below, range.hi);
    else
        snprintf(out, size, "%s", noun);
}

enum turner_result json_read_number(double *out, const struct json_reader *reader,
                                    const struct json_value *value, struct json_range range)
{
    char expected[96];
    describe_range(expected, sizeof expected, "a number", range);
    if (!cJSON_IsNumber(value->item))
        return fail_type(reader, value, expected);
    double number = value->item->valuedouble;
    if (!(fabs(number) <= (double)FLT_MAX))
        return json_fail(reader, value, "this number is too large; 3.4e38 is the limit");
    if (!in_range(number, range))
        return fail_type(reader, value, expected);
    *out = number;
    return TURNER_OK;
}

enum turner_result json_read_integer(int *out, const struct json_reader *reader,
                                     const struct json_value *value, struct json_range range)
{
    if (range.lo < INT32_MIN)
        range.lo = INT32_MIN;
    if (range.hi > INT32_MAX)
        range.hi = INT32_MAX;
    const cJSON *item = value->item;
    if (!cJSON_IsNumber(item) || !in_range(item->valuedouble, range) ||
        item->valuedouble != floor(item->valuedouble)) {
        char expected[96];
        describe_range(expected, sizeof expected, "an integer", range);
        return fail_type(reader, value, expected);
    }
    *out = (int)item->valuedouble;
    return TURNER_OK;
}

enum turner_result json_read_numbers(double *out, size_t count, const struct json_reader *reader,
                                     const struct json_value *value)
{
    char expected[48];
    snprintf(expected, sizeof expected, "a list of %zu numbers", count);
    if (!cJSON_IsArray(value->item))
        return fail_type(reader, value, expected);
    size_t found = 0;
    TURNER_TRY(json_expect_list(&found, reader, value, SIZE_MAX));
    if (found != count)
        return json_fail(reader, value, "expected %s, but here are %zu", expected, found);
    double numbers[12];
    assert(count <= 12);
    for (struct json_value e = json_first(value); e.item; e = json_next(e))
        TURNER_TRY(json_read_number(&numbers[e.index], reader, &e,
                                    (struct json_range)JSON_UNBOUNDED));
    memcpy(out, numbers, count * sizeof *out);
    return TURNER_OK;
}

enum turner_result json_read_point(struct turner_vec3 *out, const struct json_reader *reader,
                                   const struct json_value *value)
{
    double p[3];
    TURNER_TRY(json_read_numbers(p, 3, reader, value));
    *out = turner_vec3_of(p[0], p[1], p[2]);
    return TURNER_OK;
}

enum turner_result json_read_direction(struct turner_vec3 *out, const struct json_reader *reader,
                                       const struct json_value *value)
{
    struct turner_vec3 direction;
    TURNER_TRY(json_read_point(&direction, reader, value));
    direction = turner_vec3_normalize(direction);
    if (!(fabs(turner_vec3_length(direction) - 1) < 1e-9))
        return json_fail(reader, value, "expected a direction, but this has no length");
    *out = direction;
    return TURNER_OK;
}

/* ---- colours, words ---- */

static bool parse_hex_color(struct turner_vec3 *out, const char *text)
{
    if (text[0] != '#' || strlen(text) != 7 ||
        strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    unsigned r, g, b;
    sscanf(text + 1, "%2x%2x%2x", &r, &g, &b);
    *out = turner_vec3_of(turner_srgb_to_linear(r / 255.0), turner_srgb_to_linear(g / 255.0),
                          turner_srgb_to_linear(b / 255.0));
    return true;
}

enum turner_result json_read_color(struct turner_vec3 *out, const struct json_reader *reader,
                                   const struct json_value *value)
{
    static const char expected[] = "a colour (a number, [r, g, b] or \"#rrggbb\")";
    const struct json_range range = JSON_NOT_NEGATIVE;
    if (cJSON_IsNumber(value->item)) {
        double grey;
        TURNER_TRY(json_read_number(&grey, reader, value, range));
        *out = turner_vec3_of(grey, grey, grey);
        return TURNER_OK;
    }
    if (cJSON_IsString(value->item))
        return parse_hex_color(out, value->item->valuestring) ? TURNER_OK
                                                              : fail_type(reader, value, expected);
    if (!cJSON_IsArray(value->item))
        return fail_type(reader, value, expected);
    struct turner_vec3 color;
    TURNER_TRY(json_read_point(&color, reader, value));
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        double channel;
        TURNER_TRY(json_read_number(&channel, reader, &e, range));
    }
    *out = color;
    return TURNER_OK;
}

enum turner_result json_read_boolean(bool *out, const struct json_reader *reader,
                                     const struct json_value *value)
{
    if (!cJSON_IsBool(value->item))
        return fail_type(reader, value, "true or false");
    *out = cJSON_IsTrue(value->item);
    return TURNER_OK;
}

enum turner_result json_read_string(const char **out, const struct json_reader *reader,
                                    const struct json_value *value)
{
    if (!cJSON_IsString(value->item))
        return fail_type(reader, value, "text");
    *out = value->item->valuestring;
    return TURNER_OK;
}

static const char *choice_word(const void *user, size_t i)
{
    return ((const char *const *)user)[i];
}

enum turner_result json_read_choice(int *out, const struct json_reader *reader,
                                    const struct json_value *value, const char *const *choices)
{
    char expected[160] = "";
    size_t count = 0, used = 0;
    for (; choices[count]; count++) {
        if (cJSON_IsString(value->item) && strcmp(value->item->valuestring, choices[count]) == 0) {
            *out = (int)count;
            return TURNER_OK;
        }
    }
    for (size_t i = 0; i < count; i++)
        used += (size_t)snprintf(expected + used, sizeof expected - used, "%s\"%s\"",
                                 i == 0 ? "" : i + 1 < count ? ", " : " or ", choices[i]);
    if (!cJSON_IsString(value->item))
        return fail_type(reader, value, expected);
    char quoted[JSON_QUOTE];
    json_quote(quoted, value->item->valuestring);
    const char *near = turner_nearest(value->item->valuestring, count, choice_word, choices);
    return json_fail(reader, value, "expected %s, but here is \"%s\"%s%s%s", expected, quoted,
                     near ? "; did you mean \"" : "", near ? near : "", near ? "\"?" : "");
}
