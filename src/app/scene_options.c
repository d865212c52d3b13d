#include "app/scene_options.h"

#include <getopt.h>

#include "render/params.h"
#include "render/shader_path.h"
#include "scene/methods.h"

static enum turner_result take_error(double *out, const char *text)
{
    double error;
    if (!turner_fraction(&error, text) || error < TURNER_ERROR_LEAST || error > TURNER_ERROR_MOST)
        return turner_fail(TURNER_USAGE, "--error takes a number from %g to %g, or a fraction as in "
                                         "1/255, not \"%s\"", TURNER_ERROR_LEAST,
                           TURNER_ERROR_MOST, text);
    *out = error;
    return TURNER_OK;
}

static enum turner_result take_method(struct turner_scene_options *o, const char *text)
{
    if (o->method_count == TURNER_METHOD_OPTIONS)
        return turner_fail(TURNER_USAGE, "--method can be given %d times", TURNER_METHOD_OPTIONS);
    o->methods[o->method_count++] = text;
    return TURNER_OK;
}

static enum turner_result take_param(struct turner_scene_options *o, const char *text)
{
    if (o->param_count == TURNER_PARAM_OPTIONS)
        return turner_fail(TURNER_USAGE, "--set can be given %d times", TURNER_PARAM_OPTIONS);
    o->params[o->param_count++] = text;
    return TURNER_OK;
}

static enum turner_result take_shader_dir(struct turner_scene_options *o, const char *text)
{
    if (o->render.shader_dir_count == TURNER_SHADER_DIRS)
        return turner_fail(TURNER_USAGE, "--shader-dir can be given %d times", TURNER_SHADER_DIRS);
    o->shader_dirs[o->render.shader_dir_count++] = text;
    o->render.shader_dirs = o->shader_dirs;
    return TURNER_OK;
}

static enum turner_result take_traversal(struct turner_scene_options *o, const char *text)
{
    static const char *const traversals[] = {"auto", "bvh", "ray_query", "bvh_lane",
                                             "bvh_packet", NULL};
    int choice;
    TURNER_TRY(turner_option_choice(&choice, "--traversal", text, traversals));
    o->render.traversal = (enum turner_traversal)choice;
    return TURNER_OK;
}

enum turner_result turner_scene_option_take(struct turner_scene_options *o, int option, char **argv)
{
    static const char *const shadings[] = {"phong", "energy_conserving", NULL};
    static const char *const shadows[] = {"opaque", "tinted", NULL};
    static const char *const transfers[] = {"srgb", "linear", NULL};
    switch (option) {
    case 'd': o->render.device = optarg; return TURNER_OK;
    case 'm': return take_method(o, optarg);
    case TURNER_OPTION_CAMERA:
        return turner_option_int(&o->camera, "--camera", optarg, 0, TURNER_MAX_CAMERAS);
    case TURNER_OPTION_SIZE:
        return turner_option_size(&o->width, &o->height, "--size", optarg);
    case TURNER_OPTION_DEPTH:
        return turner_option_int(&o->depth, "--depth", optarg, 0, TURNER_MAX_DEPTH);
    case TURNER_OPTION_CUTOFF: return turner_option_real(&o->cutoff, "--cutoff", optarg, 0, 1);
    case TURNER_OPTION_SPP: return turner_option_int(&o->spp, "--spp", optarg, 1, TURNER_MAX_SPP);
    case TURNER_OPTION_ERROR: return take_error(&o->error, optarg);
    case TURNER_OPTION_SHADING:
        return turner_option_choice(&o->shading, "--shading", optarg, shadings);
    case TURNER_OPTION_SHADOWS:
        return turner_option_choice(&o->shadows, "--shadows", optarg, shadows);
    case TURNER_OPTION_EXPOSURE:
        return turner_option_real(&o->exposure, "--exposure", optarg, -64, 64);
    case TURNER_OPTION_TRANSFER:
        return turner_option_choice(&o->transfer, "--transfer", optarg, transfers);
    case TURNER_OPTION_SPD_RAYS: o->spd_rays = true; return TURNER_OK;
    case TURNER_OPTION_SPD_GRID: o->spd_grid = true; return TURNER_OK;
    case TURNER_OPTION_TRAVERSAL: return take_traversal(o, optarg);
    case TURNER_OPTION_SHADER_DIR: return take_shader_dir(o, optarg);
    case TURNER_OPTION_SET: return take_param(o, optarg);
    case TURNER_OPTION_NO_SCENE_SHADERS: o->render.no_scene_shaders = true; return TURNER_OK;
    }
    return turner_bad_option(argv);
}

enum turner_result turner_scene_options_apply(const struct turner_scene_options *o,
                                              struct turner_scene *scene)
{
    TURNER_TRY(turner_scene_options_settings(o, scene));
    return turner_scene_options_settle(o, scene);
}

enum turner_result turner_scene_options_settings(const struct turner_scene_options *o,
                                                 struct turner_scene *scene)
{
    struct turner_settings *s = &scene->settings;
    bool asked = o->spp || o->depth >= 0 || !isnan(o->cutoff);
    if (o->camera)
        TURNER_TRY(turner_scene_use_camera(scene, o->camera));
    for (size_t i = 0; i < o->method_count; i++)
        TURNER_TRY(turner_method_assign(s, o->methods[i]));
    if (!isnan(o->error) && asked)
        return turner_fail(TURNER_USAGE, "--error chooses depth, cutoff and samples itself; leave "
                                         "out --depth, --cutoff and --spp");
    if (asked)
        s->error = 0;
    if (!isnan(o->error))
        s->error = o->error;
    if (o->width)
        s->width = o->width, s->height = o->height;
    if (o->depth >= 0)
        s->depth = o->depth, s->depth_asked = true;
    if (!isnan(o->cutoff))
        s->cutoff = o->cutoff;
    if (o->spp)
        s->spp = o->spp, s->aa_threshold = 0;
    if (o->shading >= 0)
        s->shading = (enum turner_shading)o->shading;
    if (o->shadows >= 0)
        s->shadows = (enum turner_shadows)o->shadows;
    if (!isnan(o->exposure))
        s->exposure = o->exposure;
    if (o->transfer >= 0)
        s->transfer = (enum turner_transfer)o->transfer;
    s->spd_rays = s->spd_rays || o->spd_rays;
    s->spd_grid = s->spd_grid || o->spd_grid;
    return turner_scene_validate(scene);
}

enum turner_result turner_scene_options_settle(const struct turner_scene_options *o,
                                               struct turner_scene *scene)
{
    struct turner_render_options render = o->render;
    struct turner_shader_path path;
    enum turner_result result;
    turner_shader_path_create(&path, &render, scene);
    for (size_t i = 0; i < o->param_count; i++)
        TURNER_TRY_DONE(turner_scene_assign_param(scene, o->params[i]));
    TURNER_TRY_DONE(turner_params_settle(scene, &render));
done:
    turner_shader_path_destroy(&path);
    return result;
}
