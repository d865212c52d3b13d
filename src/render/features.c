#include "render/features.h"

#include <string.h>

#include "render/layers.h"
#include "scene/ids.h"

#define TILE_MAX 256 /* one ray a pixel: quick enough for any watchdog */

struct pass {
    struct turner_layers *layers;
    struct turner_renderer *renderer;
    const struct turner_scene *scene;
    struct turner_ids ids; /* when they are wanted */
    struct turner_kernel kernel;
    struct turner_program program;
    struct turner_param_block params;
    struct turner_buffer features; /* a tile of turner_gpu_feature */
    int edge;                      /* of a tile */
};

static uint32_t id_of(const struct pass *pass, const struct turner_gpu_feature *feature)
{
    const struct turner_scene *scene = pass->scene;
    if (feature->id == TURNER_NO_INDEX)
        return 0;
    uint32_t kind = feature->id >> TURNER_KIND_SHIFT;
    uint32_t place = feature->id & ((1u << TURNER_KIND_SHIFT) - 1);
    if (kind == TURNER_KIND_PLANE)
        return 1 + place;
    const struct turner_group *group =
        &scene->groups[feature->instance ? scene->instances[feature->instance - 1].group : 0];
    if (kind != TURNER_KIND_SPHERE)
        place += (uint32_t)group->sphere_count;
    if (kind == TURNER_KIND_TRIANGLE)
        place += (uint32_t)group->cone_count;
    return turner_id_of(&pass->ids, feature->instance, place);
}

static void store(const struct pass *pass, const struct turner_gpu_feature *feature, size_t pixel)
{
    float *const *real = pass->layers->real;
    if (real[TURNER_LAYER_DEPTH])
        real[TURNER_LAYER_DEPTH][pixel] = feature->depth;
    if (real[TURNER_LAYER_NORMAL])
        memcpy(real[TURNER_LAYER_NORMAL] + 3 * pixel, feature->normal, sizeof feature->normal);
    if (real[TURNER_LAYER_ALBEDO])
        memcpy(real[TURNER_LAYER_ALBEDO] + 3 * pixel, feature->albedo, sizeof feature->albedo);
    if (real[TURNER_LAYER_POSITION])
        memcpy(real[TURNER_LAYER_POSITION] + 3 * pixel, feature->position,
               sizeof feature->position);
    if (pass->layers->whole[TURNER_LAYER_ID])
        pass->layers->whole[TURNER_LAYER_ID][pixel] = id_of(pass, feature);
}

static enum turner_result draw_tile(struct pass *pass, int x, int y)
{
    const struct turner_renderer *renderer = pass->renderer;
    int width = pass->layers->width - x, height = pass->layers->height - y;
    width = width < pass->edge ? width : pass->edge;
    height = height < pass->edge ? height : pass->edge;
    struct turner_gpu_dispatch push = {
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = pass->features.address,
        .params = pass->params.buffer.address,
        .tile_x = (uint32_t)x,
        .tile_y = (uint32_t)y,
        .tile_width = (uint32_t)width,
        .tile_height = (uint32_t)height,
    };
    VkCommandBuffer commands;
    TURNER_TRY(turner_gpu_begin(renderer->gpu, &commands));
    turner_program_dispatch(commands, &pass->program, &push,
                            ((uint32_t)width + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP,
                            ((uint32_t)height + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP, 1);
    TURNER_TRY(turner_gpu_submit_wait(renderer->gpu, commands));
    const struct turner_gpu_feature *features = pass->features.mapped;
    for (int row = 0; row < height; row++) {
        for (int column = 0; column < width; column++)
            store(pass, features++,
                  (size_t)(y + row) * (size_t)pass->layers->width + (size_t)(x + column));
    }
    return TURNER_OK;
}

static enum turner_result prepare(struct pass *pass, const struct turner_kernel *kernel,
                                  const struct turner_render_options *options,
                                  struct turner_statistics *statistics)
{
    struct turner_renderer *renderer = pass->renderer;
    if (pass->layers->whole[TURNER_LAYER_ID])
        TURNER_TRY(turner_ids_create(&pass->ids, pass->scene));
    double start = turner_seconds();
    TURNER_TRY(turner_kernel_create_from(&pass->kernel, "features.comp", kernel->kind, options));
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, &pass->kernel, &renderer->needs,
                                            renderer->flat.max_depth, pass->scene));
    TURNER_TRY(turner_param_block_create(&pass->params, renderer->gpu, &pass->kernel.params,
                                         pass->scene));
    TURNER_TRY(turner_program_create(&pass->program, renderer->gpu, &pass->kernel.spirv, constants,
                                     count, options->no_cache));
    statistics->seconds_compile += turner_seconds() - start;
    if (renderer->ray_query)
        TURNER_TRY(turner_program_bind_acceleration(&pass->program, renderer->gpu,
                                                    TURNER_BINDING_TLAS,
                                                    renderer->scene.top.handle));
    uint64_t pixels = (uint64_t)pass->edge * (uint64_t)pass->edge;
    return turner_buffer_create(&pass->features, renderer->gpu,
                                pixels * sizeof(struct turner_gpu_feature), 0, TURNER_MEMORY_HOST,
                                "a tile of layers");
}

static enum turner_result draw(struct pass *pass, const struct turner_render_options *options)
{
    for (int y = 0; y < pass->layers->height; y += pass->edge) {
        for (int x = 0; x < pass->layers->width; x += pass->edge) {
            TURNER_TRY(turner_report(options, 0));
            TURNER_TRY(draw_tile(pass, x, y));
        }
    }
    return TURNER_OK;
}

enum turner_result turner_features_draw(struct turner_layers *layers,
                                        struct turner_renderer *renderer,
                                        const struct turner_kernel *kernel,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics)
{
    bool smaller = options->tile && options->tile < TILE_MAX;
    struct pass pass = {.layers = layers, .renderer = renderer, .scene = scene,
                        .edge = smaller ? options->tile : TILE_MAX};
    enum turner_result result = prepare(&pass, kernel, options, statistics);
    double start = turner_seconds();
    if (result == TURNER_OK)
        result = draw(&pass, options);
    statistics->seconds_layers += turner_seconds() - start;
    turner_buffer_destroy(renderer->gpu, &pass.features);
    turner_param_block_destroy(renderer->gpu, &pass.params);
    turner_program_destroy(renderer->gpu, &pass.program);
    turner_kernel_destroy(&pass.kernel);
    turner_ids_destroy(&pass.ids);
    return result;
}
