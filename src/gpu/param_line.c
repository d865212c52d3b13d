/* The line that declares a parameter, and what stands in the shader for it. */
#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "gpu/param.h"

#define MARK "//!PARAM"
#define WORD 256 /* bytes of one word of a line */

struct line {
    const char *start, *next, *end;
    const char *word; /* where the last one began */
};

static enum turner_result fail(const struct line *line, const char *format, ...)
    TURNER_PRINTF(2, 3);
static enum turner_result fail(const struct line *line, const char *format, ...)
{
    char message[600];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return turner_fail(TURNER_BAD_INPUT, "%d: %s", (int)(line->word - line->start) + 1, message);
}

static void skip_spaces(struct line *line)
{
    while (line->next < line->end && strchr(" \t\r", *line->next))
        line->next++;
    line->word = line->next;
}

/* The next word, or what stands between quotes; `what` is what should stand there. */
static enum turner_result take(char out[WORD], struct line *line, const char *what)
{
    skip_spaces(line);
    bool quoted = line->next < line->end && *line->next == '"';
    const char *start = line->next + quoted, *at = start;
    while (at < line->end && (quoted ? *at != '"' : !strchr(" \t\r\"", *at)))
        at++;
    if (at == start && !quoted)
        return fail(line, "%s is missing here", what);
    if (quoted && at == line->end)
        return fail(line, "the closing quote is missing");
    size_t length = (size_t)(at - start);
    if (length >= WORD)
        return fail(line, "%s has more than %d bytes", what, WORD - 1);
    memcpy(out, start, length);
    out[length] = 0;
    for (const char *c = out; *c; c++) {
        if ((unsigned char)*c < ' ')
            return fail(line, "%s has a control character in it", what);
    }
    line->next = at + quoted;
    return TURNER_OK;
}

static bool is_name(const char *name)
{
    if (!isalpha((unsigned char)*name) || strncmp(name, "gl_", 3) == 0 || strstr(name, "__"))
        return false;
    while (isalnum((unsigned char)*name) || *name == '_')
        name++;
    return !*name;
}

static enum turner_result take_name(char out[TURNER_PARAM_NAME], struct line *line)
{
    char word[WORD];
    TURNER_TRY(take(word, line, "the parameter's name"));
    if (!is_name(word))
        return fail(line, "\"%s\" cannot be a name: letters, digits and single _, a letter first, "
                          "not gl_", word);
    if (strlen(word) >= TURNER_PARAM_NAME)
        return fail(line, "a name has at most %d letters", TURNER_PARAM_NAME - 1);
    strcpy(out, word);
    return TURNER_OK;
}

static enum turner_result take_type(struct turner_param *param, struct line *line)
{
    char word[WORD];
    TURNER_TRY(take(word, line, "the type"));
    param->constant = strcmp(word, "const") == 0;
    if (param->constant)
        TURNER_TRY(take(word, line, "the type"));
    for (int type = 0; type <= TURNER_PARAM_MATERIAL; type++) {
        if (strcmp(turner_param_type_name((enum turner_param_type)type), word) != 0)
            continue;
        param->type = (enum turner_param_type)type;
        if (param->constant && param->type == TURNER_PARAM_MATERIAL)
            return fail(line, "a material cannot be const");
        return TURNER_OK;
    }
    return fail(line, "\"%.60s\" is no type: float, int, bool, color, choice or material", word);
}

static enum turner_result take_bound(double *out, struct line *line, const char *what, bool whole)
{
    char word[WORD];
    struct turner_param number = {.type = whole ? TURNER_PARAM_INT : TURNER_PARAM_FLOAT,
                                  .least = whole ? -2147483647.0 : -HUGE_VAL,
                                  .most = whole ? 2147483647.0 : HUGE_VAL};
    struct turner_param_value value;
    TURNER_TRY(take(word, line, what));
    if (turner_param_read(&value, &number, word) != TURNER_OK)
        return fail(line, "%s must be a %snumber, not \"%.60s\"", what, whole ? "whole " : "", word);
    *out = value.number[0];
    return TURNER_OK;
}

static enum turner_result take_range(struct turner_param *param, struct line *line)
{
    bool whole = param->type == TURNER_PARAM_INT;
    TURNER_TRY(take_bound(&param->least, line, "the least value", whole));
    TURNER_TRY(take_bound(&param->most, line, "the most", whole));
    if (!(param->least <= param->most))
        return fail(line, "the most is less than the least, %.9g", param->least);
    return TURNER_OK;
}

static enum turner_result take_choices(struct turner_param *param, struct line *line)
{
    char words[WORD];
    TURNER_TRY(take(words, line, "the list of choices, as in word|word"));
    for (char *word = words, *next; word; word = next) {
        next = strchr(word, '|');
        if (next)
            *next++ = 0;
        if (!is_name(word) || strlen(word) >= TURNER_PARAM_NAME)
            return fail(line, "\"%.60s\" cannot be a choice: letters, digits and single _, with | "
                              "between", word);
        if (param->choice_count == TURNER_PARAM_CHOICES)
            return fail(line, "more than %d choices", TURNER_PARAM_CHOICES);
        for (int i = 0; i < param->choice_count; i++) {
            if (strcmp(param->choices[i], word) == 0)
                return fail(line, "the choice \"%s\" stands here twice", word);
        }
        strcpy(param->choices[param->choice_count++], word);
    }
    return TURNER_OK;
}

/* Whether the next thing is no text in quotes. */
static bool more_words(struct line *line)
{
    skip_spaces(line);
    return line->next < line->end && *line->next != '"';
}

static enum turner_result take_values(struct turner_param *param, struct line *line)
{
    char word[WORD];
    TURNER_TRY(take(word, line, "the default"));
    struct line at = *line; /* for what is wrong with the default */
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
    case TURNER_PARAM_INT: TURNER_TRY(take_range(param, line)); break;
    case TURNER_PARAM_COLOR:
        param->most = 1;
        if (more_words(line))
            TURNER_TRY(take_range(param, line));
        break;
    case TURNER_PARAM_CHOICE: TURNER_TRY(take_choices(param, line)); break;
    case TURNER_PARAM_BOOL:
    case TURNER_PARAM_MATERIAL: break;
    }
    if (turner_param_read(&param->standard, param, word) != TURNER_OK)
        return fail(&at, "%s", turner_message());
    return TURNER_OK;
}

bool turner_param_is_line(const char *line, size_t length)
{
    size_t mark = strlen(MARK), at = 0;
    while (at < length && strchr(" \t", line[at]))
        at++;
    return length - at >= mark && memcmp(line + at, MARK, mark) == 0 &&
           (length - at == mark || strchr(" \t\r", line[at + mark]));
}

enum turner_result turner_param_parse(struct turner_param *param, const char *text, size_t length)
{
    char words[WORD];
    struct line line = {.start = text, .next = text, .end = text + length};
    *param = (struct turner_param){0};
    skip_spaces(&line);
    line.next += strlen(MARK);
    TURNER_TRY(take_name(param->name, &line));
    TURNER_TRY(take_type(param, &line));
    TURNER_TRY(take_values(param, &line));
    skip_spaces(&line);
    if (line.next == line.end || *line.next != '"')
        return fail(&line, "a text in quotes is missing here: it says what the parameter does");
    TURNER_TRY(take(words, &line, "the text"));
    if (strlen(words) >= TURNER_PARAM_TEXT)
        return fail(&line, "the text has more than %d bytes", TURNER_PARAM_TEXT - 1);
    strcpy(param->text, words);
    skip_spaces(&line);
    if (line.next < line.end)
        return fail(&line, "nothing may follow the text");
    return TURNER_OK;
}

/* ---- in the shader ---- */

static void append(char *text, size_t size, const char *format, ...) TURNER_PRINTF(3, 4);
static void append(char *text, size_t size, const char *format, ...)
{
    va_list arguments;
    size_t used = strlen(text);
    va_start(arguments, format);
    vsnprintf(text + used, size - used, format, arguments);
    va_end(arguments);
}

static void append_constant(char *text, size_t size, const struct turner_param *param)
{
    const double *n = param->standard.number;
    const char *name = param->name;
    const char *constant = "layout(constant_id = TURNER_CONSTANT_PARAMS";
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
        append(text, size, "%s + %u) const float %s = %.9e;", constant, param->word, name, n[0]);
        break;
    case TURNER_PARAM_BOOL:
        append(text, size, "%s + %u) const bool %s = %s;", constant, param->word, name,
               n[0] != 0 ? "true" : "false");
        break;
    case TURNER_PARAM_COLOR:
        for (unsigned i = 0; i < 3; i++)
            append(text, size, "%s + %u) const float %s_%c = %.9e; ", constant, param->word + i,
                   name, "rgb"[i], n[i]);
        append(text, size, "const vec3 %s = vec3(%s_r, %s_g, %s_b);", name, name, name, name);
        break;
    default:
        append(text, size, "%s + %u) const int %s = %.0f;", constant, param->word, name, n[0]);
    }
}

void turner_param_glsl(char *text, size_t size, const struct turner_param *param)
{
    static const char *const live[] = {
        [TURNER_PARAM_FLOAT] = "float %s = turner_param_float(%u);",
        [TURNER_PARAM_INT] = "int %s = turner_param_int(%u);",
        [TURNER_PARAM_BOOL] = "bool %s = turner_param_int(%u) != 0;",
        [TURNER_PARAM_COLOR] = "vec3 %s = turner_param_color(%u);",
        [TURNER_PARAM_CHOICE] = "int %s = turner_param_int(%u);",
        [TURNER_PARAM_MATERIAL] = "uint %s = uint(turner_param_int(%u));",
    };
    *text = 0;
    for (int i = 0; i < param->choice_count; i++)
        append(text, size, "const int %s_%s = %d; ", param->name, param->choices[i], i);
    if (param->constant)
        append_constant(text, size, param);
    else
        append(text, size, live[param->type], param->name, param->word);
}
