/* turner compare-shaders: one scene, two ways to draw it. */
#ifndef TURNER_APP_COMPARE_SHADERS_H
#define TURNER_APP_COMPARE_SHADERS_H

#include "app/scene_options.h"
#include "image/image.h"

#define TURNER_SIDE_CHOICES 32
#define TURNER_SIDE_RUNS 101

/* One side: what it is drawn with, and what came of it. */
struct turner_side {
    const char *folder; /* of shaders, before all others; "-": none */
    const char *methods[TURNER_SIDE_CHOICES], *params[TURNER_SIDE_CHOICES]; /* "name=value" */
    size_t method_count, param_count;

    struct turner_scene *scene;
    char hooks[512];       /* files that replace hooks, with commas, or "" */
    size_t kernel_bytes;   /* of SPIR-V, specialised to the scene and optimised */
    double seconds[TURNER_SIDE_RUNS], median; /* of a picture */
    double compile;        /* seconds from source to a kernel that has run once */
    struct turner_statistics statistics; /* of one picture */
    struct turner_image image;
    bool has_error;        /* against the reference: where no hook is replaced */
    struct turner_comparison error;
};

struct turner_sides {
    struct turner_scene_options options; /* of both */
    const char *path;                    /* of the scene */
    struct turner_side side[2];
    int runs;
    bool reference, json, quiet;
    const char *heatmap;

    double ratios[TURNER_SIDE_RUNS], ratio; /* of seconds, second to first, run by run; the median */
    struct turner_comparison difference;    /* of the second from the first */
    char device[256];
};

/* Draws both by turns and compares. */
enum turner_result turner_sides_measure(struct turner_sides *sides);
void turner_sides_destroy(struct turner_sides *sides);

#endif
