/* Ray counts of the Standard Procedural Databases, an oracle that knows of no acceleration
 * structure: `test_spd SCENE centres|published reference|bvh|ray_query|f64`.
 * centres:   512×512 rays through pixel centres; counts of a double-precision tracer of this model
 *            (gears: with a reflection ray at every glass, as the SPD has it); the reference and f64,
 *            the device in double precision, meet them exactly.
 * published: Haines' own counts, on his grid of 513×513 samples. His count of refracted rays
 *            includes those that total internal reflection turned into reflected ones. */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "scene/scene.h"
#include "turner.h"

#define TOLERANCE 0.003

struct oracle {
    const char *scene;
    uint64_t rays, shadow;                                   /* centres */
    uint64_t hits, reflected, refracted, published_shadow;   /* published */
};

static const struct oracle oracles[] = {
    {"balls", 437572, 950735, 263169, 175095, 0, 954368},
    {"gears", 767698, 2249863, 245086, 304643, 207564, 2246955},
    {"mount", 974824, 414585, 173125, 354769, 354769, 412922},
    {"teapot", 487835, 408459, 161120, 225248, 0, 407656},
};

static int compare(const char *what, uint64_t got, uint64_t want, double tolerance)
{
    double off = fabs((double)got - (double)want);
    bool good = off <= tolerance * (double)want;
    printf("%-10s %9llu, expected %9llu (%+.4f %%)%s\n", what, (unsigned long long)got,
           (unsigned long long)want,
           want ? 100 * ((double)got - (double)want) / (double)want : 0.0,
           good ? "" : "  WRONG");
    return good ? 0 : 1;
}

int main(int argc, char **argv)
{
    const struct oracle *oracle = NULL;
    for (size_t i = 0; argc == 4 && i < sizeof oracles / sizeof *oracles; i++) {
        if (strcmp(argv[1], oracles[i].scene) == 0)
            oracle = &oracles[i];
    }
    if (!oracle)
        return TURNER_USAGE;
    bool published = strcmp(argv[2], "published") == 0;

    char path[4096];
    snprintf(path, sizeof path, TURNER_SHARED_DIR "/scenes/nff/%s.nff", oracle->scene);
    if (access(path, R_OK) != 0) {
        printf("skipped: there is no %s\n", path);
        return 77;
    }
    struct turner_scene *scene;
    struct turner_image image = {0};
    struct turner_statistics s = {0};
    struct turner_render_options options = {
        .device = strcmp(argv[3], "reference") == 0 ? "reference" : NULL,
        .traversal = strcmp(argv[3], "ray_query") == 0 ? TURNER_TRAVERSAL_RAY_QUERY
                                                       : TURNER_TRAVERSAL_BVH,
    };
    if (turner_scene_load(&scene, path) != TURNER_OK) {
        fprintf(stderr, "%s\n", turner_message());
        return 1;
    }
    if (strcmp(argv[3], "f64") == 0)
        scene->settings.methods.precision = TURNER_PRECISION_F64;
    bool exact = options.device || scene->settings.methods.precision == TURNER_PRECISION_F64;
    scene->settings.width = scene->settings.height = published ? 513 : 512;
    scene->settings.spd_grid = published;
    scene->settings.spd_rays = published || strcmp(oracle->scene, "gears") == 0;
    enum turner_result result = turner_render(&image, scene, &options, &s);
    turner_image_destroy(&image);
    turner_scene_destroy(scene);
    if (result != TURNER_OK) {
        printf("%s\n", turner_message());
        return result == TURNER_DEVICE ? 77 : 1; /* no device: skipped */
    }
    if (!published) {
        double tolerance = exact ? 0 : TOLERANCE;
        return compare("rays", s.camera_rays + s.reflected_rays + s.refracted_rays, oracle->rays,
                       tolerance) |
               compare("shadow", s.shadow_rays, oracle->shadow, tolerance);
    }
    return compare("eye hits", s.camera_hits, oracle->hits, TOLERANCE) |
           compare("reflected", s.reflected_rays, oracle->reflected, TOLERANCE) |
           compare("refracted", s.refracted_rays + s.tir_rays, oracle->refracted, TOLERANCE) |
           compare("shadow", s.shadow_rays, oracle->published_shadow, TOLERANCE);
}
