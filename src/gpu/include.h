/* Shader source: one file with everything it includes. (glslang 12's C interface has no include
 * callbacks, and the files found here are the ones to watch for changes.)
 *
 * #include "name" looks for `name` in the folders, in order, then among the copies inside the
 * program. Names are relative to those folders, whoever includes; no "..", no leading "/".
 * A file comes in only once, as with #pragma once: in the text every file stands between
 * #ifndef TURNER_FILE_n and #endif, so this holds for includes under #if, too.
 * #include <name> is left as it is: it belongs to C, where both languages share a file.
 * A line //!PARAM (gpu/param.h) is replaced by the declaration it stands for.
 * #line N n, n the index into `files`, keeps the compiler's line numbers right. */
#ifndef TURNER_GPU_INCLUDE_H
#define TURNER_GPU_INCLUDE_H

#include "base/embedded.h"
#include "base/result.h"
#include "gpu/param.h"

#define TURNER_INCLUDE_DEPTH 32        /* files inside files */
#define TURNER_SOURCE_BYTES (4u << 20) /* of the whole expanded text */

/* Copies of the files of shaders/ in the program; names are relative to shaders/. */
extern const struct turner_embedded_file turner_embedded_shaders[]; /* sorted by name */
extern const size_t turner_embedded_shaders_count;

struct turner_source_file {
    char *name;    /* as included */
    char *path;    /* where it was found; "built-in/NAME" when inside the program */
    bool embedded; /* not a file to watch */
    char *text;
};

struct turner_shader_source {
    char *text; /* expanded, ends with a zero */
    size_t length;
    struct turner_source_file *files; /* [0] is the first one; in order of inclusion */
    size_t file_count, file_capacity;
    char *missing; /* after a failure: the name of a file that was not there, or NULL */
    struct turner_params params; /* declared in them, in order; all have different names */
    uint32_t param_words;        /* that they take */
};

/* Reads `name` and expands it. `source` owns everything; destroy it also after a failure: it then
 * holds the files read so far, so that a program that watches them sees the repair.
 * TURNER_BAD_INPUT for a folder that is not there or not readable, and with "file:line:column: …" and the
 * folders searched for a file that is not there or unreadable, a
 * malformed #include or //!PARAM, one declared twice, too much nesting or text, or a zero byte. */
enum turner_result turner_shader_source_create(struct turner_shader_source *source,
                                               const char *name, const char *const *folders,
                                               size_t folder_count);
/* The same with the first file's text given; `name` is for messages. */
enum turner_result turner_shader_source_from_text(struct turner_shader_source *source,
                                                  const char *name, const char *text,
                                                  const char *const *folders, size_t folder_count);
/* The same with one file found at a place of its own, whatever the folders hold. */
struct turner_shader_replacement {
    const char *name, *path;
};
enum turner_result turner_shader_source_create_with(
    struct turner_shader_source *source, const char *name, const char *const *folders,
    size_t folder_count, const struct turner_shader_replacement *replacement);
void turner_shader_source_destroy(struct turner_shader_source *source);

#endif
