/* A device that is opened in a thread of its own, while the scene is read and shaders are compiled:
 * opening one means loading its driver. */
#ifndef TURNER_RENDER_OPENING_H
#define TURNER_RENDER_OPENING_H

#include <pthread.h>

#include "render/renderer.h"

struct turner_opening {
    const char *device; /* as for turner_gpu_create */
    struct turner_gpu gpu;
    double seconds; /* it took */
    enum turner_result result;
    char *message; /* of a failure */
    pthread_t thread;
    bool begun, threaded; /* and not joined yet */
};

/* `device` lives until turner_opening_finish. The device "reference" opens none. */
void turner_opening_start(struct turner_opening *opening, const char *device);

/* Waits for it; the device is used from the caller's thread from here on. */
enum turner_result turner_opening_finish(struct turner_opening *opening);

/* Compiles the scene's kernel and prepares a renderer meanwhile, waits for the device, and has what is
 * right for it in the end (turner_renderer_finish comes next). Adds to seconds_compile. The caller
 * destroys the kernel, also after a failure; the renderer, which is zeros at first, is none then. */
enum turner_result turner_opening_prepare(struct turner_renderer *renderer,
                                          struct turner_kernel *kernel,
                                          struct turner_opening *opening,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics);

/* Closes the device in a thread of its own, while the caller does what needs none. */
void turner_opening_close(struct turner_opening *opening);

/* Waits, if need be, and closes the device, if it is open; nothing where all is 0. */
void turner_opening_destroy(struct turner_opening *opening);

/* turner_render, with the options' device being opened already. */
enum turner_result turner_render_opened(struct turner_image *image,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics,
                                        struct turner_opening *opening);

#endif
