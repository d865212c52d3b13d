/* For tests of whole pictures: a device with its kernels, scenes from text, pictures compared. */
#ifndef TURNER_TESTS_RENDER_TEST_H
#define TURNER_TESTS_RENDER_TEST_H

#include "../gpu/gpu_test.h"
#include "reference/reference.h"
#include "render/renderer.h"
#include "scene/readers.h"

/* Places in a rig: what the device lacks is left out. */
#define BVH 0
#define KERNELS 3

/* What every scene from text starts with, to be followed by ", …}". */
#define SCENE_HEAD "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]}"

/* One device for the whole program, and what was compiled for it. */
struct rig {
    struct turner_gpu gpu;
    struct turner_kernel kernels[KERNELS]; /* BVH what the device gets; then others */
    int traversals;                        /* how many */
};

void rig_open(struct rig *rig);              /* exits with 77 without a device */
int rig_close(struct rig *rig, int failures); /* validation messages and leaks are failures */

struct turner_scene *scene_of(const char *text);

/* Draws on the device. `options` and `statistics` may be NULL. */
void draw(struct rig *rig, struct turner_image *image, const struct turner_scene *scene,
          int traversal, const struct turner_render_options *options,
          struct turner_statistics *statistics);

/* Fails unless both have the same bytes; names the first pixel that differs. */
void assert_same_picture(const struct turner_image *a, const struct turner_image *b,
                         const char *what);

/* Draws with every traversal of the rig and compares with the reference: a pixel may be off by
 * 1e-4, or 1e-3 of its value; what is off by more must lie on an edge or the like
 * (tests/truth/explain.h), and be one in `share` of the pixels at most. */
void assert_true_picture(struct rig *rig, struct turner_scene *scene, double share);

#endif
