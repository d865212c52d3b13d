#include "render/shader_watch.h"

#include <stdio.h>

static void add(struct turner_watch *watch, const char *name, const struct turner_shader_path *path,
                struct timespec since)
{
    char file[PATH_MAX];
    for (size_t i = 0; i < path->count; i++) {
        if (snprintf(file, sizeof file, "%s/%s", path->folders[i], name) < (int)sizeof file)
            turner_watch_add(watch, file, since);
    }
}

void turner_shader_watch_add(struct turner_watch *watch, const struct turner_shader_source *source,
                             const struct turner_shader_path *path, struct timespec since)
{
    for (size_t i = 0; i < path->count; i++)
        turner_watch_add(watch, path->folders[i], since);
    for (size_t i = 0; i < source->file_count; i++)
        add(watch, source->files[i].name, path, since);
    if (source->missing)
        add(watch, source->missing, path, since);
}

void turner_shader_watch_folder(struct turner_watch *watch, const struct turner_scene *scene,
                                struct timespec since)
{
    char folder[PATH_MAX];
    if (turner_shader_path_of_scene(folder, scene))
        turner_watch_add(watch, folder, since);
}

void turner_shader_watch_all(struct turner_watch *watch,
                             const struct turner_render_options *options,
                             const struct turner_scene *scene, struct timespec since)
{
    static const char *const kernels[] = {"render.comp", "features.comp", "post.comp"};
    struct turner_render_options whole = *options;
    struct turner_shader_path path;
    turner_shader_path_create(&path, &whole, scene);
    for (size_t i = 0; i < sizeof kernels / sizeof *kernels; i++) {
        struct turner_shader_source source;
        turner_shader_source_create(&source, kernels[i], whole.shader_dirs, whole.shader_dir_count);
        turner_shader_watch_add(watch, &source, &path, since);
        turner_shader_source_destroy(&source);
    }
    turner_shader_watch_folder(watch, scene, since);
    turner_shader_path_destroy(&path);
}
