/* JSON as text: what cJSON does not check, and where things stand. */
#ifndef TURNER_SCENE_JSON_TEXT_H
#define TURNER_SCENE_JSON_TEXT_H

#include "base/result.h"

#define JSON_MAX_NESTING 32
#define JSON_MAX_NUMBER 63 /* characters of a number; cJSON would cut longer ones */

/* A place for people: both from 1, columns in characters. */
struct json_place {
    size_t line, column;
};

/* Checks that the text is strict JSON (RFC 8259) in UTF-8 and keeps the limits on nesting and
 * numbers; a byte order mark before it is skipped. `*start` is the offset after that mark and
 * `*values` the number of values, which tells how much memory the tree will need.
 * TURNER_BAD_INPUT with "path:line:column: …". */
enum turner_result json_check_text(size_t *start, size_t *values, const char *text, size_t length,
                                   const char *path);

/* The offset of a value in text that json_check_text has accepted: from the root down, the
 * `indices[i]`-th member or element. With `want_key`, of the last member's key instead. */
size_t json_locate(const char *text, size_t length, const size_t *indices, size_t count,
                   bool want_key);

/* The offset behind the value at `at` of such a text. */
size_t json_end(const char *text, size_t length, size_t at);

struct json_place json_place_of(const char *text, size_t offset);

#endif
