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
#pragma GCC visibility push(default) /* all else stays inside the library */

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

/* ---- Layers: what is known of each pixel besides its colour (docs/layers.md) ---- */
enum turner_layer {
    TURNER_LAYER_ERROR,     /* real: estimate of the largest error of a channel, radiance */
    TURNER_LAYER_PRUNED,    /* real: weight of the rays that were cut, mean of the samples */
    TURNER_LAYER_SAMPLES,   /* whole */
    TURNER_LAYER_RAYS,      /* whole: rays traced for all its samples, shadow rays too */
    TURNER_LAYER_RECURSION, /* whole: deepest recursion of a ray that was followed, camera 0 */
    TURNER_LAYER_NONFINITE, /* whole: 1 where a colour or pruned is not finite, else 0 */
    /* Of what the ray through the pixel's centre meets: */
    TURNER_LAYER_DEPTH,    /* real: metres along the ray; infinite for the background */
    TURNER_LAYER_NORMAL,   /* 3 real: unit shading normal, world, towards the eye; or 0 0 0 */
    TURNER_LAYER_ALBEDO,   /* 3 real: k_d with its pattern; background 0 */
    TURNER_LAYER_POSITION, /* 3 real: metres, world; background 0 */
    TURNER_LAYER_ID,       /* whole: which primitive of which instance; background 0 */
    TURNER_LAYERS
};

/* Layers of one picture. Set `wanted`, the sum of 1u << TURNER_LAYER_…, leave the rest 0, and point
 * turner_render_options at it: turner_render fills it. Row 0 is at the top; each wanted layer has
 * its plane in `real` or in `whole`, all other pointers are NULL. */
struct turner_layers {
    uint32_t wanted;
    int width, height;
    float *real[TURNER_LAYERS];     /* width × height × 1 or 3 floats */
    uint32_t *whole[TURNER_LAYERS]; /* width × height */
};
void turner_layers_destroy(struct turner_layers *layers); /* keeps `wanted` */

/* ---- Rendering ---- */
enum turner_traversal {
    TURNER_TRAVERSAL_AUTO, /* the fastest on the device */
    TURNER_TRAVERSAL_BVH,  /* the faster of BVH_LANE and BVH_PACKET on the device */
    TURNER_TRAVERSAL_RAY_QUERY,
    TURNER_TRAVERSAL_BVH_LANE,  /* each lane for itself */
    TURNER_TRAVERSAL_BVH_PACKET /* the lanes of a subgroup together; needs subgroups of 8 */
};

/* Settings on top of the scene's own; zeroed is a good default. */
struct turner_render_options {
    const char *device; /* NULL: best; an index or part of a name; "reference": extended precision
                           on the CPU, no Vulkan */
    enum turner_traversal traversal; /* auto: as the scene's settings say */
    const char *const *shader_dirs; /* searched first */
    size_t shader_dir_count;
    bool no_scene_shaders; /* none from the scene's folder */
    int tile;            /* pixels, width and height of what is traced at once; 0 adapts to time */
    int threads;         /* of the reference; 0 one per core */
    bool unspecialised;  /* everything in the kernel, needed or not: same picture, slower */
    bool no_cache;       /* compiled shaders are neither taken from nor kept on disk */
    bool soon;           /* the kernel is made sooner and traces slower, for few samples: same picture */
    struct turner_layers *layers; /* NULL, or what to fill beside the picture; the caller destroys
                                     it, also after a failure */
    /* Called with the share done in [0,1]; false ends the rendering (TURNER_INTERRUPTED). */
    bool (*progress)(double share, void *user);
    void *user;
};

struct turner_statistics {
    char device[256], driver[512];
    const char *traversal;    /* "bvh", "ray_query" or "reference" */
    const char *precision;    /* "f32", "f64" or "extended" */
    uint64_t camera_rays, reflected_rays, refracted_rays, shadow_rays;
    uint64_t tir_rays;        /* reflected rays that total internal reflection sent */
    uint64_t camera_hits;     /* camera rays that met something */
    uint64_t unfinished;      /* samples that ran into a loop's bound; 0 in a right picture */
    int largest_depth;        /* of a ray that was followed */
    double pruned_mean, pruned_max;
    double samples_mean;      /* of a pixel */
    int samples_max;
    double error_mean, error_max; /* estimated, of a pixel, where the settings ask for one */
    uint64_t error_missed;    /* pixels whose estimate is more than asked for */
    double cutoff_least;      /* lowest cutoff in use */
    uint64_t nonfinite;       /* pixels that are not finite, and the first one's place */
    int nonfinite_x, nonfinite_y;
    /* Some of these run side by side, so that their sum may be more than the whole. What the
     * library does not know, it leaves 0: start (processor time until main), parse, write, whole. */
    double seconds_start, seconds_parse, seconds_device, seconds_build, seconds_compile,
        seconds_upload, seconds_layers, seconds_trace, seconds_read_back, seconds_write,
        seconds_whole;
    uint64_t host_peak_bytes, device_peak_bytes;
    uint32_t needs;           /* TURNER_NEEDS_… that were compiled in */
    size_t kernel_words;      /* size of the kernel's SPIR-V before specialisation */
    /* The cache had the SPIR-V of the shaders, that of the kernel specialised to the scene, and what the
     * driver makes of it (of devices of software; others keep that themselves). */
    bool source_cached, kernel_cached, driver_cached;
    size_t primitives, instances;
};

/* Renders into a new picture (destroy it also after a failure). `statistics` may be NULL.
 * TURNER_DEVICE with what is missing, TURNER_BAD_INPUT for a broken shader. */
enum turner_result turner_render(struct turner_image *image, const struct turner_scene *scene,
                                 const struct turner_render_options *options,
                                 struct turner_statistics *statistics);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
#endif
