#include <getopt.h>
#include <stdio.h>
#include <string.h>

#include "app/app.h"
#include "app/check_needs.h"
#include "app/check_shader.h"
#include "render/advice.h"
#include "render/params.h"
#include "render/shader_path.h"

static void print_help(void)
{
    puts("Usage: turner check [OPTION]… FILE…\n"
         "       turner check --template HOOK\n\n"
         "Reads scenes (.json .nff and meshes) without drawing anything: says what each holds and\n"
         "needs of the kernel, and warns where it asks for more than its picture can show.\n"
         "Compiles shaders (.comp .glsl) in every kernel they are part of: a file takes the place of\n"
         "turner's of that name, or of the hook whose function it defines (docs/shaders.md).\n"
         "What is wrong is said as file:line:column: message. Exit status 0 when all is well, 3\n"
         "otherwise.\n\n"
         "      --template HOOK print a hook to begin with: surface, brdf, background, light, post\n"
         "      --needs         what each scene needs and who asks for it, how deep rays can go,\n"
         "                      what double precision could show, what was left out of the kernel\n"
         "                      and how large it is (docs/needs.md)\n"
         "      --json          --needs as JSON, a list with an object for each scene\n"
         "      --measure DIR   draw each scene with the kernel that has what it needs and with\n"
         "                      the one that has everything, by turns; write times and sizes to\n"
         "                      DIR/needs.csv and needs.json, and a chart to needs.png and .svg.\n"
         "                      Exit status 1 unless both pictures are the same to the byte\n"
         "      --runs N        of each kind (default 5, at least 5); the median counts\n"
         "      --size WxH, --spp N        for --measure, in place of the scene's\n"
         "  -d, --device D      for --measure: index or part of the name (turner devices)\n"
         "      --traversal KIND           auto | bvh | bvh_lane | bvh_packet | ray_query\n"
         "  -q, --quiet         say only what is wrong\n"
         "  -h, --help          this text\n\n"
         "Examples: turner check --needs scenes/prism.json\n"
         "          turner check --template brdf > brdf.glsl && turner check brdf.glsl\n"
         "          turner check --measure out --size 320x240 scenes/prism.json scenes/mesh.json");
}

static void describe(const char *path, const struct turner_scene *scene)
{
    size_t spheres = 0, cones = 0, triangles = 0;
    for (size_t g = 0; g < scene->group_count; g++) {
        spheres += scene->groups[g].sphere_count;
        cones += scene->groups[g].cone_count;
        for (size_t m = 0; m < scene->groups[g].mesh_count; m++)
            triangles += scene->groups[g].meshes[m].triangle_count;
    }
    printf("%s: %zu spheres, %zu cones, %zu triangles, %zu planes, %zu instances, %zu lights, "
           "%zu materials\n", path, spheres, cones, triangles, scene->plane_count,
           scene->instance_count, scene->light_count, scene->material_count);
    struct turner_needs needs = turner_needs_of(scene);
    printf("  needs");
    const char *separator = " ";
    for (uint32_t bit = 1; bit && bit <= needs.bits; bit <<= 1) {
        if (needs.bits & bit) {
            printf("%s%s", separator, turner_needs_name(bit));
            separator = ", ";
        }
    }
    puts("");
}

struct arguments {
    bool needs, json, quiet;
    const char *template;  /* the hook whose file is to be printed, or NULL */
    struct turner_measure measure; /* when its folder is set */
};

/* That its folder of shaders can be read, and that its parameters are theirs. */
static enum turner_result check_params(struct turner_scene *scene)
{
    struct turner_render_options options = {0};
    struct turner_shader_path shaders;
    turner_shader_path_create(&shaders, &options, scene);
    enum turner_result result = turner_params_settle(scene, &options);
    turner_shader_path_destroy(&shaders);
    return result == TURNER_USAGE ? turner_fail_within(TURNER_BAD_INPUT, "\"params\"") : result;
}

static enum turner_result check_scene(const struct arguments *a, const char *path,
                                      struct turner_kernel_set *kernels, cJSON *list)
{
    /* without a device: what a CPU would do that can do everything */
    static const struct turner_gpu_info able = {
        .name = "any", .software = true, .ray_query = true, .packets = true,
        .float64 = true};
    const struct turner_sized_kernel *kernel = NULL;
    struct turner_scene *scene;
    enum turner_result result = TURNER_OK;
    TURNER_TRY(turner_scene_load(&scene, path));
    result = check_params(scene);
    if (result == TURNER_OK && a->needs)
        result = turner_kernel_set_get(&kernel, kernels, &able, scene, a->measure.traversal);
    if (result != TURNER_OK)
        turner_fail_within(result, "%s", path);
    else if (list)
        result = turner_needs_list(list, scene, path, kernel);
    else if (a->needs)
        result = turner_needs_print(scene, path, kernel);
    else if (!a->quiet)
        describe(path, scene);
    if (result == TURNER_OK)
        turner_advise(scene, path, 0);
    turner_scene_destroy(scene);
    return result;
}

static bool is_shader(const char *path)
{
    const char *ending = strrchr(path, '.');
    return ending && (strcmp(ending, ".comp") == 0 || strcmp(ending, ".glsl") == 0);
}

enum { OPTION_NEEDS = 256, OPTION_JSON, OPTION_MEASURE, OPTION_RUNS, OPTION_SIZE, OPTION_SPP,
       OPTION_TRAVERSAL, OPTION_TEMPLATE };

static const struct option long_options[] = {
    {"needs", no_argument, NULL, OPTION_NEEDS},
    {"json", no_argument, NULL, OPTION_JSON},
    {"measure", required_argument, NULL, OPTION_MEASURE},
    {"runs", required_argument, NULL, OPTION_RUNS},
    {"size", required_argument, NULL, OPTION_SIZE},
    {"spp", required_argument, NULL, OPTION_SPP},
    {"template", required_argument, NULL, OPTION_TEMPLATE},
    {"device", required_argument, NULL, 'd'},
    {"traversal", required_argument, NULL, OPTION_TRAVERSAL},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {0}};

static enum turner_result take(struct arguments *a, int option, char **argv)
{
    static const char *const traversals[] = {"auto", "bvh", "ray_query", "bvh_lane",
                                             "bvh_packet", NULL};
    struct turner_measure *m = &a->measure;
    int choice;
    switch (option) {
    case OPTION_NEEDS: a->needs = true; return TURNER_OK;
    case OPTION_JSON: a->json = true; return TURNER_OK;
    case OPTION_MEASURE: m->folder = optarg; return TURNER_OK;
    case OPTION_RUNS: return turner_option_int(&m->runs, "--runs", optarg, 5, 10000);
    case OPTION_SIZE: return turner_option_size(&m->width, &m->height, "--size", optarg);
    case OPTION_SPP: return turner_option_int(&m->spp, "--spp", optarg, 1, TURNER_MAX_SPP);
    case OPTION_TRAVERSAL:
        TURNER_TRY(turner_option_choice(&choice, "--traversal", optarg, traversals));
        m->traversal = (enum turner_traversal)choice;
        return TURNER_OK;
    case 'd': m->device = optarg; return TURNER_OK;
    case OPTION_TEMPLATE: a->template = optarg; return TURNER_OK;
    case 'q': a->quiet = m->quiet = true; return TURNER_OK;
    }
    return turner_bad_option(argv);
}

/* Each file for itself: one that is wrong does not keep the others from being read. */
static enum turner_result check_files(const struct arguments *a, char **paths, size_t count)
{
    enum turner_result worst = TURNER_OK;
    struct turner_kernel_set kernels = {0};
    cJSON *list = a->json ? cJSON_CreateArray() : NULL;
    for (size_t i = 0; i < count; i++) {
        enum turner_result result =
            is_shader(paths[i]) ? turner_check_shader(paths[i], a->quiet || list)
                                : check_scene(a, paths[i], &kernels, list);
        if (result == TURNER_OK)
            continue;
        /* editors look for file:line:column at the beginning */
        fprintf(stderr, "%s%s\n", is_shader(paths[i]) ? "" : "turner: error: ", turner_message());
        turner_fail(result, "%s", ""); /* said already */
        worst = result;
    }
    if (list) {
        char *text = cJSON_Print(list);
        puts(text);
        cJSON_free(text);
    }
    cJSON_Delete(list);
    turner_kernel_set_destroy(&kernels);
    return worst;
}

enum turner_result turner_cmd_check(int argc, char **argv)
{
    struct arguments a = {.measure = {.runs = 5}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "d:qh", long_options, NULL)) != -1;) {
        if (option == 'h') {
            print_help();
            return TURNER_OK;
        }
        TURNER_TRY(take(&a, option, argv));
    }
    if (a.template)
        return turner_check_template(a.template);
    if (optind == argc)
        return turner_fail(TURNER_USAGE, "check takes scenes or shaders; see turner check --help");
    if (a.json && !a.needs)
        return turner_fail(TURNER_USAGE, "--json is for --needs; see turner check --help");
    turner_set_quiet(a.quiet);
    if (a.measure.folder)
        return turner_needs_measure(&a.measure, (const char *const *)argv + optind,
                                    (size_t)(argc - optind));
    return check_files(&a, argv + optind, (size_t)(argc - optind));
}
