#include "gpu/compiler.h"

#include <ctype.h>
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
#include <glslang/build_info.h>
#include <pthread.h>
#include <spirv-tools/libspirv.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define SHOWN_ERRORS 6

/* A message being put together, a little shorter than turner_message may be. */
struct report {
    char text[1900];
    size_t length;
    int errors;
};

static void report_add(struct report *report, const char *format, ...) TURNER_PRINTF(2, 3);
static void report_add(struct report *report, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    size_t room = sizeof report->text - report->length;
    int length = vsnprintf(report->text + report->length, room, format, arguments);
    va_end(arguments);
    report->length += (size_t)length < room ? (size_t)length : room - 1;
}

/* Line `line` (from 1) of `text`, or "" when it has fewer; its end in *end. */
static const char *line_of(const char *text, int line, const char **end)
{
    while (line > 1 && *text) {
        text += strcspn(text, "\n");
        text += *text == '\n';
        line--;
    }
    *end = text + strcspn(text, "\r\n");
    return text;
}

/* What a parser says about the first line after an include may be the include's fault: names that
 * file in `name` and returns true. */
static bool follows_include(char name[256], const struct turner_source_file *file, int line)
{
    while (--line > 0) {
        const char *end, *text = line_of(file->text, line, &end);
        text += strspn(text, " \t");
        if (sscanf(text, "# include \"%255[^\"\n]\"", name) == 1)
            return true;
        if (text < end && strncmp(text, "//", 2) != 0)
            return false;
    }
    return false;
}

/* What glslang calls punctuation that it did not expect. */
static const char *spelling(const char *name, size_t length)
{
    static const char *const names[][2] = {
        {"SEMICOLON", ";"},  {"COMMA", ","},         {"COLON", ":"},       {"EQUAL", "="},
        {"LEFT_PAREN", "("}, {"RIGHT_PAREN", ")"},   {"LEFT_BRACE", "{"},  {"RIGHT_BRACE", "}"},
        {"DOT", "."},        {"LEFT_BRACKET", "["},  {"RIGHT_BRACKET", "]"}, {"BANG", "!"},
        {"PLUS", "+"},       {"DASH", "-"},          {"STAR", "*"},        {"SLASH", "/"},
        {"LEFT_ANGLE", "<"}, {"RIGHT_ANGLE", ">"},   {"QUESTION", "?"},
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strlen(names[i][0]) == length && strncmp(names[i][0], name, length) == 0)
            return names[i][1];
    }
    return NULL;
}

static bool is_word(char c)
{
    return isalnum((unsigned char)c) || c == '_';
}

/* Where `token` stands in the line first, as a word of its own; NULL where it does not. */
static const char *find_token(const char *code, const char *end, const char *token, size_t length)
{
    for (const char *at = code; length && at + length <= end; at++) {
        if (strncmp(at, token, length) != 0)
            continue;
        if (is_word(*token) && ((at > code && is_word(at[-1])) ||
                                (at + length < end && is_word(at[length]))))
            continue;
        return at;
    }
    return NULL;
}

/* The column of what the message is about, in bytes from 1. glslang names the token alone, and not
 * always: else it is where the line's text begins. */
static int column_of(const char *code, const char *end, const char *message, size_t length)
{
    static const char unexpected[] = "unexpected ";
    const char *token = NULL, *found = NULL;
    size_t size = 0;
    if (length && *message == '\'') {
        const char *close = memchr(message + 1, '\'', length - 1);
        token = message + 1;
        size = close ? (size_t)(close - token) : 0;
    } else {
        const char *name = strstr(message, unexpected);
        if (name && name < message + length) {
            name += strlen(unexpected);
            token = spelling(name, strcspn(name, " ,\n"));
            size = token ? strlen(token) : 0;
        }
    }
    if (size)
        found = find_token(code, end, token, size);
    if (!found)
        found = code + strspn(code, " \t");
    return found < end ? (int)(found - code) + 1 : 1;
}

/* One line of glslang's log, "ERROR: 3:12: …" with the index of a file and a line of it. */
static void report_line(struct report *report, const struct turner_shader_source *source,
                        const char *log, size_t length)
{
    const char *const error = "ERROR: ";
    if (strncmp(log, error, strlen(error)) != 0)
        return;
    int prefix = (int)strlen(error), used = 0, line = 0;
    unsigned index = 0;
    if (sscanf(log + prefix, "%u:%d: %n", &index, &line, &used) != 2 || used == 0)
        index = 0, line = 0, used = 0;
    const char *text = log + prefix + used;
    int text_length = (int)length - prefix - used;
    while (text_length > 0 && isspace((unsigned char)text[text_length - 1]))
        text_length--;
    if (text_length <= 0 || (line == 0 && isdigit((unsigned char)*text)))
        return;                          /* "2 compilation errors.  No code generated." */
    if (strncmp(text, "'' :", 4) == 0) { /* no token to blame */
        int skipped = 4 + (int)strspn(text + 4, " ");
        text += skipped;
        text_length -= skipped;
    }
    if (strstr(text, "compilation terminated") == text)
        return;
    if (++report->errors > SHOWN_ERRORS)
        return;
    if (report->length)
        report_add(report, "\n");
    if (line == 0 || index >= source->file_count) {
        report_add(report, "%s:1:1: %.*s", source->files[0].path, text_length, text);
        return;
    }
    const struct turner_source_file *file = &source->files[index];
    const char *end, *code = line_of(file->text, line, &end);
    report_add(report, "%s:%d:%d: %.*s", file->path, line,
               column_of(code, end, text, (size_t)text_length), text_length, text);
    if (report->errors == 1) {
        code += strspn(code, " \t");
        if (code < end)
            report_add(report, "\n    %.*s", end - code > 200 ? 200 : (int)(end - code), code);
        char name[256];
        if (strstr(text, "syntax error") && follows_include(name, file, line))
            report_add(report, "\n    (or a ';' or '}' is missing at the end of %s)", name);
    }
}

static enum turner_result fail_with_log(const struct turner_shader_source *source, const char *log)
{
    struct report report = {0};
    for (const char *line = log; line && *line;) {
        size_t length = strcspn(line, "\n");
        report_line(&report, source, line, length);
        line += length + (line[length] == '\n');
    }
    if (report.errors == 0)
        report_add(&report, "%s:1:1: does not compile: %s", source->files[0].path, log ? log : "");
    if (report.errors > SHOWN_ERRORS)
        report_add(&report, "\n(%d more)", report.errors - SHOWN_ERRORS);
    return turner_fail(TURNER_BAD_INPUT, "%s", report.text);
}

/* "#define NAME value" lines for glslang's preamble; the caller frees it. */
static char *make_preamble(const char *const *defines, size_t count)
{
    size_t size = 1;
    for (size_t i = 0; i < count; i++)
        size += strlen(defines[i]) + sizeof "#define  1\n";
    char *preamble = turner_calloc(size, 1);
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        int name = (int)strcspn(defines[i], "=");
        const char *value = defines[i][name] ? defines[i] + name + 1 : "1";
        used += (size_t)snprintf(preamble + used, size - used, "#define %.*s %s\n", name,
                                 defines[i], value);
    }
    return preamble;
}

static pthread_once_t once = PTHREAD_ONCE_INIT;
static int ready;

static void initialise(void)
{
    ready = glslang_initialize_process(); /* never finalised: it lasts as long as the process */
}

bool turner_spirv_wants_validation(void)
{
#ifndef NDEBUG
    return true;
#else
    const char *value = getenv("TURNER_VALIDATION");
    return value && strcmp(value, "1") == 0;
#endif
}

static enum turner_result compile(struct turner_spirv *out,
                                  const struct turner_shader_source *source,
                                  const char *const *defines, size_t define_count)
{
    *out = (struct turner_spirv){0};
    pthread_once(&once, initialise);
    if (!ready)
        return turner_fail(TURNER_DEVICE, "glslang cannot be initialised");

    enum turner_result result = TURNER_OK;
    const int messages = GLSLANG_MSG_SPV_RULES_BIT | GLSLANG_MSG_VULKAN_RULES_BIT |
                         GLSLANG_MSG_CASCADING_ERRORS_BIT; /* not only the first error */
    const glslang_input_t input = {
        .language = GLSLANG_SOURCE_GLSL,
        .stage = GLSLANG_STAGE_COMPUTE,
        .client = GLSLANG_CLIENT_VULKAN,
        .client_version = GLSLANG_TARGET_VULKAN_1_3,
        .target_language = GLSLANG_TARGET_SPV,
        .target_language_version = GLSLANG_TARGET_SPV_1_6,
        .code = source->text ? source->text : "",
        .default_version = 460,
        .default_profile = GLSLANG_NO_PROFILE,
        .messages = messages,
        .resource = glslang_default_resource(),
    };
    char *preamble = make_preamble(defines, define_count);
    glslang_program_t *program = glslang_program_create();
    glslang_shader_t *shader = glslang_shader_create(&input);
    glslang_shader_set_preamble(shader, preamble);
    if (!glslang_shader_preprocess(shader, &input) || !glslang_shader_parse(shader, &input)) {
        result = fail_with_log(source, glslang_shader_get_info_log(shader));
        goto done;
    }
    glslang_program_add_shader(program, shader);
    if (!glslang_program_link(program, messages)) {
        result = fail_with_log(source, glslang_program_get_info_log(program));
        goto done;
    }
    /* without glslang's own validation, whose findings it only notes: it takes half as long again */
    glslang_spv_options_t options = {.disable_optimizer = true};
    glslang_program_SPIRV_generate_with_options(program, GLSLANG_STAGE_COMPUTE, &options);
    out->count = glslang_program_SPIRV_get_size(program);
    out->words = turner_calloc(out->count, sizeof *out->words);
    glslang_program_SPIRV_get(program, out->words);
    if (turner_spirv_wants_validation()) {
        result = turner_spirv_validate(out);
        if (result != TURNER_OK)
            turner_fail_within(result, "%s", source->files[0].path);
    }
done:
    glslang_program_delete(program);
    glslang_shader_delete(shader);
    free(preamble);
    if (result != TURNER_OK)
        turner_spirv_destroy(out);
    return result;
}

enum turner_result turner_compile(struct turner_spirv *out,
                                  const struct turner_shader_source *source,
                                  const char *const *defines, size_t define_count)
{
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&mutex);
    enum turner_result result = compile(out, source, defines, define_count);
    pthread_mutex_unlock(&mutex);
    return result;
}

void turner_compiler_warm(void)
{
    struct turner_shader_source source;
    struct turner_spirv spirv;
    if (turner_shader_source_from_text(&source, "warm", "#version 460\nvoid main()\n{\n}\n", NULL,
                                       0) == TURNER_OK &&
        turner_compile(&spirv, &source, NULL, 0) == TURNER_OK)
        turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
}

void turner_spirv_destroy(struct turner_spirv *spirv)
{
    free(spirv->words);
    *spirv = (struct turner_spirv){0};
}

enum turner_result turner_spirv_validate(const struct turner_spirv *spirv)
{
    spv_const_binary_t binary = {spirv->words, spirv->count};
    spv_context context = spvContextCreate(SPV_ENV_VULKAN_1_3);
    spv_validator_options options = spvValidatorOptionsCreate();
    spvValidatorOptionsSetScalarBlockLayout(options, true);
    spv_diagnostic diagnostic = NULL;
    enum turner_result result = TURNER_OK;
    if (spvValidateWithOptions(context, options, &binary, &diagnostic) != SPV_SUCCESS)
        result =
            turner_fail(TURNER_BAD_INPUT, "the SPIR-V is not valid: %s",
                        diagnostic && diagnostic->error ? diagnostic->error : "no reason given");
    spvDiagnosticDestroy(diagnostic);
    spvValidatorOptionsDestroy(options);
    spvContextDestroy(context);
    return result;
}

void turner_compiler_libraries(char text[256])
{
    snprintf(text, 256, "glslang %d.%d.%d%s, %s", GLSLANG_VERSION_MAJOR, GLSLANG_VERSION_MINOR,
             GLSLANG_VERSION_PATCH, GLSLANG_VERSION_FLAVOR, spvSoftwareVersionString());
}
