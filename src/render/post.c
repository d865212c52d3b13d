#include "render/post.h"

#include <string.h>

#include "render/hooks.h"
#include "render/renderer.h"
#include "../shaders/shared.h"

enum turner_result turner_post_create_program(struct turner_post *post, struct turner_gpu *gpu,
                                              const struct turner_kernel *kernel,
                                              const struct turner_scene *scene, bool no_cache)
{
    struct turner_constant constants[TURNER_PARAM_WORDS];
    size_t count = 0;
    *post = (struct turner_post){.wanted = true, .source = kernel->source};
    TURNER_TRY(turner_params_constants(constants, &count, &kernel->params, scene));
    return turner_program_create(&post->program, gpu, &kernel->spirv, constants, count,
                                 no_cache);
}

enum turner_result turner_post_create_buffers(struct turner_post *post, struct turner_gpu *gpu,
                                              const struct turner_kernel *kernel,
                                              const struct turner_scene *scene)
{
    TURNER_TRY(turner_param_block_create(&post->params, gpu, &kernel->params, scene));
    return turner_buffer_create(&post->pixels, gpu, TURNER_POST_PIXELS * 4 * sizeof(float), 0,
                                TURNER_MEMORY_HOST, "pixels for user/post.glsl");
}

static enum turner_result create(struct turner_post *post, struct turner_gpu *gpu,
                                 const struct turner_scene *scene,
                                 struct turner_shader_source *source, bool no_cache)
{
    struct turner_kernel kernel;
    enum turner_result result = turner_kernel_compile(&kernel, 0, source, no_cache);
    if (result == TURNER_OK)
        result = turner_post_create_program(post, gpu, &kernel, scene, no_cache);
    if (result == TURNER_OK)
        result = turner_post_create_buffers(post, gpu, &kernel, scene);
    turner_kernel_destroy(&kernel);
    return result;
}

enum turner_result turner_post_create(struct turner_post *post, struct turner_gpu *gpu,
                                      const struct turner_scene *scene,
                                      const struct turner_render_options *options)
{
    struct turner_shader_source source;
    *post = (struct turner_post){0};
    enum turner_result result = turner_shader_source_create(
        &source, "post.comp", options->shader_dirs, options->shader_dir_count);
    if (result == TURNER_OK)
        post->source = turner_source_hash(&source);
    if (result == TURNER_OK && turner_hooks_of(&source) & 1u << TURNER_HOOK_POST)
        result = create(post, gpu, scene, &source, options->no_cache);
    turner_shader_source_destroy(&source);
    return result;
}

void turner_post_destroy(struct turner_gpu *gpu, struct turner_post *post)
{
    turner_param_block_destroy(gpu, &post->params);
    turner_buffer_destroy(gpu, &post->pixels);
    turner_program_destroy(gpu, &post->program);
    *post = (struct turner_post){0};
}

enum turner_result turner_post_draw(struct turner_image *image, struct turner_post *post,
                                    struct turner_gpu *gpu)
{
    const uint32_t group = TURNER_WORKGROUP * TURNER_WORKGROUP;
    size_t pixels = post->wanted ? (size_t)image->width * (size_t)image->height : 0;
    for (size_t first = 0; first < pixels; first += TURNER_POST_PIXELS) {
        size_t count = pixels - first < TURNER_POST_PIXELS ? pixels - first : TURNER_POST_PIXELS;
        struct turner_gpu_dispatch push = {
            .pixels = post->pixels.address,
            .params = post->params.buffer.address,
            .tile_width = (uint32_t)image->width,
            .tile_height = (uint32_t)image->height,
            .first = (uint32_t)first,
            .count = (uint32_t)count,
        };
        VkCommandBuffer commands;
        float *rgba = image->rgba + 4 * first;
        memcpy(post->pixels.mapped, rgba, count * 4 * sizeof *rgba);
        TURNER_TRY(turner_gpu_begin(gpu, &commands));
        turner_program_dispatch(commands, &post->program, &push,
                                ((uint32_t)count + group - 1) / group, 1, 1);
        TURNER_TRY(turner_gpu_submit_wait(gpu, commands));
        memcpy(rgba, post->pixels.mapped, count * 4 * sizeof *rgba);
    }
    return TURNER_OK;
}
