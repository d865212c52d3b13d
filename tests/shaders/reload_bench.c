#include "reload_bench.h"

#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static void remove_all(const char *folder)
{
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0)
        fprintf(stderr, "%s cannot be removed\n", folder);
}

void bench_open(struct reload_bench *bench, const char *scene, bool no_cache, bool validation)
{
    struct turner_statistics statistics = {0};
    char user[96];
    unsigned kind;
    *bench = (struct reload_bench){.folder = "/tmp/turner-reload-XXXXXX"};
    assert_non_null(mkdtemp(bench->folder));
    snprintf(user, sizeof user, "%s/user", bench->folder);
    assert_int_equal(mkdir(user, 0700), 0);
    const char *const dirs[] = {bench->folder};
    const struct turner_render_options options = {
        .shader_dirs = dirs, .shader_dir_count = 1, .no_cache = no_cache};
    if (validation)
        open_device(&bench->gpu);
    else
        assert_ok(turner_gpu_create(&bench->gpu, NULL, false));
    if (*scene == '{')
        assert_ok(turner_scene_parse(&bench->scene, scene, strlen(scene), "test.json"));
    else
        assert_ok(turner_scene_load(&bench->scene, scene));
    bench->scene->settings.width = bench->scene->settings.height = 8;
    struct timespec since = turner_watch_now();
    assert_ok(turner_choose_kernel(&kind, &bench->gpu.info, &bench->scene->settings.methods,
                                   TURNER_TRAVERSAL_AUTO));
    assert_ok(turner_kernel_create(&bench->kernel, kind, &options));
    assert_ok(turner_renderer_create(&bench->renderer, &bench->gpu, &bench->kernel, bench->scene,
                                     &options, &statistics));
    assert_ok(turner_reload_create(&bench->reload, &bench->renderer, bench->scene, &options, since));
}

int bench_close(struct reload_bench *bench, int failures)
{
    turner_reload_destroy(bench->reload);
    turner_renderer_destroy(&bench->renderer);
    turner_kernel_destroy(&bench->kernel);
    turner_scene_destroy(bench->scene);
    remove_all(bench->folder);
    return close_device(&bench->gpu, failures);
}

void bench_write(const struct reload_bench *bench, const char *name, const char *text,
                 bool rename_it)
{
    char path[256], aside[256];
    snprintf(path, sizeof path, "%s/user/%s", bench->folder, name);
    snprintf(aside, sizeof aside, "%s/user/%s~", bench->folder, name);
    if (!text) {
        unlink(path);
        return;
    }
    FILE *file = fopen(rename_it ? aside : path, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    if (rename_it)
        assert_int_equal(rename(aside, path), 0);
}

enum turner_reload_state bench_settle(struct reload_bench *bench)
{
    double end = turner_seconds() + 60;
    enum turner_reload_state state;
    while ((state = turner_reload_poll(bench->reload)) == TURNER_RELOAD_BUILDING) {
        assert_true(turner_seconds() < end);
        nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
    }
    if (state == TURNER_RELOAD_READY)
        assert_ok(turner_reload_swap(bench->reload, &bench->kernel, bench->scene));
    return state;
}

void bench_color(struct reload_bench *bench, float color[4])
{
    static const struct turner_render_options defaults;
    struct turner_statistics statistics = {0};
    struct turner_image image;
    const struct turner_settings *settings = &bench->scene->settings;
    assert_ok(turner_image_create(&image, settings->width, settings->height));
    assert_ok(turner_renderer_draw(&bench->renderer, &image, &defaults, &statistics));
    size_t middle = (size_t)(image.height / 2 * image.width + image.width / 2);
    memcpy(color, image.rgba + 4 * middle, 4 * sizeof *color);
    turner_image_destroy(&image);
}
