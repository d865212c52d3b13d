#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/explain.h"
#include "app/scene_options.h"
#include "reference/reference.h"
#include "render/explain.h"
#include "render/hooks.h"
#include "render/shader_path.h"

static void print_help(void)
{
    puts("Usage: turner explain SCENE --pixel X,Y [OPTION]…\n\n"
         "Lists every ray that made a pixel, as a tree: where it went, what it met, how light was\n"
         "reflected there and what it brought; by a device, by the reference in extended\n"
         "precision beside it, and in how many bits of the mantissa both agree. Says at which ray\n"
         "they part first, and which number of which ray was the first that is not finite.\n\n"
         "  -p, --pixel X,Y        0,0 is the top left one\n"
         "      --sample I         of the samples of a pixel; default is one in its centre\n"
         "      --camera N, --size WxH, --depth N, --cutoff X, --spp N   as for turner render\n"
         "  -m, --method NAME=VALUE  a way to compute; turner params lists them (may be repeated)\n"
         "  -d, --device D         index or part of the name (turner devices), or reference: that\n"
         "                         tree alone, without Vulkan\n"
         "      --traversal KIND   auto | bvh | bvh_lane | bvh_packet | ray_query\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --set NAME=VALUE   a parameter of the shaders; turner params SCENE lists them (may be\n"
         "                         repeated)\n"
         "      --bits N           rays that agree in fewer bits part; default 10\n"
         "      --json             the same as JSON (docs/explain.md)\n"
         "  -h, --help             this text\n\n"
         "Example: turner explain scenes/bubble.json --pixel 320,240 --depth 2");
}

struct arguments {
    const char *pixel;
    int sample, bits; /* −1: the pixel's centre; the default */
    bool json;
    struct turner_scene_options options;
};

enum { SAMPLE = TURNER_OPTION_OWN, BITS, JSON };

static const struct option long_options[] = {
    {"pixel", required_argument, NULL, 'p'},
    {"sample", required_argument, NULL, SAMPLE},
    {"size", required_argument, NULL, TURNER_OPTION_SIZE},
    {"camera", required_argument, NULL, TURNER_OPTION_CAMERA},
    {"depth", required_argument, NULL, TURNER_OPTION_DEPTH},
    {"cutoff", required_argument, NULL, TURNER_OPTION_CUTOFF},
    {"spp", required_argument, NULL, TURNER_OPTION_SPP},
    {"method", required_argument, NULL, 'm'},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, TURNER_OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, TURNER_OPTION_SHADER_DIR},
    {"set", required_argument, NULL, TURNER_OPTION_SET},
    {"bits", required_argument, NULL, BITS},
    {"json", no_argument, NULL, JSON},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    switch (option) {
    case 'p': a->pixel = optarg; return TURNER_OK;
    case SAMPLE: return turner_option_int(&a->sample, "--sample", optarg, 0, TURNER_MAX_SPP - 1);
    case BITS: return turner_option_int(&a->bits, "--bits", optarg, 1, 53);
    case JSON: a->json = true; return TURNER_OK;
    }
    return turner_scene_option_take(&a->options, option, argv);
}

/* "X,Y" of a picture. */
static enum turner_result read_pixel(int *x, int *y, const char *text,
                                     const struct turner_settings *settings)
{
    char *comma, *end = NULL;
    long column = strtol(text, &comma, 10), row = 0; /* too large ones become the largest */
    if (comma != text && *comma == ',')
        row = strtol(comma + 1, &end, 10);
    if (!end || end == comma + 1 || *end)
        return turner_fail(TURNER_USAGE, "--pixel takes X,Y as in 320,240, not \"%s\"", text);
    if (column < 0 || row < 0 || column >= settings->width || row >= settings->height)
        return turner_fail(TURNER_USAGE,
                           "--pixel %s is outside the picture, which has %dx%d pixels: from 0,0 "
                           "to %d,%d", text, settings->width, settings->height,
                           settings->width - 1, settings->height - 1);
    *x = (int)column;
    *y = (int)row;
    return TURNER_OK;
}

static enum turner_result place_sample(struct turner_explanation *explanation,
                                       const struct arguments *a,
                                       const struct turner_settings *settings)
{
    if (a->sample < 0) {
        turner_sample_position(&explanation->sample_x, &explanation->sample_y, 0, 1);
        return TURNER_OK;
    }
    if (a->sample >= settings->spp)
        return turner_fail(TURNER_USAGE, "--sample %d: a pixel has %d sample%s, from 0 to %d; "
                                         "--spp changes that", a->sample, settings->spp,
                           settings->spp == 1 ? "" : "s", settings->spp - 1);
    turner_sample_position(&explanation->sample_x, &explanation->sample_y, a->sample,
                           settings->spp);
    return TURNER_OK;
}

static enum turner_result explain(const struct arguments *a, const struct turner_scene *scene,
                                  const struct turner_render_options *options)
{
    struct turner_explanation explanation = {.scene = scene};
    struct turner_ray_tree device = {0}, reference = {0};
    struct turner_recorder recorder = {0};
    bool alone = a->options.render.device && strcmp(a->options.render.device, "reference") == 0;
    enum turner_result result;
    TURNER_TRY(turner_hooks_warn(options, "they are why it parts from the device"));
    TURNER_TRY(read_pixel(&explanation.x, &explanation.y, a->pixel, &scene->settings));
    TURNER_TRY(place_sample(&explanation, a, &scene->settings));

    TURNER_TRY_DONE(turner_reference_explain(&reference, scene,
                                             explanation.x + explanation.sample_x,
                                             explanation.y + explanation.sample_y));
    if (!alone) {
        TURNER_TRY_DONE(turner_recorder_create(&recorder, scene, options));
        TURNER_TRY_DONE(turner_recorder_trace(&device, &recorder, explanation.x, explanation.y,
                                              explanation.sample_x, explanation.sample_y));
        explanation.device = recorder.gpu.info.name;
        explanation.driver = recorder.gpu.info.driver;
        explanation.traversal = turner_traversal_name(recorder.kind);
        explanation.precision = recorder.kind & TURNER_F64 ? "f64" : "f32";
    }
    turner_rays_compare(&explanation.comparison, alone ? NULL : &device, &reference, a->bits);
    (a->json ? turner_explain_json : turner_explain_text)(stdout, &explanation);
done:
    turner_rays_destroy(&explanation.comparison);
    if (!alone)
        turner_recorder_destroy(&recorder);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    return result;
}

enum turner_result turner_cmd_explain(int argc, char **argv)
{
    struct arguments a = {.sample = -1, .bits = 10, .options = TURNER_SCENE_OPTIONS};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "p:d:m:h", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        TURNER_TRY(take(&a, option, argv));
    }
    if (optind + 1 != argc)
        return turner_fail(TURNER_USAGE, "explain takes one scene; see turner explain --help");
    if (!a.pixel)
        return turner_fail(TURNER_USAGE, "say which pixel: --pixel X,Y");

    struct turner_scene *scene;
    TURNER_TRY(turner_scene_load(&scene, argv[optind]));
    enum turner_result result = turner_scene_options_apply(&a.options, scene);
    scene->settings.error = 0; /* one tree, of the depth and cutoff that both sides can follow */
    struct turner_render_options options = a.options.render;
    struct turner_shader_path path;
    turner_shader_path_create(&path, &options, scene);
    if (result == TURNER_OK)
        result = explain(&a, scene, &options);
    turner_shader_path_destroy(&path);
    turner_scene_destroy(scene);
    return result;
}
