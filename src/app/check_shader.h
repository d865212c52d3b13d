/* turner check of shaders, and the hooks' templates. */
#ifndef TURNER_APP_CHECK_SHADER_H
#define TURNER_APP_CHECK_SHADER_H

#include "base/result.h"

/* Compiles every kernel that the file at `path` is part of, in every kind for which that differs, with
 * it in the place of turner's own. A file user/NAME.glsl takes that file's place; one of another name
 * takes that of the hook whose function it defines, or that of turner's file of its name. Prints what
 * it compiled unless `quiet`. TURNER_BAD_INPUT with "file:line:column: message" lines. */
enum turner_result turner_check_shader(const char *path, bool quiet);

/* Prints the file of a hook ("brdf") as turner has it, to begin one's own with. TURNER_USAGE when
 * there is none of that name. */
enum turner_result turner_check_template(const char *name);

#endif
