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
         "traversal --traversal auto takes on it. `bvh` is turner's own bounding volume hierarchy\n"
         "and runs everywhere, where subgroups have 8 lanes in packets of them, which is faster;\n"
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
    printf("   bvh         yes, %s\n", info->packets ? "in packets of 8 lanes"
                                                     : "each lane for itself");
    if (info->ray_query)
        printf("   ray_query   yes\n");
    else
        printf("   ray_query   no, lacks %s\n", info->missing);
    if (turner_choose_traversal(&chosen, info, TURNER_TRAVERSAL_AUTO) == TURNER_OK)
        printf("   auto        %s\n",
               chosen == TURNER_TRAVERSAL_RAY_QUERY ? "ray_query" : "bvh");
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
