/* What `turner check --needs` says and measures. */
#ifndef TURNER_APP_CHECK_NEEDS_H
#define TURNER_APP_CHECK_NEEDS_H

#include <cjson/cJSON.h>

#include "render/renderer.h"

/* Bytes of SPIR-V of the kernel with everything in it, whatever the scene. */
enum turner_result turner_everything_size(size_t *bytes, const struct turner_kernel *kernel);

/* To stdout, for people; `everything` is the above. */
enum turner_result turner_needs_print(const struct turner_scene *scene, const char *path,
                                      const struct turner_kernel *kernel, size_t everything);

/* The same as an object appended to `list`. */
enum turner_result turner_needs_list(cJSON *list, const struct turner_scene *scene,
                                     const char *path, const struct turner_kernel *kernel,
                                     size_t everything);

struct turner_measure {
    const char *folder; /* gets needs.csv, needs.json and the pictures; made if missing */
    const char *device; /* as in turner_render_options */
    enum turner_traversal traversal;
    int runs;           /* of each kind, at least 5 */
    int width, height, spp; /* 0: the scene's */
    bool quiet;
};

/* Draws each scene specialised and with everything in the kernel, by turns. TURNER_DIFFERS, once
 * all is measured and written, when the two pictures of a scene are not the same to the byte. */
enum turner_result turner_needs_measure(const struct turner_measure *measure,
                                        const char *const *paths, size_t count);

#endif
