#include "render/shader_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"

static bool same_folder(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

static void add(struct turner_shader_path *path, const char *folder)
{
    for (size_t i = 0; i < path->count; i++) {
        if (same_folder(path->folders[i], folder))
            return; /* found there already */
    }
    *TURNER_PUSH(path->folders, path->count, path->capacity) = turner_strdup(folder);
}

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

/* `file`'s folder with its last slash, or "", as a length. */
static int folder_length(const char *file)
{
    const char *slash = strrchr(file, '/');
    return slash ? (int)(slash - file) + 1 : 0;
}

bool turner_shader_path_of_scene(char folder[PATH_MAX], const struct turner_scene *scene)
{
    if (scene->shaders)
        return snprintf(folder, PATH_MAX, "%s", scene->shaders) < PATH_MAX;
    return scene->path && snprintf(folder, PATH_MAX, "%.*sshaders", folder_length(scene->path),
                                   scene->path) < PATH_MAX;
}

static void add_of_scene(struct turner_shader_path *path, const struct turner_scene *scene)
{
    char folder[PATH_MAX];
    if (turner_shader_path_of_scene(folder, scene) && (scene->shaders || is_folder(folder)))
        add(path, folder);
}

static void add_installed(struct turner_shader_path *path)
{
    char self[PATH_MAX], folder[PATH_MAX + sizeof TURNER_SHADERS_FROM_COMMAND];
    ssize_t length = readlink("/proc/self/exe", self, sizeof self - 1);
    if (length <= 0)
        return;
    self[length] = 0;
    const char *name = self + folder_length(self);
    snprintf(folder, sizeof folder, "%.*s" TURNER_SHADERS_FROM_COMMAND, folder_length(self), self);
    if (strcmp(name, "turner") == 0 && is_folder(folder))
        add(path, folder);
}

void turner_shader_path_create(struct turner_shader_path *path,
                               struct turner_render_options *options,
                               const struct turner_scene *scene)
{
    *path = (struct turner_shader_path){0};
    for (size_t i = 0; i < options->shader_dir_count; i++)
        add(path, options->shader_dirs[i]);
    if (scene && !options->no_scene_shaders)
        add_of_scene(path, scene);
    const char *environment = getenv("TURNER_SHADERS");
    if (environment && *environment)
        add(path, environment);
    add_installed(path);
    options->shader_dirs = (const char *const *)path->folders;
    options->shader_dir_count = path->count;
}

void turner_shader_path_destroy(struct turner_shader_path *path)
{
    for (size_t i = 0; i < path->count; i++)
        free(path->folders[i]);
    free(path->folders);
    *path = (struct turner_shader_path){0};
}
