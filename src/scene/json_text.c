#include "scene/json_text.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct json_place json_place_of(const char *text, size_t offset)
{
    struct json_place place = {1, 1};
    size_t i = offset >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    for (; i < offset; i++) {
        if (text[i] == '\n')
            place = (struct json_place){place.line + 1, 1};
        else if (((unsigned char)text[i] & 0xC0) != 0x80) /* not inside a UTF-8 character */
            place.column++;
    }
    return place;
}

struct checker {
    const char *text;
    size_t length, at;
    const char *path;
    size_t opened[JSON_MAX_NESTING]; /* offsets of the brackets that are still open */
    size_t depth;
    size_t values;
};

TURNER_PRINTF(3, 4)
static enum turner_result fail(const struct checker *c, size_t offset, const char *format, ...)
{
    char message[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    struct json_place place = json_place_of(c->text, offset);
    return turner_fail(TURNER_BAD_INPUT, "%s:%zu:%zu: %s", c->path, place.line, place.column,
                       message);
}

static bool ended(const struct checker *c)
{
    return c->at >= c->length;
}

static char peek(const struct checker *c)
{
    return ended(c) ? '\0' : c->text[c->at];
}

static void skip_space(struct checker *c)
{
    while (!ended(c) && memchr(" \t\r\n", c->text[c->at], 4))
        c->at++;
}

static bool is_digit(char character)
{
    return character >= '0' && character <= '9';
}

static bool is_word(char character)
{
    return is_digit(character) || (character >= 'a' && character <= 'z') ||
           (character >= 'A' && character <= 'Z') || character == '_';
}

/* What stands at the offset, as people would call it. */
static const char *describe(const struct checker *c, char buffer[static 16])
{
    if (ended(c))
        return "the end of the file";
    unsigned char character = (unsigned char)c->text[c->at];
    if (character >= 0x21 && character < 0x7F)
        snprintf(buffer, 16, "\"%c\"", character);
    else
        snprintf(buffer, 16, "byte 0x%02X", character);
    return buffer;
}

static enum turner_result fail_expected(const struct checker *c, const char *expected)
{
    char buffer[16];
    if (ended(c) && c->depth > 0) {
        size_t open = c->opened[c->depth - 1];
        struct json_place place = json_place_of(c->text, open);
        return fail(c, c->at, "the file ends here, but the \"%c\" of line %zu, column %zu is not "
                    "closed; it may be truncated", c->text[open], place.line, place.column);
    }
    if (peek(c) == '/' || peek(c) == '#')
        return fail(c, c->at, "JSON has no comments; use \"description\" instead");
    if (peek(c) == '\'')
        return fail(c, c->at, "JSON wants double quotes");
    return fail(c, c->at, "expected %s, but here is %s", expected, describe(c, buffer));
}

/* Bytes of the UTF-8 character at the offset; 0 when it is none (RFC 3629: no overlong forms, no
 * surrogates, nothing above U+10FFFF). */
static size_t utf8_length(const struct checker *c)
{
    const unsigned char *p = (const unsigned char *)c->text + c->at;
    size_t left = c->length - c->at;
    if (p[0] < 0x80)
        return 1;
    size_t length = p[0] >= 0xC2 && p[0] <= 0xDF   ? 2
                    : p[0] >= 0xE0 && p[0] <= 0xEF ? 3
                    : p[0] >= 0xF0 && p[0] <= 0xF4 ? 4
                                                   : 0;
    if (length == 0 || length > left)
        return 0;
    for (size_t i = 1; i < length; i++) {
        if ((p[i] & 0xC0) != 0x80)
            return 0;
    }
    if ((p[0] == 0xE0 && p[1] < 0xA0) || (p[0] == 0xED && p[1] > 0x9F) ||
        (p[0] == 0xF0 && p[1] < 0x90) || (p[0] == 0xF4 && p[1] > 0x8F))
        return 0;
    return length;
}

/* Four hexadecimal digits, or −1. */
static int hex4(const struct checker *c, size_t at)
{
    int value = 0;
    for (size_t i = at; i < at + 4; i++) {
        char digit = i < c->length ? c->text[i] : '\0';
        int nibble = is_digit(digit)                    ? digit - '0'
                     : digit >= 'a' && digit <= 'f' ? digit - 'a' + 10
                     : digit >= 'A' && digit <= 'F' ? digit - 'A' + 10
                                                    : -1;
        if (nibble < 0)
            return -1;
        value = value * 16 + nibble;
    }
    return value;
}

static enum turner_result check_escape(struct checker *c)
{
    size_t start = c->at++; /* the backslash */
    if (ended(c))
        return TURNER_OK; /* the string's end is missed by the caller */
    char kind = c->text[c->at++];
    if (kind != 'u') {
        if (!memchr("\"\\/bfnrt", kind, 8))
            return fail(c, start, "unknown escape in a string; write \"\\\\\" for a backslash");
        return TURNER_OK;
    }
    int unit = hex4(c, c->at);
    if (unit < 0)
        return fail(c, start, "\"\\u\" wants four hexadecimal digits");
    c->at += 4;
    if (unit == 0)
        return fail(c, start, "the character \"\\u0000\" is not allowed");
    if (unit >= 0xDC00 && unit <= 0xDFFF)
        return fail(c, start, "half a surrogate pair");
    if (unit >= 0xD800 && unit <= 0xDBFF) {
        int second = c->at + 1 < c->length && memcmp(c->text + c->at, "\\u", 2) == 0
                         ? hex4(c, c->at + 2)
                         : -1;
        if (second < 0xDC00 || second > 0xDFFF)
            return fail(c, start, "half a surrogate pair");
        c->at += 6;
    }
    return TURNER_OK;
}

static enum turner_result check_string(struct checker *c)
{
    size_t start = c->at++;
    for (;;) {
        if (ended(c))
            return fail(c, start, "this string is not closed; the file may be truncated");
        unsigned char character = (unsigned char)c->text[c->at];
        if (character == '"') {
            c->at++;
            return TURNER_OK;
        }
        if (character == '\n')
            return fail(c, start, "this string is not closed at the end of the line");
        if (character < 0x20)
            return fail(c, c->at, "byte 0x%02X in a string; write it as \"\\u%04X\"", character,
                        character);
        if (character == '\\') {
            TURNER_TRY(check_escape(c));
            continue;
        }
        size_t bytes = utf8_length(c);
        if (bytes == 0)
            return fail(c, c->at, "byte 0x%02X is not UTF-8; save the file as UTF-8", character);
        c->at += bytes;
    }
}

static size_t skip_digits(struct checker *c)
{
    size_t start = c->at;
    while (is_digit(peek(c)))
        c->at++;
    return c->at - start;
}

static enum turner_result check_number(struct checker *c)
{
    size_t start = c->at;
    if (peek(c) == '-')
        c->at++;
    if (peek(c) == '0') {
        c->at++;
        if (is_digit(peek(c)))
            return fail(c, start, "a number may not start with 0");
    } else if (skip_digits(c) == 0) {
        return fail_expected(c, "a digit");
    }
    if (peek(c) == '.') {
        c->at++;
        if (skip_digits(c) == 0)
            return fail_expected(c, "a digit after the decimal point");
    }
    if (peek(c) == 'e' || peek(c) == 'E') {
        c->at++;
        if (peek(c) == '+' || peek(c) == '-')
            c->at++;
        if (skip_digits(c) == 0)
            return fail_expected(c, "a digit of the exponent");
    }
    if (c->at - start > JSON_MAX_NUMBER)
        return fail(c, start, "this number has %zu characters; %d are allowed", c->at - start,
                    JSON_MAX_NUMBER);
    return TURNER_OK;
}

static enum turner_result check_word(struct checker *c)
{
    static const char *const words[] = {"true", "false", "null"};
    size_t start = c->at;
    while (is_word(peek(c)))
        c->at++;
    size_t length = c->at - start;
    for (size_t i = 0; i < 3; i++) {
        if (strlen(words[i]) == length && memcmp(words[i], c->text + start, length) == 0)
            return TURNER_OK;
    }
    return fail(c, start, "\"%.*s\" is no JSON value; text wants double quotes",
                (int)(length < 40 ? length : 40), c->text + start);
}

/* A value that is not a list or an object. */
static enum turner_result check_scalar(struct checker *c)
{
    char first = peek(c);
    if (!ended(c) && first == '"')
        return check_string(c);
    if (is_digit(first) || first == '-')
        return check_number(c);
    if (is_word(first))
        return check_word(c);
    return fail_expected(c, "a value");
}

static enum turner_result check_key(struct checker *c)
{
    if (peek(c) != '"')
        return fail_expected(c, is_word(peek(c)) ? "a key in double quotes" : "a key");
    TURNER_TRY(check_string(c));
    skip_space(c);
    if (peek(c) != ':')
        return fail_expected(c, "\":\" after the key");
    c->at++;
    skip_space(c);
    return TURNER_OK;
}

static enum turner_result open_bracket(struct checker *c, bool *empty)
{
    if (c->depth == JSON_MAX_NESTING)
        return fail(c, c->at, "nested more than %d deep", JSON_MAX_NESTING);
    bool object = c->text[c->at] == '{';
    c->opened[c->depth++] = c->at++;
    skip_space(c);
    *empty = peek(c) == (object ? '}' : ']');
    return object && !*empty ? check_key(c) : TURNER_OK;
}

/* After a value: closes brackets until another value must follow. */
static enum turner_result close_brackets(struct checker *c)
{
    while (c->depth > 0) {
        bool object = c->text[c->opened[c->depth - 1]] == '{';
        char close = object ? '}' : ']';
        skip_space(c);
        if (peek(c) == ',') {
            size_t comma = c->at++;
            skip_space(c);
            if (peek(c) == close)
                return fail(c, comma, "a comma before \"%c\" is one too many", close);
            return object ? check_key(c) : TURNER_OK;
        }
        if (peek(c) != close)
            return fail_expected(c, object ? "\",\" or \"}\"" : "\",\" or \"]\"");
        c->at++;
        c->depth--;
    }
    return TURNER_OK;
}

enum turner_result json_check_text(size_t *start, size_t *values, const char *text, size_t length,
                                   const char *path)
{
    struct checker c = {.text = text, .length = length, .path = path};
    if (length >= 2 && (memcmp(text, "\xFF\xFE", 2) == 0 || memcmp(text, "\xFE\xFF", 2) == 0))
        return fail(&c, 0, "this is UTF-16; save the file as UTF-8");
    if (length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0)
        c.at = 3;
    *start = c.at;
    skip_space(&c);
    if (ended(&c))
        return fail(&c, c.at, "the file is empty");
    do {
        skip_space(&c);
        c.values++;
        bool empty = true;
        if (peek(&c) == '{' || peek(&c) == '[') {
            TURNER_TRY(open_bracket(&c, &empty));
            if (!empty)
                continue;
        } else {
            TURNER_TRY(check_scalar(&c));
        }
        TURNER_TRY(close_brackets(&c));
    } while (c.depth > 0);
    skip_space(&c);
    if (!ended(&c)) {
        char buffer[16];
        return fail(&c, c.at, "expected the end of the file, but here is %s", describe(&c, buffer));
    }
    *values = c.values;
    return TURNER_OK;
}

/* ---- finding again: the text is known to be right, so nothing here looks for its end ---- */

static size_t after_space(const char *text, size_t at)
{
    while (memchr(" \t\r\n", text[at], 4))
        at++;
    return at;
}

static size_t after_string(const char *text, size_t at)
{
    for (at++; text[at] != '"'; at++)
        at += text[at] == '\\';
    return at + 1;
}

size_t json_end(const char *text, size_t length, size_t at)
{
    size_t depth = 0;
    do {
        char character = text[at];
        if (character == '"') {
            at = after_string(text, at);
            continue;
        }
        depth += character == '{' || character == '[';
        depth -= character == '}' || character == ']';
        at++;
        /* a number or word ends where something else begins */
    } while (at < length && (depth > 0 || !memchr(" \t\r\n,]}", text[at], 7)));
    return at;
}

size_t json_locate(const char *text, size_t length, const size_t *indices, size_t count,
                   bool want_key)
{
    size_t at = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    at = after_space(text, at);
    for (size_t level = 0; level < count; level++) {
        bool object = text[at] == '{';
        assert(object || text[at] == '[');
        at = after_space(text, at + 1);
        for (size_t i = 0;; i++) {
            if (object) {
                if (want_key && level + 1 == count && i == indices[level])
                    return at;
                at = after_space(text, after_string(text, at));
                at = after_space(text, at + 1); /* the colon */
            }
            if (i == indices[level])
                break;
            at = after_space(text, json_end(text, length, at));
            assert(text[at] == ',');
            at = after_space(text, at + 1);
        }
    }
    return at;
}
