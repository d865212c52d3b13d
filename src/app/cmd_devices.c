#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>

#include "app/app.h"
#include "gpu/device.h"
#include "render/renderer.h"

static void print_help(void)
{
    puts("Usage: turner devices\n\n"
         "Lists every Vulkan device: its index and name (for --device), what it can do, and which\n"
         "traversal --traversal auto takes on it. `bvh_lane` and `bvh_packet` are turner's own\n"
         "bounding volume hierarchy, walked by each lane for itself, which runs everywhere, or by\n"
         "the eight lanes of a subgroup together; `bvh` takes the faster of the two on the device.\n"
         "`ray_query` needs the device's acceleration structures.\n"
         "`--device reference` needs no device: extended precision on the CPU.\n\n"
         "  -h, --help   this text");
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
    printf("   bvh_lane    yes\n");
    printf("   bvh_packet  %s\n", info->packets ? "yes" : "no, wants subgroups of 8 lanes");
    if (info->ray_query)
        printf("   ray_query   yes\n");
    else
        printf("   ray_query   no, lacks %s\n", info->missing);
    if (turner_choose_traversal(&chosen, info, TURNER_TRAVERSAL_AUTO) == TURNER_OK)
        printf("   auto        %s\n", chosen == TURNER_TRAVERSAL_RAY_QUERY    ? "ray_query"
                                      : chosen == TURNER_TRAVERSAL_BVH_PACKET ? "bvh_packet"
                                                                              : "bvh_lane");
}

enum turner_result turner_cmd_devices(int argc, char **argv)
{
    static const struct option options[] = {{"help", no_argument, NULL, 'h'}, {0}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        if (option != 'h')
            return turner_bad_option(argv);
        print_help();
        return TURNER_OK;
    }
    if (optind < argc)
        return turner_fail(TURNER_USAGE, "devices takes no argument (\"%s\")", argv[optind]);

    struct turner_gpu_info *infos;
    size_t count;
    TURNER_TRY(turner_gpu_list(&infos, &count));
    for (size_t i = 0; i < count; i++)
        print_device(i, &infos[i]);
    free(infos);
    return TURNER_OK;
}
