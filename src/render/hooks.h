/* The hooks: functions of the shaders that a user may replace (shaders/user/, docs/shaders.md). */
#ifndef TURNER_RENDER_HOOKS_H
#define TURNER_RENDER_HOOKS_H

#include "gpu/include.h"
#include "render/needs.h"

enum turner_hook {
    TURNER_HOOK_SURFACE,
    TURNER_HOOK_BRDF,
    TURNER_HOOK_BACKGROUND,
    TURNER_HOOK_LIGHT,
    TURNER_HOOK_POST,
    TURNER_HOOKS
};

/* "surface"; the file is user/surface.glsl. */
const char *turner_hook_name(enum turner_hook hook);

/* Whether a file has another text than the one of its name in the program. */
bool turner_source_replaced(const struct turner_source_file *file);

/* One number for all a kernel is made from: its text, and the parameters' defaults and ranges. */
uint64_t turner_source_hash(const struct turner_shader_source *source);

/* Which of the files are hooks with another text than the program's own: the sum of 1u <<
 * TURNER_HOOK_…. */
uint32_t turner_hooks_of(const struct turner_shader_source *source);

/* The same of what the options' folders hold, all five; nothing is compiled. In `paths`, unless
 * NULL, their files, with commas ("" when there are none), cut where they are too many. Results as
 * of turner_shader_source_create. */
enum turner_result turner_hooks_find(uint32_t *hooks, char paths[512],
                                     const struct turner_render_options *options);

/* Adds to what the scene needs what a replaced surface can ask for besides: a highlight, a mirror's
 * share or a pattern that no material of the scene has. */
void turner_hooks_widen(struct turner_needs *needs, const struct turner_scene *scene);

/* Warns that the reference knows nothing of the files that replace hooks, where some do; `what` is
 * what is wrong therefore ("errors are those of the hook, too"). */
enum turner_result turner_hooks_warn(const struct turner_render_options *options,
                                     const char *what);

#endif
