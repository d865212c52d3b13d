#include "render/params.h"

#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "gpu/include.h"
#include "render/hooks.h"
#include "scene/nearest.h"
#include "../shaders/shared.h"

static uint32_t material_named(const struct turner_scene *scene, const char *name)
{
    for (size_t i = 0; i < scene->material_count; i++) {
        if (scene->materials[i].name && strcmp(scene->materials[i].name, name) == 0)
            return (uint32_t)i;
    }
    return TURNER_NONE;
}

static void bits_of(uint32_t *words, const struct turner_param *param,
                    const struct turner_param_value *value, const struct turner_scene *scene)
{
    for (uint32_t i = 0; i < turner_param_size(param); i++) {
        float number = (float)value->number[i];
        if (param->type == TURNER_PARAM_FLOAT || param->type == TURNER_PARAM_COLOR)
            memcpy(&words[i], &number, sizeof number);
        else if (param->type == TURNER_PARAM_MATERIAL)
            words[i] = material_named(scene, value->name);
        else
            words[i] = (uint32_t)(int32_t)value->number[i];
    }
}

enum turner_result turner_param_of_scene(struct turner_param_value *value,
                                         const struct turner_param *param,
                                         const struct turner_scene *scene)
{
    *value = param->standard;
    for (size_t i = 0; i < scene->param_count; i++) {
        if (strcmp(scene->params[i].name, param->name) == 0)
            return turner_param_read(value, param, scene->params[i].value);
    }
    return TURNER_OK;
}

static const char *param_word(const void *user, size_t i)
{
    return ((const struct turner_params *)user)->at[i].name;
}

enum turner_result turner_params_check(const struct turner_params *params,
                                       const struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->param_count; i++) {
        const char *name = scene->params[i].name;
        const struct turner_param *param = turner_params_get(params, name);
        struct turner_param_value unused;
        if (param) {
            TURNER_TRY(turner_param_read(&unused, param, scene->params[i].value));
            continue;
        }
        const char *nearest = turner_nearest(name, params->count, param_word, params);
        if (nearest)
            return turner_fail(TURNER_USAGE, "no shader has a parameter \"%.100s\"; did you mean "
                                             "\"%s\"?", name, nearest);
        return turner_fail(TURNER_USAGE, "no shader has a parameter \"%.100s\"; turner params "
                                         "lists what the shaders of a scene have", name);
    }
    return TURNER_OK;
}

/* ---- what there is ---- */

static enum turner_result add_param(struct turner_params *params, const struct turner_param *param)
{
    const struct turner_param *known = turner_params_get(params, param->name);
    if (known && (known->line != param->line || strcmp(known->file, param->file) != 0))
        return turner_fail(TURNER_BAD_INPUT, "%s:%d:1: parameter \"%s\" is declared before, in %s:%d",
                           param->file, param->line, param->name, known->file, known->line);
    if (!known)
        *TURNER_PUSH(params->at, params->count, params->capacity) = *param;
    return TURNER_OK;
}

enum turner_result turner_params_find(struct turner_params *params, uint64_t *hash,
                                      const struct turner_render_options *options)
{
    static const char *const kernels[] = {"render.comp", "features.comp", "post.comp"};
    uint64_t sum = TURNER_HASH_START;
    *params = (struct turner_params){0};
    for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
        struct turner_shader_source source;
        enum turner_result result = turner_shader_source_create(
            &source, kernels[k], options->shader_dirs, options->shader_dir_count);
        for (size_t i = 0; result == TURNER_OK && i < source.params.count; i++)
            result = add_param(params, &source.params.at[i]);
        for (size_t i = 0; i < source.file_count; i++) {
            if (turner_source_replaced(&source.files[i])) {
                sum = turner_hash_text(sum, source.files[i].name);
                sum = turner_hash_text(sum, source.files[i].text);
            }
        }
        turner_shader_source_destroy(&source);
        TURNER_TRY(result);
    }
    if (hash)
        *hash = sum == TURNER_HASH_START ? 0 : sum;
    return TURNER_OK;
}

static enum turner_result settle(struct turner_scene *scene, const struct turner_params *params)
{
    TURNER_TRY(turner_params_check(params, scene));
    for (size_t i = 0; i < params->count; i++) {
        struct turner_param_value value;
        char text[TURNER_PARAM_VALUE];
        TURNER_TRY(turner_param_of_scene(&value, &params->at[i], scene));
        turner_param_print(text, &params->at[i], &value);
        turner_scene_set_param(scene, params->at[i].name, text);
    }
    return TURNER_OK;
}

enum turner_result turner_params_settle(struct turner_scene *scene,
                                        const struct turner_render_options *options)
{
    struct turner_params params;
    if (!options->shader_dir_count && !scene->param_count)
        return TURNER_OK; /* turner's own shaders have none */
    enum turner_result result = turner_params_find(&params, &scene->shader_hash, options);
    if (result == TURNER_OK)
        result = settle(scene, &params);
    turner_params_destroy(&params);
    return result;
}

/* ---- for the device ---- */

enum turner_result turner_params_constants(struct turner_constant *constants, size_t *count,
                                           const struct turner_params *params,
                                           const struct turner_scene *scene)
{
    for (size_t i = 0; i < params->count; i++) {
        const struct turner_param *param = &params->at[i];
        struct turner_param_value value;
        uint32_t words[3];
        if (!param->constant)
            continue;
        TURNER_TRY(turner_param_of_scene(&value, param, scene));
        bits_of(words, param, &value, scene);
        for (uint32_t k = 0; k < turner_param_size(param); k++)
            constants[(*count)++] =
                (struct turner_constant){TURNER_CONSTANT_PARAMS + param->word + k, words[k]};
    }
    return TURNER_OK;
}

enum turner_result turner_param_block_create(struct turner_param_block *block,
                                             struct turner_gpu *gpu,
                                             const struct turner_params *params,
                                             const struct turner_scene *scene)
{
    *block = (struct turner_param_block){0};
    for (size_t i = 0; i < params->count; i++)
        *TURNER_PUSH(block->params.at, block->params.count, block->params.capacity) =
            params->at[i];
    if (!params->count)
        return TURNER_OK;
    TURNER_TRY(turner_buffer_create(&block->buffer, gpu, TURNER_PARAM_WORDS * sizeof(uint32_t), 0,
                                    TURNER_MEMORY_HOST, "parameters of shaders"));
    return turner_param_block_set(block, scene);
}

void turner_param_block_destroy(struct turner_gpu *gpu, struct turner_param_block *block)
{
    turner_buffer_destroy(gpu, &block->buffer);
    turner_params_destroy(&block->params);
    *block = (struct turner_param_block){0};
}

enum turner_result turner_param_block_set(struct turner_param_block *block,
                                          const struct turner_scene *scene)
{
    uint32_t words[TURNER_PARAM_WORDS] = {0};
    for (size_t i = 0; i < block->params.count; i++) {
        const struct turner_param *param = &block->params.at[i];
        struct turner_param_value value;
        TURNER_TRY(turner_param_of_scene(&value, param, scene));
        bits_of(words + param->word, param, &value, scene);
    }
    if (block->buffer.mapped)
        memcpy(block->buffer.mapped, words, sizeof words);
    return TURNER_OK;
}
