/* Rays that leave a surface do not meet it again, at any scale and anywhere, and not for the price
 * of what lies close above it.
 *
 * Lossless mirrors of every shape stand in a background of 1 and reflect once: each pixel is 1,
 * unless a reflected ray meets the convex body it left. Around a glowing ball with a black core
 * lies a clear shell, 4e-5 radii above it: a ray that leaves the shell too far in meets the core.
 *
 * The other methods of leaving do fail here, so this test can see it. */
#include <stdio.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/renderer.h"
#include "scene/methods.h"

#define SIZE 128

enum shape { SPHERE, CONE, CYLINDER, BOX, SHELL, SHAPES };
static const char *const names[SHAPES] = {"sphere", "cone", "cylinder", "box", "shell"};

static struct turner_gpu gpu;
static struct turner_kernel kernel;

static uint32_t add_material(struct turner_scene *scene, struct turner_material material)
{
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = material;
    return (uint32_t)scene->material_count - 1;
}

static void add_shape(struct turner_scene *scene, enum shape shape, double r, double at)
{
    struct turner_group *group = &scene->groups[0];
    struct turner_vec3 c = {at, -at, at};
    struct turner_vec3 up = {c.x + 0.3 * r, c.y + r, c.z}, down = {c.x, c.y - r, c.z};
    uint32_t material = add_material(
        scene, (struct turner_material){.k_r = {1, 1, 1}, .medium = TURNER_NONE});
    if (shape == SPHERE || shape == SHELL)
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
            (struct turner_sphere){c, r, material};
    if (shape == CONE || shape == CYLINDER)
        *TURNER_PUSH(group->cones, group->cone_count, group->cone_capacity) = (struct turner_cone){
            down, up, r, shape == CONE ? 0.2 * r : r, true, material};
    if (shape == BOX)
        turner_group_add_box(group, turner_vec3_of(c.x - r, c.y - r, c.z - r),
                             turner_vec3_of(c.x + r, c.y + r, c.z + r), material);
    if (shape == SHELL) { /* the mirror becomes the lamp */
        scene->settings.depth = 3; /* in and out past the ball */
        scene->materials[material] =
            (struct turner_material){.k_e = {1, 1, 1}, .medium = TURNER_NONE};
        *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) =
            (struct turner_medium){.index = 1};
        uint32_t clear = add_material(scene, (struct turner_material){.k_t = {1, 1, 1}});
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
            (struct turner_sphere){c, r * (1 + 4e-5), clear};
        uint32_t black = add_material(scene, (struct turner_material){.medium = TURNER_NONE});
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) =
            (struct turner_sphere){c, r * 0.9, black};
    }
    scene->camera.from = turner_vec3_of(c.x + r, c.y + 2 * r, c.z + 4 * r);
    scene->camera.at = c;
    scene->camera.vfov = 0.7;
}

/* Pixels that are not 1, with a method of leaving ("error_bound" is the default). */
static int wrong_pixels(enum shape shape, double r, double at, const char *offset)
{
    static const struct turner_render_options options;
    struct turner_scene *scene = turner_scene_create();
    scene->settings.width = scene->settings.height = SIZE;
    scene->settings.depth = 1;
    scene->settings.cutoff = 0;
    scene->background.color = turner_vec3_of(1, 1, 1);
    add_shape(scene, shape, r, at);
    if (turner_method_set(&scene->settings, "offset", offset) != TURNER_OK ||
        turner_scene_validate(scene) != TURNER_OK) {
        printf("%s\n", turner_message());
        exit(1);
    }
    struct turner_statistics statistics = {0};
    struct turner_renderer renderer;
    struct turner_image image;
    int wrong = 0;
    if (turner_renderer_create(&renderer, &gpu, &kernel, scene, &options, &statistics) !=
            TURNER_OK ||
        turner_image_create(&image, SIZE, SIZE) != TURNER_OK ||
        turner_renderer_draw(&renderer, &image, &options, &statistics) != TURNER_OK) {
        printf("%s\n", turner_message());
        exit(1);
    }
    for (int i = 0; i < SIZE * SIZE; i++)
        wrong += image.rgba[4 * i] != 1;
    turner_image_destroy(&image);
    turner_renderer_destroy(&renderer);
    turner_scene_destroy(scene);
    return wrong;
}

/* Methods that are known to fail, and where. */
static const struct {
    const char *offset;
    enum shape shape;
    double r, at; /* in radii */
} naive[] = {
    {"none", SPHERE, 1, 1e3},      {"none", CONE, 1, 1e3},        {"none", CYLINDER, 1, 1e3},
    {"none", SPHERE, 1e-4, 1e3},   {"none", SPHERE, 1e4, 1e3},
    {"tmin:1e-4", SPHERE, 1, 1e5}, {"tmin:1e-4", SPHERE, 100, 1e3}, {"tmin:1e-4", SHELL, 1, 0},
    {"tmin:1e-3", SPHERE, 1, 1e5}, {"tmin:1e-3", CONE, 1e4, 1e3}, {"tmin:1e-3", SHELL, 1, 0},
    {"ulp", SHELL, 1e-4, 0},
};

static int naive_that_hold(void)
{
    int count = 0;
    for (size_t i = 0; i < sizeof naive / sizeof *naive; i++) {
        double r = naive[i].r;
        int wrong = wrong_pixels(naive[i].shape, r, naive[i].at * r, naive[i].offset);
        printf("offset=%s, %s, radius %g, centre %g radii away: %d of %d pixels wrong%s\n",
               naive[i].offset, names[naive[i].shape], r, naive[i].at, wrong, SIZE * SIZE,
               wrong ? "" : ", though it is known to fail there");
        count += wrong == 0;
    }
    return count;
}

int main(void)
{
    static const struct turner_render_options options = {0};
    if (turner_gpu_create(&gpu, NULL, false) != TURNER_OK) {
        printf("skipped: %s\n", turner_message());
        return 77;
    }
    static const struct turner_methods methods;
    unsigned kind;
    if (turner_choose_kernel(&kind, &gpu.info, &methods, TURNER_TRAVERSAL_BVH) != TURNER_OK ||
        turner_kernel_create(&kernel, kind, &options) != TURNER_OK) {
        printf("%s\n", turner_message());
        return 1;
    }
    int failures = 0;
    for (int shape = 0; shape < SHAPES; shape++) {
        for (double r = 1e-6; r < 2e6; r *= 100) {
            /* in radii; a shell of 4e-5 is not there any more where floats are further apart */
            for (double at = 0; at <= (shape == SHELL ? 0 : 1e5); at = at ? at * 10 : 1) {
                int wrong = wrong_pixels((enum shape)shape, r, at * r, "error_bound");
                if (wrong)
                    printf("%s, radius %g, centre %g radii away: %d of %d pixels wrong\n",
                           names[shape], r, at, wrong, SIZE * SIZE);
                failures += wrong > 0;
            }
        }
        printf("%s: seen from 1e-6 to 1e6\n", names[shape]);
    }
    failures += naive_that_hold();
    turner_kernel_destroy(&kernel);
    turner_gpu_destroy(&gpu);
    return failures ? 1 : 0;
}
