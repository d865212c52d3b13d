#include "render/hooks.h"

#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "../shaders/shared.h"

static const char *const names[] = {
    [TURNER_HOOK_SURFACE] = "surface", [TURNER_HOOK_BRDF] = "brdf",
    [TURNER_HOOK_BACKGROUND] = "background", [TURNER_HOOK_LIGHT] = "light",
    [TURNER_HOOK_POST] = "post",
};

const char *turner_hook_name(enum turner_hook hook)
{
    return names[hook];
}

static void file_of(char file[64], enum turner_hook hook)
{
    snprintf(file, 64, "user/%s.glsl", names[hook]);
}

bool turner_source_replaced(const struct turner_source_file *file)
{
    for (size_t i = 0; i < turner_embedded_shaders_count; i++) {
        if (strcmp(turner_embedded_shaders[i].name, file->name) == 0)
            return strcmp(turner_embedded_shaders[i].text, file->text) != 0;
    }
    return true;
}

uint64_t turner_source_hash(const struct turner_shader_source *source)
{
    uint64_t hash = turner_hash_text(TURNER_HASH_START, source->text);
    for (size_t i = 0; i < source->params.count; i++) {
        const struct turner_param *param = &source->params.at[i];
        const double range[2] = {param->least, param->most};
        hash = turner_hash_bytes(hash, range, sizeof range);
        hash = turner_hash_bytes(hash, param->standard.number, sizeof param->standard.number);
        hash = turner_hash_text(hash, param->standard.name);
    }
    return hash;
}

uint32_t turner_hooks_of(const struct turner_shader_source *source)
{
    uint32_t hooks = 0;
    for (size_t i = 0; i < source->file_count; i++) {
        for (enum turner_hook hook = 0; hook < TURNER_HOOKS; hook++) {
            char file[64];
            file_of(file, hook);
            if (strcmp(source->files[i].name, file) == 0 && turner_source_replaced(&source->files[i]))
                hooks |= 1u << hook;
        }
    }
    return hooks;
}

enum turner_result turner_hooks_find(uint32_t *hooks, char paths[512],
                                     const struct turner_render_options *options)
{
    *hooks = 0;
    if (paths)
        *paths = 0;
    for (enum turner_hook hook = 0; hook < TURNER_HOOKS && options->shader_dir_count; hook++) {
        char file[64];
        struct turner_shader_source source;
        file_of(file, hook);
        enum turner_result result = turner_shader_source_create(
            &source, file, options->shader_dirs, options->shader_dir_count);
        if (result == TURNER_OK && turner_hooks_of(&source) & 1u << hook) {
            *hooks |= 1u << hook;
            size_t used = paths ? strlen(paths) : 0;
            if (paths)
                snprintf(paths + used, 512 - used, "%s%s", used ? ", " : "", source.files[0].path);
        }
        turner_shader_source_destroy(&source);
        TURNER_TRY(result);
    }
    return TURNER_OK;
}

void turner_hooks_widen(struct turner_needs *needs, const struct turner_scene *scene)
{
    /* a checker's pattern is what asks for texture coordinates */
    uint32_t bits = TURNER_NEEDS_SPECULAR | TURNER_NEEDS_REFLECTION | TURNER_NEEDS_CHECKER;
    if (needs->bits & TURNER_NEEDS_TRANSMISSION && scene->settings.depth <= TURNER_MAX_BRANCH_DEPTH)
        bits |= TURNER_NEEDS_BRANCHING;
    turner_needs_add(needs, bits, scene);
}

enum turner_result turner_hooks_warn(const struct turner_render_options *options, const char *what)
{
    uint32_t hooks;
    char paths[512];
    TURNER_TRY(turner_hooks_find(&hooks, paths, options));
    if (hooks)
        turner_warn("the reference knows nothing of %s; %s", paths, what);
    return TURNER_OK;
}
