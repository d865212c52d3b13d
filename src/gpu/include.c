#include "gpu/include.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"

enum file_state {
    FILE_CONDITIONAL, /* has come in, but under an #if */
    FILE_OPEN,        /* being expanded */
    FILE_DONE         /* has come in for sure */
};

struct expansion {
    struct turner_shader_source *source;
    const char *const *folders;
    size_t folder_count;
    const struct turner_shader_replacement *replacement; /* or NULL */
    size_t capacity;         /* of source->text */
    enum file_state *states; /* one per source->files */
    size_t state_capacity;
};

/* Where a line ended, as far as it matters for the next one. */
struct scan {
    bool block_comment, line_comment, continued;
};

static enum turner_result append(struct expansion *e, const char *text, size_t length)
{
    struct turner_shader_source *source = e->source;
    if (source->length + length >= TURNER_SOURCE_BYTES)
        return turner_fail(TURNER_BAD_INPUT,
                           "%s: more than %u bytes with everything it includes; include less",
                           source->files[0].path, TURNER_SOURCE_BYTES);
    while (source->length + length + 1 > e->capacity) {
        e->capacity = e->capacity ? 2 * e->capacity : 65536;
        source->text = turner_realloc(source->text, e->capacity, 1);
    }
    memcpy(source->text + source->length, text, length);
    source->length += length;
    source->text[source->length] = 0;
    return TURNER_OK;
}

static enum turner_result append_format(struct expansion *e, const char *format, ...)
    TURNER_PRINTF(2, 3);
static enum turner_result append_format(struct expansion *e, const char *format, ...)
{
    char line[128];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    return append(e, line, (size_t)length);
}

/* Only one way to name a file, or it could come in twice. */
static bool name_is_plain(const char *name)
{
    if (strlen(name) > 255)
        return false;
    for (const char *part = name;; part++) {
        size_t length = strcspn(part, "/");
        if (length == 0 || strncmp(part, ".", length) == 0 || strncmp(part, "..", length) == 0)
            return false;
        for (size_t i = 0; i < length; i++) {
            if ((unsigned char)part[i] < ' ' || part[i] == '\\')
                return false;
        }
        part += length;
        if (!*part)
            return true;
    }
}

static char *join(const char *folder, const char *name)
{
    size_t length = strlen(folder) + strlen(name) + 2;
    char *path = turner_calloc(length, 1);
    snprintf(path, length, "%s/%s", folder, name);
    return path;
}

/* The whole file in *text, or *text = NULL when there is none. */
static enum turner_result read_file(char **text, const char *path)
{
    *text = NULL;
    struct stat status;
    if (stat(path, &status) != 0) {
        if (errno == ENOENT || errno == ENOTDIR)
            return TURNER_OK;
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    }
    if (!S_ISREG(status.st_mode))
        return turner_fail(TURNER_BAD_INPUT, "%s: is not a file", path);
    if (status.st_size >= (off_t)TURNER_SOURCE_BYTES)
        return turner_fail(TURNER_BAD_INPUT, "%s: %lld bytes, shaders may have %u", path,
                           (long long)status.st_size, TURNER_SOURCE_BYTES);
    FILE *file = fopen(path, "rb");
    if (!file)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    char *content = turner_calloc((size_t)status.st_size + 1, 1);
    size_t length = fread(content, 1, (size_t)status.st_size, file);
    bool failed = ferror(file);
    fclose(file);
    if (failed || memchr(content, 0, length)) {
        free(content);
        return turner_fail(TURNER_BAD_INPUT, "%s: %s", path,
                           failed ? "cannot be read" : "holds a zero byte; it is not text");
    }
    *text = content;
    return TURNER_OK;
}

static size_t add_file(struct expansion *e, const char *name, char *path, char *text, bool embedded)
{
    struct turner_shader_source *source = e->source;
    e->states = turner_grow(e->states, source->file_count, &e->state_capacity, sizeof *e->states);
    e->states[source->file_count] = FILE_CONDITIONAL;
    *TURNER_PUSH(source->files, source->file_count, source->file_capacity) =
        (struct turner_source_file){turner_strdup(name), path, embedded, text};
    return source->file_count - 1;
}

/* Sets *index to the file called `name`, read now or before. The message has no place in it. */
static enum turner_result find_file(struct expansion *e, const char *name, size_t *index)
{
    if (!name_is_plain(name))
        return turner_fail(TURNER_BAD_INPUT,
                           "\"%s\" must be a name relative to the shader folders, without \"..\"",
                           name);
    for (*index = 0; *index < e->source->file_count; ++*index) {
        if (strcmp(e->source->files[*index].name, name) == 0)
            return TURNER_OK;
    }
    const struct turner_shader_replacement *replacement = e->replacement;
    bool own = replacement && strcmp(replacement->name, name) == 0;
    for (size_t i = 0; i < (own ? 1 : e->folder_count); i++) {
        char *path = own ? turner_strdup(replacement->path) : join(e->folders[i], name), *text;
        enum turner_result result = read_file(&text, path);
        if (text) {
            *index = add_file(e, name, path, text, false);
            return TURNER_OK;
        }
        free(path);
        TURNER_TRY(result);
    }
    for (size_t i = 0; i < turner_embedded_shaders_count; i++) {
        const struct turner_embedded_file *file = &turner_embedded_shaders[i];
        if (strcmp(file->name, name) == 0) {
            *index = add_file(e, name, join("built-in", name), turner_strdup(file->text), true);
            return TURNER_OK;
        }
    }
    e->source->missing = turner_strdup(name);
    char folders[1024] = "";
    for (size_t i = 0; i < e->folder_count; i++) {
        size_t used = strlen(folders);
        snprintf(folders + used, sizeof folders - used, "%s, ", e->folders[i]);
    }
    return turner_fail(TURNER_BAD_INPUT,
                       "\"%s\" is neither in %snor built into the program; check the name", name,
                       folders);
}

/* Follows comments through one line; the offset of its '#' if it is a directive, else -1. */
static long scan_line(struct scan *scan, const char *line, size_t length)
{
    long directive = -1;
    bool blank = !scan->continued; /* so far */
    if (!scan->continued)
        scan->line_comment = false;
    for (size_t i = 0; i < length && !scan->line_comment; i++) {
        bool pair = i + 1 < length;
        if (scan->block_comment) {
            if (pair && line[i] == '*' && line[i + 1] == '/') {
                scan->block_comment = false;
                i++;
            }
        } else if (pair && line[i] == '/' && line[i + 1] == '/') {
            scan->line_comment = true;
        } else if (pair && line[i] == '/' && line[i + 1] == '*') {
            scan->block_comment = true;
            i++;
        } else if (!strchr(" \t\r\v\f", line[i])) {
            if (blank && line[i] == '#')
                directive = (long)i;
            blank = false;
        }
    }
    if (length && line[length - 1] == '\r')
        length--;
    scan->continued = length && line[length - 1] == '\\';
    return directive;
}

/* Whether `text` starts with the directive `word`; *rest is what follows it. */
static bool directive_is(const char *text, const char *word, const char **rest)
{
    text++; /* '#' */
    text += strspn(text, " \t");
    size_t length = strlen(word);
    if (strncmp(text, word, length) != 0 || isalnum((unsigned char)text[length]))
        return false; /* another, longer word */
    *rest = text + length + strspn(text + length, " \t");
    return true;
}

/* Whether nothing but a comment to the line's end stands at `text`. */
static bool line_ends(const char *text)
{
    text += strspn(text, " \t\r\v\f");
    return !*text || *text == '\n' || strncmp(text, "//", 2) == 0;
}

static enum turner_result expand(struct expansion *e, size_t index, bool conditional, int depth);

/* The line `#include …`; `rest` is what follows the word. */
static enum turner_result expand_include(struct expansion *e, size_t includer, int line, int column,
                                         const char *rest, bool conditional, int depth)
{
    const char *where = e->source->files[includer].path;
    const char *end = *rest == '"' ? rest + 1 + strcspn(rest + 1, "\"\n") : rest;
    if (end == rest || *end != '"')
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:%d: write #include \"name\"", where, line,
                           column);
    if (!line_ends(end + 1))
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:%d: nothing may follow #include \"name\"",
                           where, line, column);
    char name[256];
    size_t length = (size_t)(end - rest - 1);
    if (length >= sizeof name)
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:%d: file name of %zu bytes, at most %zu",
                           where, line, column, length, sizeof name - 1);
    memcpy(name, rest + 1, length);
    name[length] = 0;

    size_t included;
    enum turner_result result = find_file(e, name, &included);
    where = e->source->files[includer].path; /* the array may have moved */
    if (result != TURNER_OK)
        return turner_fail_within(result, "%s:%d:%d", where, line, column);
    if (e->states[included] != FILE_CONDITIONAL)
        return append(e, "\n", 1);
    if (depth + 1 >= TURNER_INCLUDE_DEPTH)
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:%d: more than %d files inside each other",
                           where, line, column, TURNER_INCLUDE_DEPTH);
    TURNER_TRY(
        append_format(e, "#ifndef TURNER_FILE_%zu\n#define TURNER_FILE_%zu\n", included, included));
    TURNER_TRY(append_format(e, "#line 1 %zu\n", included));
    TURNER_TRY(expand(e, included, conditional, depth + 1));
    return append_format(e, "#endif\n#line %d %zu\n", line + 1, includer);
}

/* A file under an #if may come in twice; its parameters are the same ones then. */
static const struct turner_param *same_line(const struct turner_params *params, const char *file,
                                            int line)
{
    for (size_t i = 0; i < params->count; i++) {
        if (params->at[i].line == line && strcmp(params->at[i].file, file) == 0)
            return &params->at[i];
    }
    return NULL;
}

/* The line `//!PARAM …`. */
static enum turner_result expand_param(struct expansion *e, size_t index, int line,
                                       const char *text, size_t length)
{
    char glsl[2048];
    struct turner_shader_source *source = e->source;
    const char *path = source->files[index].path;
    struct turner_param param;
    if (turner_param_parse(&param, text, length) != TURNER_OK) {
        snprintf(glsl, sizeof glsl, "%s", turner_message());
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:%s", path, line, glsl);
    }
    snprintf(param.file, sizeof param.file, "%s", path);
    param.line = line;
    param.word = source->param_words;
    const struct turner_param *known = same_line(&source->params, param.file, line);
    const struct turner_param *other = turner_params_get(&source->params, param.name);
    if (known) {
        param = *known;
    } else if (other) {
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: parameter \"%s\" is declared before, in "
                                             "%s:%d", path, line, param.name, other->file,
                           other->line);
    } else {
        source->param_words += turner_param_size(&param);
        *TURNER_PUSH(source->params.at, source->params.count, source->params.capacity) = param;
    }
    if (source->param_words > TURNER_PARAM_WORDS)
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: the parameters take more than %d numbers", path,
                           line, TURNER_PARAM_WORDS);
    turner_param_glsl(glsl, sizeof glsl, &param);
    TURNER_TRY(append(e, glsl, strlen(glsl)));
    return append(e, "\n", 1);
}

static enum turner_result expand(struct expansion *e, size_t index, bool conditional, int depth)
{
    const char *path = e->source->files[index].path, *next = e->source->files[index].text;
    struct scan scan = {0};
    int lines = 0, nested = 0, opened = 0; /* #ifs not yet closed, line of the outermost */
    e->states[index] = FILE_OPEN;
    for (int line = 1; *next; line++) {
        const char *text = next, *rest;
        size_t length = strcspn(text, "\n");
        lines = line;
        next = text + length + (text[length] == '\n');
        bool param = !scan.block_comment && !scan.continued && turner_param_is_line(text, length);
        long hash = scan_line(&scan, text, length);
        if (param && scan.continued)
            return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: //!PARAM must end on its own line", path,
                               line);
        if (param) {
            TURNER_TRY(expand_param(e, index, line, text, length));
            continue;
        }
        const char *directive = hash < 0 ? NULL : text + hash;
        bool include = directive && directive_is(directive, "include", &rest) && *rest != '<';
        bool once = !include && directive && directive_is(directive, "pragma", &rest) &&
                    strncmp(rest, "once", 4) == 0 && line_ends(rest + 4);
        if (include || once) {
            if (scan.continued || scan.block_comment)
                return turner_fail(TURNER_BAD_INPUT, "%s:%d:%ld: #%s must end on its own line",
                                   path, line, hash + 1, include ? "include" : "pragma once");
            TURNER_TRY(append(e, text, (size_t)hash)); /* a comment may end here */
        }
        if (include) {
            TURNER_TRY(expand_include(e, index, line, (int)hash + 1, rest,
                                      conditional || nested > 0, depth));
            continue;
        }
        if (once) {
            TURNER_TRY(append(e, "\n", 1)); /* always so here; glslang would warn */
            continue;
        }
        if (directive &&
            (directive_is(directive, "if", &rest) || directive_is(directive, "ifdef", &rest) ||
             directive_is(directive, "ifndef", &rest))) {
            if (nested++ == 0)
                opened = line;
        } else if (directive && directive_is(directive, "endif", &rest) && nested-- == 0) {
            return turner_fail(TURNER_BAD_INPUT, "%s:%d:%ld: #endif without #if", path, line,
                               hash + 1);
        }
        TURNER_TRY(append(e, text, length));
        TURNER_TRY(append(e, "\n", 1));
    }
    if (nested > 0)
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: #if without #endif", path, opened);
    if (scan.block_comment || scan.continued)
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: ends inside a comment or a continued line",
                           path, lines);
    e->states[index] = conditional ? FILE_CONDITIONAL : FILE_DONE;
    return TURNER_OK;
}

/* A mistyped folder would otherwise go unnoticed: what is not found there is built in. */
static enum turner_result check_folders(const char *const *folders, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        struct stat status;
        int error = stat(folders[i], &status) != 0          ? errno
                    : !S_ISDIR(status.st_mode)              ? ENOTDIR
                    : access(folders[i], R_OK | X_OK) != 0 ? errno
                                                            : 0;
        if (error)
            return turner_fail(TURNER_BAD_INPUT, "shader folder %s: %s; check its name",
                               folders[i], strerror(error));
    }
    return TURNER_OK;
}

enum turner_result turner_shader_source_create(struct turner_shader_source *source,
                                               const char *name, const char *const *folders,
                                               size_t folder_count)
{
    return turner_shader_source_create_with(source, name, folders, folder_count, NULL);
}

enum turner_result turner_shader_source_create_with(
    struct turner_shader_source *source, const char *name, const char *const *folders,
    size_t folder_count, const struct turner_shader_replacement *replacement)
{
    *source = (struct turner_shader_source){0};
    TURNER_TRY(check_folders(folders, folder_count));
    struct expansion e = {.source = source, .folders = folders, .folder_count = folder_count,
                          .replacement = replacement};
    size_t index;
    enum turner_result result = find_file(&e, name, &index);
    if (result == TURNER_OK)
        result = expand(&e, index, false, 0);
    free(e.states);
    return result;
}

enum turner_result turner_shader_source_from_text(struct turner_shader_source *source,
                                                  const char *name, const char *text,
                                                  const char *const *folders, size_t folder_count)
{
    *source = (struct turner_shader_source){0};
    struct expansion e = {.source = source, .folders = folders, .folder_count = folder_count};
    size_t index = add_file(&e, name, turner_strdup(name), turner_strdup(text), true);
    enum turner_result result = expand(&e, index, false, 0);
    free(e.states);
    return result;
}

void turner_shader_source_destroy(struct turner_shader_source *source)
{
    for (size_t i = 0; i < source->file_count; i++) {
        free(source->files[i].name);
        free(source->files[i].path);
        free(source->files[i].text);
    }
    free(source->files);
    free(source->missing);
    turner_params_destroy(&source->params);
    free(source->text);
    *source = (struct turner_shader_source){0};
}
