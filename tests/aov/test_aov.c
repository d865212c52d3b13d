/* The layers of one scene against the reference:
 *
 *   test_aov SCENE bvh | ray_query | f64 [plain]
 *
 * plain: also that the picture is the same without layers.
 *
 * Where the reference meets the same primitive within RADIUS of a pixel's centre, so must the
 * device, and its normal, albedo, position and depth may differ from the reference's by as much as
 * the reference's own do within RADIUS, and by rounding (see `slack`). At an edge, where the
 * reference meets several, the device must meet one of them. */
#include "../gpu/gpu_test.h"
#include "../truth/explain.h"
#include "reference/trace.h"
#include "render/features.h"
#include "render/layers.h"
#include "scene/ids.h"
#include "scene/readers.h"

#define WIDTH 64
#define HEIGHT 48
#define PIXELS (WIDTH * HEIGHT)
#define PROBES 16
#define RADIUS 1e-3 /* pixels; the direction of a float ray is off by some 1e-5 */
#define ALL ((1u << TURNER_LAYERS) - 1 - (1u << TURNER_LAYER_ERROR))

static struct turner_gpu gpu;
static struct turner_kernel kernel;
static struct turner_scene *scene;
static struct turner_world world;
static struct turner_ids ids;
static struct turner_layers truth; /* the reference's */
static struct turner_reference_statistics truth_counts;
static struct turner_layers layers; /* the device's */
static struct turner_statistics counts;
static struct turner_image image;

static uint32_t id_of(const struct turner_place *place)
{
    return place->instance == TURNER_INSTANCE_PLANES
               ? 1 + place->primitive
               : turner_id_of(&ids, (uint32_t)place->instance, place->primitive);
}

/* ---- what the reference says around a pixel's centre ---- */

struct around {
    uint32_t ids[PROBES];
    bool edge;
    double normal, albedo, position, depth; /* largest difference to the centre's */
};

static double apart(turner_vector a, turner_vector b)
{
    return (double)fmaxl(fmaxl(fabsl(a.x - b.x), fabsl(a.y - b.y)), fabsl(a.z - b.z));
}

static bool probe(struct turner_first_hit *first, double x, double y)
{
    struct turner_vec3 d = explain_direction(scene, x, y), eye = scene->camera.from;
    return turner_trace_first_hit(first, &world, (turner_vector){eye.x, eye.y, eye.z},
                                  (turner_vector){d.x, d.y, d.z});
}

static struct around look_around(int x, int y)
{
    struct around around = {0};
    struct turner_first_hit center, first;
    uint32_t center_id = probe(&center, x + 0.5, y + 0.5) ? id_of(&center.place) : 0;
    for (int i = 0; i < PROBES; i++) {
        double r = i % 2 ? RADIUS : RADIUS / 2, angle = 2 * 3.14159265358979 * i / PROBES;
        bool found = probe(&first, x + 0.5 + r * cos(angle), y + 0.5 + r * sin(angle));
        around.ids[i] = found ? id_of(&first.place) : 0;
        around.edge = around.edge || around.ids[i] != center_id;
        around.normal = fmax(around.normal, apart(first.normal, center.normal));
        around.albedo = fmax(around.albedo, apart(first.albedo, center.albedo));
        around.position = fmax(around.position, apart(first.position, center.position));
        around.depth = fmax(around.depth, (double)fabsl(first.depth - center.depth));
    }
    return around;
}

/* ---- one pixel of the device ---- */

static double off(const float *a, const float *b, int count)
{
    double largest = 0;
    for (int i = 0; i < count; i++) {
        double difference = fabs((double)a[i] - (double)b[i]);
        if (!(difference <= largest)) /* NaN, too */
            largest = a[i] == b[i] ? largest : difference; /* both infinite is the same */
    }
    return largest;
}

struct worst {
    double normal, albedo, position, depth;
    int edges;
};

/* Takes what `found` exceeds `allowed` by, in units of `slack`, into *worst. */
static void judge(double *worst, const char *what, int pixel, double found, double allowed,
                  double slack)
{
    double excess = (found - allowed) / slack;
    if (!(excess <= 1))
        fail_msg("%s of pixel %d,%d is off by %g, where the reference varies by %g, and rounding "
                 "explains %g", what, pixel % WIDTH, pixel / WIDTH, found, allowed, slack);
    *worst = fmax(*worst, excess);
}

static void check_pixel(struct worst *worst, int pixel)
{
    float *const *real = layers.real, *const *true_real = truth.real;
    struct around around = look_around(pixel % WIDTH, pixel / WIDTH);
    uint32_t id = layers.whole[TURNER_LAYER_ID][pixel];
    uint32_t true_id = truth.whole[TURNER_LAYER_ID][pixel];
    if (around.edge) {
        bool known = id == true_id;
        for (int i = 0; i < PROBES; i++)
            known = known || id == around.ids[i];
        if (!known)
            fail_msg("pixel %d,%d on an edge: the device sees %u, the reference around it %u and "
                     "others", pixel % WIDTH, pixel / WIDTH, id, true_id);
        worst->edges++;
        return;
    }
    if (id != true_id)
        fail_msg("pixel %d,%d: the device sees %u, the reference %u", pixel % WIDTH,
                 pixel / WIDTH, id, true_id);
    double depth = (double)true_real[TURNER_LAYER_DEPTH][pixel];
    double size = id ? depth + turner_vec3_length(scene->camera.from) : 1;
    judge(&worst->normal, "normal", pixel,
          off(real[TURNER_LAYER_NORMAL] + 3 * pixel, true_real[TURNER_LAYER_NORMAL] + 3 * pixel, 3),
          around.normal, 1e-6);
    judge(&worst->albedo, "albedo", pixel,
          off(real[TURNER_LAYER_ALBEDO] + 3 * pixel, true_real[TURNER_LAYER_ALBEDO] + 3 * pixel, 3),
          around.albedo, 1e-6);
    judge(&worst->position, "position", pixel,
          off(real[TURNER_LAYER_POSITION] + 3 * pixel,
              true_real[TURNER_LAYER_POSITION] + 3 * pixel, 3),
          around.position, 1e-6 * size);
    judge(&worst->depth, "depth", pixel,
          off(real[TURNER_LAYER_DEPTH] + pixel, true_real[TURNER_LAYER_DEPTH] + pixel, 1),
          around.depth, 1e-6 * size);
}

/* ---- tests ---- */

static void require(enum turner_result result)
{
    if (result == TURNER_OK)
        return;
    fprintf(stderr, "%s\n", turner_message());
    exit(1);
}

/* `wanted` may be NULL. */
static void draw(struct turner_image *picture, struct turner_layers *wanted,
                 struct turner_statistics *statistics)
{
    struct turner_renderer renderer;
    struct turner_render_options options = {.layers = wanted};
    require(turner_image_create(picture, WIDTH, HEIGHT));
    if (wanted)
        require(turner_layers_create(wanted, scene));
    require(turner_renderer_create(&renderer, &gpu, &kernel, scene, &options, statistics));
    if (wanted)
        require(turner_features_draw(wanted, &renderer, &kernel, scene, &options, statistics));
    require(turner_renderer_draw(&renderer, picture, &options, statistics));
    if (wanted)
        turner_layers_inspect(wanted, picture);
    turner_renderer_destroy(&renderer);
}

static void layers_are_the_references(void **state)
{
    (void)state;
    struct worst worst = {0};
    for (int i = 0; i < PIXELS; i++)
        check_pixel(&worst, i);
    printf("  %d pixels on edges; of what is allowed to rounding, normals used %.2f, albedos %.2f, "
           "positions %.2f, depths %.2f\n", worst.edges, worst.normal, worst.albedo,
           worst.position, worst.depth);
    assert_true(worst.edges <= 0.01 * PIXELS);
}

struct totals {
    uint64_t rays;
    uint32_t recursion;
};

static struct totals totals_of(const struct turner_layers *of)
{
    struct totals totals = {0};
    for (int i = 0; i < PIXELS; i++) {
        uint32_t recursion = of->whole[TURNER_LAYER_RECURSION][i];
        totals.rays += of->whole[TURNER_LAYER_RAYS][i];
        totals.recursion = recursion > totals.recursion ? recursion : totals.recursion;
    }
    return totals;
}

/* The sums over the picture are what is counted without layers; pixel by pixel the device counts
 * what the reference does, but for those few whose rays part from the reference's at some edge. */
static void counts_add_up(void **state)
{
    (void)state;
    struct totals totals = totals_of(&truth);
    assert_int_equal(totals.rays, truth_counts.camera_rays + truth_counts.reflected_rays +
                                      truth_counts.refracted_rays + truth_counts.shadow_rays);
    assert_int_equal(totals.recursion, truth_counts.largest_depth);
    totals = totals_of(&layers);
    assert_int_equal(totals.rays, counts.camera_rays + counts.reflected_rays +
                                      counts.refracted_rays + counts.shadow_rays);
    assert_int_equal(totals.recursion, counts.largest_depth);
    int same = 0;
    for (int i = 0; i < PIXELS; i++) {
        same += layers.whole[TURNER_LAYER_RAYS][i] == truth.whole[TURNER_LAYER_RAYS][i] &&
                layers.whole[TURNER_LAYER_RECURSION][i] == truth.whole[TURNER_LAYER_RECURSION][i];
        assert_int_equal(layers.whole[TURNER_LAYER_SAMPLES][i], scene->settings.spp);
        assert_int_equal(layers.whole[TURNER_LAYER_NONFINITE][i], 0);
        assert_memory_equal(&layers.real[TURNER_LAYER_PRUNED][i], image.rgba + 4 * i + 3,
                            sizeof(float));
    }
    printf("  rays and recursion are the reference's in %d of %d pixels\n", same, PIXELS);
    assert_true(same >= 0.998 * PIXELS);
}

static void layers_change_no_picture(void **state)
{
    (void)state;
    struct turner_image plain;
    struct turner_statistics statistics = {0};
    draw(&plain, NULL, &statistics);
    assert_memory_equal(plain.rgba, image.rgba, PIXELS * 4 * sizeof *plain.rgba);
    turner_image_destroy(&plain);
}

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    bool ray_query = strcmp(argv[2], "ray_query") == 0, f64 = strcmp(argv[2], "f64") == 0;
    open_device(&gpu);
    if (ray_query && !gpu.info.ray_query) {
        printf("skipped: %s lacks %s\n", gpu.info.name, gpu.info.missing);
        return 77;
    }
    if (f64 && !gpu.info.float64) {
        printf("skipped: %s has no 64-bit floats\n", gpu.info.name);
        return 77;
    }
    require(turner_scene_load(&scene, argv[1]));
    if (f64)
        scene->settings.methods.precision = TURNER_PRECISION_F64;
    scene->settings.width = WIDTH;
    scene->settings.height = HEIGHT;
    scene->settings.spp = 2; /* so that sums over samples are made */
    require(turner_world_create(&world, scene));
    require(turner_ids_create(&ids, scene));
    truth.wanted = ALL;
    require(turner_layers_create(&truth, scene));
    require(turner_reference_render_layers(&image, &truth, scene, 0, &truth_counts, NULL, NULL));
    turner_image_destroy(&image);
    static const struct turner_render_options defaults;
    unsigned kind;
    require(turner_choose_kernel(&kind, &gpu.info, &scene->settings.methods,
                                 ray_query ? TURNER_TRAVERSAL_RAY_QUERY : TURNER_TRAVERSAL_BVH));
    require(turner_kernel_create(&kernel, kind, &defaults));
    layers.wanted = ALL;
    draw(&image, &layers, &counts);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layers_are_the_references),
        cmocka_unit_test(counts_add_up),
    };
    const struct CMUnitTest plain[] = {cmocka_unit_test(layers_change_no_picture)};
    int failures = cmocka_run_group_tests(tests, NULL, NULL);
    if (argc > 3)
        failures += cmocka_run_group_tests(plain, NULL, NULL);
    turner_image_destroy(&image);
    turner_layers_destroy(&layers);
    turner_layers_destroy(&truth);
    turner_world_destroy(&world);
    turner_ids_destroy(&ids);
    turner_kernel_destroy(&kernel);
    turner_scene_destroy(scene);
    return close_device(&gpu, failures);
}
