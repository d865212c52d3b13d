#include "render/preview.h"

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "gpu/cached.h"
#include "gpu/translate.h"
#include "../shaders/shared.h"

#define BAND_PIXELS (1 << 15) /* what is submitted at once: some milliseconds */
#define PIXELS_MAX (1 << 23)  /* of a picture: 64 bytes each */

/* ---- the kernels ---- */

/* It is small: what the driver has more to do with what was not reduced takes less than reducing. */
static enum turner_result create_lighting_program(struct turner_lighting *lighting,
                                                  struct turner_gpu *gpu,
                                                  const struct turner_needs *needs,
                                                  const struct turner_scene *scene, bool no_cache)
{
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    const struct turner_kernel *kernel = &lighting->kernel;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, kernel, needs, 0, scene));
    TURNER_TRY(turner_spirv_validate(&kernel->spirv));
    return turner_program_create(&lighting->program, gpu, &kernel->spirv, constants, count,
                                 no_cache);
}

enum turner_result turner_lighting_create(struct turner_lighting *lighting, struct turner_gpu *gpu,
                                          struct turner_shader_source *source, unsigned kind,
                                          const struct turner_needs *needs,
                                          const struct turner_scene *scene, bool no_cache)
{
    kind &= TURNER_F64 | TURNER_SPHERE_F64; /* it traces nothing */
    *lighting = (struct turner_lighting){0};
    enum turner_result result = turner_kernel_compile(&lighting->kernel, kind, source, no_cache);
    if (result == TURNER_OK)
        result = create_lighting_program(lighting, gpu, needs, scene, no_cache);
    if (result != TURNER_OK)
        turner_lighting_destroy(gpu, lighting);
    return result;
}

void turner_lighting_destroy(struct turner_gpu *gpu, struct turner_lighting *lighting)
{
    turner_program_destroy(gpu, &lighting->program);
    turner_kernel_destroy(&lighting->kernel);
    *lighting = (struct turner_lighting){0};
}

static enum turner_result create_visibility_program(struct turner_program *program,
                                                    struct turner_gpu *gpu,
                                                    const struct turner_kernel *kernel,
                                                    const struct turner_needs *needs,
                                                    uint32_t bvh_depth,
                                                    const struct turner_scene *scene,
                                                    bool no_cache)
{
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    struct turner_spirv special;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, kernel, needs, bvh_depth, scene));
    TURNER_TRY(no_cache
                   ? turner_spirv_reduce(&special, &kernel->spirv, constants, count, false)
                   : turner_spirv_reduce_cached(&special, NULL, &kernel->spirv, constants, count,
                                                false));
    enum turner_result result = turner_spirv_validate(&special);
    if (result == TURNER_OK) {
        turner_gpu_translate(gpu, &special);
        result = turner_program_create(program, gpu, &special, NULL, 0, no_cache);
    }
    turner_spirv_destroy(&special);
    return result;
}

enum turner_result turner_visibility_create(struct turner_program *program, struct turner_gpu *gpu,
                                            struct turner_shader_source *source, unsigned kind,
                                            const struct turner_needs *needs, uint32_t bvh_depth,
                                            const struct turner_scene *scene, bool no_cache)
{
    struct turner_kernel kernel;
    *program = (struct turner_program){0};
    enum turner_result result = turner_kernel_compile(&kernel, kind, source, no_cache);
    if (result == TURNER_OK)
        result = create_visibility_program(program, gpu, &kernel, needs, bvh_depth, scene,
                                           no_cache);
    turner_kernel_destroy(&kernel);
    return result;
}

/* ---- pictures ---- */

static enum turner_result submit(struct turner_gpu *gpu, const struct turner_program *program,
                                 const struct turner_gpu_dispatch *push)
{
    VkCommandBuffer commands;
    TURNER_TRY(turner_gpu_begin(gpu, &commands));
    turner_program_dispatch(commands, program, push,
                            (push->tile_width + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP,
                            (push->tile_height + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP, 1);
    return turner_gpu_submit_wait(gpu, commands);
}

/* The rows from `y` on, as many as are submitted at once, and where what is visible in them stands. */
static struct turner_gpu_dispatch band_of(const struct turner_preview *preview,
                                          const struct turner_renderer *renderer, int width,
                                          int height, int y, VkDeviceAddress *visible)
{
    int rows = BAND_PIXELS / width > TURNER_WORKGROUP ? BAND_PIXELS / width : TURNER_WORKGROUP;
    *visible = preview->visible.address +
               (VkDeviceAddress)y * (VkDeviceAddress)width * sizeof(struct turner_gpu_visible);
    return (struct turner_gpu_dispatch){
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .tile_y = (uint32_t)y,
        .tile_width = (uint32_t)width,
        .tile_height = (uint32_t)(rows < height - y ? rows : height - y),
    };
}

/* The picture's other light stays; a pixel of many samples may have less of what is visible than its
 * centre. */
static void change(float *image, const float *now, const float *before, size_t floats)
{
    for (size_t i = 0; i < floats; i++) {
        float by = now[i] - before[i], sum = image[i] + by;
        float changed = sum > 0 ? sum : 0; /* the compiler makes vectors of this */
        image[i] = fabsf(by) <= FLT_MAX ? changed : image[i];
    }
}

/* `image` becomes what is visible, lit, or is changed by what that is more than `before`. */
static enum turner_result light(const struct turner_preview *preview, struct turner_image *image,
                                const struct turner_image *before,
                                struct turner_renderer *renderer, struct turner_lighting *lighting,
                                const struct turner_scene *scene)
{
    struct turner_gpu *gpu = renderer->gpu;
    struct turner_param_block params;
    struct turner_buffer pixels = {0};
    enum turner_result result;
    size_t floats = 4 * (size_t)image->width;
    int rows = BAND_PIXELS / image->width + TURNER_WORKGROUP;
    TURNER_TRY_DONE(turner_param_block_create(&params, gpu, &lighting->kernel.params, scene));
    TURNER_TRY_DONE(turner_buffer_create(&pixels, gpu, (size_t)rows * floats * sizeof(float), 0,
                                         TURNER_MEMORY_HOST, "a band of pixels"));
    for (int y = 0; y < image->height;) {
        VkDeviceAddress visible;
        struct turner_gpu_dispatch push =
            band_of(preview, renderer, image->width, image->height, y, &visible);
        push.pixels = pixels.address;
        push.positions = visible;
        push.params = params.buffer.address;
        TURNER_TRY_DONE(submit(gpu, &lighting->program, &push));
        float *rows_of_image = image->rgba + (size_t)y * floats;
        if (before)
            change(rows_of_image, pixels.mapped, before->rgba + (size_t)y * floats,
                   push.tile_height * floats);
        else
            memcpy(rows_of_image, pixels.mapped, push.tile_height * floats * sizeof(float));
        y += (int)push.tile_height;
    }
done:
    turner_buffer_destroy(gpu, &pixels);
    turner_param_block_destroy(gpu, &params);
    return result;
}

static enum turner_result make_room(struct turner_preview *preview, struct turner_gpu *gpu,
                                    int width, int height)
{
    if (preview->before.width == width && preview->before.height == height)
        return TURNER_OK;
    turner_buffer_destroy(gpu, &preview->visible);
    turner_image_destroy(&preview->before);
    preview->visible = (struct turner_buffer){0};
    TURNER_TRY(turner_buffer_create(
        &preview->visible, gpu,
        (VkDeviceSize)width * (VkDeviceSize)height * sizeof(struct turner_gpu_visible), 0,
        TURNER_MEMORY_DEVICE, "what is visible"));
    return turner_image_create(&preview->before, width, height);
}

enum turner_result turner_preview_record(struct turner_preview *preview,
                                         struct turner_renderer *renderer,
                                         struct turner_lighting *lighting,
                                         const struct turner_scene *scene,
                                         const struct turner_render_options *options)
{
    const struct turner_settings *settings = &scene->settings;
    if ((int64_t)settings->width * settings->height > PIXELS_MAX)
        return turner_fail(TURNER_DEVICE, "the picture is too large for a preview");
    TURNER_TRY(make_room(preview, renderer->gpu, settings->width, settings->height));
    if (renderer->ray_query)
        TURNER_TRY(turner_program_bind_acceleration(&preview->visibility, renderer->gpu,
                                                    TURNER_BINDING_TLAS,
                                                    renderer->scene.top.handle));
    TURNER_TRY(turner_renderer_look(renderer, scene));
    for (int y = 0; y < settings->height;) {
        VkDeviceAddress visible;
        struct turner_gpu_dispatch push =
            band_of(preview, renderer, settings->width, settings->height, y, &visible);
        push.pixels = visible;
        TURNER_TRY(turner_report(options, 0));
        TURNER_TRY(submit(renderer->gpu, &preview->visibility, &push));
        y += (int)push.tile_height;
    }
    TURNER_TRY(light(preview, &preview->before, NULL, renderer, lighting, scene));
    preview->recorded = true;
    return TURNER_OK;
}

enum turner_result turner_preview_light(const struct turner_preview *preview,
                                        struct turner_image *image,
                                        struct turner_renderer *renderer,
                                        struct turner_lighting *lighting,
                                        const struct turner_scene *scene)
{
    TURNER_TRY(turner_renderer_look(renderer, scene));
    return light(preview, image, &preview->before, renderer, lighting, scene);
}

void turner_preview_destroy(struct turner_gpu *gpu, struct turner_preview *preview)
{
    turner_program_destroy(gpu, &preview->visibility);
    turner_buffer_destroy(gpu, &preview->visible);
    turner_image_destroy(&preview->before);
    *preview = (struct turner_preview){0};
}
