#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/scene_options.h"

#ifdef TURNER_VIEW

#include <cjson/cJSON.h>

#include "app/against.h"
#include "app/explain.h"
#include "image/atomic.h"
#include "image/image.h"
#include "reference/reference.h"
#include "render/explain.h"
#include "render/params.h"
#include "render/renderer.h"
#include "render/shader_path.h"
#include "view/view.h"

#define EXPLAIN_BITS 10 /* rays that agree in fewer part, as turner explain has it */

static void print_help(void)
{
    puts("Usage: turner view SCENE [OPTION]…\n\n"
         "Shows SCENE in a window. While the camera moves, resolution and depth give way as far as 30\n"
         "pictures a second need it; at rest the picture gets better until it is the one that turner\n"
         "render writes with the same settings. Then nothing is done until something changes.\n\n"
         "  left drag               orbit around what is looked at\n"
         "  middle or Shift+left    pan\n"
         "  right drag              look around; with W A S D Q E held: fly\n"
         "  wheel                   nearer, farther\n"
         "  arrows, Page up, down   fly; Shift faster, Ctrl slower\n"
         "  double click            look at what is there\n"
         "  Ctrl+click              the rays of that pixel, as turner explain prints them\n"
         "  Home; 0 1 … 9           back to where it began; the scene's cameras\n"
         "  C; Shift+C              print the camera as JSON; write it into the scene file\n"
         "  R                       record a path of cameras, and end it: turner render --path draws it\n"
         "  V, Shift+V              what is shown: picture, normal, depth, … as --show\n"
         "  S                       save the picture, once it is finished\n"
         "  X; H                    --against: the divider to an edge or the middle; heat map\n"
         "  Tab or P                panel\n"
         "  F1                      all keys\n"
         "  Esc or Q                quit\n\n"
         "  -o, --output FILE      what S saves: .exr .png …; default is the scene's name with .png,\n"
         "                         here; a number is added where there is such a file\n"
         "      --camera N         begin with one of the scene's \"cameras\"\n"
         "      --size WxH         of the window, and the picture in it\n"
         "      --depth N, --cutoff X, --spp N, --error E, --shading KIND, --shadows KIND,\n"
         "      --exposure STOPS, --transfer CURVE   as for turner render\n"
         "  -m, --method NAME=VALUE  a way to compute; turner params lists them (may be repeated)\n"
         "  -d, --device D         index or part of the name (turner devices)\n"
         "      --traversal KIND   auto | bvh | bvh_lane | bvh_packet | ray_query\n"
         "      --set NAME=VALUE   a parameter of the shaders; turner params SCENE lists them (may be\n"
         "                         repeated)\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --no-scene-shaders leave out the shaders of the scene's own folder (docs/shaders.md)\n"
         "      --against DIR      the window split in two, with a divider to be dragged: the right side\n"
         "                         with the shaders of DIR (\"-\": turner's own), and for both sides\n"
         "                         time, rays, error against the reference and how they differ\n"
         "      --against NAME=VALUE  the same with another method, setting (depth, cutoff, error, spp,\n"
         "                         shading, shadows, exposure, transfer) or parameter of the shaders\n"
         "                         (may be repeated)\n"
         "      --show WHAT        picture | normal | depth | id | rays | recursion | pruned | error |\n"
         "                         nonfinite | difference: to the reference, of a small picture;\n"
         "                         against: where the two sides of --against differ\n"
         "      --spin SECONDS     the camera goes around by itself, once in so long\n"
         "      --seconds S        close after so long\n"
         "      --stats FILE       time to the first picture, pictures a second while moving and what\n"
         "                         was given up for them, as JSON (- for stdout)\n"
         "  -q, --quiet            no warnings, no word on how to get help\n"
         "  -h, --help             this text\n\n"
         "Examples:\n"
         "  turner view scenes/whitted1980.json --size 1280x720\n"
         "  turner view scenes/metals.json --against shaders/examples/blinn\n"
         "  turner view scenes/mirrors.json --against depth=3 --against fresnel=schlick");
}

struct arguments {
    const char *scene, *output, *stats;
    double spin, seconds, start;
    bool quiet;
    int seen;
    struct turner_scene_options options;
    struct turner_second_side against;
};

enum { SPIN = TURNER_OPTION_OWN, SECONDS, STATS, SHOW, AGAINST };

static const struct option long_options[] = {
    {"output", required_argument, NULL, 'o'},
    {"method", required_argument, NULL, 'm'},
    {"size", required_argument, NULL, TURNER_OPTION_SIZE},
    {"camera", required_argument, NULL, TURNER_OPTION_CAMERA},
    {"depth", required_argument, NULL, TURNER_OPTION_DEPTH},
    {"cutoff", required_argument, NULL, TURNER_OPTION_CUTOFF},
    {"spp", required_argument, NULL, TURNER_OPTION_SPP},
    {"error", required_argument, NULL, TURNER_OPTION_ERROR},
    {"shading", required_argument, NULL, TURNER_OPTION_SHADING},
    {"shadows", required_argument, NULL, TURNER_OPTION_SHADOWS},
    {"exposure", required_argument, NULL, TURNER_OPTION_EXPOSURE},
    {"transfer", required_argument, NULL, TURNER_OPTION_TRANSFER},
    {"spd-rays", no_argument, NULL, TURNER_OPTION_SPD_RAYS},
    {"spd-grid", no_argument, NULL, TURNER_OPTION_SPD_GRID},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, TURNER_OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, TURNER_OPTION_SHADER_DIR},
    {"set", required_argument, NULL, TURNER_OPTION_SET},
    {"no-scene-shaders", no_argument, NULL, TURNER_OPTION_NO_SCENE_SHADERS},
    {"against", required_argument, NULL, AGAINST},
    {"show", required_argument, NULL, SHOW},
    {"spin", required_argument, NULL, SPIN},
    {"seconds", required_argument, NULL, SECONDS},
    {"stats", required_argument, NULL, STATS},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result take_seen(int *seen, const char *text)
{
    const char *names[TURNER_SEEN_KINDS + 1] = {NULL};
    for (int i = 0; i < TURNER_SEEN_KINDS; i++)
        names[i] = turner_seen_name((enum turner_seen)i);
    return turner_option_choice(seen, "--show", text, names);
}

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    switch (option) {
    case 'o': a->output = optarg; return TURNER_OK;
    case 'q': a->quiet = true; return TURNER_OK;
    case SPIN: return turner_option_real(&a->spin, "--spin", optarg, 0.1, 1e6);
    case SECONDS: return turner_option_real(&a->seconds, "--seconds", optarg, 0.1, 1e6);
    case SHOW: return take_seen(&a->seen, optarg);
    case STATS: a->stats = optarg; return TURNER_OK;
    case AGAINST: return turner_side_take(&a->against, optarg, argv);
    }
    return turner_scene_option_take(&a->options, option, argv);
}

static enum turner_result write_picture(const char *path, const struct turner_scene *scene,
                                        const struct turner_image *image,
                                        const struct turner_statistics *statistics)
{
    return turner_picture_write(path, scene, image, statistics, NULL);
}

/* Parameters stay as they are given: the shaders may change, and with them what is not given. */
static enum turner_result apply_options(const struct turner_scene_options *options,
                                        struct turner_scene *scene)
{
    struct turner_render_options render = options->render;
    struct turner_shader_path path;
    struct turner_params params;
    enum turner_result result = TURNER_OK;
    TURNER_TRY(turner_scene_options_settings(options, scene));
    for (size_t i = 0; i < options->param_count; i++)
        TURNER_TRY(turner_scene_assign_param(scene, options->params[i]));
    if (!scene->param_count)
        return TURNER_OK;
    turner_shader_path_create(&path, &render, scene);
    TURNER_TRY_DONE(turner_params_find(&params, NULL, &render));
    TURNER_TRY_DONE(turner_params_check(&params, scene));
done:
    turner_params_destroy(&params);
    turner_shader_path_destroy(&path);
    return result;
}

static enum turner_result read_scene(void *user, struct turner_scene **scene)
{
    const struct arguments *a = user;
    TURNER_TRY(turner_scene_load(scene, a->scene));
    enum turner_result result = apply_options(&a->options, *scene);
    if (result != TURNER_OK) {
        turner_scene_destroy(*scene);
        *scene = NULL;
    }
    return result;
}

static enum turner_result read_second(void *user, struct turner_scene **scene)
{
    const struct arguments *a = user;
    return turner_side_load(scene, &a->against);
}

/* As turner explain does it, in the middle of the pixel. */
static enum turner_result explain_pixel(FILE *out, const struct turner_scene *scene,
                                        const struct turner_render_options *options, int x, int y)
{
    struct turner_explanation explanation = {.scene = scene, .x = x, .y = y};
    struct turner_ray_tree device = {0}, reference = {0};
    struct turner_recorder recorder = {0};
    enum turner_result result;
    turner_sample_position(&explanation.sample_x, &explanation.sample_y, 0, 1);
    TURNER_TRY_DONE(turner_reference_explain(&reference, scene, x + explanation.sample_x,
                                             y + explanation.sample_y));
    TURNER_TRY_DONE(turner_recorder_create(&recorder, scene, options));
    TURNER_TRY_DONE(turner_recorder_trace(&device, &recorder, x, y, explanation.sample_x,
                                          explanation.sample_y));
    explanation.device = recorder.gpu.info.name;
    explanation.driver = recorder.gpu.info.driver;
    explanation.traversal = turner_traversal_name(recorder.kind);
    explanation.precision = recorder.kind & TURNER_F64 ? "f64" : "f32";
    turner_rays_compare(&explanation.comparison, &device, &reference, EXPLAIN_BITS);
    turner_explain_text(out, &explanation);
done:
    turner_rays_destroy(&explanation.comparison);
    turner_recorder_destroy(&recorder);
    turner_ray_tree_destroy(&device);
    turner_ray_tree_destroy(&reference);
    return result;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static void add_error(cJSON *object, const char *name, const struct turner_comparison *comparison)
{
    cJSON *error = cJSON_AddObjectToObject(object, name);
    cJSON_AddNumberToObject(error, "rmse", comparison->rmse);
    cJSON_AddNumberToObject(error, "largest", comparison->largest);
    cJSON_AddNumberToObject(error, "pixels_over", (double)comparison->pixels_over);
    cJSON_AddNumberToObject(error, "pixels", (double)comparison->pixels);
}

static void add_sides(cJSON *object, const struct turner_view_report *report)
{
    static const char *const names[] = {"a", "b"};
    for (int i = 0; i < 2; i++) {
        const struct turner_statistics *s = &report->side[i].statistics;
        cJSON *side = cJSON_AddObjectToObject(object, names[i]);
        cJSON_AddNumberToObject(side, "seconds", report->side[i].seconds);
        cJSON *rays = cJSON_AddObjectToObject(side, "rays");
        cJSON_AddNumberToObject(rays, "camera", (double)s->camera_rays);
        cJSON_AddNumberToObject(rays, "reflected", (double)s->reflected_rays);
        cJSON_AddNumberToObject(rays, "refracted", (double)s->refracted_rays);
        cJSON_AddNumberToObject(rays, "shadow", (double)s->shadow_rays);
        if (report->side[i].compared)
            add_error(side, "error", &report->side[i].error);
    }
    if (report->differ_known)
        add_error(object, "difference", &report->difference);
}

static char *report_json(struct turner_view_report *report)
{
    cJSON *object = cJSON_CreateObject();
    int size[2] = {report->width, report->height};
    cJSON_AddStringToObject(object, "device", report->device);
    cJSON_AddStringToObject(object, "traversal", report->traversal);
    cJSON_AddStringToObject(object, "presented_by", report->presenting);
    cJSON_AddItemToObject(object, "size", cJSON_CreateIntArray(size, 2));
    cJSON *seconds = cJSON_AddObjectToObject(object, "seconds");
    cJSON_AddNumberToObject(seconds, "first_picture", report->first_picture);
    cJSON_AddNumberToObject(seconds, "full_picture", report->full_picture);
    cJSON_AddNumberToObject(object, "frames", report->frames);
    if (report->moved) {
        size_t count = report->moved;
        qsort(report->intervals, count, sizeof *report->intervals, by_size);
        cJSON *moving = cJSON_AddObjectToObject(object, "moving");
        cJSON_AddNumberToObject(moving, "frames", report->moved);
        cJSON_AddNumberToObject(moving, "per_second", report->moved / report->moved_seconds);
        cJSON_AddNumberToObject(moving, "median", report->intervals[count / 2]);
        cJSON_AddNumberToObject(moving, "slowest_twentieth", report->intervals[count * 19 / 20]);
        cJSON_AddNumberToObject(moving, "scale", report->scale);
        cJSON_AddNumberToObject(moving, "depth", report->depth);
    }
    cJSON *changes = cJSON_AddObjectToObject(object, "changes");
    cJSON_AddNumberToObject(changes, "built", report->changes.built);
    cJSON_AddNumberToObject(changes, "painted", report->changes.painted);
    cJSON_AddNumberToObject(changes, "moved", report->changes.moved);
    cJSON_AddNumberToObject(changes, "previewed", report->changes.previewed);
    if (report->sides)
        add_sides(object, report);
    char *text = cJSON_Print(object);
    cJSON_Delete(object);
    return text;
}

static enum turner_result write_report(const char *path, struct turner_view_report *report)
{
    char *text = report_json(report);
    enum turner_result result = TURNER_OK;
    if (strcmp(path, "-") == 0)
        puts(text);
    else
        result = turner_atomic_write(path, text, strlen(text));
    free(text);
    return result;
}

/* The scene's name with another ending, in the folder turner runs in. */
static void default_output(char output[256], const char *scene)
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene;
    const char *dot = strrchr(name, '.');
    int stem = (int)(dot && dot > name ? dot - name : (long)strlen(name));
    snprintf(output, 256, "%.*s.png", stem < 200 ? stem : 200, name);
}

static enum turner_result load_and_view(struct arguments *a)
{
    struct turner_scene *scene, *second = NULL;
    struct turner_opening opening;
    struct turner_view_report report = {0};
    char output[256];
    default_output(output, a->scene);
    turner_signals_block();
    turner_opening_start(&opening, a->options.render.device);
    enum turner_result result;
    TURNER_TRY_DONE(turner_scene_load(&scene, a->scene));
    struct turner_camera first = scene->camera;
    result = apply_options(&a->options, scene);
    struct turner_view_options options = {
        .first = first,
        .seen = (enum turner_seen)a->seen,
        .camera = a->options.camera,
        .scene = scene,
        .path = a->scene,
        .opening = &opening,
        .render = a->options.render,
        .write = write_picture,
        .explain = explain_pixel,
        .read = read_scene,
        .reader = a,
        .output = a->output ? a->output : output,
        .start = a->start,
        .quiet = a->quiet,
        .spin = a->spin,
        .seconds = a->seconds,
    };
    struct turner_against_options against = {.render = a->against.render,
                                             .read = read_second,
                                             .reader = a,
                                             .adapt = turner_side_adapt,
                                             .keeps = turner_side_keeps,
                                             .user = &a->against,
                                             .name = a->against.name};
    if (result == TURNER_OK && a->against.given)
        result = turner_side_load(&second, &a->against);
    against.scene = second;
    options.against = second ? &against : NULL;
    if (result == TURNER_OK)
        result = turner_view(&options, &report);
    turner_scene_destroy(scene);
    turner_scene_destroy(second);
    if (a->stats && (result == TURNER_OK || result == TURNER_INTERRUPTED)) {
        enum turner_result written = write_report(a->stats, &report);
        result = written == TURNER_OK ? result : written;
    }
done:
    free(report.intervals);
    turner_opening_destroy(&opening);
    return result;
}

enum turner_result turner_cmd_view(int argc, char **argv)
{
    struct arguments a = {.options = TURNER_SCENE_OPTIONS,
                          .against = {.other = TURNER_SCENE_OPTIONS},
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
        return turner_fail(TURNER_USAGE, "view takes one scene; see turner view --help");
    a.scene = argv[optind];
    a.against.first = &a.options;
    a.against.path = a.scene;
    turner_side_finish(&a.against);
    if (a.seen == TURNER_SEEN_AGAINST && !a.against.given)
        return turner_fail(TURNER_USAGE, "--show against shows how two sides differ; --against says "
                                         "what the second is");
    turner_set_quiet(a.quiet);
    if (a.options.render.device && strcmp(a.options.render.device, "reference") == 0)
        return turner_fail(TURNER_USAGE, "the reference is too slow for a window; turner render "
                                         "--device reference draws with it");
    if (a.output)
        TURNER_TRY(turner_image_check_writable(a.output));
    if (a.stats && strcmp(a.stats, "-") != 0)
        TURNER_TRY(turner_atomic_check(a.stats));
    return load_and_view(&a);
}

#else

enum turner_result turner_cmd_view(int argc, char **argv)
{
    (void)argc, (void)argv;
    return turner_fail(TURNER_DEVICE, "this turner was built without a window: install GLFW "
                                      "(libglfw3-dev) and Dear ImGui (libimgui-dev) and build it "
                                      "with TURNER_VIEW on; turner render draws without one");
}

#endif
