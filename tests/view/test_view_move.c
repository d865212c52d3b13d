/* Instances that moved: the picture is that of a renderer made for them, by every traversal. */
#include "../gpu/gpu_test.h"

#include <string.h>

#include "render/renderer.h"
#include "scene/readers.h"

#define MOVES 5

static struct turner_gpu gpu;
static uint32_t dice = 1;

static double roll(void) /* in [−1, 1), PCG, O'Neill 2014 */
{
    dice = dice * 747796405u + 2891336453u;
    uint32_t word = ((dice >> ((dice >> 28) + 4)) ^ dice) * 277803737u;
    return ((word >> 22) ^ word) / 2147483648.0 - 1;
}

static struct turner_scene *load(enum turner_precision precision)
{
    struct turner_scene *scene;
    assert_ok(turner_scene_load(&scene, TURNER_SOURCE_DIR "/scenes/instances.json"));
    scene->settings.width = 96;
    scene->settings.height = 72;
    scene->settings.spp = 1;
    scene->settings.methods.precision = precision;
    return scene;
}

/* Every second one stands elsewhere, and one far off. */
static void move(struct turner_scene *scene)
{
    for (size_t i = 0; i < scene->instance_count; i += 2) {
        for (int axis = 0; axis < 3; axis++)
            scene->instances[i].transform.m[axis][3] += 0.4 * roll();
    }
    scene->instances[7].transform.m[0][3] += 30 * roll();
}

static void create(struct turner_renderer *renderer, struct turner_kernel *kernel,
                   const struct turner_scene *scene, enum turner_traversal traversal)
{
    const struct turner_render_options options = {.traversal = traversal};
    struct turner_statistics statistics = {0};
    unsigned kind;
    assert_ok(turner_choose_kernel(&kind, &gpu.info, &scene->settings.methods, traversal));
    if (!kernel->spirv.words)
        assert_ok(turner_kernel_create(kernel, kind, &options));
    assert_ok(turner_renderer_create(renderer, &gpu, kernel, scene, &options, &statistics));
}

static void draw(struct turner_image *image, struct turner_renderer *renderer,
                 const struct turner_scene *scene)
{
    const struct turner_render_options options = {0};
    struct turner_statistics statistics = {0};
    assert_ok(turner_image_create(image, scene->settings.width, scene->settings.height));
    assert_ok(turner_renderer_look(renderer, scene));
    assert_ok(turner_renderer_draw(renderer, image, &options, &statistics));
}

static void check(enum turner_traversal traversal, enum turner_precision precision)
{
    struct turner_scene *scene = load(precision);
    struct turner_kernel kernel = {0};
    struct turner_renderer moved, made;
    struct turner_image before, now, wanted;
    bool fits;
    size_t bytes = 4 * sizeof(float) * (size_t)scene->settings.width *
                   (size_t)scene->settings.height;
    create(&moved, &kernel, scene, traversal);
    draw(&before, &moved, scene);
    for (int i = 0; i < MOVES; i++) {
        move(scene);
        assert_ok(turner_renderer_move(&moved, scene, &fits));
        assert_true(fits);
        draw(&now, &moved, scene);
        create(&made, &kernel, scene, traversal);
        draw(&wanted, &made, scene);
        assert_memory_equal(now.rgba, wanted.rgba, bytes);
        assert_memory_not_equal(now.rgba, before.rgba, bytes);
        turner_renderer_destroy(&made);
        turner_image_destroy(&wanted);
        turner_image_destroy(&before);
        before = now;
    }
    scene->instance_count--;
    assert_ok(turner_renderer_move(&moved, scene, &fits));
    assert_false(fits);
    scene->instance_count++;
    turner_image_destroy(&before);
    turner_renderer_destroy(&moved);
    turner_kernel_destroy(&kernel);
    turner_scene_destroy(scene);
}

static void by_packets(void **state)
{
    (void)state;
    check(TURNER_TRAVERSAL_BVH, TURNER_PRECISION_F32);
}

static void by_lanes(void **state)
{
    (void)state;
    check(TURNER_TRAVERSAL_BVH_LANE, TURNER_PRECISION_F32);
    if (gpu.info.float64)
        check(TURNER_TRAVERSAL_BVH_LANE, TURNER_PRECISION_F64);
}

static void by_the_device(void **state)
{
    (void)state;
    if (!gpu.info.ray_query)
        skip();
    check(TURNER_TRAVERSAL_RAY_QUERY, TURNER_PRECISION_F32);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(by_packets),
        cmocka_unit_test(by_lanes),
        cmocka_unit_test(by_the_device),
    };
    open_device(&gpu);
    return close_device(&gpu, cmocka_run_group_tests(tests, NULL, NULL));
}
