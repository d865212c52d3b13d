/* Thousands of dispatches in one process: no memory is lost, and validation has nothing to say. */
#include <unistd.h>

#include "render_test.h"

#define DISPATCHES_A_DRAW 1024 /* 64×64 pixels in tiles of 2×2 */

static struct rig rig;

static long resident_kib(void)
{
    FILE *file = fopen("/proc/self/status", "r");
    char line[256];
    long kib = -1;
    assert_non_null(file);
    while (fgets(line, sizeof line, file))
        sscanf(line, "VmRSS: %ld kB", &kib);
    fclose(file);
    assert_true(kib > 0);
    return kib;
}

static struct turner_scene *soak_scene(void)
{
    struct turner_scene *scene = scene_of(
        SCENE_HEAD ", \"background\": 0.5, \"settings\": {\"size\": [64, 64], \"depth\": 3}, "
        "\"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": 1, \"index\": 1.5}, \"grey\": {\"k_d\": "
        "0.5}}, \"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, "
        "\"material\": \"glass\"}, {\"type\": \"box\", \"min\": [-3, -2, -2], \"max\": [3, -1.5, 2],"
        " \"material\": \"grey\"}], \"lights\": [{\"type\": \"point\", \"position\": [2, 4, 3], "
        "\"intensity\": 30}]}");
    return scene;
}

/* Mesa's own pools may still settle, so a quarter of the dispatches goes before; what is lost after
 * that may be 64 bytes a dispatch: less than any object of ours. */
static void dispatches(void **state)
{
    (void)state;
    static const struct turner_render_options options = {.tile = 2};
    struct turner_scene *scene = soak_scene();
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        struct turner_renderer renderer;
        struct turner_image first, image;
        struct turner_statistics statistics = {0};
        assert_ok(turner_renderer_create(&renderer, &rig.gpu, &rig.kernels[traversal], scene,
                                         &options, &statistics));
        assert_ok(turner_image_create(&first, 64, 64));
        assert_ok(turner_image_create(&image, 64, 64));
        assert_ok(turner_renderer_draw(&renderer, &first, &options, &statistics));
        long before = resident_kib();
        uint64_t used = rig.gpu.memory_used;
        for (int i = 0; i < 3; i++) {
            assert_ok(turner_renderer_draw(&renderer, &image, &options, &statistics));
            assert_same_picture(&first, &image, "drawn again");
        }
        long grown = resident_kib() - before;
        printf("%s: %d dispatches, memory has grown by %ld KiB from %ld\n",
               turner_traversal_name(rig.kernels[traversal].kind), 4 * DISPATCHES_A_DRAW, grown, before);
        assert_true(grown * 1024 <= 3 * DISPATCHES_A_DRAW * 64);
        assert_int_equal(rig.gpu.memory_used, used);
        turner_renderer_destroy(&renderer);
        assert_int_equal(rig.gpu.memory_used, 0);
        turner_image_destroy(&first);
        turner_image_destroy(&image);
    }
    turner_scene_destroy(scene);
}

/* Scenes made ready and given back on one device: all buffers go. What the driver keeps of each
 * compiled pipeline is its own and only reported. */
static void renderers(void **state)
{
    (void)state;
    struct turner_scene *scene = soak_scene();
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        long before = 0;
        for (int i = 0; i < 12; i++) {
            struct turner_image image;
            draw(&rig, &image, scene, traversal, NULL, NULL);
            turner_image_destroy(&image);
            assert_int_equal(rig.gpu.memory_used, 0);
            if (i == 3)
                before = resident_kib();
        }
        printf("%s: 8 more renderers, memory has grown by %ld KiB\n",
               turner_traversal_name(rig.kernels[traversal].kind), resident_kib() - before);
    }
    turner_scene_destroy(scene);
}

int main(void)
{
    rig_open(&rig);
    const struct CMUnitTest tests[] = {cmocka_unit_test(dispatches), cmocka_unit_test(renderers)};
    return rig_close(&rig, cmocka_run_group_tests(tests, NULL, NULL));
}
