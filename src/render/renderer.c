#include "render/renderer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"
#include "gpu/cached.h"
#include "gpu/include.h"
#include "render/adaptive.h"
#include "render/follow.h"
#include "render/hooks.h"
#include "render/layers.h"
#include "scene/methods.h"

double turner_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

enum turner_result turner_choose_traversal(enum turner_traversal *chosen,
                                           const struct turner_gpu_info *info,
                                           enum turner_traversal wanted)
{
    *chosen = wanted == TURNER_TRAVERSAL_AUTO ? info->fastest : wanted;
    wanted = *chosen;
    /* not measured: a CPU is faster at our own hierarchy (docs/performance.md), hardware at its own */
    if (wanted == TURNER_TRAVERSAL_AUTO && info->ray_query && !info->software)
        *chosen = TURNER_TRAVERSAL_RAY_QUERY;
    else if (wanted == TURNER_TRAVERSAL_AUTO || wanted == TURNER_TRAVERSAL_BVH)
        *chosen = info->packets ? TURNER_TRAVERSAL_BVH_PACKET : TURNER_TRAVERSAL_BVH_LANE;
    if (*chosen == TURNER_TRAVERSAL_RAY_QUERY && !info->ray_query)
        return turner_fail(TURNER_DEVICE,
                           "device \"%s\" cannot trace with ray queries: it lacks %s; use "
                           "--traversal bvh, or auto", info->name, info->missing);
    if (*chosen == TURNER_TRAVERSAL_BVH_PACKET && !info->packets)
        return turner_fail(TURNER_DEVICE,
                           "device \"%s\" cannot trace packets: its subgroups are not of 8 lanes "
                           "that can hand each other numbers; use --traversal bvh, or auto",
                           info->name);
    return TURNER_OK;
}

const char *turner_traversal_name(unsigned kind)
{
    return kind & TURNER_RAY_QUERY ? "ray_query" : kind & TURNER_PACKET ? "bvh_packet" : "bvh_lane";
}

static unsigned kind_of(const struct turner_methods *methods)
{
    return (methods->precision == TURNER_PRECISION_F64 ? TURNER_F64 : 0) |
           (methods->sphere == TURNER_SPHERE_DOUBLE ? TURNER_SPHERE_F64 : 0);
}

enum turner_result turner_choose_kernel(unsigned *kind, const struct turner_gpu_info *info,
                                        const struct turner_methods *methods,
                                        enum turner_traversal wanted)
{
    bool f64 = methods->precision == TURNER_PRECISION_F64;
    enum turner_traversal chosen;
    *kind = kind_of(methods);
    if (*kind && !info->float64)
        return turner_fail(TURNER_DEVICE, "device \"%s\" has no 64-bit floats; leave out %s",
                           info->name, f64 ? "precision=f64" : "sphere=f64");
    if (wanted == TURNER_TRAVERSAL_AUTO)
        wanted = methods->traversal;
    if (f64 && wanted == TURNER_TRAVERSAL_RAY_QUERY)
        return turner_fail(TURNER_USAGE, "ray queries are in 32-bit floats: choose traversal bvh "
                                         "for precision f64");
    if (f64 && wanted == TURNER_TRAVERSAL_AUTO)
        wanted = TURNER_TRAVERSAL_BVH;
    TURNER_TRY(turner_choose_traversal(&chosen, info, wanted));
    *kind |= chosen == TURNER_TRAVERSAL_RAY_QUERY    ? TURNER_RAY_QUERY
             : chosen == TURNER_TRAVERSAL_BVH_PACKET ? TURNER_PACKET
                                                     : 0;
    return TURNER_OK;
}

enum turner_result turner_kernel_create(struct turner_kernel *kernel, unsigned kind,
                                        const struct turner_render_options *options)
{
    return turner_kernel_create_from(kernel, "render.comp", kind, options);
}

enum turner_result turner_kernel_create_from(struct turner_kernel *kernel, const char *file,
                                             unsigned kind,
                                             const struct turner_render_options *options)
{
    memset(kernel, 0, sizeof *kernel);
    struct turner_shader_source source;
    enum turner_result result = turner_shader_source_create(&source, file, options->shader_dirs,
                                                            options->shader_dir_count);
    if (result == TURNER_OK)
        result = turner_kernel_compile(kernel, kind, &source, options->no_cache);
    turner_shader_source_destroy(&source);
    return result;
}

enum turner_result turner_kernel_compile(struct turner_kernel *kernel, unsigned kind,
                                         struct turner_shader_source *source, bool no_cache)
{
    static const char *const names[] = {
        "TURNER_RAY_QUERY", "TURNER_PACKET",     "TURNER_F64",            "TURNER_SPHERE_F64",
        "TURNER_RECORD",    "TURNER_PROBE_HITS", "TURNER_PROBE_RADIANCE", "TURNER_RAYS_SEND"};
    const char *defines[sizeof names / sizeof *names];
    size_t count = 0;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (kind & 1u << i)
            defines[count++] = names[i];
    }
    memset(kernel, 0, sizeof *kernel);
    kernel->kind = kind;
    kernel->source = turner_source_hash(source);
    kernel->hooks = turner_hooks_of(source);
    kernel->params = source->params;
    source->params = (struct turner_params){0};
    return no_cache
               ? turner_compile(&kernel->spirv, source, defines, count)
               : turner_compile_cached(&kernel->spirv, &kernel->cached, source, defines, count);
}

void turner_kernel_destroy(struct turner_kernel *kernel)
{
    turner_params_destroy(&kernel->params);
    turner_spirv_destroy(&kernel->spirv);
}

/* Sizes are rounded up so that scenes that differ a little share the driver's compiled code. */
static uint32_t round_up(uint32_t size, uint32_t step)
{
    return (size + step - 1) / step * step;
}

struct turner_kernel_constants turner_kernel_constants(const struct turner_needs *needs,
                                                       uint32_t bvh_depth)
{
    return (struct turner_kernel_constants){{
        {TURNER_CONSTANT_NEEDS, needs->bits},
        {TURNER_CONSTANT_STACK, needs->stack > 1 ? round_up(needs->stack, 8) : 1},
        {TURNER_CONSTANT_BVH_STACK, round_up(bvh_depth > 0 ? bvh_depth : 1, 8)},
        {TURNER_CONSTANT_METHODS, needs->methods},
        {TURNER_CONSTANT_PIXEL_COUNTS, needs->pixel_counts},
        {TURNER_CONSTANT_SOON, needs->soon},
    }};
}

enum turner_result turner_kernel_specialisation(
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS], size_t *count,
    const struct turner_kernel *kernel, const struct turner_needs *needs, uint32_t bvh_depth,
    const struct turner_scene *scene)
{
    struct turner_kernel_constants own = turner_kernel_constants(needs, bvh_depth);
    *count = sizeof own.at / sizeof *own.at;
    memcpy(constants, own.at, sizeof own.at);
    return turner_params_constants(constants, count, &kernel->params, scene);
}

enum turner_result turner_kernel_size(size_t *bytes, const struct turner_kernel *kernel,
                                      const struct turner_needs *needs)
{
    /* the depth of the tree is an array's length, and changes no instruction */
    struct turner_kernel_constants constants = turner_kernel_constants(needs, 0);
    struct turner_spirv special;
    TURNER_TRY(turner_spirv_specialise(&special, &kernel->spirv, constants.at,
                                       sizeof constants.at / sizeof *constants.at));
    *bytes = special.count * sizeof *special.words;
    turner_spirv_destroy(&special);
    return TURNER_OK;
}

/* Drivers could fold the constants themselves, but those that run on a CPU do it each time anew. */
static enum turner_result specialise(struct turner_renderer *renderer,
                                     const struct turner_kernel *kernel,
                                     const struct turner_scene *scene,
                                     const struct turner_render_options *options,
                                     struct turner_statistics *statistics)
{
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, kernel, &renderer->needs,
                                            renderer->flat.max_depth, scene));
    return options->no_cache
               ? turner_spirv_reduce(&renderer->special, &kernel->spirv, constants, count,
                                     options->soon)
               : turner_spirv_reduce_cached(&renderer->special, &statistics->kernel_cached,
                                            &kernel->spirv, constants, count, options->soon);
}

static enum turner_result build(struct turner_renderer *renderer,
                                const struct turner_kernel *kernel,
                                const struct turner_scene *scene,
                                const struct turner_render_options *options,
                                struct turner_statistics *statistics)
{
    double start = turner_seconds();
    TURNER_TRY(turner_flat_create(&renderer->flat, scene,
                                  renderer->ray_query            ? TURNER_ORDER_MEDIAN
                                  : kernel->kind & TURNER_PACKET ? TURNER_ORDER_WIDE
                                                                 : TURNER_ORDER_SAH));
    double built = turner_seconds();
    TURNER_TRY(specialise(renderer, kernel, scene, options, statistics));
    statistics->seconds_build = built - start;
    statistics->seconds_compile += turner_seconds() - built;
    statistics->kernel_words = kernel->spirv.count;
    statistics->source_cached = kernel->cached;
    statistics->needs = renderer->needs.bits;
    return TURNER_OK;
}

static enum turner_result upload(struct turner_renderer *renderer,
                                 const struct turner_kernel *kernel,
                                 const struct turner_scene *scene,
                                 const struct turner_render_options *options,
                                 struct turner_statistics *statistics)
{
    struct turner_gpu *gpu = renderer->gpu;
    double start = turner_seconds();
    TURNER_TRY(turner_program_create(&renderer->program, gpu, &renderer->special, NULL, 0,
                                     options->no_cache));
    turner_spirv_destroy(&renderer->special);
    statistics->driver_cached = renderer->program.cached;
    double made = turner_seconds();
    TURNER_TRY(turner_param_block_create(&renderer->params, gpu, &kernel->params, scene));
    TURNER_TRY(turner_post_create(&renderer->post, gpu, scene, options));
    TURNER_TRY(turner_device_scene_create(&renderer->scene, gpu, scene, &renderer->flat,
                                          &renderer->needs, renderer->ray_query));
    turner_flat_release(&renderer->flat);
    if (renderer->ray_query)
        TURNER_TRY(turner_program_bind_acceleration(&renderer->program, gpu, TURNER_BINDING_TLAS,
                                                    renderer->scene.top.handle));
    bool adaptive = turner_adaptive_wanted(&renderer->settings);
    uint64_t edge = (uint64_t)(renderer->tile ? renderer->tile : TURNER_TILE_MAX);
    uint64_t pixels = adaptive && edge * edge < TURNER_LIST_MAX ? TURNER_LIST_MAX : edge * edge;
    TURNER_TRY(turner_buffer_create(&renderer->pixels, gpu, pixels * 4 * sizeof(float), 0,
                                    TURNER_MEMORY_HOST, "a tile of pixels"));
    TURNER_TRY(turner_buffer_create(&renderer->counters, gpu, sizeof(struct turner_gpu_counters),
                                    0, TURNER_MEMORY_HOST, "ray counters"));
    if (renderer->needs.pixel_counts)
        TURNER_TRY(turner_buffer_create(&renderer->pixel_counts, gpu,
                                        pixels * sizeof(struct turner_gpu_pixel_counts), 0,
                                        TURNER_MEMORY_HOST, "ray counts of a tile"));
    if (adaptive)
        TURNER_TRY(turner_buffer_create(&renderer->positions, gpu,
                                        TURNER_LIST_MAX * 2 * sizeof(float), 0,
                                        TURNER_MEMORY_HOST, "a list of samples"));
    statistics->seconds_compile += made - start;
    statistics->seconds_upload = turner_seconds() - made;
    statistics->primitives = renderer->flat.primitive_count + scene->plane_count;
    statistics->instances = scene->instance_count;
    return TURNER_OK;
}

static enum turner_result create_accurate(struct turner_renderer *renderer,
                                          const struct turner_kernel *kernel,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics)
{
    struct turner_statistics own = {0};
    struct turner_scene copy = *scene;
    if (!turner_methods_approximate(&copy.settings.methods, &scene->settings.methods))
        return TURNER_OK;
    renderer->accurate = turner_calloc(1, sizeof *renderer->accurate);
    TURNER_TRY(turner_renderer_create(renderer->accurate, renderer->gpu, kernel, &copy, options,
                                      &own));
    statistics->seconds_build += own.seconds_build;
    statistics->seconds_compile += own.seconds_compile;
    statistics->seconds_upload += own.seconds_upload;
    return TURNER_OK;
}

/* The scene with the depth that its settings come to; shares all but them. */
static struct turner_scene deep_enough(const struct turner_scene *scene)
{
    struct turner_scene deep = *scene;
    if (deep.settings.error > 0)
        turner_follow_settings(&deep.settings,
                               turner_needs_of(scene).bits & TURNER_NEEDS_BRANCHING);
    return deep;
}

enum turner_result turner_renderer_prepare(struct turner_renderer *renderer,
                                           const struct turner_kernel *kernel,
                                           const struct turner_scene *scene,
                                           const struct turner_render_options *options,
                                           struct turner_statistics *statistics)
{
    memset(renderer, 0, sizeof *renderer);
    assert((kernel->kind & (TURNER_F64 | TURNER_SPHERE_F64)) ==
           kind_of(&scene->settings.methods));
    renderer->kind = kernel->kind;
    renderer->source = kernel->source;
    renderer->ray_query = kernel->kind & TURNER_RAY_QUERY;
    struct turner_scene deep = deep_enough(scene);
    renderer->needs = turner_needs_of(&deep);
    renderer->needs.pixel_counts = turner_layers_want(options->layers, TURNER_LAYERS_OF_RAYS);
    renderer->needs.soon = options->soon;
    if (options->unspecialised)
        renderer->needs.bits = TURNER_NEEDS_ALL;
    renderer->needs_of_scene = renderer->needs;
    renderer->needs_of_surface = renderer->needs;
    turner_hooks_widen(&renderer->needs_of_surface, &deep);
    if (kernel->hooks & 1u << TURNER_HOOK_SURFACE)
        renderer->needs = renderer->needs_of_surface;
    renderer->settings = deep.settings;
    renderer->glow = turner_follow_glow(scene);
    renderer->blend = turner_follow_blend(scene);
    renderer->tile = options->tile;
    enum turner_result result = build(renderer, kernel, &deep, options, statistics);
    if (result != TURNER_OK)
        turner_renderer_destroy(renderer);
    return result;
}

enum turner_result turner_renderer_finish(struct turner_renderer *renderer, struct turner_gpu *gpu,
                                          const struct turner_kernel *kernel,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics)
{
    struct turner_scene deep = deep_enough(scene);
    renderer->gpu = gpu;
    enum turner_result result = upload(renderer, kernel, &deep, options, statistics);
    if (result == TURNER_OK && scene->settings.error > 0)
        result = create_accurate(renderer, kernel, scene, options, statistics);
    if (result != TURNER_OK)
        turner_renderer_destroy(renderer);
    return result;
}

enum turner_result turner_renderer_create(struct turner_renderer *renderer, struct turner_gpu *gpu,
                                          const struct turner_kernel *kernel,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics)
{
    TURNER_TRY(turner_renderer_prepare(renderer, kernel, scene, options, statistics));
    return turner_renderer_finish(renderer, gpu, kernel, scene, options, statistics);
}

enum turner_result turner_renderer_set_bounds(struct turner_renderer *renderer,
                                              const struct turner_needs *needs)
{
    const struct turner_buffer *block = &renderer->scene.arrays[TURNER_ARRAY_SCENE];
    TURNER_TRY(turner_buffer_upload(renderer->gpu, block, offsetof(struct turner_gpu_scene, max_steps),
                                    &needs->max_steps, sizeof needs->max_steps));
    return turner_buffer_upload(renderer->gpu, block,
                                offsetof(struct turner_gpu_scene, max_crossings),
                                &needs->max_crossings, sizeof needs->max_crossings);
}

enum turner_result turner_renderer_set_params(struct turner_renderer *renderer,
                                              const struct turner_scene *scene)
{
    if (renderer->accurate)
        TURNER_TRY(turner_renderer_set_params(renderer->accurate, scene));
    TURNER_TRY(turner_param_block_set(&renderer->params, scene));
    return turner_param_block_set(&renderer->post.params, scene);
}

enum turner_result turner_renderer_look(struct turner_renderer *renderer,
                                        const struct turner_scene *scene)
{
    struct turner_scene deep = deep_enough(scene);
    assert(!turner_adaptive_wanted(&deep.settings) || renderer->positions.buffer);
    renderer->settings = deep.settings;
    renderer->glow = turner_follow_glow(scene);
    renderer->blend = turner_follow_blend(scene);
    TURNER_TRY(turner_device_scene_look(&renderer->scene, renderer->gpu, &deep, &renderer->flat,
                                        &renderer->needs, renderer->ray_query));
    return renderer->accurate ? turner_renderer_look(renderer->accurate, scene) : TURNER_OK;
}

static bool transmits(const struct turner_material *material)
{
    return material->k_t.x != 0 || material->k_t.y != 0 || material->k_t.z != 0;
}

enum turner_result turner_renderer_paint(struct turner_renderer *renderer,
                                         const struct turner_scene *before,
                                         const struct turner_scene *scene, bool *fits)
{
    *fits = !(turner_needs_of(scene).bits & ~renderer->needs.bits);
    for (size_t i = 0; i < scene->material_count && *fits; i++)
        *fits = transmits(&scene->materials[i]) == transmits(&before->materials[i]);
    if (!*fits)
        return TURNER_OK;
    TURNER_TRY(turner_device_scene_paint(&renderer->scene, renderer->gpu, scene));
    return renderer->accurate ? turner_device_scene_paint(&renderer->accurate->scene,
                                                          renderer->gpu, scene)
                              : TURNER_OK;
}

enum turner_result turner_renderer_move(struct turner_renderer *renderer,
                                        const struct turner_scene *scene, bool *fits)
{
    enum turner_result result = TURNER_OK;
    *fits = !(turner_needs_of(scene).bits & ~renderer->needs.bits);
    if (*fits)
        result = turner_flat_move(&renderer->flat, scene, fits);
    if (result == TURNER_OK && *fits)
        result = turner_device_scene_move(&renderer->scene, renderer->gpu, scene, &renderer->flat,
                                          renderer->ray_query);
    turner_flat_release(&renderer->flat);
    if (result == TURNER_OK && *fits && renderer->ray_query)
        result = turner_program_bind_acceleration(&renderer->program, renderer->gpu,
                                                  TURNER_BINDING_TLAS, renderer->scene.top.handle);
    if (result == TURNER_OK && *fits && renderer->accurate)
        result = turner_renderer_move(renderer->accurate, scene, fits);
    return result;
}

void turner_renderer_destroy(struct turner_renderer *renderer)
{
    struct turner_gpu *gpu = renderer->gpu;
    if (renderer->accurate)
        turner_renderer_destroy(renderer->accurate);
    free(renderer->accurate);
    if (gpu) {
        turner_buffer_destroy(gpu, &renderer->pixel_counts);
        turner_buffer_destroy(gpu, &renderer->counters);
        turner_buffer_destroy(gpu, &renderer->pixels);
        turner_buffer_destroy(gpu, &renderer->positions);
        turner_device_scene_destroy(gpu, &renderer->scene);
        turner_param_block_destroy(gpu, &renderer->params);
        turner_post_destroy(gpu, &renderer->post);
        turner_program_destroy(gpu, &renderer->program);
    }
    turner_spirv_destroy(&renderer->special);
    turner_flat_destroy(&renderer->flat);
    memset(renderer, 0, sizeof *renderer);
}
