/* Previews of saved hooks (render/preview.h) against the picture that follows. */
#include "reload_bench.h"

#include <math.h>
#include <time.h>

#define WIDTH 96
#define HEIGHT 64

/* All kinds of primitives and lights, shadows, a pattern, an instance, a medium around the camera. */
#define SCENE                                                                                      \
    "{\"version\": 1, \"camera\": {\"from\": [1, 2, 6], \"at\": [0, 0.5, 0], \"vfov\": 45},"      \
    " \"settings\": {\"size\": [8, 8], \"depth\": %d}, \"ambient\": 0.1, \"background\": [0.2, 0.3, 0.5]," \
    " \"materials\": {"                                                                            \
    "  \"floor\": {\"k_d\": 0.7, \"pattern\": {\"type\": \"checker\", \"colors\": [\"#d02020\", \"#e8c840\"]}}," \
    "  \"shiny\": {\"k_d\": [0.2, 0.4, 0.8], \"k_s\": 0.4, \"exponent\": 30},"                   \
    "  \"lamp\": {\"k_e\": [0.5, 0.2, 0.1]},"                                                    \
    "  \"mirror\": {\"k_d\": 0.1, \"k_r\": 0.8}, \"glass\": {\"k_t\": 1, \"k_r\": 1, \"index\": 1.5}}," \
    " \"primitives\": ["                                                                           \
    "  {\"type\": \"plane\", \"point\": [0, 0, 0], \"normal\": [0, 1, 0], \"material\": \"floor\"}," \
    "  {\"type\": \"sphere\", \"center\": [-1.2, 0.7, 0], \"radius\": 0.7, \"material\": \"shiny\"}," \
    "  {\"type\": \"sphere\", \"center\": [0, 2.2, -1], \"radius\": 0.3, \"material\": \"lamp\"}," \
    "  {\"type\": \"cylinder\", \"base\": [0.3, 0, -0.5], \"apex\": [0.3, 1.2, -0.5], \"radius\": 0.3, \"material\": \"shiny\"}," \
    "  {\"type\": \"box\", \"min\": [1.2, 0, -0.6], \"max\": [2.4, 1.2, 0.1], \"material\": \"floor\"}%s]," \
    " \"lights\": ["                                                                               \
    "  {\"type\": \"point\", \"position\": [3, 4, 4], \"intensity\": 20},"                         \
    "  {\"type\": \"directional\", \"direction\": [1, -2, -1], \"irradiance\": 0.6},"              \
    "  {\"type\": \"spot\", \"position\": [-3, 4, 2], \"direction\": [1, -1.4, -0.8], \"intensity\": 25,"  \
    "   \"inner\": 15, \"outer\": 30}]}"
#define GLOSSY                                                                                     \
    ",{\"type\": \"sphere\", \"center\": [0.6, 0.5, 1.2], \"radius\": 0.5, \"material\": \"mirror\"}," \
    "{\"type\": \"sphere\", \"center\": [-0.5, 0.4, 1.8], \"radius\": 0.4, \"material\": \"glass\"}"

static struct reload_bench bench;

static struct turner_image drawn(void)
{
    static const struct turner_render_options defaults;
    struct turner_statistics statistics = {0};
    struct turner_image image;
    assert_ok(turner_image_create(&image, WIDTH, HEIGHT));
    assert_ok(turner_renderer_look(&bench.renderer, bench.scene));
    assert_ok(turner_renderer_draw(&bench.renderer, &image, &defaults, &statistics));
    return image;
}

static bool note(double share, void *seen)
{
    (void)share;
    *(bool *)seen = true;
    return true;
}

/* Until what is visible has been remembered. */
static void rest(void)
{
    bool seen = false;
    const struct turner_render_options options = {.progress = note, .user = &seen};
    turner_reload_forget(bench.reload);
    for (double end = turner_seconds() + 60; !seen; nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL)) {
        assert_true(turner_seconds() < end);
        assert_int_equal(turner_reload_poll(bench.reload), TURNER_RELOAD_CURRENT);
        assert_ok(turner_reload_rest(bench.reload, bench.scene, &options));
    }
}

/* Turns the finished picture into the preview of what was saved; false when there comes none. */
static bool preview(struct turner_image *image)
{
    for (double end = turner_seconds() + 60; turner_seconds() < end;) {
        enum turner_reload_state state = turner_reload_poll(bench.reload);
        if (turner_reload_has_preview(bench.reload)) {
            assert_ok(turner_reload_preview(bench.reload, image, bench.scene));
            assert_false(turner_reload_has_preview(bench.reload)); /* once */
            return true;
        }
        if (state != TURNER_RELOAD_BUILDING)
            return false;
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    fail_msg("neither a preview nor a kernel");
    return false;
}

/* The largest difference, where the largest value is about 1. */
static float difference(const struct turner_image *a, const struct turner_image *b)
{
    float most = 0;
    for (size_t i = 0; i < (size_t)WIDTH * HEIGHT * 4; i++)
        most = i % 4 < 3 ? fmaxf(most, fabsf(a->rgba[i] - b->rgba[i])) : most;
    return most;
}

static void saved(const char *name, const char *text)
{
    bench_write(&bench, name, text, true);
}

/* Every hook: what is seen without a mirror or glass is as it will be. */
static void previews_are_the_picture(void **state)
{
    (void)state;
    static const struct { const char *file, *text; } hooks[] = {
        {"brdf.glsl", "vec3 user_brdf(turner_gpu_material m, real3 N, real3 V, real3 L)\n"
                      "{ return 2.0 * local_illumination(m, N, V, L).bgr + 0.01; }\n"},
        {"surface.glsl", "//!PARAM deep const float 0.4 0 1 \"\"\n//!PARAM green float 0.3 0 1 \"\"\n"
                         "void user_surface(inout turner_gpu_material m, inout real3 ns, surface_t s)\n"
                         "{ m.k_d *= vec3(deep, 1.0 - green, abs(sin(3.0 * s.point.x)));\n"
                         "  ns = normalize(ns + 0.2 * real3(sin(9.0 * s.point.x), 0, 0)); }\n"},
        {"background.glsl", "vec3 user_background(vec3 d) { return abs(d) * 0.5; }\n"},
        {"light.glsl", "arrival_t user_light(turner_gpu_light l, uint i, real3 p)\n"
                       "{ arrival_t a = light_arrival(l, p); a.irradiance *= vec3(i, 1, 0.5); return a; }\n"},
    };
    bench.scene->settings.width = WIDTH;
    bench.scene->settings.height = HEIGHT;
    turner_reload_want_previews(bench.reload, true);
    for (size_t i = 0; i < sizeof hooks / sizeof *hooks; i++) {
        struct turner_image image = drawn(), after;
        rest();
        saved(hooks[i].file, hooks[i].text);
        struct turner_image before = drawn();
        assert_true(difference(&before, &image) == 0);
        assert_true(preview(&image));
        assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
        after = drawn();
        assert_true(difference(&before, &after) > 0.05f); /* it does change something */
        assert_true(difference(&image, &after) < 3e-6f);
        turner_image_destroy(&before);
        turner_image_destroy(&image);
        turner_image_destroy(&after);
    }
}

/* A hook that cannot be compiled has none, nor has a text that was saved over. */
static void none_of_what_is_not_there(void **state)
{
    (void)state;
    struct turner_image image = drawn(), before = drawn();
    rest();
    saved("background.glsl", "vec3 user_background(vec3 d) { return d }\n");
    assert_false(preview(&image));
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_BROKEN);
    saved("background.glsl", "vec3 user_background(vec3 d) { return vec3(0.25); }\n");
    assert_int_equal(turner_reload_poll(bench.reload), TURNER_RELOAD_BUILDING);
    nanosleep(&(struct timespec){.tv_nsec = 300000000}, NULL);
    saved("background.glsl", "vec3 user_background(vec3 d) { return vec3(0.75); }\n");
    assert_true(preview(&image));
    assert_float_equal(image.rgba[0], 0.75, 1e-6); /* the sky */
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    turner_image_destroy(&image);
    turner_image_destroy(&before);
}

/* The hook post makes no ray: the picture's kernel stays, which takes far longer to make, and so does
 * what is remembered. Both at once are made. */
static void post_alone(void **state)
{
    (void)state;
    struct turner_image image = drawn();
    rest();
    VkPipelineLayout layout = bench.renderer.program.layout;
    saved("post.glsl", "vec3 user_post(vec3 c, vec2 p, vec2 s) { return 0.5 * c; }\n");
    assert_false(preview(&image));
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    assert_true(bench.renderer.post.wanted);
    assert_ptr_equal(bench.renderer.program.layout, layout);
    saved("post.glsl", "vec3 user_post(vec3 c, vec2 p, vec2 s) { return 0.25 * c; }\n");
    saved("background.glsl", "vec3 user_background(vec3 d) { return vec3(0.5); }\n");
    assert_true(preview(&image));
    assert_float_equal(image.rgba[0], 0.5, 1e-6); /* before the new post */
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    saved("post.glsl", NULL);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    assert_false(bench.renderer.post.wanted);
    turner_image_destroy(&image);
}

/* What mirrors and glass show stays until the picture comes: the same hook in other words changes
 * nothing at all. */
static void other_light_stays(void **state)
{
    (void)state;
    bench.scene->settings.width = WIDTH;
    bench.scene->settings.height = HEIGHT;
    turner_reload_want_previews(bench.reload, true);
    struct turner_image image = drawn(), before = drawn();
    rest();
    saved("background.glsl", "vec3 user_background(vec3 d) { return background(1.0 * d); }\n");
    assert_true(preview(&image));
    assert_true(difference(&image, &before) == 0);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    turner_image_destroy(&image);
    turner_image_destroy(&before);
}

int main(void)
{
    char scene[8192];
    const struct CMUnitTest plain[] = {
        cmocka_unit_test(previews_are_the_picture),
        cmocka_unit_test(none_of_what_is_not_there),
        cmocka_unit_test(post_alone),
    };
    const struct CMUnitTest glossy[] = {
        cmocka_unit_test(other_light_stays),
    };
    snprintf(scene, sizeof scene, SCENE, 0, "");
    bench_open(&bench, scene, false, true);
    int failures = bench_close(&bench, cmocka_run_group_tests(plain, NULL, NULL));
    snprintf(scene, sizeof scene, SCENE, 5, GLOSSY);
    bench_open(&bench, scene, false, true);
    return failures + bench_close(&bench, cmocka_run_group_tests(glossy, NULL, NULL));
}
