#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "image/atomic.h"
#include "image/image.h"
#include "render/advice.h"
#include "render/layers.h"
#include "render/renderer.h"
#include "scene/methods.h"

static void print_help(void)
{
    puts("Usage: turner render SCENE -o PICTURE [OPTION]…\n\n"
         "Draws SCENE (.json, .nff, or a mesh: .obj .ply .stl .gltf .glb) into PICTURE. The ending\n"
         "says the format: .exr .hdr .tif hold linear radiance, .png .jpg .ppm what an eye sees.\n"
         "Settings come from the defaults, then the scene, then these options:\n\n"
         "  -o, --output FILE      the picture; it appears whole or not at all\n"
         "      --size WxH         pixels\n"
         "      --depth N          how often light may be reflected or refracted\n"
         "      --cutoff X         rays that count less are not followed; 0 follows all\n"
         "      --spp N            samples per pixel\n"
         "      --error E          choose depth, cutoff and samples so that no pixel is estimated to be\n"
         "                         off by more than E (1/255, 0.002 …) in a channel, linear\n"
         "  -m, --method NAME=VALUE  a way to compute: sphere=textbook, aa=adaptive:0.05,64 …; turner\n"
         "                         params lists them (may be repeated)\n"
         "      --shading KIND     phong | energy_conserving\n"
         "      --shadows KIND     opaque | tinted\n"
         "      --exposure STOPS   for .png .jpg .ppm: brighter by 2 to the power of it\n"
         "      --transfer CURVE   for .png .jpg .ppm: srgb | linear\n"
         "      --aov LAYERS       what else is known of each pixel, as layers of an .exr: a list with\n"
         "                         commas, or all (docs/layers.md):\n"
         "                           normal albedo position id   of the surface at the pixel's centre\n"
         "                           depth      metres along the ray to it, from the eye\n"
         "                           recursion  how deep reflection and refraction went\n"
         "                           rays samples pruned error nonfinite\n"
         "      --spd-rays, --spd-grid   count rays as the Standard Procedural Databases do\n\n"
         "  -d, --device D         index or part of the name (turner devices), or reference:\n"
         "                         extended precision on the CPU, slow, the truth to compare with\n"
         "      --traversal KIND   auto | bvh | ray_query\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --tile N           pixels traced at once, N×N; default adapts to the time it takes\n"
         "      --threads N        of the reference\n"
         "      --unspecialised    compile everything in, needed or not: same picture, slower\n"
         "      --stats FILE       what was done and how long it took, as JSON (- for stdout)\n"
         "      --print-settings   print the settings as they will be used, and stop\n"
         "  -q, --quiet            no progress bar, no summary, no warnings\n"
         "  -h, --help             this text\n\n"
         "Examples:\n"
         "  turner render scenes/prism.json -o prism.png --size 1280x720 --spp 16\n"
         "  turner render scenes/prism.json -o prism.exr --aov normal,depth,rays");
}

#define MAX_SHADER_DIRS 16
#define MAX_METHODS 64

struct arguments {
    const char *scene, *output, *stats;
    int width, height, depth, spp, shading, shadows, transfer; /* −1 (or 0): the scene's */
    double cutoff, exposure, error; /* NaN: the scene's */
    bool spd_rays, spd_grid, print_settings, quiet;
    const char *shader_dirs[MAX_SHADER_DIRS];
    const char *methods[MAX_METHODS]; /* "name=value", later ones win */
    size_t method_count;
    struct turner_layers layers;
    struct turner_render_options render;
};

enum { OPTION_SIZE = 256, OPTION_DEPTH, OPTION_CUTOFF, OPTION_SPP, OPTION_SHADING, OPTION_SHADOWS,
       OPTION_EXPOSURE, OPTION_TRANSFER, OPTION_SPD_RAYS, OPTION_SPD_GRID, OPTION_TRAVERSAL,
       OPTION_SHADER_DIR, OPTION_TILE, OPTION_THREADS, OPTION_UNSPECIALISED, OPTION_STATS,
       OPTION_PRINT_SETTINGS, OPTION_AOV, OPTION_ERROR };

static const struct option long_options[] = {
    {"output", required_argument, NULL, 'o'},
    {"method", required_argument, NULL, 'm'},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"depth", required_argument, NULL, OPTION_DEPTH},
    {"cutoff", required_argument, NULL, OPTION_CUTOFF},
    {"spp", required_argument, NULL, OPTION_SPP},
    {"shading", required_argument, NULL, OPTION_SHADING},
    {"shadows", required_argument, NULL, OPTION_SHADOWS},
    {"exposure", required_argument, NULL, OPTION_EXPOSURE},
    {"transfer", required_argument, NULL, OPTION_TRANSFER},
    {"error", required_argument, NULL, OPTION_ERROR},
    {"aov", required_argument, NULL, OPTION_AOV},
    {"spd-rays", no_argument, NULL, OPTION_SPD_RAYS},
    {"spd-grid", no_argument, NULL, OPTION_SPD_GRID},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, OPTION_SHADER_DIR},
    {"tile", required_argument, NULL, OPTION_TILE},
    {"threads", required_argument, NULL, OPTION_THREADS},
    {"unspecialised", no_argument, NULL, OPTION_UNSPECIALISED},
    {"stats", required_argument, NULL, OPTION_STATS},
    {"print-settings", no_argument, NULL, OPTION_PRINT_SETTINGS},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0}};

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

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    static const char *const shadings[] = {"phong", "energy_conserving", NULL};
    static const char *const shadows[] = {"opaque", "tinted", NULL};
    static const char *const transfers[] = {"srgb", "linear", NULL};
    static const char *const traversals[] = {"auto", "bvh", "ray_query", NULL};
    int choice;
    switch (option) {
    case 'o': a->output = optarg; return TURNER_OK;
    case 'd': a->render.device = optarg; return TURNER_OK;
    case 'm':
        if (a->method_count == MAX_METHODS)
            return turner_fail(TURNER_USAGE, "--method can be given %d times", MAX_METHODS);
        a->methods[a->method_count++] = optarg;
        return TURNER_OK;
    case 'q': a->quiet = true; return TURNER_OK;
    case OPTION_SIZE: return turner_option_size(&a->width, &a->height, "--size", optarg);
    case OPTION_DEPTH: return turner_option_int(&a->depth, "--depth", optarg, 0, TURNER_MAX_DEPTH);
    case OPTION_CUTOFF: return turner_option_real(&a->cutoff, "--cutoff", optarg, 0, 1);
    case OPTION_SPP: return turner_option_int(&a->spp, "--spp", optarg, 1, TURNER_MAX_SPP);
    case OPTION_SHADING: return turner_option_choice(&a->shading, "--shading", optarg, shadings);
    case OPTION_SHADOWS: return turner_option_choice(&a->shadows, "--shadows", optarg, shadows);
    case OPTION_EXPOSURE:
        return turner_option_real(&a->exposure, "--exposure", optarg, -64, 64);
    case OPTION_TRANSFER:
        return turner_option_choice(&a->transfer, "--transfer", optarg, transfers);
    case OPTION_ERROR: return take_error(&a->error, optarg);
    case OPTION_AOV: return turner_layers_parse(&a->layers.wanted, optarg);
    case OPTION_SPD_RAYS: a->spd_rays = true; return TURNER_OK;
    case OPTION_SPD_GRID: a->spd_grid = true; return TURNER_OK;
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
    case OPTION_TILE: return turner_option_int(&a->render.tile, "--tile", optarg, 1, 4096);
    case OPTION_THREADS:
        return turner_option_int(&a->render.threads, "--threads", optarg, 1, 1024);
    case OPTION_UNSPECIALISED: a->render.unspecialised = true; return TURNER_OK;
    case OPTION_STATS: a->stats = optarg; return TURNER_OK;
    case OPTION_PRINT_SETTINGS: a->print_settings = true; return TURNER_OK;
    }
    return turner_bad_option(argv);
}

static enum turner_result apply(const struct arguments *a, struct turner_scene *scene)
{
    struct turner_settings *s = &scene->settings;
    for (size_t i = 0; i < a->method_count; i++)
        TURNER_TRY(turner_method_assign(s, a->methods[i]));
    if (a->width)
        s->width = a->width, s->height = a->height;
    if (a->depth >= 0)
        s->depth = a->depth, s->depth_asked = true;
    if (!isnan(a->cutoff))
        s->cutoff = a->cutoff;
    if (a->spp)
        s->spp = a->spp, s->aa_threshold = 0;
    if (a->spp || a->depth >= 0 || !isnan(a->cutoff))
        s->error = 0;
    if (!isnan(a->error) && (a->spp || a->depth >= 0 || !isnan(a->cutoff)))
        return turner_fail(TURNER_USAGE, "--error chooses depth, cutoff and samples itself; leave "
                                         "out --depth, --cutoff and --spp");
    if (!isnan(a->error))
        s->error = a->error;
    if (a->shading >= 0)
        s->shading = (enum turner_shading)a->shading;
    if (a->shadows >= 0)
        s->shadows = (enum turner_shadows)a->shadows;
    if (!isnan(a->exposure))
        s->exposure = a->exposure;
    if (a->transfer >= 0)
        s->transfer = (enum turner_transfer)a->transfer;
    s->spd_rays = s->spd_rays || a->spd_rays;
    s->spd_grid = s->spd_grid || a->spd_grid;
    return turner_scene_validate(scene);
}

static enum turner_result write_picture(const struct arguments *a,
                                        const struct turner_scene *scene,
                                        const struct turner_image *image,
                                        struct turner_statistics *statistics)
{
    char *settings = turner_settings_json(scene);
    struct turner_image_text texts[] = {
        {"turner:version", turner_version()},
        {"turner:device", statistics->device},
        {"turner:traversal", statistics->traversal},
        {"turner:settings", settings},
    };
    struct turner_image_channel channels[TURNER_LAYER_CHANNELS];
    struct turner_image_encoding encoding = {
        .exposure = scene->settings.exposure,
        .linear = scene->settings.transfer == TURNER_TRANSFER_LINEAR,
        .texts = texts,
        .text_count = sizeof texts / sizeof *texts,
        .channels = channels,
        .channel_count = turner_layers_channels(channels, &a->layers),
    };
    double start = turner_seconds();
    enum turner_result result = turner_image_write(image, a->output, &encoding);
    statistics->seconds_write = turner_seconds() - start;
    free(settings);
    return result;
}

static void print_summary(const struct arguments *a, const struct turner_statistics *s)
{
    uint64_t rays = s->camera_rays + s->reflected_rays + s->refracted_rays + s->shadow_rays;
    printf("%s: %llu rays in %.3f s (%.2f million a second) on %s, %s, %s\n", a->output,
           (unsigned long long)rays, s->seconds_trace, (double)rays / s->seconds_trace / 1e6,
           s->device, s->traversal, s->precision);
    if (s->error_max > 0)
        printf("error: estimated %.2g at most, %.2g on average; %.1f samples a pixel, %d at most; "
               "depth %d, cutoff %.2g\n", s->error_max, s->error_mean, s->samples_mean,
               s->samples_max, s->largest_depth, s->cutoff_least);
    if (s->error_missed)
        printf("%llu pixel%s could not be brought below the error asked for\n",
               (unsigned long long)s->error_missed, s->error_missed == 1 ? "" : "s");
    else if (s->pruned_max > 0 && s->error_max == 0)
        printf("cut off: weight %.2g per pixel on average, %.2g at most (times the largest "
               "radiance bounds the error)\n", s->pruned_mean, s->pruned_max);
}

static enum turner_result render(struct arguments *a, struct turner_scene *scene,
                                 struct turner_statistics *statistics)
{
    struct turner_progress_bar bar;
    struct turner_image image = {0};
    enum turner_result result;
    turner_progress_begin(&bar, a->quiet);
    a->render.shader_dirs = a->shader_dirs;
    a->render.progress = turner_progress_show;
    a->render.user = &bar;
    a->render.layers = a->layers.wanted ? &a->layers : NULL;
    result = turner_render(&image, scene, &a->render, statistics);
    turner_progress_end(&bar);
    if (result != TURNER_OK)
        goto done;
    TURNER_TRY_DONE(write_picture(a, scene, &image, statistics));
    if (a->stats)
        TURNER_TRY_DONE(turner_statistics_write(a->stats, scene, statistics));
    if (!a->quiet && !(a->stats && strcmp(a->stats, "-") == 0))
        print_summary(a, statistics);
done:
    turner_image_destroy(&image);
    turner_layers_destroy(&a->layers);
    return result;
}

enum turner_result turner_cmd_render(int argc, char **argv)
{
    struct arguments a = {.depth = -1, .cutoff = NAN, .exposure = NAN, .error = NAN, .shading = -1,
                          .shadows = -1, .transfer = -1};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "o:d:m:qh", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        TURNER_TRY(take(&a, option, argv));
    }
    if (optind + 1 != argc)
        return turner_fail(TURNER_USAGE, "render takes one scene; see turner render --help");
    a.scene = argv[optind];
    turner_set_quiet(a.quiet);
    if (!a.output && !a.print_settings)
        return turner_fail(TURNER_USAGE, "say where the picture goes: -o picture.png");
    if (a.output && a.layers.wanted)
        TURNER_TRY(turner_image_check_channels(a.output));
    if (a.output)
        TURNER_TRY(turner_image_check_writable(a.output));
    if (a.stats && strcmp(a.stats, "-") != 0)
        TURNER_TRY(turner_atomic_check(a.stats));

    struct turner_scene *scene;
    struct turner_statistics statistics = {0};
    double start = turner_seconds();
    TURNER_TRY(turner_scene_load(&scene, a.scene));
    statistics.seconds_parse = turner_seconds() - start;
    enum turner_result result = apply(&a, scene);
    if (result == TURNER_OK && a.print_settings) {
        char *settings = turner_settings_json(scene);
        puts(settings);
        free(settings);
    } else if (result == TURNER_OK) {
        turner_advise(scene, a.scene, turner_image_bits(a.output));
        result = render(&a, scene, &statistics);
    }
    turner_scene_destroy(scene);
    return result;
}
