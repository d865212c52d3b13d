#include "app/against.h"

#include <getopt.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "render/params.h"
#include "render/shader_path.h"
#include "scene/methods.h"

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static bool is_method(const char *name, size_t length)
{
    for (size_t i = 0; i < turner_method_count; i++) {
        const char *known = turner_methods_list[i].name;
        if (strncmp(known, name, length) == 0 && !known[length])
            return true;
    }
    return false;
}

enum turner_result turner_side_take(struct turner_second_side *side, const char *text, char **argv)
{
    static const struct {
        const char *name;
        int option;
    } settings[] = {{"spp", TURNER_OPTION_SPP},
                    {"shading", TURNER_OPTION_SHADING},
                    {"shadows", TURNER_OPTION_SHADOWS},
                    {"exposure", TURNER_OPTION_EXPOSURE},
                    {"transfer", TURNER_OPTION_TRANSFER}};
    const char *equals = strchr(text, '=');
    side->given = true;
    if (strcmp(text, "-") == 0 || is_folder(text)) {
        side->folder = text;
        return TURNER_OK;
    }
    if (!equals)
        return turner_fail(TURNER_USAGE, "--against takes a folder of shaders or NAME=VALUE, and "
                                         "\"%.200s\" is neither", text);
    size_t length = (size_t)(equals - text);
    for (size_t i = 0; i < sizeof settings / sizeof *settings; i++) {
        if (strncmp(settings[i].name, text, length) == 0 && !settings[i].name[length]) {
            optarg = (char *)equals + 1;
            return turner_scene_option_take(&side->other, settings[i].option, argv);
        }
    }
    optarg = (char *)text;
    return turner_scene_option_take(&side->other,
                                    is_method(text, length) ? 'm' : TURNER_OPTION_SET, argv);
}

static void append(char name[256], const char *text)
{
    size_t used = strlen(name);
    snprintf(name + used, 256 - used, "%s%s", used > 3 ? ", " : "", text);
}

void turner_side_finish(struct turner_second_side *side)
{
    const struct turner_scene_options *other = &side->other;
    char text[64];
    side->render = side->first->render;
    if (side->folder) {
        bool own = strcmp(side->folder, "-") == 0;
        side->folders[0] = side->folder;
        side->render.shader_dirs = side->folders;
        side->render.shader_dir_count = own ? 0 : 1;
        side->render.no_scene_shaders = side->render.no_scene_shaders || own;
    }
    snprintf(side->name, sizeof side->name, "B: ");
    if (side->folder)
        append(side->name, strcmp(side->folder, "-") == 0 ? "turner's shaders" : side->folder);
    for (size_t i = 0; i < other->method_count; i++)
        append(side->name, other->methods[i]);
    for (size_t i = 0; i < other->param_count; i++)
        append(side->name, other->params[i]);
    if (other->spp) {
        snprintf(text, sizeof text, "spp=%d", other->spp);
        append(side->name, text);
    }
    if (other->shading >= 0)
        append(side->name, other->shading ? "shading=energy_conserving" : "shading=phong");
    if (other->shadows >= 0)
        append(side->name, other->shadows ? "shadows=tinted" : "shadows=opaque");
    if (!isnan(other->exposure)) {
        snprintf(text, sizeof text, "exposure=%g", other->exposure);
        append(side->name, text);
    }
    if (other->transfer >= 0)
        append(side->name, other->transfer ? "transfer=linear" : "transfer=srgb");
}

/* What is given for the second alone must be one of its parameters. */
static enum turner_result check_params(const struct turner_second_side *side,
                                       const struct turner_scene *scene)
{
    struct turner_render_options render = side->render;
    struct turner_shader_path path;
    struct turner_params params;
    struct turner_scene *given = turner_scene_create();
    enum turner_result result;
    turner_shader_path_create(&path, &render, scene);
    TURNER_TRY_DONE(turner_params_find(&params, NULL, &render));
    for (size_t i = 0; i < side->other.param_count; i++)
        TURNER_TRY_DONE(turner_scene_assign_param(given, side->other.params[i]));
    TURNER_TRY_DONE(turner_params_check(&params, given));
done:
    turner_params_destroy(&params);
    turner_shader_path_destroy(&path);
    turner_scene_destroy(given);
    return result;
}

static enum turner_result apply(const struct turner_second_side *side, struct turner_scene *scene)
{
    TURNER_TRY(turner_scene_options_settings(side->first, scene));
    TURNER_TRY(turner_scene_options_settings(&side->other, scene));
    for (size_t i = 0; i < side->first->param_count; i++)
        TURNER_TRY(turner_scene_assign_param(scene, side->first->params[i]));
    for (size_t i = 0; i < side->other.param_count; i++)
        TURNER_TRY(turner_scene_assign_param(scene, side->other.params[i]));
    return side->other.param_count ? check_params(side, scene) : TURNER_OK;
}

enum turner_result turner_side_load(struct turner_scene **scene,
                                    const struct turner_second_side *side)
{
    TURNER_TRY(turner_scene_load(scene, side->path));
    enum turner_result result = apply(side, *scene);
    if (result != TURNER_OK) {
        turner_scene_destroy(*scene);
        *scene = NULL;
    }
    return result;
}

void turner_side_adapt(void *user, struct turner_settings *settings)
{
    const struct turner_second_side *side = user;
    const struct turner_scene_options *o = &side->other;
    for (size_t i = 0; i < o->method_count; i++)
        turner_method_assign(settings, o->methods[i]); /* was valid when it was taken */
    if (o->spp) {
        settings->spp = o->spp;
        settings->aa_threshold = settings->error = 0;
    }
    if (o->shading >= 0)
        settings->shading = (enum turner_shading)o->shading;
    if (o->shadows >= 0)
        settings->shadows = (enum turner_shadows)o->shadows;
    if (!isnan(o->exposure))
        settings->exposure = o->exposure;
    if (o->transfer >= 0)
        settings->transfer = (enum turner_transfer)o->transfer;
}

bool turner_side_keeps(void *user, const char *param)
{
    const struct turner_second_side *side = user;
    size_t length = strlen(param);
    for (size_t i = 0; i < side->other.param_count; i++) {
        const char *given = side->other.params[i];
        if (strncmp(given, param, length) == 0 && given[length] == '=')
            return true;
    }
    return false;
}
