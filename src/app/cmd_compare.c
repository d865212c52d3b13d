/* turner compare: how much a picture differs from its reference, and whether that is too much. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "app/app.h"
#include "app/compare_flip.h"
#include "image/atomic.h"
#include "image/image.h"

static const char help[] =
    "Usage: turner compare [OPTION]… PICTURE REFERENCE\n"
    "Measures how much PICTURE differs from REFERENCE and says whether that is tolerable.\n"
    "\n"
    "A tolerance has two halves, and both are printed: how much a pixel may differ, and how many\n"
    "pixels may differ by more.\n"
    "  -t, --threshold ABS   a pixel is over when a channel differs by more than ABS …\n"
    "                        (default 0.004, a hair more than one step of 8 bits)\n"
    "  -r, --relative R      … and also by more than R times the reference (default 0)\n"
    "  -n, --pixels N|P%     this many pixels, or per cent of them, may be over (default 0)\n"
    "      --max-rmse X      also differ when the root mean square error is above X\n"
    "\n"
    "NaN and infinity differ from everything, themselves included; pictures of unequal size differ.\n"
    "\n"
    "  -m, --heatmap FILE    write where they differ: black equal, through red and yellow to white,\n"
    "                        the largest difference; magenta where a value is not finite\n"
    "      --preview FOLDER  write both as 8-bit PNG, for dashboards, into FOLDER: picture.png and\n"
    "                        reference.png\n"
    "      --linear          take the values of 8/16-bit pictures as they are stored; otherwise the\n"
    "                        sRGB curve is taken off first, and differences are of linear radiance\n"
    "      --flip            also the mean FLIP error, what an eye notices (needs python3 with the\n"
    "                        package flip-evaluator and numpy; fails without)\n"
    "      --json FILE       the figures as JSON; \"-\" prints them instead of the report\n"
    "  -h, --help            this text\n"
    "\n"
    "Example: at most 0.1 % of the pixels off by more than 0.01 and 1 % of their value:\n"
    "  turner compare -t 0.01 -r 0.01 -n 0.1% new.exr golden.exr --heatmap difference.png\n"
    "\n"
    "Exit status: 0 equal within the tolerance, 1 different, 2 wrong command line, 3 a picture (or\n"
    "the tool for --flip) is missing or unreadable, 5 the heat map or JSON cannot be written.\n";

struct options {
    const char *paths[2]; /* picture, reference */
    double threshold, relative, max_rmse;
    double pixels; /* a count, or per cent */
    bool per_cent, linear, flip;
    const char *heatmap, *json, *preview;
};

struct findings {
    struct turner_comparison figures;
    uint64_t allowed;
    double heatmap_full;
    double flip;
    const char *flip_kind; /* NULL: not measured */
    bool differ;
};

/* A count, or per cent of all pixels. */
static enum turner_result parse_pixels(struct options *options, const char *text)
{
    char *end;
    options->pixels = strtod(text, &end);
    options->per_cent = end != text && *end == '%';
    end += options->per_cent;
    double most = options->per_cent ? 100 : 1e15;
    if (end == text || *end || !(options->pixels >= 0 && options->pixels <= most) ||
        (!options->per_cent && options->pixels != floor(options->pixels)))
        return turner_fail(TURNER_USAGE, "--pixels takes a whole number or a percentage up to "
                                         "100%%, not \"%s\"", text);
    return TURNER_OK;
}

/* `*done` when --help was all there was to do. */
static enum turner_result parse(struct options *options, int argc, char **argv, bool *done)
{
    enum { MAX_RMSE = 256, LINEAR, FLIP, JSON, PREVIEW };
    static const struct option known[] = {
        {"threshold", required_argument, NULL, 't'}, {"relative", required_argument, NULL, 'r'},
        {"pixels", required_argument, NULL, 'n'},    {"max-rmse", required_argument, NULL, MAX_RMSE},
        {"heatmap", required_argument, NULL, 'm'},   {"linear", no_argument, NULL, LINEAR},
        {"flip", no_argument, NULL, FLIP},           {"json", required_argument, NULL, JSON},
        {"preview", required_argument, NULL, PREVIEW}, {"help", no_argument, NULL, 'h'}, {0}};
    const double most = 1e30;
    *options = (struct options){.threshold = .004, .max_rmse = HUGE_VAL};
    *done = false;
    optind = 0; /* start anew, whatever was parsed before */
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "t:r:n:m:h", known, NULL)) != -1;) {
        switch (option) {
        case 't':
            TURNER_TRY(turner_option_real(&options->threshold, "--threshold", optarg, 0, most));
            break;
        case 'r':
            TURNER_TRY(turner_option_real(&options->relative, "--relative", optarg, 0, most));
            break;
        case 'n': TURNER_TRY(parse_pixels(options, optarg)); break;
        case MAX_RMSE:
            TURNER_TRY(turner_option_real(&options->max_rmse, "--max-rmse", optarg, 0, most));
            break;
        case 'm': options->heatmap = optarg; break;
        case LINEAR: options->linear = true; break;
        case FLIP: options->flip = true; break;
        case JSON: options->json = optarg; break;
        case PREVIEW: options->preview = optarg; break;
        case 'h':
            fputs(help, stdout);
            *done = true;
            return TURNER_OK;
        default: return turner_bad_option(argv);
        }
    }
    if (argc - optind != 2)
        return turner_fail(TURNER_USAGE, "compare wants two pictures, PICTURE REFERENCE; see "
                                         "turner compare --help");
    options->paths[0] = argv[optind];
    options->paths[1] = argv[optind + 1];
    return TURNER_OK;
}

static void report(const struct options *options, const struct findings *findings)
{
    const struct turner_comparison *c = &findings->figures;
    printf("RMSE                %.6g\n", c->rmse);
    printf("relative MSE        %.6g\n", c->relative_mse);
    printf("largest difference  %.6g", c->largest);
    if (c->largest_x >= 0)
        printf(" at pixel (%d,%d)", c->largest_x, c->largest_y);
    printf("\ntolerance           %g absolute, %g relative\n", options->threshold,
           options->relative);
    printf("pixels over it      %llu of %llu (%.4g %%), %llu allowed\n",
           (unsigned long long)c->pixels_over, (unsigned long long)c->pixels,
           100 * (double)c->pixels_over / (double)c->pixels,
           (unsigned long long)findings->allowed);
    if (c->nonfinite_x >= 0) {
        printf("not finite          %llu pixels of the picture, %llu of the reference, first at "
               "(%d,%d)\n", (unsigned long long)c->nonfinite_a,
               (unsigned long long)c->nonfinite_b, c->nonfinite_x, c->nonfinite_y);
    }
    if (findings->flip_kind)
        printf("mean FLIP (%s)     %.6g\n", findings->flip_kind, findings->flip);
    if (options->heatmap)
        printf("heat map            %s, white is %.6g\n", options->heatmap, findings->heatmap_full);
    puts(findings->differ ? "different" : "equal within the tolerance");
}

static void add_position(cJSON *json, const char *key, int x, int y)
{
    if (x >= 0)
        cJSON_AddItemToObject(json, key, cJSON_CreateIntArray((int[]){x, y}, 2));
}

static void add_figures(cJSON *json, const struct options *options,
                        const struct findings *findings)
{
    const struct turner_comparison *c = &findings->figures;
    cJSON_AddNumberToObject(json, "rmse", c->rmse);
    cJSON_AddNumberToObject(json, "relative_mse", c->relative_mse);
    cJSON_AddNumberToObject(json, "largest", c->largest);
    add_position(json, "largest_at", c->largest_x, c->largest_y);
    cJSON_AddNumberToObject(json, "threshold", options->threshold);
    cJSON_AddNumberToObject(json, "relative", options->relative);
    cJSON_AddNumberToObject(json, "pixels", (double)c->pixels);
    cJSON_AddNumberToObject(json, "pixels_over", (double)c->pixels_over);
    cJSON_AddNumberToObject(json, "pixels_allowed", (double)findings->allowed);
    cJSON_AddNumberToObject(json, "nonfinite_picture", (double)c->nonfinite_a);
    cJSON_AddNumberToObject(json, "nonfinite_reference", (double)c->nonfinite_b);
    add_position(json, "nonfinite_at", c->nonfinite_x, c->nonfinite_y);
    if (findings->flip_kind) {
        cJSON_AddNumberToObject(json, "flip", findings->flip);
        cJSON_AddStringToObject(json, "flip_kind", findings->flip_kind);
    }
}

/* The report as JSON, without figures when the sizes differ; all numbers are finite. */
static enum turner_result write_json(const struct options *options,
                                     const struct findings *findings, const struct turner_image *a,
                                     const struct turner_image *b)
{
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "picture", options->paths[0]);
    cJSON_AddStringToObject(json, "reference", options->paths[1]);
    cJSON_AddItemToObject(json, "picture_size",
                          cJSON_CreateIntArray((int[]){a->width, a->height}, 2));
    cJSON_AddItemToObject(json, "reference_size",
                          cJSON_CreateIntArray((int[]){b->width, b->height}, 2));
    cJSON_AddBoolToObject(json, "different", findings->differ);
    if (findings->figures.pixels)
        add_figures(json, options, findings);
    char *text = cJSON_Print(json);
    enum turner_result result = TURNER_OK;
    if (!text)
        result = turner_fail(TURNER_DEVICE, "compare: no memory for the JSON report");
    else if (strcmp(options->json, "-") == 0)
        puts(text);
    else
        result = turner_atomic_write(options->json, text, strlen(text));
    cJSON_free(text);
    cJSON_Delete(json);
    return result;
}

static enum turner_result write_heatmap(const struct options *options, struct findings *findings,
                                        const struct turner_image *a, const struct turner_image *b)
{
    /* the largest difference is white; within the tolerance the map is allowed to stay dark */
    findings->heatmap_full = fmax(findings->figures.largest, options->threshold);
    struct turner_image heatmap;
    enum turner_result result = turner_image_heatmap(&heatmap, a, b, findings->heatmap_full);
    if (result == TURNER_OK)
        result = turner_image_write(&heatmap, options->heatmap,
                                    &(struct turner_image_encoding){.linear = true});
    turner_image_destroy(&heatmap);
    return result;
}

static enum turner_result write_preview(const struct options *options, const char *name,
                                        const struct turner_image *image)
{
    char path[4096];
    if (snprintf(path, sizeof path, "%s/%s", options->preview, name) >= (int)sizeof path)
        return turner_fail(TURNER_USAGE, "--preview: the folder's name is too long");
    return turner_image_write(image, path,
                              &(struct turner_image_encoding){.linear = options->linear});
}

static enum turner_result judge(const struct options *options, struct findings *findings)
{
    const struct turner_comparison *c = &findings->figures;
    findings->allowed = (uint64_t)(options->per_cent
                                       ? floor(options->pixels / 100 * (double)c->pixels)
                                       : options->pixels);
    findings->differ = c->nonfinite_a || c->nonfinite_b || c->pixels_over > findings->allowed ||
                       !(c->rmse <= options->max_rmse);
    const char *a = options->paths[0], *b = options->paths[1];
    if (c->nonfinite_a || c->nonfinite_b) {
        return turner_fail(TURNER_DIFFERS, "%s and %s: a value is not finite, first at pixel "
                                           "(%d,%d)", a, b, c->nonfinite_x, c->nonfinite_y);
    }
    if (c->pixels_over > findings->allowed) {
        return turner_fail(TURNER_DIFFERS, "%s and %s differ: %llu of %llu pixels are over the "
                                           "tolerance, %llu are allowed",
                           a, b, (unsigned long long)c->pixels_over,
                           (unsigned long long)c->pixels, (unsigned long long)findings->allowed);
    }
    if (findings->differ) {
        return turner_fail(TURNER_DIFFERS, "%s and %s differ: the RMSE is %.6g, %g is allowed", a,
                           b, c->rmse, options->max_rmse);
    }
    return TURNER_OK;
}

static enum turner_result compare(const struct options *options, const struct turner_image *a,
                                  const struct turner_image *b)
{
    struct findings findings = {.differ = true};
    if (options->preview) {
        TURNER_TRY(write_preview(options, "picture.png", a));
        TURNER_TRY(write_preview(options, "reference.png", b));
    }
    enum turner_result verdict = turner_image_compare(&findings.figures, a, b, options->threshold,
                                                      options->relative);
    if (verdict == TURNER_OK) {
        if (options->flip && findings.figures.nonfinite_x < 0)
            TURNER_TRY(turner_compare_flip(a, b, &findings.flip, &findings.flip_kind));
        if (options->heatmap)
            TURNER_TRY(write_heatmap(options, &findings, a, b));
        verdict = judge(options, &findings);
        if (!options->json || strcmp(options->json, "-") != 0)
            report(options, &findings);
    } else {
        turner_fail_within(verdict, "%s and %s", options->paths[0], options->paths[1]);
    }
    if (options->json)
        TURNER_TRY(write_json(options, &findings, a, b));
    return verdict;
}

enum turner_result turner_cmd_compare(int argc, char **argv)
{
    struct options options;
    bool done;
    TURNER_TRY(parse(&options, argc, argv, &done));
    if (done)
        return TURNER_OK;
    if (options.heatmap)
        TURNER_TRY(turner_image_check_writable(options.heatmap));
    struct turner_image a = {0}, b = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_image_read(&a, options.paths[0], !options.linear));
    TURNER_TRY_DONE(turner_image_read(&b, options.paths[1], !options.linear));
    result = compare(&options, &a, &b);
done:
    turner_image_destroy(&a);
    turner_image_destroy(&b);
    return result;
}
