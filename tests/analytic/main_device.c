/* The checks on the best Vulkan device: main_device bvh_packet|bvh_lane|ray_query [FILTER]. One
 * kernel, that of bvh, is specialised to each scene; the others are not, which shows that everything
 * at once is right, too, and saves the time of compiling them a hundred times. */
#include <stdio.h>
#include <string.h>

#include "analytic/analytic.h"
#include "render/renderer.h"

static struct turner_gpu gpu;
static struct turner_kernel kernel;

static enum turner_result render(struct turner_image *image, const struct turner_scene *scene)
{
    const bool bvh = kernel.kind == (gpu.info.packets ? TURNER_PACKET : 0);
    const struct turner_render_options options = {.unspecialised = !bvh};
    struct turner_statistics statistics = {0};
    struct turner_renderer renderer;
    *image = (struct turner_image){0};
    TURNER_TRY(turner_renderer_create(&renderer, &gpu, &kernel, scene, &options, &statistics));
    enum turner_result result =
        turner_image_create(image, scene->settings.width, scene->settings.height);
    if (result == TURNER_OK)
        result = turner_renderer_draw(&renderer, image, &options, &statistics);
    turner_renderer_destroy(&renderer);
    return result;
}

int main(int argc, char **argv)
{
    static const struct turner_render_options options;
    const char *name = argc > 1 ? argv[1] : "bvh_lane";
    enum turner_traversal traversal = strcmp(name, "ray_query") == 0 ? TURNER_TRAVERSAL_RAY_QUERY
                                      : strcmp(name, "bvh_packet") == 0
                                          ? TURNER_TRAVERSAL_BVH_PACKET
                                          : TURNER_TRAVERSAL_BVH_LANE;
    static const struct turner_methods methods;
    unsigned kind;
    if (turner_gpu_create(&gpu, NULL, false) != TURNER_OK ||
        turner_choose_kernel(&kind, &gpu.info, &methods, traversal) != TURNER_OK) {
        printf("skipped: %s\n", turner_message());
        turner_gpu_destroy(&gpu);
        return 77;
    }
    int failures = 0;
    if (turner_kernel_create(&kernel, kind, &options) != TURNER_OK) {
        printf("%s\n", turner_message());
        failures++;
    } else {
        failures = analytic_run(render, ANALYTIC_SINGLE, argc > 2 ? argv[2] : NULL);
    }
    failures += (int)turner_gpu_validation_count();
    turner_kernel_destroy(&kernel);
    turner_gpu_destroy(&gpu);
    return failures ? 1 : 0;
}
