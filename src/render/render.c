/* turner_render: from a scene to a picture and its statistics, on a device or by the reference. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "base/memory.h"
#include "reference/reference.h"
#include "render/adaptive.h"
#include "render/cells.h"
#include "render/contrast.h"
#include "render/features.h"
#include "render/hooks.h"
#include "render/layers.h"
#include "render/measure.h"
#include "render/opening.h"
#include "render/renderer.h"
#include "render/shader_path.h"
#include "../shaders/shared.h"

static void inspect(const struct turner_image *image, struct turner_statistics *statistics)
{
    double sum = 0;
    size_t count = (size_t)image->width * (size_t)image->height;
    statistics->nonfinite_x = statistics->nonfinite_y = -1;
    for (size_t i = 0; i < count; i++) {
        const float *pixel = image->rgba + 4 * i;
        double pruned = (double)pixel[3];
        sum += pruned;
        if (pruned > statistics->pruned_max)
            statistics->pruned_max = pruned;
        if (isfinite(pixel[0]) && isfinite(pixel[1]) && isfinite(pixel[2]) && isfinite(pixel[3]))
            continue;
        if (statistics->nonfinite++ == 0) {
            statistics->nonfinite_x = (int)(i % (size_t)image->width);
            statistics->nonfinite_y = (int)(i / (size_t)image->width);
        }
    }
    statistics->pruned_mean = sum / (double)count;
}

static void warn(const struct turner_statistics *statistics)
{
    if (statistics->nonfinite)
        turner_warn("%llu pixel%s not finite, the first at %d,%d; turner explain SCENE --pixel "
                    "%d,%d says which ray began it", (unsigned long long)statistics->nonfinite,
                    statistics->nonfinite == 1 ? " is" : "s are", statistics->nonfinite_x,
                    statistics->nonfinite_y, statistics->nonfinite_x, statistics->nonfinite_y);
    if (statistics->unfinished)
        turner_warn("%llu samples ran into the bound of a loop and are too dark; lower --depth",
                    (unsigned long long)statistics->unfinished);
}

/* Of a pixel; the reference gives each the most. */
static int least_samples(const struct turner_settings *settings, bool reference)
{
    return turner_adaptive_wanted(settings) && !reference ? TURNER_CELL_SAMPLES : settings->spp;
}

static enum turner_result draw_by_reference(struct turner_image *image,
                                            const struct turner_scene *scene,
                                            const struct turner_render_options *options,
                                            struct turner_statistics *statistics)
{
    struct turner_reference_statistics counts = {0};
    snprintf(statistics->device, sizeof statistics->device, "reference");
    statistics->traversal = "reference";
    statistics->precision = "extended";
    double start = turner_seconds();
    TURNER_TRY(turner_reference_render_layers(image, options->layers, scene, options->threads,
                                              &counts, options->progress, options->user));
    statistics->seconds_trace = turner_seconds() - start;
    statistics->camera_rays = counts.camera_rays;
    statistics->reflected_rays = counts.reflected_rays;
    statistics->refracted_rays = counts.refracted_rays;
    statistics->shadow_rays = counts.shadow_rays;
    statistics->tir_rays = counts.tir_rays;
    statistics->camera_hits = counts.camera_hits;
    statistics->largest_depth = counts.largest_depth;
    return TURNER_OK;
}

/* Which is faster, ray queries in hardware or our own hierarchy, only measuring tells: once on each
 * device. A CPU's ray queries are no hardware. Without an answer auto goes by rule. */
static void measure_once(struct turner_gpu *gpu, const struct turner_methods *methods,
                         const struct turner_render_options *options)
{
    struct turner_traversal_rate rates[TURNER_TRAVERSALS_MEASURED];
    size_t count;
    if (options->traversal == TURNER_TRAVERSAL_AUTO &&
        methods->traversal == TURNER_TRAVERSAL_AUTO &&
        gpu->info.fastest == TURNER_TRAVERSAL_AUTO && gpu->info.ray_query && !gpu->info.software &&
        !options->no_cache)
        (void)turner_measure_traversals(rates, &count, gpu, options);
}

/* Of a larger scene building the hierarchy waits for the device, in case it is for another. */
#define GUESSED_PRIMITIVES 65536

static bool is_small(const struct turner_scene *scene)
{
    size_t count = 0;
    for (size_t i = 0; i < scene->group_count; i++)
        count += turner_group_primitive_count(&scene->groups[i]);
    return count <= GUESSED_PRIMITIVES;
}

/* What is done while the device opens is for the kernel that one on a CPU would get; whether that was
 * right is known afterwards. Either's failure counts in the order of the steps. */
enum turner_result turner_opening_prepare(struct turner_renderer *renderer,
                                          struct turner_kernel *kernel,
                                          struct turner_opening *opening,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options,
                                          struct turner_statistics *statistics)
{
    static const struct turner_gpu_info likely = {
        .software = true, .packets = true, .ray_query = true, .float64 = true};
    const struct turner_methods *methods = &scene->settings.methods;
    unsigned guess, kind;
    double start = turner_seconds();
    enum turner_result guessed =
        turner_choose_kernel(&guess, &likely, methods, options->traversal);
    bool chosen = guessed == TURNER_OK, prepared = chosen && is_small(scene);
    if (guessed == TURNER_OK)
        guessed = turner_kernel_create(kernel, guess, options);
    statistics->seconds_compile = turner_seconds() - start;
    if (guessed == TURNER_OK && prepared)
        guessed = turner_renderer_prepare(renderer, kernel, scene, options, statistics);
    char *message = guessed == TURNER_OK ? NULL : turner_strdup(turner_message());

    enum turner_result result;
    TURNER_TRY_DONE(turner_opening_finish(opening));
    measure_once(&opening->gpu, methods, options);
    TURNER_TRY_DONE(
        turner_choose_kernel(&kind, &opening->gpu.info, methods, options->traversal));
    if (!chosen || kind != guess) {
        turner_renderer_destroy(renderer);
        turner_kernel_destroy(kernel);
        prepared = false;
        start = turner_seconds();
        result = turner_kernel_create(kernel, kind, options);
        statistics->seconds_compile += turner_seconds() - start;
    } else if (guessed != TURNER_OK) {
        result = turner_fail(guessed, "%s", message);
    }
    if (result == TURNER_OK && !prepared)
        result = turner_renderer_prepare(renderer, kernel, scene, options, statistics);
done:
    if (result != TURNER_OK)
        turner_renderer_destroy(renderer);
    free(message);
    return result;
}

static enum turner_result draw_on_device(struct turner_image *image,
                                         const struct turner_scene *scene,
                                         const struct turner_render_options *options,
                                         struct turner_statistics *statistics,
                                         struct turner_opening *opening)
{
    struct turner_gpu *gpu = &opening->gpu;
    struct turner_kernel kernel = {0};
    struct turner_renderer renderer = {0};
    enum turner_result result;
    const struct turner_methods *methods = &scene->settings.methods;
    TURNER_TRY_DONE(
        turner_opening_prepare(&renderer, &kernel, opening, scene, options, statistics));
    statistics->seconds_device = opening->seconds;
    snprintf(statistics->device, sizeof statistics->device, "%s", gpu->info.name);
    snprintf(statistics->driver, sizeof statistics->driver, "%s", gpu->info.driver);
    TURNER_TRY_DONE(turner_renderer_finish(&renderer, gpu, &kernel, scene, options, statistics));
    double start = turner_seconds();
    TURNER_TRY_DONE(turner_renderer_warm(&renderer));
    statistics->seconds_compile += turner_seconds() - start;
    statistics->traversal = turner_traversal_name(kernel.kind);
    statistics->precision = methods->precision == TURNER_PRECISION_F64 ? "f64" : "f32";
    if (turner_layers_want(options->layers, TURNER_LAYERS_OF_CENTER))
        TURNER_TRY_DONE(turner_features_draw(options->layers, &renderer, &kernel, scene, options,
                                             statistics));
    TURNER_TRY_DONE(turner_renderer_draw(&renderer, image, options, statistics));
done:
    turner_renderer_destroy(&renderer);
    turner_kernel_destroy(&kernel);
    statistics->device_peak_bytes = gpu->memory_peak;
    return result;
}

enum turner_result turner_render(struct turner_image *image, const struct turner_scene *scene,
                                 const struct turner_render_options *options,
                                 struct turner_statistics *statistics)
{
    struct turner_opening opening;
    turner_opening_start(&opening, options ? options->device : NULL);
    enum turner_result result = turner_render_opened(image, scene, options, statistics, &opening);
    turner_opening_destroy(&opening);
    return result;
}

/* What does not take part in the picture, or in what is said of it. */
static enum turner_result warn_of_hooks(const struct turner_scene *scene,
                                        const struct turner_render_options *options, bool reference)
{
    uint32_t hooks;
    char paths[512];
    if (reference)
        return turner_hooks_warn(options, "its picture is without them");
    if (scene->settings.error == 0)
        return TURNER_OK;
    TURNER_TRY(turner_hooks_find(&hooks, paths, options));
    if (hooks)
        turner_warn("the estimate of the error knows nothing of %s: it may be too low where they "
                    "make light, and is of the picture before user/post.glsl", paths);
    return TURNER_OK;
}

/* A misspelt name would otherwise do nothing. */
static enum turner_result check_params(const struct turner_scene *scene,
                                       const struct turner_render_options *options)
{
    struct turner_params params;
    if (!scene->param_count)
        return TURNER_OK;
    enum turner_result result = turner_params_find(&params, NULL, options);
    if (result == TURNER_OK)
        result = turner_params_check(&params, scene);
    turner_params_destroy(&params);
    return result;
}

static enum turner_result draw(struct turner_image *image, const struct turner_scene *scene,
                               const struct turner_render_options *options,
                               struct turner_statistics *statistics,
                               struct turner_opening *opening)
{
    struct turner_statistics unused;
    if (!statistics)
        statistics = &unused;
    double seconds_parse = statistics == &unused ? 0 : statistics->seconds_parse;
    memset(statistics, 0, sizeof *statistics);
    statistics->samples_mean = statistics->samples_max = scene->settings.spp;
    statistics->seconds_parse = seconds_parse; /* whoever loaded the scene knows it */

    memset(image, 0, sizeof *image);
    bool reference = options->device && strcmp(options->device, "reference") == 0;
    if (reference && scene->settings.error > 0)
        return turner_fail(TURNER_USAGE, "the reference draws with given samples, depth and "
                                         "cutoff, not to an error; give it --spp");
    if (options->layers)
        TURNER_TRY(turner_layers_create(options->layers, scene));
    if (!reference) /* that makes its own */
        TURNER_TRY(turner_image_create(image, scene->settings.width, scene->settings.height));
    TURNER_TRY(warn_of_hooks(scene, options, reference));
    TURNER_TRY(check_params(scene, options));
    TURNER_TRY(reference ? draw_by_reference(image, scene, options, statistics)
                         : draw_on_device(image, scene, options, statistics, opening));
    inspect(image, statistics);
    if (options->layers)
        turner_layers_inspect(options->layers, image);
    if (scene->settings.error == 0 &&
        turner_layers_want(options->layers, 1u << TURNER_LAYER_ERROR))
        turner_contrast_estimate(options->layers->real[TURNER_LAYER_ERROR], image,
                                 least_samples(&scene->settings, reference));
    warn(statistics);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    statistics->host_peak_bytes = (uint64_t)usage.ru_maxrss * 1024;
    return TURNER_OK;
}

enum turner_result turner_render_opened(struct turner_image *image,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics,
                                        struct turner_opening *opening)
{
    struct turner_render_options whole = {0};
    struct turner_shader_path path;
    if (options)
        whole = *options;
    turner_shader_path_create(&path, &whole, scene);
    enum turner_result result = draw(image, scene, &whole, statistics, opening);
    turner_shader_path_destroy(&path);
    return result;
}
