/* turner: a recursive Whitted ray tracer on Vulkan compute. The library's public face.
 *
 * Every function that can fail returns a turner_result; turner_message() then holds the sentence
 * for the user (per thread, valid until the next failing call on that thread). Functions are to be
 * called from one thread at a time for the same object. */
#ifndef TURNER_H
#define TURNER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Also the exit status of the command. */
enum turner_result {
    TURNER_OK = 0,
    TURNER_DIFFERS = 1,   /* pictures differ, or a check failed */
    TURNER_USAGE = 2,     /* wrong command line or wrong argument */
    TURNER_BAD_INPUT = 3, /* unreadable or wrong input */
    TURNER_DEVICE = 4,    /* device, driver or memory */
    TURNER_OUTPUT = 5,    /* could not write */
    TURNER_INTERRUPTED = 130
};

const char *turner_version(void);
const char *turner_message(void);
void turner_set_quiet(bool quiet); /* no warnings on stderr */

/* ---- Pictures: width × height × 4 floats, linear, row 0 at the top; RGB radiance and, from the
 * renderer, the pruned weight in the fourth channel (see turner_render). ---- */
struct turner_image {
    int width, height;
    float *rgba;
};

/* A picture of zeros. TURNER_DEVICE when there is not enough memory. */
enum turner_result turner_image_create(struct turner_image *image, int width, int height);
void turner_image_destroy(struct turner_image *image);

/* ---- Scenes ---- */
struct turner_scene;

/* Reads a scene; the file name's ending says the format: .json, .nff, or a mesh (.obj .ply .stl
 * .gltf .glb), which is shown with a default camera and light. TURNER_BAD_INPUT with file, line,
 * column and what to do. Free with turner_scene_destroy, also after a failure (*scene is NULL
 * then). */
enum turner_result turner_scene_load(struct turner_scene **scene, const char *path);
void turner_scene_destroy(struct turner_scene *scene);

#ifdef __cplusplus
}
#endif
#endif
