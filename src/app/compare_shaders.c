/* turner compare-shaders: the work. */
#include "app/compare_shaders.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/specialise.h"
#include "reference/reference.h"
#include "render/hooks.h"
#include "render/params.h"
#include "render/renderer.h"
#include "render/shader_path.h"
#include "scene/methods.h"

/* What a side has on the device. */
struct station {
    struct turner_render_options options;
    const char *dirs[TURNER_SHADER_DIRS + 1];
    struct turner_shader_path path;
    struct turner_kernel kernel;
    struct turner_renderer renderer;
};

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(const double *values, int count)
{
    double sorted[TURNER_SIDE_RUNS];
    memcpy(sorted, values, (size_t)count * sizeof *values);
    qsort(sorted, (size_t)count, sizeof *sorted, by_size);
    return count % 2 ? sorted[count / 2] : 0.5 * (sorted[count / 2 - 1] + sorted[count / 2]);
}

/* ---- scenes ---- */

/* The parameters of both sides may differ: a value is for those that have it, and one that none has
 * is a mistake. */
static enum turner_result check_names(const struct turner_params params[2],
                                      const struct turner_scene *scene)
{
    struct turner_params both = {0};
    for (int i = 0; i < 2; i++) {
        for (size_t k = 0; k < params[i].count; k++)
            *TURNER_PUSH(both.at, both.count, both.capacity) = params[i].at[k];
    }
    enum turner_result result = turner_params_check(&both, scene);
    turner_params_destroy(&both);
    return result;
}

/* Leaves the side the values of the parameters it has. */
static void keep_own(struct turner_scene *scene, const struct turner_params *params)
{
    size_t kept = 0;
    for (size_t i = 0; i < scene->param_count; i++) {
        struct turner_scene_param param = scene->params[i];
        if (turner_params_get(params, param.name)) {
            scene->params[kept++] = param;
        } else {
            free(param.name);
            free(param.value);
        }
    }
    scene->param_count = kept;
}

static enum turner_result load_side(struct turner_side *side, const struct turner_sides *sides)
{
    struct turner_scene_options options = sides->options;
    TURNER_TRY(turner_scene_load(&side->scene, sides->path));
    for (size_t i = 0; i < side->method_count; i++)
        TURNER_TRY(turner_method_assign(&side->scene->settings, side->methods[i]));
    for (size_t i = 0; i < options.param_count; i++)
        TURNER_TRY(turner_scene_assign_param(side->scene, options.params[i]));
    for (size_t i = 0; i < side->param_count; i++)
        TURNER_TRY(turner_scene_assign_param(side->scene, side->params[i]));
    return turner_scene_options_settings(&options, side->scene);
}

static void find_folders(struct station *station, const struct turner_side *side,
                         const struct turner_sides *sides)
{
    const struct turner_render_options *render = &sides->options.render;
    size_t count = 0;
    station->options = *render;
    if (strcmp(side->folder, "-") != 0)
        station->dirs[count++] = side->folder;
    for (size_t i = 0; i < render->shader_dir_count; i++)
        station->dirs[count++] = render->shader_dirs[i];
    station->options.shader_dirs = station->dirs;
    station->options.shader_dir_count = count;
    turner_shader_path_create(&station->path, &station->options, side->scene);
}

static enum turner_result load_sides(struct turner_sides *sides, struct station stations[2])
{
    struct turner_params params[2] = {{0}};
    enum turner_result result;
    for (int i = 0; i < 2; i++) {
        struct turner_side *side = &sides->side[i];
        uint32_t hooks;
        TURNER_TRY_DONE(load_side(side, sides));
        find_folders(&stations[i], side, sides);
        TURNER_TRY_DONE(turner_hooks_find(&hooks, side->hooks, &stations[i].options));
        TURNER_TRY_DONE(turner_params_find(&params[i], NULL, &stations[i].options));
    }
    for (int i = 0; i < 2; i++) {
        TURNER_TRY_DONE(check_names(params, sides->side[i].scene));
        keep_own(sides->side[i].scene, &params[i]);
        TURNER_TRY_DONE(turner_params_settle(sides->side[i].scene, &stations[i].options));
    }
done:
    turner_params_destroy(&params[0]);
    turner_params_destroy(&params[1]);
    return result;
}

/* ---- on the device ---- */

/* As turner_kernel_size, with the scene's values of const parameters. */
static enum turner_result measure_kernel(size_t *bytes, const struct station *station,
                                         const struct turner_scene *scene)
{
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    struct turner_spirv special;
    size_t count;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, &station->kernel,
                                            &station->renderer.needs, 0, scene));
    TURNER_TRY(turner_spirv_specialise(&special, &station->kernel.spirv, constants, count));
    *bytes = special.count * sizeof *special.words;
    turner_spirv_destroy(&special);
    return TURNER_OK;
}

static enum turner_result make(struct station *station, struct turner_side *side,
                               struct turner_gpu *gpu)
{
    struct turner_statistics statistics = {0};
    unsigned kind;
    const struct turner_settings *settings = &side->scene->settings;
    double start = turner_seconds();
    TURNER_TRY(turner_choose_kernel(&kind, &gpu->info, &settings->methods,
                                    station->options.traversal));
    TURNER_TRY(turner_kernel_create(&station->kernel, kind, &station->options));
    double kernel = turner_seconds() - start;
    TURNER_TRY(turner_renderer_create(&station->renderer, gpu, &station->kernel, side->scene,
                                      &station->options, &statistics));
    start = turner_seconds();
    TURNER_TRY(turner_renderer_warm(&station->renderer));
    side->compile = kernel + statistics.seconds_compile + turner_seconds() - start;
    TURNER_TRY(measure_kernel(&side->kernel_bytes, station, side->scene));
    return turner_image_create(&side->image, settings->width, settings->height);
}

struct progress {
    struct turner_progress_bar bar;
    double done, all; /* pictures */
};

static bool show(double share, void *user)
{
    struct progress *progress = user;
    return turner_progress_show((progress->done + share) / progress->all, &progress->bar);
}

static enum turner_result draw_by_turns(struct turner_sides *sides, struct station stations[2],
                                        struct progress *progress)
{
    for (int run = -1; run < sides->runs; run++) { /* the first sizes the tiles */
        for (int k = 0; k < 2; k++) {
            int i = run % 2 == 0 ? k : 1 - k; /* neither is always first */
            struct turner_side *side = &sides->side[i];
            side->statistics = (struct turner_statistics){0};
            double start = turner_seconds();
            TURNER_TRY(turner_renderer_draw(&stations[i].renderer, &side->image,
                                            &stations[i].options, &side->statistics));
            if (run >= 0)
                side->seconds[run] = turner_seconds() - start;
            progress->done++;
        }
        if (run >= 0)
            sides->ratios[run] = sides->side[1].seconds[run] / sides->side[0].seconds[run];
    }
    sides->ratio = median(sides->ratios, sides->runs);
    for (int i = 0; i < 2; i++)
        sides->side[i].median = median(sides->side[i].seconds, sides->runs);
    return turner_image_compare(&sides->difference, &sides->side[1].image, &sides->side[0].image, 0,
                                0);
}

/* The reference draws the scene without methods' approximations, for which the sides' own settings
 * of samples, depth and cutoff may differ: each is compared with its own. */
static enum turner_result compare_with_reference(struct turner_sides *sides,
                                                 struct progress *progress)
{
    for (int i = 0; i < 2 && sides->reference; i++) {
        struct turner_side *side = &sides->side[i];
        struct turner_image truth;
        if (*side->hooks || side->scene->settings.error > 0)
            continue;
        TURNER_TRY(turner_reference_render(&truth, side->scene, sides->options.render.threads, NULL,
                                           show, progress));
        enum turner_result result =
            turner_image_compare(&side->error, &side->image, &truth, 0, 0);
        turner_image_destroy(&truth);
        TURNER_TRY(result);
        side->has_error = true;
        progress->done++;
    }
    return TURNER_OK;
}

enum turner_result turner_sides_measure(struct turner_sides *sides)
{
    struct station stations[2] = {0};
    struct turner_gpu gpu = {0};
    struct progress progress = {.all = 2.0 * (sides->runs + 1) + (sides->reference ? 2 : 0)};
    enum turner_result result;
    TURNER_TRY_DONE(load_sides(sides, stations));
    TURNER_TRY_DONE(turner_gpu_create(&gpu, sides->options.render.device, false));
    snprintf(sides->device, sizeof sides->device, "%s", gpu.info.name);
    turner_progress_begin(&progress.bar, sides->quiet);
    for (int i = 0; i < 2 && result == TURNER_OK; i++) {
        stations[i].options.progress = show;
        stations[i].options.user = &progress;
        result = make(&stations[i], &sides->side[i], &gpu);
    }
    if (result == TURNER_OK)
        result = draw_by_turns(sides, stations, &progress);
    if (result == TURNER_OK)
        result = compare_with_reference(sides, &progress);
    turner_progress_end(&progress.bar);
done:
    for (int i = 0; i < 2; i++) {
        turner_renderer_destroy(&stations[i].renderer);
        turner_kernel_destroy(&stations[i].kernel);
        turner_shader_path_destroy(&stations[i].path);
    }
    turner_gpu_destroy(&gpu);
    return result;
}

void turner_sides_destroy(struct turner_sides *sides)
{
    for (int i = 0; i < 2; i++) {
        turner_scene_destroy(sides->side[i].scene);
        turner_image_destroy(&sides->side[i].image);
    }
}
