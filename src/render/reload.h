/* Shaders that change while a picture is shown: a renderer's kernel is made anew in a thread of its
 * own whenever a file that went into it is saved (render/shader_watch.h), and taken when it is
 * complete. In the thread that owns the device, once a frame:
 *
 *     if (turner_reload_poll(reload) == TURNER_RELOAD_READY)
 *         turner_reload_swap(reload, &kernel, scene);      and draw anew
 *     else if (turner_reload_state(reload) == TURNER_RELOAD_BROKEN)
 *         show turner_reload_message(reload)               over the picture as it is
 *
 * Complete means compiled, valid (spirv-val), reflected, its pipeline made, and translated where the
 * driver does that at the first dispatch only (gpu/translate.h). What is READY or BROKEN is so of the files as they were at
 * the last poll, never of older ones. */
#ifndef TURNER_RENDER_RELOAD_H
#define TURNER_RENDER_RELOAD_H

#include "base/watch.h"
#include "render/preview.h"

enum turner_reload_state {
    TURNER_RELOAD_CURRENT,  /* the renderer draws what the files say */
    TURNER_RELOAD_BUILDING, /* they say something else now */
    TURNER_RELOAD_READY,    /* the kernel for that is complete: swap */
    TURNER_RELOAD_BROKEN    /* it cannot be made; the message says why */
};

struct turner_reload;

/* Watches the shaders of `renderer`, which stays where it is as long as this lives, and its device
 * too. `options` are those of the user, before turner_shader_path_create; their strings and `scene`
 * are not needed after the call. `since` is the time before the renderer's shaders were read
 * (turner_watch_now). */
enum turner_result turner_reload_create(struct turner_reload **reload,
                                        struct turner_renderer *renderer,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct timespec since);
/* Waits for a kernel that is being made. */
void turner_reload_destroy(struct turner_reload *reload);

/* Looks at the files, a fifth of a millisecond; begins to build where they have changed, and takes
 * note of what was built. */
enum turner_reload_state turner_reload_poll(struct turner_reload *reload);

/* As of the last poll. */
enum turner_reload_state turner_reload_state(const struct turner_reload *reload);

/* Why it is BROKEN, "file:line:column: …" where there is such a place; else "". */
const char *turner_reload_message(const struct turner_reload *reload);

/* Seconds from the poll that saw a change to the kernel for it being complete; 0 as long as there is
 * none. */
double turner_reload_seconds(const struct turner_reload *reload);

/* Puts the kernel that is READY into the renderer, and what it was compiled to into `kernel`, whose
 * old content is destroyed; live parameters get the scene's values. Not while something is traced.
 * After a failure (TURNER_DEVICE: memory) the renderer is as it was and the state BROKEN. */
enum turner_result turner_reload_swap(struct turner_reload *reload, struct turner_kernel *kernel,
                                      const struct turner_scene *scene);

/* Asks for previews (render/preview.h) of what is BUILDING, or for no more of them. */
void turner_reload_want_previews(struct turner_reload *reload, bool wanted);

/* When the picture of `scene` is finished and nothing is to be done, once in a while: has the kernels
 * for previews made, in the thread, and then remembers what is visible in it. Does nothing without
 * turner_reload_want_previews. TURNER_INTERRUPTED when options->progress says so. */
enum turner_result turner_reload_rest(struct turner_reload *reload,
                                      const struct turner_scene *scene,
                                      const struct turner_render_options *options);

/* Another picture is drawn: what is remembered is not of that. */
void turner_reload_forget(struct turner_reload *reload);

/* Whether there is a new one of what is BUILDING, before that is READY. Then the other changes
 * `image`, the finished picture (as it was before the hook `post`), into it. */
bool turner_reload_has_preview(const struct turner_reload *reload);
enum turner_result turner_reload_preview(struct turner_reload *reload, struct turner_image *image,
                                         const struct turner_scene *scene);

/* The scene's values of parameters, its materials' names, or its folder of shaders are other ones:
 * live parameters take them at once (not while something is traced), a const one makes a new kernel.
 * TURNER_USAGE, and nothing is changed, when a value does not fit. */
enum turner_result turner_reload_set_params(struct turner_reload *reload,
                                            const struct turner_scene *scene);

#endif
