#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/explain.h"
#include "reference/reference.h"
#include "render/explain.h"
#include "scene/methods.h"

static void print_help(void)
{
    puts("Usage: turner explain SCENE --pixel X,Y [OPTION]…\n\n"
         "Lists every ray that made a pixel, as a tree: where it went, what it met, how light was\n"
         "reflected there and what it brought; by a device, by the reference in extended\n"
         "precision beside it, and in how many bits of the mantissa both agree. Says at which ray\n"
         "they part first, and which number of which ray was the first that is not finite.\n\n"
         "  -p, --pixel X,Y        0,0 is the top left one\n"
         "      --sample I         of the samples of a pixel; default is one in its centre\n"
         "      --size WxH, --depth N, --cutoff X, --spp N   as for turner render\n"
         "  -m, --method NAME=VALUE  a way to compute; turner params lists them (may be repeated)\n"
         "  -d, --device D         index or part of the name (turner devices), or reference: that\n"
         "                         tree alone, without Vulkan\n"
         "      --traversal KIND   auto | bvh | ray_query\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --bits N           rays that agree in fewer bits part; default 10\n"
         "      --json             the same as JSON (docs/explain.md)\n"
         "  -h, --help             this text\n\n"
         "Example: turner explain scenes/bubble.json --pixel 320,240 --depth 2");
}

#define MAX_SHADER_DIRS 16
#define MAX_METHODS 64

struct arguments {
    const char *scene, *pixel;
    int width, height, depth, spp, sample, bits; /* −1 (or 0): the scene's, or the default */
    double cutoff;                               /* NaN: the scene's */
    bool json;
    const char *methods[MAX_METHODS], *shader_dirs[MAX_SHADER_DIRS];
    size_t method_count;
    struct turner_render_options render;
};

enum { OPTION_SIZE = 256, OPTION_DEPTH, OPTION_CUTOFF, OPTION_SPP, OPTION_SAMPLE,
       OPTION_TRAVERSAL, OPTION_SHADER_DIR, OPTION_BITS, OPTION_JSON };

static const struct option long_options[] = {
    {"pixel", required_argument, NULL, 'p'},
    {"sample", required_argument, NULL, OPTION_SAMPLE},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"depth", required_argument, NULL, OPTION_DEPTH},
    {"cutoff", required_argument, NULL, OPTION_CUTOFF},
    {"spp", required_argument, NULL, OPTION_SPP},
    {"method", required_argument, NULL, 'm'},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, OPTION_SHADER_DIR},
    {"bits", required_argument, NULL, OPTION_BITS},
    {"json", no_argument, NULL, OPTION_JSON},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    static const char *const traversals[] = {"auto", "bvh", "ray_query", NULL};
    int choice;
    switch (option) {
    case 'p': a->pixel = optarg; return TURNER_OK;
    case 'd': a->render.device = optarg; return TURNER_OK;
    case 'm':
        if (a->method_count == MAX_METHODS)
            return turner_fail(TURNER_USAGE, "--method can be given %d times", MAX_METHODS);
        a->methods[a->method_count++] = optarg;
        return TURNER_OK;
    case OPTION_SAMPLE:
        return turner_option_int(&a->sample, "--sample", optarg, 0, TURNER_MAX_SPP - 1);
    case OPTION_SIZE: return turner_option_size(&a->width, &a->height, "--size", optarg);
    case OPTION_DEPTH: return turner_option_int(&a->depth, "--depth", optarg, 0, TURNER_MAX_DEPTH);
    case OPTION_CUTOFF: return turner_option_real(&a->cutoff, "--cutoff", optarg, 0, 1);
    case OPTION_SPP: return turner_option_int(&a->spp, "--spp", optarg, 1, TURNER_MAX_SPP);
    case OPTION_TRAVERSAL:
        TURNER_TRY(turner_option_choice(&choice, "--traversal", optarg, traversals));
        a->render.traversal = (enum turner_traversal)choice;
        return TURNER_OK;
    case OPTION_SHADER_DIR:
        if (a->render.shader_dir_count == MAX_SHADER_DIRS)
            return turner_fail(TURNER_USAGE, "--shader-dir can be given %d times",
                               MAX_SHADER_DIRS);
        a->shader_dirs[a->render.shader_dir_count++] = optarg;
        return TURNER_OK;
    case OPTION_BITS: return turner_option_int(&a->bits, "--bits", optarg, 1, 53);
    case OPTION_JSON: a->json = true; return TURNER_OK;
    }
    return turner_bad_option(argv);
}

static enum turner_result apply(const struct arguments *a, struct turner_scene *scene)
{
    struct turner_settings *s = &scene->settings;
    for (size_t i = 0; i < a->method_count; i++)
        TURNER_TRY(turner_method_assign(s, a->methods[i]));
    s->error = 0; /* one tree, of the depth and cutoff that are given: both sides can follow it */
    if (a->width)
        s->width = a->width, s->height = a->height;
    if (a->depth >= 0)
        s->depth = a->depth;
    if (!isnan(a->cutoff))
        s->cutoff = a->cutoff;
    if (a->spp)
        s->spp = a->spp, s->aa_threshold = 0;
    return turner_scene_validate(scene);
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

static enum turner_result explain(const struct arguments *a, const struct turner_scene *scene)
{
    struct turner_explanation explanation = {.scene = scene};
    struct turner_ray_tree device = {0}, reference = {0};
    struct turner_recorder recorder = {0};
    bool alone = a->render.device && strcmp(a->render.device, "reference") == 0;
    enum turner_result result;
    TURNER_TRY(read_pixel(&explanation.x, &explanation.y, a->pixel, &scene->settings));
    TURNER_TRY(place_sample(&explanation, a, &scene->settings));

    TURNER_TRY_DONE(turner_reference_explain(&reference, scene,
                                             explanation.x + explanation.sample_x,
                                             explanation.y + explanation.sample_y));
    if (!alone) {
        TURNER_TRY_DONE(turner_recorder_create(&recorder, scene, &a->render));
        TURNER_TRY_DONE(turner_recorder_trace(&device, &recorder, explanation.x, explanation.y,
                                              explanation.sample_x, explanation.sample_y));
        explanation.device = recorder.gpu.info.name;
        explanation.driver = recorder.gpu.info.driver;
        explanation.traversal = recorder.kind & TURNER_RAY_QUERY ? "ray_query" : "bvh";
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
    struct arguments a = {.depth = -1, .cutoff = NAN, .sample = -1, .bits = 10};
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
    a.render.shader_dirs = a.shader_dirs;

    struct turner_scene *scene;
    TURNER_TRY(turner_scene_load(&scene, argv[optind]));
    enum turner_result result = apply(&a, scene);
    if (result == TURNER_OK)
        result = explain(&a, scene);
    turner_scene_destroy(scene);
    return result;
}
