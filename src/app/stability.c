#include "app/stability.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/povray.h"
#include "base/memory.h"
#include "reference/reference.h"

static const struct turner_render_options options;

enum turner_result turner_stability_create(struct turner_stability *s, const char *device)
{
    memset(s, 0, sizeof *s);
    return turner_gpu_create(&s->gpu, device, false);
}

void turner_stability_destroy(struct turner_stability *s)
{
    turner_image_destroy(&s->truth);
    for (size_t i = 0; i < s->kernel_count; i++)
        turner_kernel_destroy(&s->kernels[i]);
    free(s->kernels);
    turner_gpu_destroy(&s->gpu);
    memset(s, 0, sizeof *s);
}

enum turner_result turner_stability_assign(struct turner_scene *scene, const char *assign)
{
    char *text = turner_strdup(assign ? assign : ""), *rest = text;
    enum turner_result result = TURNER_OK;
    for (char *one; result == TURNER_OK && (one = strtok_r(rest, " ", &rest));)
        result = turner_method_assign(&scene->settings, one);
    free(text);
    return result;
}

/* The kernel for the scene's methods, compiled the first time it is asked for. */
static enum turner_result find_kernel(const struct turner_kernel **kernel,
                                      struct turner_stability *s,
                                      const struct turner_scene *scene, unsigned probe)
{
    unsigned kind;
    TURNER_TRY(turner_choose_kernel(&kind, &s->gpu.info, &scene->settings.methods,
                                    TURNER_TRAVERSAL_AUTO));
    kind |= probe;
    for (size_t i = 0; i < s->kernel_count; i++) {
        if (s->kernels[i].kind == kind) {
            *kernel = &s->kernels[i];
            return TURNER_OK;
        }
    }
    struct turner_kernel made;
    TURNER_TRY(turner_kernel_create_from(&made, probe ? "probe.comp" : "render.comp", kind,
                                         &options));
    *TURNER_PUSH(s->kernels, s->kernel_count, s->kernel_capacity) = made;
    *kernel = &s->kernels[s->kernel_count - 1];
    return TURNER_OK;
}

static bool device_can(const struct turner_stability *s, const struct turner_scene *scene)
{
    const struct turner_methods *methods = &scene->settings.methods;
    bool doubles = methods->precision == TURNER_PRECISION_F64 ||
                   methods->sphere == TURNER_SPHERE_DOUBLE;
    return (!doubles || s->gpu.info.float64) &&
           (methods->traversal != TURNER_TRAVERSAL_RAY_QUERY || s->gpu.info.ray_query);
}

static enum turner_result make_renderer(struct turner_renderer *renderer,
                                        struct turner_stability *s,
                                        const struct turner_scene *scene, unsigned probe)
{
    const struct turner_kernel *kernel;
    struct turner_render_options small = {.tile = probe ? 8 : 128};
    struct turner_statistics statistics = {0};
    TURNER_TRY(turner_scene_validate(scene));
    TURNER_TRY(find_kernel(&kernel, s, scene, probe));
    return turner_renderer_create(renderer, &s->gpu, kernel, scene, &small, &statistics);
}

enum turner_result turner_stability_probe(struct turner_gpu_probe *probes, size_t count,
                                          struct turner_stability *s,
                                          const struct turner_scene *scene,
                                          enum turner_kernel_kind kind, bool *possible)
{
    struct turner_renderer renderer;
    *possible = device_can(s, scene);
    if (!*possible)
        return TURNER_OK;
    TURNER_TRY(make_renderer(&renderer, s, scene, kind));
    enum turner_result result = turner_probe_trace(probes, count, &renderer);
    turner_renderer_destroy(&renderer);
    return result;
}

enum turner_result turner_stability_draw(struct turner_image *image, struct turner_stability *s,
                                         const struct turner_scene *scene,
                                         struct turner_statistics *statistics, bool *possible)
{
    struct turner_renderer renderer;
    struct turner_statistics unused = {0};
    memset(image, 0, sizeof *image);
    *possible = device_can(s, scene);
    if (!*possible)
        return TURNER_OK;
    TURNER_TRY(make_renderer(&renderer, s, scene, 0));
    enum turner_result result;
    TURNER_TRY_DONE(turner_image_create(image, scene->settings.width, scene->settings.height));
    TURNER_TRY_DONE(turner_renderer_draw(&renderer, image, &options,
                                         statistics ? statistics : &unused));
done:
    turner_renderer_destroy(&renderer);
    return result;
}

enum turner_result turner_stability_count_hits(struct turner_stability_hits *hits,
                                               struct turner_stability *s,
                                               const struct turner_scene *scene,
                                               struct turner_gpu_probe *probes, size_t count,
                                               bool *possible)
{
    struct turner_world world;
    TURNER_TRY(turner_stability_probe(probes, count, s, scene, TURNER_PROBE_HITS, possible));
    if (!*possible)
        return TURNER_OK;
    TURNER_TRY(turner_world_create(&world, scene));
    size_t wrong = 0, both = 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        struct turner_ray ray = turner_stage_ray(&probes[i]);
        struct turner_hit hit;
        bool truth = turner_world_intersect(&hit, &world, &ray, (turner_real)INFINITY);
        double t = turner_stage_t(&probes[i], 0);
        if (truth != !isinf(t)) {
            wrong++;
        } else if (truth) {
            sum += fabs(t - (double)hit.t);
            both++;
        }
    }
    turner_world_destroy(&world);
    *hits = (struct turner_stability_hits){(double)wrong / (double)count,
                                           both ? sum / (double)both : 0};
    return TURNER_OK;
}

/* ---- pictures ---- */

/* Share of the pixels with a channel that differs by more than `tolerance`, of itself where it is
 * brighter than 1 (not finite: differs). */
static double wrong_share(const struct turner_image *image, const struct turner_image *truth,
                          double tolerance)
{
    size_t count = (size_t)truth->width * (size_t)truth->height, wrong = 0;
    for (size_t i = 0; i < count; i++) {
        bool close = true;
        for (size_t c = 4 * i; c < 4 * i + 3; c++) {
            double off = fabs((double)image->rgba[c] - (double)truth->rgba[c]);
            close = close && off <= tolerance * fmax(1, fabs((double)truth->rgba[c]));
        }
        wrong += !close;
    }
    return (double)wrong / (double)count;
}

/* The reference's picture, and what rounding the scene to floats alone makes of it. */
static enum turner_result find_truth(struct turner_stability *s, const struct turner_sweep *sweep,
                                     double value, int variant)
{
    if (s->truth_sweep == sweep && s->truth_value == value && s->truth_variant == variant)
        return TURNER_OK;
    struct turner_scene *scene = sweep->scene(value, variant);
    struct turner_image rounded = {0};
    enum turner_result result;
    turner_image_destroy(&s->truth);
    s->truth_sweep = NULL;
    TURNER_TRY_DONE(turner_scene_validate(scene));
    TURNER_TRY_DONE(turner_reference_render(&s->truth, scene, 0, NULL, NULL, NULL));
    turner_stage_round(scene);
    s->truth_limit = NAN;
    if (turner_scene_validate(scene) == TURNER_OK) { /* two corners may have become one */
        TURNER_TRY_DONE(turner_reference_render(&rounded, scene, 0, NULL, NULL, NULL));
        s->truth_limit = wrong_share(&rounded, &s->truth, sweep->tolerance);
    }
    s->truth_sweep = sweep;
    s->truth_value = value;
    s->truth_variant = variant;
done:
    turner_image_destroy(&rounded);
    turner_scene_destroy(scene);
    return result;
}

static enum turner_result draw_method(struct turner_image *image, struct turner_stability *s,
                                      struct turner_scene *scene, const char *name,
                                      const struct turner_sweep_method *method, bool *possible)
{
    if (strcmp(method->name, TURNER_POVRAY) == 0) {
        *possible = s->povray != NULL;
        return *possible ? turner_povray_render(image, scene, s->povray, name) : TURNER_OK;
    }
    TURNER_TRY(turner_stability_assign(scene, method->assign));
    return turner_stability_draw(image, s, scene, NULL, possible);
}

enum turner_result turner_stability_picture(double *error, struct turner_stability *s,
                                            const struct turner_sweep *sweep, double value,
                                            const struct turner_sweep_method *method)
{
    struct turner_image image = {0};
    bool possible = false;
    char name[96];
    enum turner_result result;
    struct turner_scene *scene = sweep->scene(value, method->variant);
    *error = NAN;
    TURNER_TRY_DONE(find_truth(s, sweep, value, method->variant));
    snprintf(name, sizeof name, "%s-%g", sweep->name, value);
    TURNER_TRY_DONE(draw_method(&image, s, scene, name, method, &possible));
    if (possible)
        *error = wrong_share(&image, &s->truth, sweep->tolerance);
done:
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
    return result;
}
