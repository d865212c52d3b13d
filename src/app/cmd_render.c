#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/scene_options.h"
#include "image/atomic.h"
#include "image/image.h"
#include "render/advice.h"
#include "render/layers.h"
#include "render/opening.h"
#include "render/renderer.h"
#include "scene/camera_file.h"

static void print_help(void)
{
    puts("Usage: turner render SCENE -o PICTURE [OPTION]…\n\n"
         "Draws SCENE (.json, .nff, or a mesh: .obj .ply .stl .gltf .glb) into PICTURE. The ending\n"
         "says the format: .exr .hdr .tif hold linear radiance, .png .jpg .ppm what an eye sees.\n"
         "Settings come from the defaults, then the scene, then these options:\n\n"
         "  -o, --output FILE      the picture; it appears whole or not at all\n"
         "      --size WxH         pixels\n"
         "      --camera N         one of the scene's \"cameras\"; 0, the default, is its \"camera\"\n"
         "      --path FILE        a picture for each camera of a path (R in turner view records one):\n"
         "                         picture-0001.png …\n"
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
         "      --traversal KIND   auto | bvh | bvh_lane | bvh_packet | ray_query\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --set NAME=VALUE   a parameter of the shaders; turner params SCENE lists them (may be\n"
         "                         repeated)\n"
         "      --no-scene-shaders leave out the shaders of the scene's own folder (docs/shaders.md)\n"
         "      --tile N           pixels traced at once, N×N; default adapts to the time it takes\n"
         "      --threads N        of the reference\n"
         "      --no-cache         compile the shaders anew, and keep nothing (docs/start.md)\n"
         "      --unspecialised    compile everything in, needed or not: same picture, slower\n"
         "      --stats FILE       what was done and how long it took, as JSON (- for stdout)\n"
         "      --print-settings   print the settings as they will be used, and stop\n"
         "  -q, --quiet            no progress bar, no summary, no warnings\n"
         "  -h, --help             this text\n\n"
         "Examples:\n"
         "  turner render scenes/prism.json -o prism.png --size 1280x720 --spp 16\n"
         "  turner render scenes/prism.json -o prism.exr --aov normal,depth,rays");
}

struct arguments {
    const char *scene, *output, *stats, *path;
    const char *what; /* is drawn: beside the progress bar */
    bool print_settings, quiet;
    double loading, start; /* seconds before main, and the clock then */
    struct turner_layers layers;
    struct turner_scene_options options;
};

enum { TILE = TURNER_OPTION_OWN, PATH, THREADS, UNSPECIALISED, NO_CACHE, STATS, PRINT_SETTINGS, AOV };

static const struct option long_options[] = {
    {"output", required_argument, NULL, 'o'},
    {"method", required_argument, NULL, 'm'},
    {"size", required_argument, NULL, TURNER_OPTION_SIZE},
    {"camera", required_argument, NULL, TURNER_OPTION_CAMERA},
    {"depth", required_argument, NULL, TURNER_OPTION_DEPTH},
    {"cutoff", required_argument, NULL, TURNER_OPTION_CUTOFF},
    {"spp", required_argument, NULL, TURNER_OPTION_SPP},
    {"shading", required_argument, NULL, TURNER_OPTION_SHADING},
    {"shadows", required_argument, NULL, TURNER_OPTION_SHADOWS},
    {"exposure", required_argument, NULL, TURNER_OPTION_EXPOSURE},
    {"transfer", required_argument, NULL, TURNER_OPTION_TRANSFER},
    {"error", required_argument, NULL, TURNER_OPTION_ERROR},
    {"aov", required_argument, NULL, AOV},
    {"spd-rays", no_argument, NULL, TURNER_OPTION_SPD_RAYS},
    {"spd-grid", no_argument, NULL, TURNER_OPTION_SPD_GRID},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, TURNER_OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, TURNER_OPTION_SHADER_DIR},
    {"set", required_argument, NULL, TURNER_OPTION_SET},
    {"no-scene-shaders", no_argument, NULL, TURNER_OPTION_NO_SCENE_SHADERS},
    {"tile", required_argument, NULL, TILE},
    {"path", required_argument, NULL, PATH},
    {"threads", required_argument, NULL, THREADS},
    {"no-cache", no_argument, NULL, NO_CACHE},
    {"unspecialised", no_argument, NULL, UNSPECIALISED},
    {"stats", required_argument, NULL, STATS},
    {"print-settings", no_argument, NULL, PRINT_SETTINGS},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    struct turner_render_options *render = &a->options.render;
    switch (option) {
    case 'o': a->output = optarg; return TURNER_OK;
    case 'q': a->quiet = true; return TURNER_OK;
    case AOV: return turner_layers_parse(&a->layers.wanted, optarg);
    case TILE: return turner_option_int(&render->tile, "--tile", optarg, 1, 4096);
    case PATH: a->path = optarg; return TURNER_OK;
    case THREADS: return turner_option_int(&render->threads, "--threads", optarg, 1, 1024);
    case NO_CACHE: render->no_cache = true; return TURNER_OK;
    case UNSPECIALISED: render->unspecialised = true; return TURNER_OK;
    case STATS: a->stats = optarg; return TURNER_OK;
    case PRINT_SETTINGS: a->print_settings = true; return TURNER_OK;
    }
    return turner_scene_option_take(&a->options, option, argv);
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

/* Of the processor before main: what loading the program took. */
static double loading_seconds(void)
{
    struct timespec used;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

static enum turner_result render(struct arguments *a, struct turner_scene *scene,
                                 struct turner_statistics *statistics,
                                 struct turner_opening *opening)
{
    struct turner_progress_bar bar;
    struct turner_image image = {0};
    enum turner_result result;
    turner_progress_begin(&bar, a->quiet);
    bar.what = a->what;
    struct turner_render_options *options = &a->options.render;
    options->progress = turner_progress_show;
    options->user = &bar;
    options->layers = a->layers.wanted ? &a->layers : NULL;
    result = turner_render_opened(&image, scene, options, statistics, opening);
    turner_progress_end(&bar);
    if (result != TURNER_OK)
        goto done;
    double start = turner_seconds();
    TURNER_TRY_DONE(turner_picture_write(a->output, scene, &image, statistics, &a->layers));
    statistics->seconds_write = turner_seconds() - start;
    statistics->seconds_start = a->loading;
    statistics->seconds_whole = a->loading + turner_seconds() - a->start;
    if (a->stats)
        TURNER_TRY_DONE(turner_statistics_write(a->stats, scene, statistics));
    if (!a->quiet && !(a->stats && strcmp(a->stats, "-") == 0))
        print_summary(a, statistics);
done:
    turner_image_destroy(&image);
    turner_layers_destroy(&a->layers);
    return result;
}

static enum turner_result load(struct turner_scene **scene, const struct arguments *a)
{
    TURNER_TRY(turner_scene_load(scene, a->scene));
    enum turner_result result = turner_scene_options_apply(&a->options, *scene);
    if (result != TURNER_OK)
        turner_scene_destroy(*scene);
    return result;
}

static enum turner_result print_settings(const struct arguments *a)
{
    struct turner_scene *scene;
    TURNER_TRY(load(&scene, a));
    char *settings = turner_settings_json(scene);
    puts(settings);
    free(settings);
    turner_scene_destroy(scene);
    return TURNER_OK;
}

/* "picture.png" → "picture-0007.png"; what ends in .16.png keeps that, too. */
static void number_name(char *name, size_t size, const char *output, size_t number)
{
    const char *slash = strrchr(output, '/'), *dot = strrchr(slash ? slash : output, '.');
    if (dot && dot - output > 3 && strncmp(dot - 3, ".16", 3) == 0)
        dot -= 3;
    int stem = (int)(dot ? dot - output : (long)strlen(output));
    snprintf(name, size, "%.*s-%04zu%s", stem, output, number, dot ? dot : "");
}

static enum turner_result render_path(struct arguments *a, struct turner_scene *scene,
                                      struct turner_statistics *statistics,
                                      struct turner_opening *opening)
{
    struct turner_camera_path path;
    const char *output = a->output;
    char name[4096], what[64];
    TURNER_TRY(turner_camera_path_load(&path, a->path, scene));
    enum turner_result result = TURNER_OK;
    for (size_t i = 0; i < path.count && result == TURNER_OK; i++) {
        number_name(name, sizeof name, output, i + 1);
        snprintf(what, sizeof what, "picture %zu of %zu", i + 1, path.count);
        a->output = name;
        a->what = what;
        scene->camera = path.cameras[i];
        result = render(a, scene, statistics, opening);
    }
    a->output = output;
    a->what = NULL;
    turner_camera_path_destroy(&path);
    return result;
}

static enum turner_result load_and_render(struct arguments *a)
{
    struct turner_scene *scene;
    struct turner_statistics statistics = {0};
    struct turner_opening opening;
    turner_opening_start(&opening, a->options.render.device);
    double start = turner_seconds();
    enum turner_result result = load(&scene, a);
    statistics.seconds_parse = turner_seconds() - start;
    if (result == TURNER_OK) {
        turner_advise(scene, a->scene, turner_image_bits(a->output));
        result = (a->path ? render_path : render)(a, scene, &statistics, &opening);
        turner_scene_destroy(scene);
    }
    turner_opening_destroy(&opening);
    return result;
}

enum turner_result turner_cmd_render(int argc, char **argv)
{
    struct arguments a = {.options = TURNER_SCENE_OPTIONS,
                          .loading = loading_seconds(),
                          .start = turner_seconds()};
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
    if (a.path && a.stats)
        return turner_fail(TURNER_USAGE, "--stats is of one picture, and --path draws many");
    if (a.output && a.layers.wanted)
        TURNER_TRY(turner_image_check_channels(a.output));
    if (a.output)
        TURNER_TRY(turner_image_check_writable(a.output));
    if (a.stats && strcmp(a.stats, "-") != 0)
        TURNER_TRY(turner_atomic_check(a.stats));

    return a.print_settings ? print_settings(&a) : load_and_render(&a);
}
