/* Ray counts against the reference's, and which samples make a pixel. */
#include "render_test.h"

static struct rig rig;

#define LIGHTS "\"lights\": [{\"type\": \"point\", \"position\": [3, 5, 4], \"intensity\": 60}, " \
               "{\"type\": \"directional\", \"direction\": [1, -2, -1], \"irradiance\": 1}]"

/* No silhouette of these passes within 1e-4 of a pixel's centre, so both count the same. */
static void counts_are_the_references(void **state)
{
    (void)state;
    static const char *const scenes[] = {
        SCENE_HEAD ", \"settings\": {\"size\": [33, 21], \"depth\": 4}, \"background\": 0.3, "
        LIGHTS ", \"materials\": {\"grey\": {\"k_d\": 0.5, \"k_s\": 0.2, \"exponent\": 9}}, "
        "\"primitives\": [{\"type\": \"sphere\", \"center\": [0.1, 0.2, 0], \"radius\": 1, "
        "\"material\": \"grey\"}, {\"type\": \"plane\", \"point\": [0, -1, 0], \"normal\": "
        "[0, 1, 0], \"material\": \"grey\"}]}",
        SCENE_HEAD ", \"settings\": {\"size\": [33, 21], \"depth\": 6, \"cutoff\": 0}, "
        "\"background\": 0.3, " LIGHTS ", \"materials\": {\"mirror\": {\"k_r\": 0.8}, \"grey\": "
        "{\"k_d\": 0.5}}, \"primitives\": [{\"type\": \"sphere\", \"center\": [0.9, 0.2, 0], "
        "\"radius\": 0.8, \"material\": \"mirror\"}, {\"type\": \"box\", \"min\": [-2, -0.9, -1], "
        "\"max\": [-0.3, 0.7, 0.3], \"material\": \"mirror\"}, {\"type\": \"plane\", \"point\": "
        "[0, -1, 0], \"normal\": [0, 1, 0], \"material\": \"grey\"}]}",
        SCENE_HEAD ", \"settings\": {\"size\": [33, 21], \"depth\": 5, \"cutoff\": 0}, "
        "\"background\": 0.3, " LIGHTS ", \"materials\": {\"glass\": {\"k_r\": 1, \"k_t\": 1, "
        "\"index\": 1.5}, \"grey\": {\"k_d\": 0.5}}, \"primitives\": [{\"type\": \"box\", \"min\": "
        "[-1.3, -0.9, -0.6], \"max\": [1.1, 0.7, 0.3], \"material\": \"glass\"}, {\"type\": "
        "\"plane\", \"point\": [0, -1, 0], \"normal\": [0, 1, 0], \"material\": \"grey\"}]}",
    };
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        struct turner_scene *scene = scene_of(scenes[i]);
        struct turner_image image;
        struct turner_reference_statistics truth;
        assert_ok(turner_reference_render(&image, scene, 0, &truth, NULL, NULL));
        turner_image_destroy(&image);
        for (int traversal = 0; traversal < rig.traversals; traversal++) {
            struct turner_statistics found = {0};
            draw(&rig, &image, scene, traversal, NULL, &found);
            turner_image_destroy(&image);
            printf("scene %zu, %s: %llu camera rays (%llu hit), %llu reflected (%llu totally), "
                   "%llu refracted, %llu shadow, depth %d\n", i, turner_traversal_name(rig.kernels[traversal].kind),
                   (unsigned long long)found.camera_rays, (unsigned long long)found.camera_hits,
                   (unsigned long long)found.reflected_rays, (unsigned long long)found.tir_rays,
                   (unsigned long long)found.refracted_rays,
                   (unsigned long long)found.shadow_rays, found.largest_depth);
            assert_int_equal(found.camera_rays, 33 * 21);
            assert_int_equal(found.camera_rays, truth.camera_rays);
            assert_int_equal(found.camera_hits, truth.camera_hits);
            assert_int_equal(found.reflected_rays, truth.reflected_rays);
            assert_int_equal(found.tir_rays, truth.tir_rays);
            assert_int_equal(found.refracted_rays, truth.refracted_rays);
            assert_int_equal(found.shadow_rays, truth.shadow_rays);
            assert_int_equal(found.largest_depth, truth.largest_depth);
        }
        turner_scene_destroy(scene);
    }
}

/* Does the ray through (x, y), in pixels of a 24×16 picture with a 40° view, meet the sphere of
 * radius 1 at the origin, seen from (0, 0, 5)? */
static bool meets(double x, double y)
{
    double s = 2 * tan(20 * 3.14159265358979323846 / 180) / 16;
    double u = (x - 12) * s, v = (8 - y) * s;
    /* distance of the line to the origin: 5·sin of the angle to the axis */
    return 25 * (u * u + v * v) < 1 + u * u + v * v;
}

/* docs/model.md "Camera", written out: n samples at ((i+½)/n, vdC₂(i) + 2^−(k+1)). A glowing ball
 * on black shows in each pixel how many of its samples hit. */
static void samples_lie_where_the_model_says(void **state)
{
    (void)state;
    static const double ones[][2] = {{0.5, 0.5}};
    static const double threes[][2] = {{1 / 6.0, 0.125}, {0.5, 0.625}, {5 / 6.0, 0.375}};
    static const double fours[][2] = {
        {0.125, 0.125}, {0.375, 0.625}, {0.625, 0.375}, {0.875, 0.875}};
    static const struct {
        int spp;
        const double (*at)[2];
    } cases[] = {{1, ones}, {3, threes}, {4, fours}};
    struct turner_scene *scene = scene_of(
        SCENE_HEAD ", \"settings\": {\"size\": [24, 16]}, \"materials\": {\"lamp\": {\"k_e\": 1}}, "
        "\"primitives\": [{\"type\": \"sphere\", \"center\": [0, 0, 0], \"radius\": 1, "
        "\"material\": \"lamp\"}]}");
    scene->camera.vfov = 40 * 3.14159265358979323846 / 180;
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        scene->settings.spp = cases[c].spp;
        struct turner_image images[1 + KERNELS]; /* reference, then the traversals */
        assert_ok(turner_reference_render(&images[0], scene, 0, NULL, NULL, NULL));
        for (int traversal = 0; traversal < rig.traversals; traversal++)
            draw(&rig, &images[1 + traversal], scene, traversal, NULL, NULL);
        int partly = 0;
        for (int i = 0; i < 24 * 16; i++) {
            int hits = 0;
            for (int k = 0; k < cases[c].spp; k++)
                hits += meets(i % 24 + cases[c].at[k][0], i / 24 + cases[c].at[k][1]);
            partly += hits > 0 && hits < cases[c].spp;
            for (int image = 0; image <= rig.traversals; image++) {
                double found = (double)images[image].rgba[4 * i] * cases[c].spp;
                if (fabs(found - hits) > 1e-6)
                    fail_msg("%d samples, pixel %d,%d: %g of them hit instead of %d (picture %d)",
                             cases[c].spp, i % 24, i / 24, found, hits, image);
            }
        }
        printf("%d samples: %d pixels are partly covered\n", cases[c].spp, partly);
        assert_true(cases[c].spp == 1 || partly > 10);
        for (int image = 0; image <= rig.traversals; image++)
            turner_image_destroy(&images[image]);
    }
    turner_scene_destroy(scene);
}

int main(void)
{
    rig_open(&rig);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_are_the_references),
        cmocka_unit_test(samples_lie_where_the_model_says),
    };
    return rig_close(&rig, cmocka_run_group_tests(tests, NULL, NULL));
}
