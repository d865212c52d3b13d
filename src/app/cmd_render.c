#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "app/scene_options.h"
#include "image/atomic.h"
#include "image/image.h"
#include "render/adaptive.h"
#include "render/advice.h"
#include "render/layers.h"
#include "render/opening.h"
#include "render/renderer.h"
#include "render/shader_watch.h"
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
         "      --watch            draw again whenever a file that went into the picture is saved:\n"
         "                         shaders, the scene, meshes, textures; say what is wrong and go on;\n"
         "                         Ctrl-C ends it (status 130)\n"
         "      --stats FILE       what was done and how long it took, as JSON (- for stdout)\n"
         "      --print-settings   print the settings as they will be used, and stop\n"
         "  -q, --quiet            no progress bar, no summary, no warnings\n"
         "  -h, --help             this text\n\n"
         "Examples:\n"
         "  turner render scenes/prism.json -o prism.png --size 1280x720 --spp 16\n"
         "  turner render scenes/prism.json -o prism.exr --aov normal,depth,rays");
}

/* Of so few it takes longer to have Mesa's CPU device optimise the code than to do without. */
#define FEW_SAMPLES 16384

struct arguments {
    const char *scene, *output, *stats, *path;
    const char *what; /* is drawn: beside the progress bar */
    bool print_settings, quiet;
    double loading, start; /* seconds before main, and the clock then */
    struct turner_layers layers;
    struct turner_scene_options options;
    struct turner_progress_bar bar;
    /* --watch */
    bool watching;
    struct turner_watch *watch; /* the files that went into the picture; NULL without */
    struct timespec since;      /* before they were read */
    bool changed;               /* one has changed while the picture was drawn */
    double looked;              /* when that was last looked at */
};

enum { TILE = TURNER_OPTION_OWN, PATH, THREADS, UNSPECIALISED, NO_CACHE, STATS, PRINT_SETTINGS, AOV,
       WATCH };

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
    {"watch", no_argument, NULL, WATCH},
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
    case WATCH: a->watching = true; return TURNER_OK;
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

static bool show(double share, void *user)
{
    return turner_progress_show(share, &((struct arguments *)user)->bar);
}

static bool show_and_look(double share, void *user);

static enum turner_result render(struct arguments *a, struct turner_scene *scene,
                                 struct turner_statistics *statistics,
                                 struct turner_opening *opening)
{
    struct turner_image image = {0};
    enum turner_result result;
    turner_progress_begin(&a->bar, a->quiet);
    a->bar.what = a->what;
    struct turner_render_options *options = &a->options.render;
    options->progress = a->watch ? show_and_look : show;
    options->user = a;
    options->layers = a->layers.wanted ? &a->layers : NULL;
    result = turner_render_opened(&image, scene, options, statistics, opening);
    turner_progress_end(&a->bar);
    if (result != TURNER_OK)
        goto done;
    if (!a->watching && !a->path)
        turner_opening_close(opening);
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
    if (a->watch)
        turner_shader_watch_all(a->watch, &a->options.render, *scene, a->since);
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

static bool has_few_samples(const struct turner_settings *settings)
{
    return !turner_adaptive_wanted(settings) &&
           (double)settings->width * settings->height * settings->spp <= FEW_SAMPLES;
}

/* Whether that is to be known before the device opens; else reading the scene is not waited for. */
static bool may_have_few_samples(const struct arguments *a)
{
    double pixels = (double)a->options.width * a->options.height;
    return pixels > 0 && pixels <= FEW_SAMPLES && !a->watching && !a->path;
}

/* The scene once, with a device that is being opened, or is opened now. */
static enum turner_result load_and_render(struct arguments *a, struct turner_opening *opening)
{
    struct turner_scene *scene;
    struct turner_statistics statistics = {0};
    double start = turner_seconds();
    TURNER_TRY(load(&scene, a));
    statistics.seconds_parse = turner_seconds() - start;
    if (!opening->begun) {
        a->options.render.soon = has_few_samples(&scene->settings) && turner_gpu_prefer_soon();
        turner_opening_start(opening, a->options.render.device);
    }
    turner_advise(scene, a->scene, turner_image_bits(a->output));
    enum turner_result result = (a->path ? render_path : render)(a, scene, &statistics, opening);
    turner_scene_destroy(scene);
    return result;
}

/* ---- --watch ---- */

static void pause_for(double seconds)
{
    struct timespec time = {(time_t)seconds, (long)(1e9 * fmod(seconds, 1))};
    nanosleep(&time, NULL);
}

/* Until a file changes, and then until all are left in peace: one that is being written is changed
 * several times. */
static void wait_for_change(struct arguments *a)
{
    bool changed = a->changed;
    for (int quiet = 0; !changed || quiet < 2;) {
        pause_for(changed ? 0.015 : 0.05);
        bool now = turner_watch_changed(a->watch);
        quiet = now ? 0 : quiet + 1;
        changed |= now;
    }
}

/* For turner_render_options.progress: a picture of files that have changed since is not finished. */
static bool show_and_look(double share, void *user)
{
    struct arguments *a = user;
    double now = turner_seconds();
    if (now - a->looked > 0.05) {
        a->looked = now;
        a->changed |= turner_watch_changed(a->watch);
    }
    return !a->changed && turner_progress_show(share, &a->bar);
}

/* Draws, and again whenever a file that went into the picture changes, until somebody ends the
 * program. What is wrong with a file is said, and may be mended; all else ends it. */
static enum turner_result watch(struct arguments *a, struct turner_opening *opening)
{
    struct turner_watch files = {0};
    enum turner_result result;
    bool drawn = false; /* once: the command line is right */
    a->watch = &files;
    for (;;) {
        a->since = turner_watch_now();
        a->changed = false;
        a->start = turner_seconds();
        turner_watch_reads(&files, a->since);
        result = load_and_render(a, opening);
        turner_watch_reads(NULL, a->since);
        bool wrong = result == TURNER_BAD_INPUT || (result == TURNER_USAGE && drawn);
        drawn |= result == TURNER_OK;
        if (wrong)
            fprintf(stderr, "%s\n", turner_message());
        else if (result != TURNER_OK && !(result == TURNER_INTERRUPTED && a->changed))
            break;
        fflush(stdout);
        a->loading = 0;
        wait_for_change(a);
        if (!wrong) /* what was not reached may be among those from before */
            turner_watch_clear(&files);
    }
    turner_watch_clear(&files);
    return result;
}

static enum turner_result open_and_render(struct arguments *a)
{
    struct turner_opening opening = {0};
    if (!may_have_few_samples(a))
        turner_opening_start(&opening, a->options.render.device);
    enum turner_result result = a->watching ? watch(a, &opening) : load_and_render(a, &opening);
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

    return a.print_settings ? print_settings(&a) : open_and_render(&a);
}
