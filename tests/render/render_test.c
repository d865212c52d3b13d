#include "render_test.h"

#include "../truth/explain.h"

void rig_open(struct rig *rig)
{
    memset(rig, 0, sizeof *rig);
    open_device(&rig->gpu);
    if (!rig->gpu.info.ray_query)
        printf("ray_query is left out: %s lacks %s\n", rig->gpu.info.name, rig->gpu.info.missing);
    if (!rig->gpu.info.packets)
        printf("bvh_packet is left out: subgroups are not of 8 lanes\n");
    static const struct turner_render_options defaults;
    const unsigned kinds[KERNELS] = {TURNER_PACKET, 0, TURNER_RAY_QUERY};
    const bool able[KERNELS] = {rig->gpu.info.packets, true, rig->gpu.info.ray_query};
    for (int i = 0; i < KERNELS; i++) {
        if (!able[i])
            continue;
        if (turner_kernel_create(&rig->kernels[rig->traversals++], kinds[i], &defaults) !=
            TURNER_OK) {
            fprintf(stderr, "%s\n", turner_message());
            exit(1);
        }
    }
}

int rig_close(struct rig *rig, int failures)
{
    for (int traversal = 0; traversal < rig->traversals; traversal++)
        turner_kernel_destroy(&rig->kernels[traversal]);
    return close_device(&rig->gpu, failures);
}

struct turner_scene *scene_of(const char *text)
{
    struct turner_scene *scene;
    assert_ok(turner_scene_parse(&scene, text, strlen(text), "test.json"));
    return scene;
}

void draw(struct rig *rig, struct turner_image *image, const struct turner_scene *scene,
          int traversal, const struct turner_render_options *options,
          struct turner_statistics *statistics)
{
    static const struct turner_render_options defaults;
    struct turner_statistics unused = {0};
    struct turner_renderer renderer;
    if (!options)
        options = &defaults;
    if (!statistics)
        statistics = &unused;
    assert_ok(turner_image_create(image, scene->settings.width, scene->settings.height));
    assert_ok(turner_renderer_create(&renderer, &rig->gpu, &rig->kernels[traversal], scene, options,
                                     statistics));
    assert_ok(turner_renderer_draw(&renderer, image, options, statistics));
    turner_renderer_destroy(&renderer);
    assert_int_equal(statistics->unfinished, 0);
}

void assert_same_picture(const struct turner_image *a, const struct turner_image *b,
                         const char *what)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    for (int i = 0; i < a->width * a->height; i++) {
        const float *p = a->rgba + 4 * i, *q = b->rgba + 4 * i;
        if (memcmp(p, q, 4 * sizeof *p) != 0)
            fail_msg("%s: pixel %d,%d is %g %g %g, pruned %g, and %g %g %g, pruned %g", what,
                     i % a->width, i / a->width, (double)p[0], (double)p[1], (double)p[2],
                     (double)p[3], (double)q[0], (double)q[1], (double)q[2], (double)q[3]);
    }
}

void assert_true_picture(struct rig *rig, struct turner_scene *scene, double share)
{
    static const struct tolerance tolerance = {1e-4, 1e-3};
    struct turner_image truth, image;
    struct turner_world world;
    assert_ok(turner_reference_render(&truth, scene, 0, NULL, NULL, NULL));
    assert_ok(turner_world_create(&world, scene));
    int pixels = truth.width * truth.height;
    for (int traversal = 0; traversal < rig->traversals; traversal++) {
        const char *name = turner_traversal_name(rig->kernels[traversal].kind);
        draw(rig, &image, scene, traversal, NULL, NULL);
        int off = 0;
        for (int i = 0; i < pixels; i++) {
            const float *p = image.rgba + 4 * i, *q = truth.rgba + 4 * i;
            if (!is_off(p, q, tolerance))
                continue;
            off++;
            int x = i % truth.width, y = i / truth.width;
            if (explain(scene, &world, x, y, p, tolerance) == CAUSE_NONE)
                fail_msg("%s: pixel %d,%d is %g %g %g instead of %g %g %g", name, x, y,
                         (double)p[0], (double)p[1], (double)p[2], (double)q[0], (double)q[1],
                         (double)q[2]);
        }
        printf("  %s: %d of %d pixels off, all on edges\n", name, off, pixels);
        if (off > share * pixels)
            fail_msg("%s: too many", name);
        turner_image_destroy(&image);
    }
    turner_world_destroy(&world);
    turner_image_destroy(&truth);
}
