#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/bench.h"
#include "app/chart.h"
#include "app/machine.h"
#include "base/memory.h"

static void print_help(void)
{
    puts("Usage: turner bench [OPTION]… [SCENE]…\n\n"
         "Measures how many rays a second each tracer traces: turner's own hierarchy (bvh), the\n"
         "device's (ray_query), and Embree on as many threads where it is installed. Rays are made\n"
         "once - the camera's, shadow rays, mirror bounces and scattered ones - and every tracer\n"
         "gets the same in the same order, in turn, several rounds. What it says they meet is\n"
         "compared with the reference first: who is wrong gets no figure, and the status is 1.\n"
         "docs/performance.md says how to read it.\n\n"
         "SCENE is a file, sphereflake:LEVEL (9^LEVEL spheres and more) or mesh:TRIANGLES.\n"
         "Without one: sphereflake:4 sphereflake:5 mesh:100000 mesh:1000000.\n\n"
         "  -o, --output FOLDER  write bench.csv, build.csv, bench.json and pictures (python3 with\n"
         "                       matplotlib)\n"
         "      --stages         instead of rays: turner render of each SCENE, a file, from start to\n"
         "                       end, and where the time goes; with empty caches and full ones\n"
         "                       (stages.csv)\n"
         "      --growth[=MOST]  instead of scenes: meshes of 10 thousand triangles to MOST\n"
         "                       (1000000), camera and random rays, and a fit of the time a ray\n"
         "                       takes by the logarithm\n"
         "  -s, --size WxH       camera rays (1024x1024)\n"
         "      --rays A,B       camera, shadow, mirror 1, mirror 2, mirror 3, random (all)\n"
         "      --tracers A,B    bvh, ray_query, embree, embree 8 (packets), embree robust (all)\n"
         "      --with FOLDER    measure bvh with shaders from there, too; may be repeated\n"
         "  -r, --rounds N       times each is measured (7)\n"
         "      --cpu            rates by processor time, divided by the threads: on a CPU device,\n"
         "                       while other programs run\n"
         "      --check N        rays of each kind compared with the reference, at least (4096)\n"
         "      --threads N      of Embree (as the device has: one per core, or LP_NUM_THREADS)\n"
         "  -d, --device D       index or part of the name (turner devices)\n"
         "  -q, --quiet          no progress bar, no warnings\n"
         "  -h, --help           this text\n\n"
         "Rates are medians in million rays a second, ± half of the distance between quartiles;\n"
         "N.NN× is the median of the rounds' ratios to embree: ratios can be trusted on a busy\n"
         "machine, rates cannot. Times are by the clock on the wall, from a submission of some\n"
         "30 ms or more of rays to its end, unless --cpu says otherwise.\n\n"
         "Examples:\n"
         "  turner bench -o bench && xdg-open bench/bench.png\n"
         "  turner bench --rays camera,shadow --tracers bvh,embree mesh:100000 scenes/forest.json\n"
         "  turner bench --stages scenes/prism.json scenes/mesh.json\n"
         "  turner bench --with my_shaders --tracers 'bvh,bvh my_shaders' sphereflake:4");
}

struct arguments {
    struct turner_bench bench;
    char *lists[2];     /* texts that names point into */
    char **names[2];    /* kinds, tracers */
    char **with;
    size_t with_count, with_capacity;
    int growth; /* largest size; 0: no */
    bool stages, quiet, help;
};

/* Splits a copy of `text` at commas: names up to a NULL. */
static void split(struct arguments *a, int list, const char *text)
{
    size_t count = 0, capacity = 0;
    free(a->lists[list]);
    free(a->names[list]);
    a->names[list] = NULL;
    a->lists[list] = turner_strdup(text);
    for (char *name = strtok(a->lists[list], ","); name; name = strtok(NULL, ","))
        *TURNER_PUSH(a->names[list], count, capacity) = name;
    *TURNER_PUSH(a->names[list], count, capacity) = NULL;
}

static enum turner_result choose_kinds(struct arguments *a)
{
    memset(a->bench.kinds, !a->names[0], sizeof a->bench.kinds);
    for (char **name = a->names[0]; name && *name; name++) {
        int kind;
        TURNER_TRY(turner_option_choice(&kind, "--rays", *name, turner_bench_kind_names));
        a->bench.kinds[kind] = true;
    }
    return TURNER_OK;
}

static enum turner_result choose_tracers(struct arguments *a)
{
    static const char *const known[] = {"bvh", "ray_query", "embree", "embree 8", "embree robust",
                                        NULL};
    for (char **name = a->names[1]; name && *name; name++) {
        bool own = false;
        for (size_t i = 0; i < a->with_count; i++)
            own = own || (strncmp(*name, "bvh ", 4) == 0 && strcmp(*name + 4, a->with[i]) == 0);
        int choice;
        if (!own)
            TURNER_TRY(turner_option_choice(&choice, "--tracers", *name, known));
    }
    a->bench.tracers = a->names[1];
    return TURNER_OK;
}

static enum turner_result parse(struct arguments *a, int argc, char **argv)
{
    enum { OPTION_RAYS = 256, OPTION_TRACERS, OPTION_WITH, OPTION_CHECK, OPTION_THREADS,
           OPTION_GROWTH, OPTION_STAGES, OPTION_CPU };
    static const struct option options[] = {
        {"output", required_argument, NULL, 'o'},
        {"size", required_argument, NULL, 's'},
        {"rays", required_argument, NULL, OPTION_RAYS},
        {"tracers", required_argument, NULL, OPTION_TRACERS},
        {"with", required_argument, NULL, OPTION_WITH},
        {"rounds", required_argument, NULL, 'r'},
        {"cpu", no_argument, NULL, OPTION_CPU},
        {"check", required_argument, NULL, OPTION_CHECK},
        {"threads", required_argument, NULL, OPTION_THREADS},
        {"stages", no_argument, NULL, OPTION_STAGES},
        {"growth", optional_argument, NULL, OPTION_GROWTH},
        {"device", required_argument, NULL, 'd'},
        {"quiet", no_argument, NULL, 'q'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0}};
    struct turner_bench *b = &a->bench;
    int option, check = 4096;
    opterr = 0;
    while ((option = getopt_long(argc, argv, "o:s:r:d:qh", options, NULL)) != -1) {
        switch (option) {
        case 'o': b->output = optarg; break;
        case 's': TURNER_TRY(turner_option_size(&b->width, &b->height, "--size", optarg)); break;
        case OPTION_RAYS: split(a, 0, optarg); break;
        case OPTION_TRACERS: split(a, 1, optarg); break;
        case OPTION_WITH: *TURNER_PUSH(a->with, a->with_count, a->with_capacity) = optarg; break;
        case 'r':
            TURNER_TRY(turner_option_int(&b->rounds, "--rounds", optarg, 1, TURNER_BENCH_ROUNDS));
            break;
        case OPTION_CPU: b->processor_time = true; break;
        case OPTION_CHECK:
            TURNER_TRY(turner_option_int(&check, "--check", optarg, 1, 1 << 30));
            break;
        case OPTION_THREADS:
            TURNER_TRY(turner_option_int(&b->threads, "--threads", optarg, 1, 1024));
            break;
        case OPTION_GROWTH:
            TURNER_TRY(turner_option_int(&a->growth, "--growth", optarg ? optarg : "1000000",
                                         10000, 100000000));
            break;
        case OPTION_STAGES: a->stages = true; break;
        case 'd': b->wanted = optarg; break;
        case 'q': a->quiet = true; break;
        case 'h': a->help = true; return TURNER_OK;
        default: return turner_bad_option(argv);
        }
    }
    b->check = (size_t)check;
    if ((int64_t)b->width * b->height > 1 << 26)
        return turner_fail(TURNER_USAGE, "--size %dx%d is more than 64 million rays", b->width,
                           b->height);
    *TURNER_PUSH(a->with, a->with_count, a->with_capacity) = NULL;
    b->with = a->with;
    a->with_count--;
    b->growth = a->growth;
    if (a->growth && optind < argc)
        return turner_fail(TURNER_USAGE, "--growth makes its own scenes; leave out \"%s\"",
                           argv[optind]);
    if (a->stages && (a->growth || optind == argc))
        return turner_fail(TURNER_USAGE, "--stages takes scene files, as in: turner bench --stages "
                                         "scenes/prism.json");
    if (a->growth && !a->names[0])
        split(a, 0, "camera,random");
    if (a->growth && !a->names[1])
        split(a, 1, "bvh,embree");
    TURNER_TRY(choose_kinds(a));
    TURNER_TRY(choose_tracers(a));
    return TURNER_OK;
}

static enum turner_result measure_rays(struct turner_bench *bench)
{
    struct turner_gpu gpu;
    const char *why;
    TURNER_TRY(turner_gpu_create(&gpu, bench->wanted, false));
    if (bench->processor_time && !gpu.info.software) {
        turner_gpu_destroy(&gpu);
        return turner_fail(TURNER_USAGE, "--cpu is for CPU devices: \"%s\" has a clock of its own, "
                                         "leave it out", gpu.info.name);
    }
    snprintf(bench->device, sizeof bench->device, "%s", gpu.info.name);
    snprintf(bench->driver, sizeof bench->driver, "%s", gpu.info.driver);
    struct turner_embree *embree = turner_embree_open(bench->threads, &why);
    snprintf(bench->embree, sizeof bench->embree, "%s", embree ? turner_embree_name(embree) : why);
    enum turner_result result = TURNER_OK;
    double share = 1.0 / (double)bench->scene_count;
    for (size_t i = 0; result == TURNER_OK && i < bench->scene_count; i++)
        result = turner_bench_measure(bench, &bench->scenes[i], &gpu, embree, (double)i * share,
                                      share);
    turner_embree_close(embree);
    turner_gpu_destroy(&gpu);
    return result;
}

/* Who is wrong has been named; this is for the exit status. */
static enum turner_result judge(const struct turner_bench *bench)
{
    size_t wrong = 0;
    for (size_t i = 0; i < bench->scene_count; i++) {
        for (int kind = 0; kind < TURNER_BENCH_KINDS; kind++) {
            for (size_t k = 0; k < bench->tracer_count; k++)
                wrong += !turner_bench_right(&bench->scenes[i].cells[kind][k],
                                             bench->scenes[i].rays[kind]);
        }
    }
    return wrong ? turner_fail(TURNER_DIFFERS, "%zu streams were traced wrong and have no figure",
                               wrong)
                 : TURNER_OK;
}

static enum turner_result run(struct arguments *a, char *const *names, size_t count)
{
    struct turner_bench *bench = &a->bench;
    if (bench->output)
        TURNER_TRY(turner_chart_make_folder(bench->output));
    turner_machine_cpu(bench->cpu, sizeof bench->cpu);
    bench->scene_count = count;
    if (a->stages)
        bench->stages = turner_calloc(count, sizeof *bench->stages);
    else
        bench->scenes = turner_calloc(count, sizeof *bench->scenes);
    for (size_t i = 0; i < count; i++)
        *(a->stages ? &bench->stages[i].name : &bench->scenes[i].name) = names[i];
    turner_progress_begin(&bench->bar, a->quiet);
    enum turner_result result =
        a->stages ? turner_bench_measure_stages(bench) : measure_rays(bench);
    turner_progress_end(&bench->bar);
    if (result == TURNER_OK) {
        turner_bench_print(bench);
        if (bench->output)
            result = turner_bench_write(bench);
    }
    if (result == TURNER_OK && !a->stages)
        result = judge(bench);
    free(bench->scenes);
    free(bench->stages);
    return result;
}

/* Scenes of turner's own. */
static enum turner_result run_own(struct arguments *a)
{
    char own[16][32] = {"sphereflake:4", "sphereflake:5", "mesh:100000", "mesh:1000000"};
    char *names[16];
    size_t count = 4;
    if (a->growth) {
        count = 0;
        for (double size = 1e4; size < 1.001 * a->growth; size *= sqrt(10))
            snprintf(own[count++], sizeof *own, "mesh:%.0f", size);
    }
    for (size_t i = 0; i < count; i++)
        names[i] = own[i];
    return run(a, names, count);
}

enum turner_result turner_cmd_bench(int argc, char **argv)
{
    struct arguments a = {.bench = {.width = 1024, .height = 1024, .rounds = 7,
                                    .threads = (int)turner_gpu_cpu_threads()}};
    enum turner_result result = parse(&a, argc, argv);
    if (result == TURNER_OK && a.help)
        print_help();
    turner_set_quiet(a.quiet);
    if (result == TURNER_OK && !a.help)
        result = optind < argc ? run(&a, argv + optind, (size_t)(argc - optind))
                               : run_own(&a);
    for (int i = 0; i < 2; i++) {
        free(a.lists[i]);
        free(a.names[i]);
    }
    free(a.with);
    return result;
}
