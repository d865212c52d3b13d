/* The same picture, byte for byte, whatever the tile size, the threads, and how often it is drawn.
 *
 * test_repeat --draw TRAVERSAL FILE draws it in a process of its own. */
#include <errno.h>
#include <sys/wait.h>
#include <unistd.h>

#include "image/image.h"
#include "render_test.h"

#define SCENE TURNER_SOURCE_DIR "/scenes/water_glass.json" /* every kind of ray */

static struct rig rig;
static struct turner_scene *scene;
static const char *program;

static struct turner_scene *load(void)
{
    struct turner_scene *loaded;
    if (turner_scene_load(&loaded, SCENE) != TURNER_OK) {
        fprintf(stderr, "%s\n", turner_message());
        exit(1);
    }
    loaded->settings.width = 90; /* so that no tile size divides both */
    loaded->settings.height = 70;
    loaded->settings.spp = 2;
    return loaded;
}

static const char *name_of(int traversal)
{
    return turner_traversal_name(rig.kernels[traversal].kind);
}

static void tiles_and_times(void **state)
{
    (void)state;
    static const int tiles[] = {7, 16, 33, 128, 0, 0};
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        struct turner_image first, again;
        struct turner_statistics counts = {0};
        draw(&rig, &first, scene, traversal, NULL, &counts);
        for (size_t i = 0; i < sizeof tiles / sizeof *tiles; i++) {
            struct turner_render_options options = {.tile = tiles[i]};
            struct turner_statistics other = {0};
            char what[64];
            snprintf(what, sizeof what, "%s, tiles of %d", name_of(traversal), tiles[i]);
            draw(&rig, &again, scene, traversal, &options, &other);
            assert_same_picture(&first, &again, what);
            assert_int_equal(counts.shadow_rays, other.shadow_rays);
            assert_int_equal(counts.reflected_rays, other.reflected_rays);
            assert_int_equal(counts.refracted_rays, other.refracted_rays);
            turner_image_destroy(&again);
        }
        turner_image_destroy(&first);
    }
}

/* One renderer that draws twice: nothing of the first picture stays. */
static void one_renderer_twice(void **state)
{
    (void)state;
    static const struct turner_render_options defaults;
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        struct turner_renderer renderer;
        struct turner_image images[2];
        struct turner_statistics counts[2];
        memset(counts, 0, sizeof counts);
        assert_ok(turner_renderer_create(&renderer, &rig.gpu, &rig.kernels[traversal], scene,
                                         &defaults, &counts[0]));
        for (int i = 0; i < 2; i++) {
            assert_ok(turner_image_create(&images[i], 90, 70));
            assert_ok(turner_renderer_draw(&renderer, &images[i], &defaults, &counts[i]));
        }
        turner_renderer_destroy(&renderer);
        assert_same_picture(&images[0], &images[1], name_of(traversal));
        assert_int_equal(counts[0].shadow_rays, counts[1].shadow_rays);
        assert_int_equal(counts[0].camera_rays, counts[1].camera_rays);
        turner_image_destroy(&images[0]);
        turner_image_destroy(&images[1]);
    }
}

/* Draws in a process of its own with so many threads of lavapipe (others ignore the variable). */
static void draw_elsewhere(struct turner_image *image, int traversal, const char *threads)
{
    char path[] = "/tmp/turner-repeat-XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        setenv("LP_NUM_THREADS", threads, 1);
        execl(program, program, "--draw", name_of(traversal), path, (char *)NULL);
        _exit(126);
    }
    int status;
    while (waitpid(child, &status, 0) < 0)
        assert_int_equal(errno, EINTR);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_ok(turner_image_create(image, 90, 70));
    size_t bytes = (size_t)90 * 70 * 4 * sizeof(float);
    assert_int_equal(read(file, image->rgba, bytes), (ssize_t)bytes);
    close(file);
    unlink(path);
}

static int draw_here(const char *traversal, const char *path)
{
    struct turner_image image;
    const struct turner_render_options options = {
        .traversal = strcmp(traversal, "bvh_lane") == 0     ? TURNER_TRAVERSAL_BVH_LANE
                     : strcmp(traversal, "bvh_packet") == 0 ? TURNER_TRAVERSAL_BVH_PACKET
                                                            : TURNER_TRAVERSAL_RAY_QUERY};
    if (turner_render(&image, load(), &options, NULL) != TURNER_OK) {
        fprintf(stderr, "%s\n", turner_message());
        return 1;
    }
    FILE *file = fopen(path, "wb");
    size_t count = (size_t)image.width * (size_t)image.height * 4;
    bool written = file && fwrite(image.rgba, sizeof(float), count, file) == count;
    if (file)
        written &= fclose(file) == 0;
    return written && !turner_gpu_validation_count() ? 0 : 1;
}

static void threads_of_the_device(void **state)
{
    (void)state;
    static const char *const threads[] = {"0", "1", "2"};
    for (int traversal = 0; traversal < rig.traversals; traversal++) {
        struct turner_image first, other;
        draw(&rig, &first, scene, traversal, NULL, NULL);
        for (int i = 0; i < 3; i++) {
            char what[64];
            snprintf(what, sizeof what, "%s, LP_NUM_THREADS=%s", name_of(traversal), threads[i]);
            draw_elsewhere(&other, traversal, threads[i]);
            assert_same_picture(&first, &other, what);
            turner_image_destroy(&other);
        }
        turner_image_destroy(&first);
    }
}

static void threads_of_the_reference(void **state)
{
    (void)state;
    struct turner_scene *small = load();
    small->settings.width = 45;
    small->settings.height = 35;
    struct turner_image first, other;
    struct turner_reference_statistics counts, other_counts;
    assert_ok(turner_reference_render(&first, small, 1, &counts, NULL, NULL));
    for (int threads = 2; threads <= 3; threads++) {
        assert_ok(turner_reference_render(&other, small, threads, &other_counts, NULL, NULL));
        assert_same_picture(&first, &other, "reference");
        assert_memory_equal(&counts, &other_counts, sizeof counts);
        turner_image_destroy(&other);
    }
    turner_image_destroy(&first);
    turner_scene_destroy(small);
}

int main(int argc, char **argv)
{
    if (argc == 4 && strcmp(argv[1], "--draw") == 0)
        return draw_here(argv[2], argv[3]);
    program = argv[0];
    rig_open(&rig);
    scene = load();
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_and_times),
        cmocka_unit_test(one_renderer_twice),
        cmocka_unit_test(threads_of_the_device),
        cmocka_unit_test(threads_of_the_reference),
    };
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    turner_scene_destroy(scene);
    return rig_close(&rig, failures);
}
