/* Building: the same primitives to each builder in turn. */
#include <math.h>
#include <string.h>

#include "app/bench.h"
#include "app/chart.h"
#include "base/memory.h"

#define LONG_SECONDS 0.5 /* builds that take longer are measured fewer times: */
#define FEW_ROUNDS 3
#define MOST_ROUNDS 11

/* Of those that build on their own. */
enum builder { OWN, DEVICE, EMBREE, EMBREE_ROBUST, BUILDERS };
static const char *const names[BUILDERS] = {"bvh", "ray_query", "embree", "embree robust"};

struct builders {
    struct turner_gpu *gpu;
    struct turner_embree *embree;
    const struct turner_scene *scene;
    struct turner_kernel kernels[2]; /* OWN, DEVICE: making the pipeline is not timed */
};

static uint64_t bytes_of(const struct turner_device_scene *device)
{
    uint64_t bytes = device->top.buffer.size;
    for (int i = 0; i < TURNER_ARRAYS; i++)
        bytes += device->arrays[i].size;
    for (size_t i = 0; i < device->accel_count; i++)
        bytes += device->accels[i].buffer.size;
    return bytes;
}

/* Ours from the scene to nodes and primitives in order; the device's from there to the end of its
 * own build. */
static enum turner_result build_own(double *seconds, uint64_t *bytes, struct builders *builders,
                                    enum builder which)
{
    const struct turner_render_options options = {.tile = TURNER_WORKGROUP};
    struct turner_statistics statistics = {0};
    struct turner_renderer renderer;
    TURNER_TRY(turner_renderer_create(&renderer, builders->gpu, &builders->kernels[which],
                                      builders->scene, &options, &statistics));
    *seconds = statistics.seconds_build + (which == DEVICE ? statistics.seconds_upload : 0);
    *bytes = bytes_of(&renderer.scene);
    turner_renderer_destroy(&renderer);
    return TURNER_OK;
}

static enum turner_result build_embree(double *seconds, uint64_t *bytes,
                                       struct builders *builders, enum builder which)
{
    struct turner_embree_scene *scene;
    uint64_t before = turner_embree_bytes(builders->embree);
    TURNER_TRY(turner_embree_scene_create(&scene, builders->embree, builders->scene,
                                          which == EMBREE_ROBUST, seconds));
    *bytes = turner_embree_bytes(builders->embree) - before;
    turner_embree_scene_destroy(scene);
    return TURNER_OK;
}

static enum turner_result build(double *seconds, uint64_t *bytes, struct builders *builders,
                                enum builder which)
{
    return which == OWN || which == DEVICE ? build_own(seconds, bytes, builders, which)
                                           : build_embree(seconds, bytes, builders, which);
}

static enum turner_result open_builder(struct builders *builders, enum builder which, bool *there)
{
    const struct turner_render_options options = {0};
    const struct turner_methods *methods = &builders->scene->settings.methods;
    const struct turner_gpu_info *info = &builders->gpu->info;
    unsigned kind;
    *there = true;
    if (which == EMBREE || which == EMBREE_ROBUST)
        *there = builders->embree && turner_embree_can(builders->scene);
    if (which == DEVICE)
        *there = info->ray_query && methods->precision == TURNER_PRECISION_F32;
    if (!*there || which > DEVICE)
        return TURNER_OK;
    TURNER_TRY(turner_choose_kernel(&kind, info, methods,
                                    which == DEVICE ? TURNER_TRAVERSAL_RAY_QUERY
                                                    : TURNER_TRAVERSAL_BVH));
    return turner_kernel_create_from(&builders->kernels[which], "rays.comp", kind, &options);
}

static void sum_up(struct turner_bench_build *build, const struct turner_bench_build *yardstick)
{
    double quartiles[3];
    build->ratio = NAN;
    if (!build->rounds)
        return;
    turner_chart_quartiles(quartiles, build->seconds, build->rounds);
    build->low = quartiles[0];
    build->median = quartiles[1];
    build->high = quartiles[2];
    if (yardstick && yardstick->rounds)
        build->ratio = turner_bench_ratio(yardstick->seconds, build->seconds, build->rounds);
}

static enum turner_result measure(struct turner_bench *bench, struct turner_bench_scene *result,
                                  struct builders *builders)
{
    struct turner_bench_build *builds[BUILDERS] = {NULL};
    for (int which = 0; which < BUILDERS; which++) {
        bool there;
        int slot = turner_bench_slot(bench, names[which]);
        TURNER_TRY(open_builder(builders, (enum builder)which, &there));
        if (there && slot >= 0)
            builds[which] = &result->builds[slot];
    }
    double longest = 0;
    for (int round = 0; round < bench->rounds; round++) {
        if (round == MOST_ROUNDS || (longest > LONG_SECONDS && round >= FEW_ROUNDS))
            break;
        for (int which = 0; which < BUILDERS; which++) {
            struct turner_bench_build *own = builds[which];
            double seconds;
            if (!own)
                continue;
            TURNER_TRY(build(&seconds, &own->bytes, builders, (enum builder)which));
            own->seconds[own->rounds++] = seconds;
            longest = fmax(longest, seconds);
        }
    }
    for (int which = 0; which < BUILDERS; which++) {
        if (builds[which])
            sum_up(builds[which], builds[EMBREE]);
    }
    return TURNER_OK;
}

enum turner_result turner_bench_measure_builds(struct turner_bench *bench,
                                               struct turner_bench_scene *result,
                                               struct turner_gpu *gpu,
                                               struct turner_embree *embree,
                                               const struct turner_scene *scene)
{
    struct builders builders = {.gpu = gpu, .embree = embree, .scene = scene};
    enum turner_result status = measure(bench, result, &builders);
    for (int i = 0; i < 2; i++)
        turner_kernel_destroy(&builders.kernels[i]);
    return status;
}
