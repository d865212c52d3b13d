/* turner chart: speed against accuracy of a grid of settings, for one scene. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "app/chart.h"
#include "app/plot.h"
#include "render/hooks.h"
#include "render/params.h"
#include "render/shader_path.h"
#include "base/memory.h"
#include "gpu/cache.h"
#include "scene/hash.h"

#define CHART_WIDTH 256
#define MAX_PARAMS 64
#define MAX_SHADER_DIRS 16

static void print_help(void)
{
    puts("Usage: turner chart SCENE [-o DIR] [--grid FILE] [OPTION]…\n\n"
         "How fast and how wrong is each way to draw SCENE? Draws it with a grid of settings, each\n"
         "several times, compares every picture with a reference in extended precision, and leaves\n"
         "in DIR (chart-SCENE by default):\n"
         "  chart.md                tables: the best error for a time, the least time for an error\n"
         "  chart-rmse.png, .svg    error against time, with the front that nothing else beats\n"
         "  chart.csv, chart.json   every point, with the times for compiling and building apart\n"
         "  points/                 what was measured, with the pictures\n"
         "Interrupt it whenever you like (Ctrl-C): the same command goes on where it was. What the\n"
         "same build measured of the same scene on the same device is not measured again.\n\n"
         "      --grid FILE        the grid, as JSON (below); without, one that fits the scene\n"
         "      --print-grid       print the grid that fits the scene, to begin with, and end\n"
         "      --list             print the points of the grid, and end\n"
         "      --size WxH         pixels; 256 wide in the scene's proportions by default\n"
         "      --runs N           runs of each point, from 5; the median counts (default 5)\n"
         "  -m, --method NAME=VALUE  for all points that do not choose it themselves\n"
         "      --metric LIST      what to chart: rmse, relative_mse, largest, flip, separated by\n"
         "                         commas, or all (default rmse; flip needs python3 with\n"
         "                         flip-evaluator)\n"
         "      --against TRUTH    what counts as error. pixel (default): all of it, against the\n"
         "                         mean over each pixel. samples: against the same sample\n"
         "                         positions, so that anti-aliasing does not drown depth, cutoff\n"
         "                         and formulas. arithmetic: against the same positions, depth,\n"
         "                         cutoff and Fresnel formula, so that only rounding is left\n"
         "      --reference-spp N  samples of the reference for pixel (default 256)\n"
         "      --cache DIR        where references are kept (default references in\n"
         "                         $TURNER_CACHE_DIR or ~/.cache/turner); may be deleted any time\n"
         "  -d, --device D         index or part of the name (turner devices)\n"
         "      --shader-dir DIR   take shaders from here first (may be repeated)\n"
         "      --set NAME=VALUE   a parameter of the shaders (may be repeated)\n"
         "  -q, --quiet            no progress bar, no tables\n"
         "  -h, --help             this text\n");
    puts("A grid names methods (turner params lists them) and their values. \"axes\" are combined,\n"
         "each value with each; every line of \"also\" is one point more. What a point does not name\n"
         "is as the scene says:\n\n"
         "  { \"axes\": { \"aa\": [1, 4, 16, \"adaptive:0.05,64\"],\n"
         "              \"depth\": [2, 8],\n"
         "              \"cutoff\": [0.03, 0.002] },\n"
         "    \"also\": [ \"aa=4 sphere=textbook\", \"aa=4 precision=f64\" ] }\n\n"
         "Examples:\n"
         "  turner chart scenes/whitted1980.json -o whitted\n"
         "  turner chart scenes/fresnel.json --print-grid > mine.json\n"
         "  turner chart scenes/fresnel.json --grid mine.json --against samples --metric all\n");
}

enum {
    OPTION_GRID = 256, OPTION_PRINT_GRID, OPTION_LIST, OPTION_SIZE, OPTION_RUNS, OPTION_METRIC,
    OPTION_AGAINST, OPTION_REFERENCE_SPP, OPTION_CACHE, OPTION_SHADER_DIR,
    OPTION_SET
};

static const struct option long_options[] = {
    {"output", required_argument, NULL, 'o'},
    {"grid", required_argument, NULL, OPTION_GRID},
    {"print-grid", no_argument, NULL, OPTION_PRINT_GRID},
    {"list", no_argument, NULL, OPTION_LIST},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"runs", required_argument, NULL, OPTION_RUNS},
    {"method", required_argument, NULL, 'm'},
    {"metric", required_argument, NULL, OPTION_METRIC},
    {"against", required_argument, NULL, OPTION_AGAINST},
    {"reference-spp", required_argument, NULL, OPTION_REFERENCE_SPP},
    {"cache", required_argument, NULL, OPTION_CACHE},
    {"device", required_argument, NULL, 'd'},
    {"shader-dir", required_argument, NULL, OPTION_SHADER_DIR},
    {"set", required_argument, NULL, OPTION_SET},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0},
};

struct arguments {
    const char *grid;
    bool print_grid, list;
    int width, height; /* 0: not given */
    const char *methods[TURNER_CHART_MAX_METHODS];
    size_t method_count;
    const char *shader_dirs[MAX_SHADER_DIRS];
    const char *params[MAX_PARAMS];
    size_t param_count;
};

static enum turner_result take_metrics(struct turner_chart *chart, const char *list)
{
    static const char *const choices[] = {"rmse", "relative_mse", "largest", "flip", "all", NULL};
    char *words = turner_strdup(list), *rest = words;
    enum turner_result result = TURNER_OK;
    memset(chart->metrics, 0, sizeof chart->metrics);
    for (char *word; result == TURNER_OK && (word = strtok_r(rest, ",", &rest));) {
        int choice = 0;
        result = turner_option_choice(&choice, "--metric", word, choices);
        for (int i = 0; i < TURNER_CHART_METRICS; i++)
            chart->metrics[i] = chart->metrics[i] || i == choice || choice == TURNER_CHART_METRICS;
    }
    free(words);
    return result;
}

static enum turner_result take(struct arguments *a, struct turner_chart *chart, int option,
                               char **argv)
{
    static const char *const againsts[] = {"pixel", "samples", "arithmetic", NULL};
    int choice;
    switch (option) {
    case 'o': chart->folder = optarg; return TURNER_OK;
    case 'd': chart->render.device = optarg; return TURNER_OK;
    case 'q': chart->quiet = true; return TURNER_OK;
    case 'm':
        if (a->method_count == TURNER_CHART_MAX_METHODS)
            return turner_fail(TURNER_USAGE, "--method can be given %d times",
                               TURNER_CHART_MAX_METHODS);
        a->methods[a->method_count++] = optarg;
        return TURNER_OK;
    case OPTION_GRID: a->grid = optarg; return TURNER_OK;
    case OPTION_PRINT_GRID: a->print_grid = true; return TURNER_OK;
    case OPTION_LIST: a->list = true; return TURNER_OK;
    case OPTION_SIZE: return turner_option_size(&a->width, &a->height, "--size", optarg);
    case OPTION_RUNS:
        return turner_option_int(&chart->runs, "--runs", optarg, TURNER_CHART_MIN_RUNS,
                                 TURNER_CHART_MAX_RUNS);
    case OPTION_METRIC: return take_metrics(chart, optarg);
    case OPTION_AGAINST:
        TURNER_TRY(turner_option_choice(&choice, "--against", optarg, againsts));
        chart->against = (enum turner_chart_against)choice;
        return TURNER_OK;
    case OPTION_REFERENCE_SPP:
        return turner_option_int(&chart->reference_spp, "--reference-spp", optarg, 2,
                                 TURNER_MAX_SPP);
    case OPTION_CACHE: chart->cache = optarg; return TURNER_OK;
    case OPTION_SET:
        if (a->param_count == MAX_PARAMS)
            return turner_fail(TURNER_USAGE, "--set can be given %d times", MAX_PARAMS);
        a->params[a->param_count++] = optarg;
        return TURNER_OK;
    case OPTION_SHADER_DIR:
        if (chart->render.shader_dir_count == MAX_SHADER_DIRS)
            return turner_fail(TURNER_USAGE, "--shader-dir can be given %d times",
                               MAX_SHADER_DIRS);
        a->shader_dirs[chart->render.shader_dir_count++] = optarg;
        return TURNER_OK;
    }
    return turner_bad_option(argv);
}

/* ---- names of folders ---- */

/* "chart-whitted1980" for scenes/whitted1980.json; free it. */
static char *default_folder(const char *scene)
{
    const char *slash = strrchr(scene, '/'), *name = slash ? slash + 1 : scene;
    const char *dot = strrchr(name, '.');
    size_t length = dot && dot > name ? (size_t)(dot - name) : strlen(name);
    size_t size = length + sizeof "chart-";
    char *folder = turner_calloc(size, 1);
    snprintf(folder, size, "chart-%.*s", (int)length, name);
    return folder;
}

/* In the chart's folder where turner has no place for what it keeps. */
static char *default_cache(const char *folder)
{
    char kept[PATH_MAX];
    const char *base = turner_cache_folder(kept) ? kept : folder;
    size_t size = strlen(base) + sizeof "/references";
    char *path = turner_calloc(size, 1);
    snprintf(path, size, "%s/references", base);
    return path;
}

/* ---- the work ---- */

static enum turner_result prepare_scene(struct turner_chart *chart, const struct arguments *a,
                                        const char *path)
{
    TURNER_TRY(turner_scene_load(&chart->scene, path));
    struct turner_settings *settings = &chart->scene->settings;
    for (size_t i = 0; i < a->method_count; i++)
        TURNER_TRY(turner_method_assign(settings, a->methods[i]));
    int height = (int)lround((double)CHART_WIDTH * settings->height / settings->width);
    settings->height = a->height ? a->height : height > 0 ? height : 1;
    settings->width = a->width ? a->width : CHART_WIDTH;
    return turner_scene_validate(chart->scene);
}

static enum turner_result read_grid(struct turner_chart *chart, const struct arguments *a)
{
    char *text;
    size_t length;
    if (a->grid) {
        TURNER_TRY(turner_chart_read_file(&text, &length, a->grid));
    } else {
        text = turner_chart_default_grid(chart->scene);
        length = strlen(text);
    }
    if (a->print_grid)
        puts(text);
    enum turner_result result =
        turner_chart_read_grid(chart, text, length, a->grid ? a->grid : "the grid of the scene");
    free(text);
    return result;
}

static enum turner_result make_chart(struct turner_chart *chart)
{
    struct turner_chart_truths truths = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_chart_measure(chart));
    TURNER_TRY_DONE(turner_chart_truths_create(&truths, chart));
    TURNER_TRY_DONE(turner_chart_compare(chart, &truths));
    TURNER_TRY_DONE(turner_chart_write_data(chart));
    TURNER_TRY_DONE(turner_chart_write_text(chart));
    const char *arguments[] = {chart->folder};
    result = turner_plot("chart", arguments, 1);
done:
    turner_chart_truths_destroy(&truths);
    return result;
}

static enum turner_result run(struct turner_chart *chart, const struct arguments *a,
                              const char *scene, struct turner_shader_path *path)
{
    TURNER_TRY(prepare_scene(chart, a, scene));
    turner_shader_path_create(path, &chart->render, chart->scene);
    for (size_t i = 0; i < a->param_count; i++)
        TURNER_TRY(turner_scene_assign_param(chart->scene, a->params[i]));
    TURNER_TRY(turner_params_settle(chart->scene, &chart->render));
    chart->scene_hash = turner_scene_hash(chart->scene);
    TURNER_TRY(turner_hooks_warn(&chart->render, "what they change counts as error"));
    TURNER_TRY(read_grid(chart, a));
    for (size_t i = 0; a->list && i < chart->point_count; i++)
        puts(chart->points[i].label);
    if (a->list || a->print_grid)
        return TURNER_OK;
    TURNER_TRY(turner_chart_make_folder(chart->folder));
    return make_chart(chart);
}

enum turner_result turner_cmd_chart(int argc, char **argv)
{
    struct turner_chart chart = {.runs = TURNER_CHART_MIN_RUNS, .reference_spp = 256};
    struct arguments a = {0};
    chart.metrics[TURNER_CHART_RMSE] = true;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "o:d:m:qh", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        TURNER_TRY(take(&a, &chart, option, argv));
    }
    if (optind + 1 != argc)
        return turner_fail(TURNER_USAGE, "chart takes one scene; see turner chart --help");
    if (chart.render.device && strcmp(chart.render.device, "reference") == 0)
        return turner_fail(TURNER_USAGE, "the reference is what devices are compared with; give "
                                         "--device one that turner devices lists");
    turner_set_quiet(chart.quiet);
    chart.render.shader_dirs = a.shader_dirs;
    char *folder = default_folder(argv[optind]);
    chart.folder = chart.folder ? chart.folder : folder;
    char *cache = default_cache(chart.folder);
    chart.cache = chart.cache ? chart.cache : cache;
    struct turner_shader_path path = {0};
    enum turner_result result = run(&chart, &a, argv[optind], &path);
    turner_shader_path_destroy(&path);
    free(folder);
    free(cache);
    free(chart.points);
    turner_scene_destroy(chart.scene);
    return result;
}
