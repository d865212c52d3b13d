/* One scene by the reference and by both traversals: how many pixels are off, and why each is.
 *
 *   test_truth SCENE SHARE ABSOLUTE RELATIVE
 *
 * Fails when more than SHARE of the pixels are off by more than both tolerances, when a pixel is
 * off without a cause, or when the two traversals disagree where there is no edge. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "explain.h"
#include "gpu/device.h"
#include "turner.h"

#define SIZE 128
#define LISTED 12 /* pixels named one by one */

static int failures;

static void require(enum turner_result result)
{
    if (result == TURNER_OK)
        return;
    fprintf(stderr, "%s\n", turner_message());
    exit(result == TURNER_DEVICE ? 77 : 1); /* no device: skipped */
}

static void draw(struct turner_image *image, const struct turner_scene *scene, const char *device,
                 enum turner_traversal traversal)
{
    struct turner_render_options options = {.device = device, .traversal = traversal};
    struct turner_statistics statistics = {0};
    require(turner_render(image, scene, &options, &statistics));
    if (statistics.nonfinite || statistics.unfinished) {
        printf("FAILED: %llu pixels not finite, %llu samples unfinished\n",
               (unsigned long long)statistics.nonfinite,
               (unsigned long long)statistics.unfinished);
        failures++;
    }
}

static void judge(struct turner_scene *scene, const struct turner_world *world,
                  const char *traversal, const struct turner_image *image,
                  const struct turner_image *truth, struct tolerance tolerance, double share)
{
    int causes[CAUSES] = {0}, off = 0;
    for (int i = 0; i < SIZE * SIZE; i++) {
        const float *pixel = image->rgba + 4 * i, *true_pixel = truth->rgba + 4 * i;
        if (!is_off(pixel, true_pixel, tolerance))
            continue;
        enum cause cause = explain(scene, world, i % SIZE, i / SIZE, pixel, tolerance);
        causes[cause]++;
        if (off++ < LISTED || cause == CAUSE_NONE)
            printf("  %s %d,%d: %g %g %g instead of %g %g %g: %s\n", traversal, i % SIZE, i / SIZE,
                   (double)pixel[0], (double)pixel[1], (double)pixel[2], (double)true_pixel[0],
                   (double)true_pixel[1], (double)true_pixel[2], cause_names[cause]);
    }
    printf("%s: %d of %d pixels off (%.3f %%, at most %.3f %%):", traversal, off, SIZE * SIZE,
           100.0 * off / (SIZE * SIZE), 100 * share);
    for (int cause = 0; cause < CAUSES; cause++)
        printf(" %d %s%s", causes[cause], cause_names[cause], cause + 1 < CAUSES ? "," : "\n");
    if (off > share * SIZE * SIZE || causes[CAUSE_NONE])
        failures++;
}

/* The traversals at the scene's own size: bvh and bvh_lane the same bytes; bvh and ray_query
 * all but 1e-5 of the pixels the same, the rest edges. What bvh sees there must be explained. What ray_query sees need not be where the camera ray meets an
 * edge: the device's own triangle test, which offers the candidates, lets some rays slip through
 * vertices (tests/watertight counts them). */
static void compare_traversals(struct turner_scene *scene, const struct turner_world *world,
                               int width, int height)
{
    static const struct tolerance none = {0, 0};
    struct turner_image bvh, lane, ray_query;
    scene->settings.width = width;
    scene->settings.height = height;
    draw(&bvh, scene, NULL, TURNER_TRAVERSAL_BVH);
    draw(&lane, scene, NULL, TURNER_TRAVERSAL_BVH_LANE);
    draw(&ray_query, scene, NULL, TURNER_TRAVERSAL_RAY_QUERY);
    if (memcmp(bvh.rgba, lane.rgba, (size_t)(width * height) * 4 * sizeof *bvh.rgba) != 0) {
        printf("  bvh and bvh_lane differ\n");
        failures++;
    }
    turner_image_destroy(&lane);
    int different = 0;
    for (int i = 0; i < width * height; i++) {
        const float *a = bvh.rgba + 4 * i, *b = ray_query.rgba + 4 * i;
        if (!is_off(a, b, none))
            continue;
        static const struct tolerance shading = {1e-4, 1e-3};
        enum cause a_cause = explain(scene, world, i % width, i / width, a, shading);
        enum cause b_cause = explain(scene, world, i % width, i / width, b, shading);
        printf("  traversals differ at %d,%d: %g %g %g (%s), %g %g %g (%s)\n", i % width,
               i / width, (double)a[0], (double)a[1], (double)a[2], cause_names[a_cause],
               (double)b[0], (double)b[1], (double)b[2], cause_names[b_cause]);
        if (a_cause == CAUSE_NONE || (b_cause == CAUSE_NONE && a_cause != CAUSE_EDGE))
            failures++;
        different++;
    }
    printf("traversals differ in %d of %d pixels\n", different, width * height);
    if (different > 1e-5 * width * height)
        failures++;
    turner_image_destroy(&bvh);
    turner_image_destroy(&ray_query);
}

int main(int argc, char **argv)
{
    if (argc != 5)
        return 2;
    double share = atof(argv[2]);
    struct tolerance tolerance = {atof(argv[3]), atof(argv[4])};
    FILE *file = fopen(argv[1], "r");
    if (!file) {
        printf("skipped: %s is not here\n", argv[1]);
        return 77;
    }
    fclose(file);

    struct turner_scene *scene;
    struct turner_world world;
    if (turner_scene_load(&scene, argv[1]) != TURNER_OK) {
        printf("%s\n", turner_message());
        return 1;
    }
    int width = scene->settings.width, height = scene->settings.height;
    scene->settings.width = scene->settings.height = SIZE;
    scene->settings.spp = 1; /* so that a pixel is one ray and has one cause */
    require(turner_world_create(&world, scene));

    struct turner_image truth, bvh, ray_query;
    draw(&truth, scene, "reference", TURNER_TRAVERSAL_AUTO);
    draw(&bvh, scene, NULL, TURNER_TRAVERSAL_BVH);
    judge(scene, &world, "bvh", &bvh, &truth, tolerance, share);
    draw(&ray_query, scene, NULL, TURNER_TRAVERSAL_RAY_QUERY);
    judge(scene, &world, "ray_query", &ray_query, &truth, tolerance, share);
    compare_traversals(scene, &world, width, height);
    if (turner_gpu_validation_count()) {
        printf("%u messages of the validation layers\n", turner_gpu_validation_count());
        failures++;
    }
    turner_image_destroy(&truth);
    turner_image_destroy(&bvh);
    turner_image_destroy(&ray_query);
    turner_world_destroy(&world);
    turner_scene_destroy(scene);
    return failures ? 1 : 0;
}
