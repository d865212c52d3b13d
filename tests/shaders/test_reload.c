/* Shaders edited while they are in use: 200 random edits, half of them broken, and what each part of
 * the interface promises. */
#include "reload_bench.h"

#include <time.h>
#include <unistd.h>

#define SCENE                                                                                      \
    "{\"version\": 1, \"camera\": {\"from\": [0, 0, 5], \"at\": [0, 0, 0]},"                      \
    " \"settings\": {\"size\": [8, 8]}}"
#define EDITS 200

static struct reload_bench bench;

static void background(char text[512], int value)
{
    snprintf(text, 512, "vec3 user_background(vec3 direction)\n{\n    return vec3(%d.0);\n}\n", value);
}

static void expect_color(float red)
{
    float color[4];
    bench_color(&bench, color);
    assert_true(color[0] == red);
}

static void expect_message(const char *words)
{
    assert_int_equal(turner_reload_state(bench.reload), TURNER_RELOAD_BROKEN);
    if (!strstr(turner_reload_message(bench.reload), words))
        fail_msg("\"%s\" lacks \"%s\"", turner_reload_message(bench.reload), words);
}

static void follows_edits(void **state)
{
    (void)state;
    char text[512];
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_CURRENT);
    expect_color(0);
    background(text, 3);
    bench_write(&bench, "background.glsl", text, false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    assert_int_equal(turner_reload_poll(bench.reload), TURNER_RELOAD_CURRENT);
    assert_true(turner_reload_seconds(bench.reload) > 0);
    expect_color(3);
    bench_write(&bench, "background.glsl", text, true); /* the same again */
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_CURRENT);

    bench_write(&bench, "background.glsl", "#include \"user/gone.glsl\"\n", false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_BROKEN);
    expect_message("user/background.glsl:1:1: \"user/gone.glsl\" is neither in");
    expect_color(3);
    bench_write(&bench, "gone.glsl", "vec3 user_background(vec3 d) { return vec3(4) }\n", false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_BROKEN);
    expect_message("user/gone.glsl:1:47: ");
    expect_message("return vec3(4) }");
    bench_write(&bench, "gone.glsl", "vec3 user_background(vec3 d) { return vec3(4); }\n", true);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    assert_string_equal(turner_reload_message(bench.reload), "");
    expect_color(4);

    bench_write(&bench, "post.glsl", "vec3 user_post(vec3 c, vec2 p, vec2 s) { return c + 1.0; }\n",
                false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    expect_color(5);
    bench_write(&bench, "post.glsl", "vec3 user_post(vec3 c, vec2 p, vec2 s) { return d; }\n", false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_BROKEN);
    expect_message("user/post.glsl:1:49: ");
    expect_color(5);
    bench_write(&bench, "post.glsl", NULL, false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    expect_color(4);
    bench_write(&bench, "background.glsl", NULL, false);
    bench_write(&bench, "gone.glsl", NULL, false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    expect_color(0);
}

static void write_with_parameters(int standard)
{
    char text[512];
    snprintf(text, sizeof text,
             "//!PARAM live float %d 0 9 \"\"\n"
             "//!PARAM count const int 2 0 9 \"\"\n"
             "vec3 user_background(vec3 d) { return vec3(live * float(count)); }\n", standard);
    bench_write(&bench, "background.glsl", text, false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    expect_color(2 * (float)standard);
}

static void sets_parameters(void **state)
{
    (void)state;
    write_with_parameters(3);
    write_with_parameters(1); /* only a default is another one */
    assert_int_equal(bench.renderer.params.params.count, 2);
    turner_scene_set_param(bench.scene, "live", "4");
    assert_ok(turner_reload_set_params(bench.reload, bench.scene));
    assert_int_equal(turner_reload_poll(bench.reload), TURNER_RELOAD_CURRENT); /* at once */
    expect_color(8);
    turner_scene_set_param(bench.scene, "count", "3");
    assert_ok(turner_reload_set_params(bench.reload, bench.scene));
    assert_int_equal(turner_reload_poll(bench.reload), TURNER_RELOAD_BUILDING);
    expect_color(8); /* the old one goes on */
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    expect_color(12);
    turner_scene_set_param(bench.scene, "live", "10");
    assert_int_equal(turner_reload_set_params(bench.reload, bench.scene), TURNER_USAGE);
    expect_color(12);
    turner_scene_set_param(bench.scene, "live", "1");
    turner_scene_set_param(bench.scene, "count", "2");
    assert_ok(turner_reload_set_params(bench.reload, bench.scene));
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
    bench_write(&bench, "background.glsl", NULL, false);
    assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
}

/* Files that changed after the kernel was made and before they were watched. */
static void begins_late(void **state)
{
    (void)state;
    const char *const dirs[] = {bench.folder};
    const struct turner_render_options options = {.shader_dirs = dirs, .shader_dir_count = 1};
    char text[512];
    background(text, 6);
    for (int there = 1; there >= 0; there--) {
        turner_reload_destroy(bench.reload);
        bench_write(&bench, "background.glsl", there ? text : NULL, false);
        assert_ok(turner_reload_create(&bench.reload, &bench.renderer, bench.scene, &options,
                                       turner_watch_now()));
        assert_int_equal(bench_settle(&bench), TURNER_RELOAD_READY);
        expect_color(there ? 6 : 0);
    }
}

/* ---- random edits ---- */

static uint32_t dice = 1;

static int roll(int sides) /* PCG, O'Neill 2014 */
{
    dice = dice * 747796405u + 2891336453u;
    uint32_t word = ((dice >> ((dice >> 28) + 4)) ^ dice) * 277803737u;
    return (int)(((word >> 22) ^ word) % (uint32_t)sides);
}

/* One edit of the background, broken or not. Returns the colour it should have, −1 when broken. */
static int edit(bool broken)
{
    static const char *const breaks[] = {
        "vec3 user_background(vec3 d) { return vec3(1.0) }\n",
        "vec3 user_background(vec3 d) { return nothing; }\n",
        "//!PARAM x float 3 0 2 \"\"\n",
        "#include \"user/none.glsl\"\n",
        "#if 1\n",
        "/* never ended",
        "",
        "vec3 user_background(vec3 d) { return vec3(",
        "\x01\xff\xfe } } ;\n",
        "int main; void main() {}\n",
    };
    char text[512];
    int value = roll(8);
    bool rename_it = roll(2);
    if (broken) {
        bench_write(&bench, "background.glsl", breaks[roll(10)], rename_it);
        return -1;
    }
    if (roll(8) == 0) {
        bench_write(&bench, "background.glsl", NULL, false);
        return 0;
    }
    background(text, value);
    bench_write(&bench, "background.glsl", text, rename_it);
    return value;
}

static void survives_random_edits(void **state)
{
    (void)state;
    int shown = 0, expected = 0, hasty = 0;
    for (int i = 0; i < EDITS; i++) {
        expected = edit(i % 2);
        enum turner_reload_state now = turner_reload_poll(bench.reload);
        if (expected < 0) /* what was ready before the edit is not any more */
            assert_true(now == TURNER_RELOAD_BUILDING || now == TURNER_RELOAD_BROKEN);
        else if (expected != shown)
            assert_true(now == TURNER_RELOAD_BUILDING);
        if (i + 1 < EDITS && roll(3) == 0) { /* the next comes before this is done */
            nanosleep(&(struct timespec){.tv_nsec = 1000000l * roll(60)}, NULL);
            hasty++;
            continue;
        }
        now = bench_settle(&bench);
        assert_int_equal(now == TURNER_RELOAD_BROKEN, expected < 0);
        if (expected < 0)
            assert_true(strlen(turner_reload_message(bench.reload)) > 10);
        else
            shown = expected;
        expect_color((float)shown);
    }
    assert_true(hasty > EDITS / 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(follows_edits),
        cmocka_unit_test(sets_parameters),
        cmocka_unit_test(begins_late),
        cmocka_unit_test(survives_random_edits),
    };
    bench_open(&bench, SCENE, false, true);
    return bench_close(&bench, cmocka_run_group_tests(tests, NULL, NULL));
}
