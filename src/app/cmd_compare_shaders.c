#include <cjson/cJSON.h>
#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/compare_shaders.h"
#include "render/needs.h"

static void print_help(void)
{
    puts("Usage: turner compare-shaders SCENE DIR_A DIR_B [OPTION]…\n\n"
         "Draws SCENE with the shaders of DIR_A and with those of DIR_B, by turns in one program, and\n"
         "says for both how long a picture takes, how many rays of which kind it is made of, how\n"
         "large the kernel is, how much the pictures differ, and how far each is from the reference\n"
         "in extended precision, which knows the model but no hooks (docs/shaders.md): where a hook\n"
         "is replaced there is no such figure. \"-\" for a folder: turner's own shaders.\n\n"
         "      --runs N           pictures of each (default 5); medians count, of the times and of\n"
         "                         the ratio run by run\n"
         "      --size WxH, --depth N, --cutoff X, --spp N   as for turner render\n"
         "  -m, --method NAME=VALUE, --set NAME=VALUE        for both sides, and for one of them:\n"
         "      --method-a, --method-b, --set-a, --set-b\n"
         "  -d, --device D         index or part of the name (turner devices)\n"
         "      --traversal KIND   auto | bvh | bvh_lane | bvh_packet | ray_query\n"
         "      --shader-dir DIR   for both, after DIR_A and DIR_B (may be repeated)\n"
         "      --no-scene-shaders leave out the shaders of the scene's own folder\n"
         "      --no-reference     leave out the errors, which take the longest\n"
         "      --heatmap FILE     write where the pictures differ, as turner compare does\n"
         "      --json             the same as JSON\n"
         "  -q, --quiet            no progress bar\n"
         "  -h, --help             this text\n\n"
         "Examples:\n"
         "  turner compare-shaders scenes/metals.json - shaders/examples/blinn --heatmap differs.png\n"
         "  turner compare-shaders marble.json marble marble --set-b octaves=2");
}

enum { RUNS = TURNER_OPTION_OWN, METHOD_A, METHOD_B, SET_A, SET_B, NO_REFERENCE, HEATMAP, JSON };

static const struct option long_options[] = {
    {"runs", required_argument, NULL, RUNS},
    {"size", required_argument, NULL, TURNER_OPTION_SIZE},
    {"depth", required_argument, NULL, TURNER_OPTION_DEPTH},
    {"cutoff", required_argument, NULL, TURNER_OPTION_CUTOFF},
    {"spp", required_argument, NULL, TURNER_OPTION_SPP},
    {"method", required_argument, NULL, 'm'},
    {"set", required_argument, NULL, TURNER_OPTION_SET},
    {"method-a", required_argument, NULL, METHOD_A},
    {"method-b", required_argument, NULL, METHOD_B},
    {"set-a", required_argument, NULL, SET_A},
    {"set-b", required_argument, NULL, SET_B},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, TURNER_OPTION_TRAVERSAL},
    {"shader-dir", required_argument, NULL, TURNER_OPTION_SHADER_DIR},
    {"no-scene-shaders", no_argument, NULL, TURNER_OPTION_NO_SCENE_SHADERS},
    {"no-reference", no_argument, NULL, NO_REFERENCE},
    {"heatmap", required_argument, NULL, HEATMAP},
    {"json", no_argument, NULL, JSON},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result add(const char **list, size_t *count)
{
    if (*count == TURNER_SIDE_CHOICES)
        return turner_fail(TURNER_USAGE, "a side takes %d choices", TURNER_SIDE_CHOICES);
    list[(*count)++] = optarg;
    return TURNER_OK;
}

static enum turner_result take(struct turner_sides *sides, int option, char **argv)
{
    struct turner_side *a = &sides->side[0], *b = &sides->side[1];
    switch (option) {
    case RUNS: return turner_option_int(&sides->runs, "--runs", optarg, 1, TURNER_SIDE_RUNS);
    case METHOD_A: return add(a->methods, &a->method_count);
    case METHOD_B: return add(b->methods, &b->method_count);
    case SET_A: return add(a->params, &a->param_count);
    case SET_B: return add(b->params, &b->param_count);
    case NO_REFERENCE: sides->reference = false; return TURNER_OK;
    case HEATMAP: sides->heatmap = optarg; return TURNER_OK;
    case JSON: sides->json = true; return TURNER_OK;
    case 'q': sides->quiet = true; return TURNER_OK;
    }
    return turner_scene_option_take(&sides->options, option, argv);
}

/* ---- what is said ---- */

static void print_counts(const char *what, uint64_t a, uint64_t b)
{
    printf("%-20s %14llu %14llu\n", what, (unsigned long long)a, (unsigned long long)b);
}

static void print_errors(const char *what, const struct turner_sides *sides, bool largest)
{
    printf("%-20s", what);
    for (int i = 0; i < 2; i++) {
        const struct turner_side *side = &sides->side[i];
        double value = largest ? side->error.largest : side->error.rmse;
        if (side->has_error)
            printf(" %14.4g", value);
        else
            printf(" %14s", "-");
    }
    puts("");
}

static void print_table(const struct turner_sides *sides)
{
    const struct turner_side *a = &sides->side[0], *b = &sides->side[1];
    const struct turner_statistics *s = &a->statistics, *t = &b->statistics;
    printf("%s, %d×%d, %s\n", sides->path, a->image.width, a->image.height, sides->device);
    printf("A: %s%s%s\nB: %s%s%s\n\n", a->folder, *a->hooks ? "; hooks: " : "", a->hooks, b->folder,
           *b->hooks ? "; hooks: " : "", b->hooks);
    printf("%-20s %14s %14s\n", "", "A", "B");
    printf("%-20s %14.2f %14.2f   B/A %.3f, median of %d\n", "ms a picture", 1e3 * a->median,
           1e3 * b->median, sides->ratio, sides->runs);
    printf("%-20s %14.0f %14.0f\n", "ms to compile", 1e3 * a->compile, 1e3 * b->compile);
    printf("%-20s %14zu %14zu\n", "kernel, bytes", a->kernel_bytes, b->kernel_bytes);
    print_counts("rays: camera", s->camera_rays, t->camera_rays);
    print_counts("      reflected", s->reflected_rays, t->reflected_rays);
    print_counts("      refracted", s->refracted_rays, t->refracted_rays);
    print_counts("      shadow", s->shadow_rays, t->shadow_rays);
    if (sides->reference) {
        print_errors("error: rmse", sides, false);
        print_errors("       largest", sides, true);
    }
    const struct turner_comparison *d = &sides->difference;
    if (d->pixels_over == 0)
        printf("\nThe pictures are the same.\n");
    else
        printf("\nThe pictures differ in %llu of %llu pixels: rmse %.4g, largest %.4g at %d,%d\n",
               (unsigned long long)d->pixels_over, (unsigned long long)d->pixels, d->rmse,
               d->largest, d->largest_x, d->largest_y);
    if (sides->reference && (*a->hooks || *b->hooks))
        puts("No error where hooks are replaced: the reference knows nothing of them.");
}

static cJSON *comparison_object(const struct turner_comparison *c)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "rmse", c->rmse);
    cJSON_AddNumberToObject(object, "largest", c->largest);
    int pixel[2] = {c->largest_x, c->largest_y};
    cJSON_AddItemToObject(object, "largest_at", cJSON_CreateIntArray(pixel, 2));
    cJSON_AddNumberToObject(object, "pixels_over", (double)c->pixels_over);
    cJSON_AddNumberToObject(object, "pixels", (double)c->pixels);
    cJSON_AddNumberToObject(object, "nonfinite", (double)(c->nonfinite_a + c->nonfinite_b));
    return object;
}

static cJSON *side_object(const struct turner_side *side, int runs)
{
    const struct turner_statistics *s = &side->statistics;
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "folder", side->folder);
    cJSON_AddStringToObject(object, "hooks", side->hooks);
    char *settings = turner_settings_json(side->scene);
    cJSON_AddItemToObject(object, "settings", cJSON_Parse(settings));
    cJSON_free(settings);
    cJSON_AddNumberToObject(object, "seconds", side->median);
    cJSON_AddItemToObject(object, "runs", cJSON_CreateDoubleArray(side->seconds, runs));
    cJSON_AddNumberToObject(object, "seconds_compile", side->compile);
    cJSON_AddNumberToObject(object, "kernel_bytes", (double)side->kernel_bytes);
    cJSON *rays = cJSON_AddObjectToObject(object, "rays");
    cJSON_AddNumberToObject(rays, "camera", (double)s->camera_rays);
    cJSON_AddNumberToObject(rays, "reflected", (double)s->reflected_rays);
    cJSON_AddNumberToObject(rays, "refracted", (double)s->refracted_rays);
    cJSON_AddNumberToObject(rays, "shadow", (double)s->shadow_rays);
    if (side->has_error)
        cJSON_AddItemToObject(object, "error", comparison_object(&side->error));
    return object;
}

static void print_json(const struct turner_sides *sides)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "version", turner_version());
    cJSON_AddStringToObject(object, "scene", sides->path);
    cJSON_AddStringToObject(object, "device", sides->device);
    cJSON_AddItemToObject(object, "a", side_object(&sides->side[0], sides->runs));
    cJSON_AddItemToObject(object, "b", side_object(&sides->side[1], sides->runs));
    cJSON_AddNumberToObject(object, "ratio", sides->ratio);
    cJSON_AddItemToObject(object, "difference", comparison_object(&sides->difference));
    char *text = cJSON_Print(object);
    puts(text);
    cJSON_free(text);
    cJSON_Delete(object);
}

static enum turner_result write_heatmap(const struct turner_sides *sides)
{
    static const struct turner_image_encoding encoding = {.linear = true};
    struct turner_image heatmap;
    double full = sides->difference.largest > 0 ? sides->difference.largest : 1;
    TURNER_TRY(turner_image_heatmap(&heatmap, &sides->side[1].image, &sides->side[0].image, full));
    enum turner_result result = turner_image_write(&heatmap, sides->heatmap, &encoding);
    turner_image_destroy(&heatmap);
    return result;
}

enum turner_result turner_cmd_compare_shaders(int argc, char **argv)
{
    struct turner_sides sides = {.options = TURNER_SCENE_OPTIONS, .runs = 5, .reference = true};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "m:d:qh", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        TURNER_TRY(take(&sides, option, argv));
    }
    if (optind + 3 != argc)
        return turner_fail(TURNER_USAGE, "compare-shaders takes a scene and two folders; see turner "
                                         "compare-shaders --help");
    const char *device = sides.options.render.device;
    if (device && strcmp(device, "reference") == 0)
        return turner_fail(TURNER_USAGE, "the reference has no shaders; give --device one that "
                                         "turner devices lists");
    sides.path = argv[optind];
    sides.side[0].folder = argv[optind + 1];
    sides.side[1].folder = argv[optind + 2];
    if (sides.heatmap)
        TURNER_TRY(turner_image_check_writable(sides.heatmap));
    turner_set_quiet(sides.quiet);
    enum turner_result result = turner_sides_measure(&sides);
    if (result == TURNER_OK)
        (sides.json ? print_json : print_table)(&sides);
    if (result == TURNER_OK && sides.heatmap)
        result = write_heatmap(&sides);
    turner_sides_destroy(&sides);
    return result;
}
