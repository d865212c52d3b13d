/* What `turner check --needs` says and measures. */
#ifndef TURNER_APP_CHECK_NEEDS_H
#define TURNER_APP_CHECK_NEEDS_H

#include <cjson/cJSON.h>

#include "render/renderer.h"

/* A kernel, and the bytes of SPIR-V it has with everything in it and some methods. */
struct turner_sized_kernel {
    bool ready;
    struct turner_kernel kernel;
    uint32_t methods; /* turner_needs.methods */
    size_t everything;
};

/* One of each kind, compiled when first asked for; starts zeroed. */
struct turner_kernel_set {
    struct turner_sized_kernel at[TURNER_KERNEL_KINDS];
};

/* The kernel of the scene's methods on that device. */
enum turner_result turner_kernel_set_get(const struct turner_sized_kernel **kernel,
                                         struct turner_kernel_set *set,
                                         const struct turner_gpu_info *info,
                                         const struct turner_scene *scene,
                                         enum turner_traversal wanted);
void turner_kernel_set_destroy(struct turner_kernel_set *set);

/* To stdout, for people. */
enum turner_result turner_needs_print(const struct turner_scene *scene, const char *path,
                                      const struct turner_sized_kernel *kernel);

/* The same as an object appended to `list`. */
enum turner_result turner_needs_list(cJSON *list, const struct turner_scene *scene,
                                     const char *path, const struct turner_sized_kernel *kernel);

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
