/* A scene on a device whose shaders are watched, and a folder of shaders to be edited. */
#ifndef TURNER_TESTS_RELOAD_BENCH_H
#define TURNER_TESTS_RELOAD_BENCH_H

#include "../gpu/gpu_test.h"
#include "render/reload.h"
#include "scene/readers.h"

struct reload_bench {
    struct turner_gpu gpu;
    struct turner_scene *scene;
    struct turner_kernel kernel;
    struct turner_renderer renderer;
    struct turner_reload *reload;
    char folder[64]; /* of shaders; user/ is in it */
};

/* Opens the device (exits with 77 without one) and draws nothing yet. `scene` is JSON, or a file.
 * `no_cache`: shaders are
 * compiled each time. The picture is of 8×8 pixels. */
void bench_open(struct reload_bench *bench, const char *scene, bool no_cache, bool validation);
/* The number of failures, the device's too. */
int bench_close(struct reload_bench *bench, int failures);

/* Writes user/NAME in the folder; in place, or as many editors do, aside and renamed. NULL removes
 * it. */
void bench_write(const struct reload_bench *bench, const char *name, const char *text, bool rename_it);

/* Polls until nothing is being built; swaps what is ready. Fails after a minute. */
enum turner_reload_state bench_settle(struct reload_bench *bench);

/* The colour of the middle pixel, drawn now. */
void bench_color(struct reload_bench *bench, float color[4]);

#endif
