/* A scene made ready on a device, and its pictures. turner_render (src/turner.h) is one of these
 * from beginning to end. */
#ifndef TURNER_RENDER_RENDERER_H
#define TURNER_RENDER_RENDERER_H

#include "gpu/program.h"
#include "render/device_scene.h"
#include "render/post.h"

/* What the shaders' source is compiled to: the names are those of #defines. */
enum turner_kernel_kind {
    TURNER_RAY_QUERY = 1 << 0,  /* the device's acceleration structures; without: our own */
    TURNER_PACKET = 1 << 1,     /* our own, walked by the lanes of a subgroup together */
    TURNER_F64 = 1 << 2,        /* method precision=f64; the device has float64 */
    TURNER_SPHERE_F64 = 1 << 3, /* method sphere=f64; the same */
    TURNER_RECORD = 1 << 4,     /* notes down what it does for one pixel (render/explain.h) */
    TURNER_PROBE_HITS = 1 << 5, /* of probe.comp (render/probe.h): what rays meet */
    TURNER_PROBE_RADIANCE = 1 << 6, /* the same: the radiance they bring */
    TURNER_RAYS_SEND = 1 << 7, /* of rays.comp (render/rays.h): rays sent on, not what they meet */
};
#define TURNER_KERNEL_KINDS 16 /* combinations of the first four */

/* The shaders compiled to SPIR-V, for any scene whose methods want this kind. */
struct turner_kernel {
    unsigned kind; /* TURNER_RAY_QUERY | … */
    bool cached;   /* the cache had it (gpu/cache.h) */
    uint64_t source; /* of what it is made from (turner_source_hash) */
    uint32_t hooks; /* of its files, those that are replaced (render/hooks.h) */
    struct turner_params params; /* that its files declare */
    struct turner_spirv spirv;
};

/* TURNER_BAD_INPUT with file, line and text for a broken shader. */
enum turner_result turner_kernel_create(struct turner_kernel *kernel, unsigned kind,
                                        const struct turner_render_options *options);
/* The same of another file than render.comp. */
enum turner_result turner_kernel_create_from(struct turner_kernel *kernel, const char *file,
                                             unsigned kind,
                                             const struct turner_render_options *options);
/* The same of source that has been read; the kernel takes its parameters from it. */
enum turner_result turner_kernel_compile(struct turner_kernel *kernel, unsigned kind,
                                         struct turner_shader_source *source, bool no_cache);
void turner_kernel_destroy(struct turner_kernel *kernel);

/* What specialises a kernel to a scene. */
#define TURNER_OWN_CONSTANTS 6 /* TURNER_CONSTANT_… */
struct turner_kernel_constants {
    struct turner_constant at[TURNER_OWN_CONSTANTS];
};

/* `bvh_depth` is turner_flat.max_depth. */
struct turner_kernel_constants turner_kernel_constants(const struct turner_needs *needs,
                                                       uint32_t bvh_depth);

#define TURNER_KERNEL_CONSTANTS (TURNER_OWN_CONSTANTS + TURNER_PARAM_WORDS)

/* The same, and the kernel's const parameters with the scene's values. TURNER_USAGE when one does
 * not fit. */
enum turner_result turner_kernel_specialisation(
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS], size_t *count,
    const struct turner_kernel *kernel, const struct turner_needs *needs, uint32_t bvh_depth,
    const struct turner_scene *scene);

/* Bytes of SPIR-V that are left of the kernel once it is specialised and optimised. No device. */
enum turner_result turner_kernel_size(size_t *bytes, const struct turner_kernel *kernel,
                                      const struct turner_needs *needs);

struct turner_renderer {
    struct turner_gpu *gpu; /* not owned; NULL until the second step */
    unsigned kind;          /* of its kernel, */
    uint64_t source;        /* and what that is made from */
    bool ray_query;
    struct turner_needs needs;
    struct turner_needs needs_of_scene, needs_of_surface; /* without what hooks ask for besides, and
                                                             with what a replaced surface does */
    struct turner_flat flat;
    struct turner_device_scene scene;
    struct turner_spirv special; /* between the two steps of creation */
    struct turner_program program;
    struct turner_param_block params;
    struct turner_post post;
    struct turner_image *before_post; /* NULL, or gets each picture, of its size, as it is before the
                                         hook `post`, where that is replaced */
    struct turner_buffer pixels;    /* of one tile, or results of one list */
    struct turner_buffer positions; /* of one list; adaptive pictures only */
    struct turner_buffer counters;
    struct turner_buffer pixel_counts; /* as many as `pixels`, where needs.pixel_counts */
    struct turner_settings settings;
    struct turner_renderer *accurate; /* an error is asked for and the methods are approximations:
                                         the same scene by those that are not; else NULL */
    float glow;  /* the largest radiance that shows without a light: background and emission */
    float blend; /* the largest difference in a channel between the ends of a gradient behind it all */
    int tile;    /* fixed edge in pixels, or 0: follows the time a tile takes, */
    int edge;    /* and is this at present, 0 before the first */
    double piece; /* seconds that what is submitted at once is to take; 0: as long as suits one who
                     waits for the whole picture */
};

/* Which traversal a device gets, BVH_LANE, BVH_PACKET or RAY_QUERY; TURNER_DEVICE says what is
 * missing when the device cannot do what is wanted. */
enum turner_result turner_choose_traversal(enum turner_traversal *chosen,
                                           const struct turner_gpu_info *info,
                                           enum turner_traversal wanted);

/* "bvh_lane", "bvh_packet" or "ray_query", of a kernel of this kind. */
const char *turner_traversal_name(unsigned kind);

/* The kind of kernel that draws with these methods on the device; `wanted` auto takes the methods'.
 * TURNER_DEVICE as above, and without float64 where they want it; TURNER_USAGE for precision f64
 * with ray queries, which are in floats. */
enum turner_result turner_choose_kernel(unsigned *kind, const struct turner_gpu_info *info,
                                        const struct turner_methods *methods,
                                        enum turner_traversal wanted);

/* The first step, without a device: builds the hierarchy and specialises the kernel, which is of the
 * kind that turner_choose_kernel gives for the scene. */
enum turner_result turner_renderer_prepare(struct turner_renderer *renderer,
                                           const struct turner_kernel *kernel,
                                           const struct turner_scene *scene,
                                           const struct turner_render_options *options,
                                           struct turner_statistics *statistics);

/* The second, with all the same: makes the program and uploads. Both fill sizes and times of
 * `statistics`, and destroy the renderer where they fail. */
enum turner_result turner_renderer_finish(struct turner_renderer *renderer, struct turner_gpu *gpu,
                                          const struct turner_kernel *kernel,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics);

/* One after the other. */
enum turner_result turner_renderer_create(struct turner_renderer *renderer, struct turner_gpu *gpu,
                                          const struct turner_kernel *kernel,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics);
void turner_renderer_destroy(struct turner_renderer *renderer);

/* Takes the scene's values of live parameters, nothing is compiled; not while something is traced.
 * TURNER_USAGE when one does not fit. Those that are const stay as they were compiled in. */
enum turner_result turner_renderer_set_params(struct turner_renderer *renderer,
                                              const struct turner_scene *scene);

/* Looks at the same scene in another way: with another camera, size, number of samples, aa_threshold
 * or error, and a depth that is no larger and a cutoff that may be any. Adaptive samples need a
 * renderer that was created for them. Builds and compiles nothing. */
enum turner_result turner_renderer_look(struct turner_renderer *renderer,
                                        const struct turner_scene *scene);

/* Takes other bounds of loops, with a program that was made for these needs. */
enum turner_result turner_renderer_set_bounds(struct turner_renderer *renderer,
                                              const struct turner_needs *needs);

/* Takes the materials and lights of `scene`, which has as many as the one it was created with, and
 * differs in nothing else; draw after turner_renderer_look. `fits` gets false, and nothing is done,
 * when the kernel lacks what they need, or a material begins or ceases to transmit. */
enum turner_result turner_renderer_paint(struct turner_renderer *renderer,
                                         const struct turner_scene *before,
                                         const struct turner_scene *scene, bool *fits);

/* Takes instances that stand elsewhere: only the level over them is built anew. `fits` gets false
 * when the scene differs in more from the one it was created with, materials and lights apart, or
 * there is no room; the renderer is then to be made anew, as after a failure. Not while something is
 * traced. */
enum turner_result turner_renderer_move(struct turner_renderer *renderer,
                                        const struct turner_scene *scene, bool *fits);

struct turner_gpu_dispatch;

/* Records a dispatch of the kernel, of render.comp or rays.comp, over `groups` > 0 pieces of
 * TURNER_WORKGROUP² samples or rays; push.counters and push.groups are filled in. The threads of a
 * CPU device take them one by one (shaders/work.glsl). */
void turner_renderer_dispatch(VkCommandBuffer commands, const struct turner_renderer *renderer,
                              struct turner_gpu_dispatch push, uint32_t groups);

/* Runs the kernel of render.comp on no pixel: a driver that compiles at the first dispatch does so
 * then. */
enum turner_result turner_renderer_warm(struct turner_renderer *renderer);

#define TURNER_TILE_MAX 512       /* edge in pixels */
#define TURNER_LIST_MAX (1u << 16) /* samples; no more than pixels of the largest tile */

/* Traces `count` samples at `positions` (in the picture, in pixels, row 0 at the top) into `results`
 * (radiance and pruned weight each), followed to `depth` and `cutoff`, which need not be those of
 * the settings, `depth` not more. Counts go to the renderer's counters. */
enum turner_result turner_renderer_trace(struct turner_renderer *renderer, int depth, double cutoff,
                                         const float (*positions)[2], size_t count,
                                         float (*results)[4]);
/* The same, and adds to `counts`, unless NULL, what each sample took (with needs.pixel_counts). */
enum turner_result turner_renderer_trace_counted(struct turner_renderer *renderer, int depth,
                                                 double cutoff, const float (*positions)[2],
                                                 size_t count, float (*results)[4],
                                                 struct turner_gpu_pixel_counts *counts);

/* Traces the picture into `image` (width × height of the scene's settings); adds to the counts and
 * times of `statistics`. */
enum turner_result turner_renderer_draw(struct turner_renderer *renderer,
                                        struct turner_image *image,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics);

/* Tells the caller of the library how far it is; TURNER_INTERRUPTED when that wants no more. */
enum turner_result turner_report(const struct turner_render_options *options, double share);

/* Seconds of a clock that only goes forward. */
double turner_seconds(void);

#endif
