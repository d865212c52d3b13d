/* test_switches SCENE: a kernel that has everything draws the same bytes as one that has only what
 * the scene needs, with both traversals. */
#include "render_test.h"

static struct rig rig;
static const char *path;

static void same_bytes(void **state)
{
    (void)state;
    struct turner_scene *scene;
    assert_ok(turner_scene_load(&scene, path));
    scene->settings.width = 64;
    scene->settings.height = 48;
    scene->settings.spp = 1;
    const struct turner_render_options all = {.unspecialised = true};
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        struct turner_image lean, full;
        struct turner_statistics lean_counts = {0}, full_counts = {0};
        draw(&rig, &lean, scene, traversal, NULL, &lean_counts);
        draw(&rig, &full, scene, traversal, &all, &full_counts);
        printf("%s: needs %#x, then %#x\n", turner_traversal_name(rig.kernels[traversal].kind), lean_counts.needs,
               full_counts.needs);
        assert_true(lean_counts.needs != full_counts.needs);
        assert_same_picture(&lean, &full, path);
        assert_int_equal(lean_counts.reflected_rays, full_counts.reflected_rays);
        assert_int_equal(lean_counts.refracted_rays, full_counts.refracted_rays);
        assert_int_equal(lean_counts.shadow_rays, full_counts.shadow_rays);
        assert_int_equal(lean_counts.tir_rays, full_counts.tir_rays);
        turner_image_destroy(&lean);
        turner_image_destroy(&full);
    }
    turner_scene_destroy(scene);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: test_switches SCENE\n");
        return 2;
    }
    path = argv[1];
    rig_open(&rig);
    const struct CMUnitTest tests[] = {cmocka_unit_test(same_bytes)};
    return rig_close(&rig, cmocka_run_group_tests(tests, NULL, NULL));
}
