/* Options that say otherwise than the scene does, or how it is drawn: the same in every command that
 * has them. */
#ifndef TURNER_APP_SCENE_OPTIONS_H
#define TURNER_APP_SCENE_OPTIONS_H

#include <math.h>

#include "app/app.h"
#include "scene/scene.h"

#define TURNER_SHADER_DIRS 16
#define TURNER_METHOD_OPTIONS 64
#define TURNER_PARAM_OPTIONS 256

struct turner_scene_options {
    int camera; /* number; 0: the scene's first */
    int width, height, depth, spp, shading, shadows, transfer; /* −1 (or 0): the scene's */
    double cutoff, exposure, error;                            /* NaN: the scene's */
    bool spd_rays, spd_grid;
    const char *methods[TURNER_METHOD_OPTIONS]; /* "name=value", later ones win */
    size_t method_count;
    const char *params[TURNER_PARAM_OPTIONS]; /* the same of parameters of shaders */
    size_t param_count;
    const char *shader_dirs[TURNER_SHADER_DIRS];
    struct turner_render_options render;
};

#define TURNER_SCENE_OPTIONS                                                                        \
    {                                                                                               \
        .depth = -1, .shading = -1, .shadows = -1, .transfer = -1, .cutoff = NAN, .exposure = NAN,  \
        .error = NAN                                                                                \
    }

/* For getopt_long; methods are 'm', the device is 'd'. */
enum turner_scene_option {
    TURNER_OPTION_SIZE = 256,
    TURNER_OPTION_DEPTH,
    TURNER_OPTION_CUTOFF,
    TURNER_OPTION_SPP,
    TURNER_OPTION_ERROR,
    TURNER_OPTION_SHADING,
    TURNER_OPTION_SHADOWS,
    TURNER_OPTION_EXPOSURE,
    TURNER_OPTION_TRANSFER,
    TURNER_OPTION_SPD_RAYS,
    TURNER_OPTION_SPD_GRID,
    TURNER_OPTION_TRAVERSAL,
    TURNER_OPTION_SHADER_DIR,
    TURNER_OPTION_SET,
    TURNER_OPTION_CAMERA,
    TURNER_OPTION_NO_SCENE_SHADERS,
    TURNER_OPTION_OWN /* a command's own ones begin here */
};

/* Takes `option`, whose value is in optarg; turner_bad_option where it is none of these. */
enum turner_result turner_scene_option_take(struct turner_scene_options *options, int option,
                                            char **argv);

/* Changes the scene's settings, settles its parameters and checks the scene; methods come first, the
 * other options after them. */
enum turner_result turner_scene_options_apply(const struct turner_scene_options *options,
                                              struct turner_scene *scene);

/* The settings alone. */
enum turner_result turner_scene_options_settings(const struct turner_scene_options *options,
                                                 struct turner_scene *scene);

/* Gives the scene the values of --set, and each other parameter of its shaders the default.
 * TURNER_USAGE for what no shader has, or does not fit. */
enum turner_result turner_scene_options_settle(const struct turner_scene_options *options,
                                               struct turner_scene *scene);

#endif
