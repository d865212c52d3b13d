#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/app.h"
#include "gpu/device.h"
#include "render/measure.h"
#include "render/renderer.h"

static void print_help(void)
{
    puts("Usage: turner devices [--measure]\n\n"
         "Lists every Vulkan device: its index and name (for --device), what it can do, and which\n"
         "traversal --traversal auto takes on it. `bvh` is turner's own bounding volume hierarchy\n"
         "and runs everywhere, where subgroups have 8 lanes in packets of them, which is faster;\n"
         "`ray_query` needs the device's acceleration structures.\n"
         "With --measure a small picture is drawn by each traversal on each device; auto takes the\n"
         "fastest from then on. (On a device with ray queries in hardware that is done when it is\n"
         "first used; otherwise auto is bvh.)\n"
         "`--device reference` needs no device: extended precision on the CPU.\n\n"
         "      --measure   rays a second of each traversal, and remember the fastest\n"
         "  -h, --help      this text");
}

static const char *traversal_name(enum turner_traversal traversal)
{
    return traversal == TURNER_TRAVERSAL_RAY_QUERY    ? "ray_query"
           : traversal == TURNER_TRAVERSAL_BVH_PACKET ? "bvh_packet"
                                                      : "bvh_lane";
}

static void print_device(size_t index, const struct turner_gpu_info *info)
{
    enum turner_traversal chosen;
    printf("%zu  %s (%s%s)\n", index, info->name, info->type, info->software ? ", software" : "");
    printf("   driver      %s\n", info->driver);
    if (!info->usable) {
        printf("   not usable  lacks %s\n", info->lacking);
        return;
    }
    printf("   memory      %.1f GiB, one allocation up to %.1f GiB\n",
           (double)info->device_memory / (1 << 30), (double)info->max_allocation / (1 << 30));
    printf("   subgroup    %u lanes; 64-bit floats: %s\n", info->subgroup_size,
           info->float64 ? "yes" : "no");
    printf("   bvh         yes, %s\n", info->packets ? "in packets of 8 lanes"
                                                     : "each lane for itself");
    if (info->ray_query)
        printf("   ray_query   yes\n");
    else
        printf("   ray_query   no, lacks %s\n", info->missing);
    if (turner_choose_traversal(&chosen, info, TURNER_TRAVERSAL_AUTO) == TURNER_OK)
        printf("   auto        %s%s\n", traversal_name(chosen),
               info->fastest == TURNER_TRAVERSAL_AUTO ? "" : ", as measured");
}

static enum turner_result measure_device(size_t index)
{
    static const struct turner_render_options options = {0};
    struct turner_traversal_rate rates[TURNER_TRAVERSALS_MEASURED];
    struct turner_gpu gpu;
    size_t count;
    char wanted[24];
    snprintf(wanted, sizeof wanted, "%zu", index);
    TURNER_TRY(turner_gpu_create(&gpu, wanted, false));
    enum turner_result result = turner_measure_traversals(rates, &count, &gpu, &options);
    for (size_t i = 0; result == TURNER_OK && i < count; i++)
        printf("   %-11s %.2f million rays a second\n", traversal_name(rates[i].traversal),
               rates[i].rays_per_second / 1e6);
    if (result == TURNER_OK)
        printf("   auto        %s from now on\n", traversal_name(gpu.info.fastest));
    turner_gpu_destroy(&gpu);
    return result;
}

enum turner_result turner_cmd_devices(int argc, char **argv)
{
    static const struct option options[] = {
        {"measure", no_argument, NULL, 'm'}, {"help", no_argument, NULL, 'h'}, {0}};
    bool measured = false;
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        switch (option) {
        case 'm':
            measured = true;
            break;
        case 'h':
            print_help();
            return TURNER_OK;
        default:
            return turner_bad_option(argv);
        }
    }
    if (optind < argc)
        return turner_fail(TURNER_USAGE, "devices takes no argument (\"%s\")", argv[optind]);

    struct turner_gpu_info *infos;
    size_t count;
    TURNER_TRY(turner_gpu_list(&infos, &count));
    enum turner_result result = TURNER_OK;
    for (size_t i = 0; result == TURNER_OK && i < count; i++) {
        print_device(i, &infos[i]);
        if (measured && infos[i].usable)
            result = measure_device(i);
    }
    free(infos);
    return result;
}
