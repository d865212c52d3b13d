/* From a file name to a scene that is ready to be drawn. */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/watch.h"
#include "scene/readers.h"

static const char known_endings[] = ".json, .nff, .obj, .ply, .stl, .gltf and .glb";

static bool has_ending(const char *path, const char *ending)
{
    size_t length = strlen(path), ending_length = strlen(ending);
    return length > ending_length && strcasecmp(path + length - ending_length, ending) == 0;
}

static bool is_mesh(const char *path)
{
    static const char *const endings[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        if (has_ending(path, endings[i]))
            return true;
    }
    return false;
}

char *turner_path_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    if (name[0] == '/' || !slash) {
        turner_watch_note(name);
        return turner_strdup(name);
    }
    size_t folder = (size_t)(slash - path) + 1, length = strlen(name);
    char *beside = turner_calloc(folder + length + 1, 1);
    memcpy(beside, path, folder);
    memcpy(beside + folder, name, length);
    turner_watch_note(beside);
    return beside;
}

/* ---- reading the file ---- */

/* Opens a regular file that is neither empty nor too large. */
static enum turner_result open_file(int *file, size_t *size, const char *path)
{
    /* O_NONBLOCK: opening a FIFO must not wait for someone to write into it */
    *file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (*file < 0)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be opened: %s", path, strerror(errno));
    struct stat status;
    if (fstat(*file, &status) != 0)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
    if (S_ISDIR(status.st_mode))
        return turner_fail(TURNER_BAD_INPUT, "%s: is a folder; give a scene file in it", path);
    if (!S_ISREG(status.st_mode))
        return turner_fail(TURNER_BAD_INPUT, "%s: is not a regular file", path);
    if (status.st_size == 0)
        return turner_fail(TURNER_BAD_INPUT, "%s: the file is empty", path);
    if (status.st_size > (off_t)TURNER_MAX_FILE_BYTES)
        return turner_fail(TURNER_BAD_INPUT, "%s: the file has %lld bytes, but %u are the limit",
                           path, (long long)status.st_size, TURNER_MAX_FILE_BYTES);
    *size = (size_t)status.st_size;
    return TURNER_OK;
}

static enum turner_result read_text(char *text, size_t size, int file, const char *path)
{
    for (size_t done = 0; done < size;) {
        ssize_t got = read(file, text + done, size - done);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read: %s", path, strerror(errno));
        if (got == 0)
            return turner_fail(TURNER_BAD_INPUT, "%s: the file became shorter while it was read",
                               path);
        done += (size_t)got;
    }
    return TURNER_OK;
}

/* ---- mesh files alone ---- */

/* Looks at the whole group from above its front, the sun over the left shoulder. */
static void add_default_view(struct turner_scene *scene)
{
    struct turner_vec3 lo = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    const struct turner_mesh *mesh = &scene->groups[0].meshes[0];
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        struct turner_vec3 p = mesh->positions[i];
        lo = turner_vec3_of(fmin(lo.x, p.x), fmin(lo.y, p.y), fmin(lo.z, p.z));
        hi = turner_vec3_of(fmax(hi.x, p.x), fmax(hi.y, p.y), fmax(hi.z, p.z));
    }
    struct turner_vec3 half = turner_vec3_scale(turner_vec3_sub(hi, lo), 0.5);
    double radius = turner_vec3_length(half);
    if (!(radius > 0))
        radius = 1;
    struct turner_camera *camera = &scene->camera;
    struct turner_vec3 aside = turner_vec3_normalize(turner_vec3_of(0.5, 0.4, 1));
    double distance = 1.05 * radius / sin(camera->vfov / 2); /* the bounding sphere fits */
    camera->at = turner_vec3_add(lo, half);
    camera->from = turner_vec3_add(camera->at, turner_vec3_scale(aside, distance));

    double pi = acos(-1);
    struct turner_light sun = {
        .kind = TURNER_LIGHT_DIRECTIONAL,
        .direction = turner_vec3_normalize(turner_vec3_of(0.4, -1, -0.8)),
        .power = turner_vec3_of(pi, pi, pi), /* a white surface that faces it has radiance 1 */
    };
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = sun;
    scene->ambient = turner_vec3_of(0.15, 0.15, 0.15);
    scene->background.kind = TURNER_BACKGROUND_GRADIENT;
    scene->background.color = turner_vec3_of(0.3, 0.3, 0.3);
    scene->background.top = turner_vec3_of(0.6, 0.65, 0.75);
}

static enum turner_result read_mesh_scene(struct turner_scene *scene, const char *path)
{
    struct turner_mesh mesh;
    TURNER_TRY(turner_mesh_read_file(&mesh, path, -1));
    turner_group_add_mesh(&scene->groups[0], &mesh);
    struct turner_material clay = {
        .name = turner_strdup("clay"),
        .k_a = {0.75, 0.72, 0.68},
        .k_d = {0.75, 0.72, 0.68},
        .exponent = 1,
        .medium = TURNER_NONE,
        .uv_scale = {1, 1},
        .image = TURNER_NONE,
    };
    *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) = clay;
    add_default_view(scene);
    return TURNER_OK;
}

/* ---- any file ---- */

static enum turner_result finish(struct turner_scene **out, struct turner_scene *scene,
                                 enum turner_result result, const char *path)
{
    if (result == TURNER_OK) {
        turner_scene_sort_media(scene);
        result = turner_scene_validate(scene);
        if (result != TURNER_OK)
            turner_fail_within(result, "%s", path);
    }
    if (result != TURNER_OK) {
        turner_scene_destroy(scene);
        return result;
    }
    scene->path = turner_strdup(path);
    *out = scene;
    return TURNER_OK;
}

enum turner_result turner_scene_parse(struct turner_scene **out, const char *text, size_t length,
                                      const char *path)
{
    *out = NULL;
    struct turner_scene *scene = turner_scene_create();
    enum turner_result result = has_ending(path, ".nff")
                                    ? turner_scene_read_nff(scene, text, length, path)
                                    : turner_scene_read_json(scene, text, length, path);
    return finish(out, scene, result, path);
}

enum turner_result turner_scene_load(struct turner_scene **out, const char *path)
{
    *out = NULL;
    turner_watch_note(path);
    enum turner_result result;
    char *text = NULL;
    size_t size = 0;
    int file = -1;
    TURNER_TRY_DONE(open_file(&file, &size, path));
    if (is_mesh(path)) {
        struct turner_scene *scene = turner_scene_create();
        result = finish(out, scene, read_mesh_scene(scene, path), path);
        goto done;
    }
    if (!has_ending(path, ".json") && !has_ending(path, ".nff")) {
        result = turner_fail(TURNER_BAD_INPUT, "%s: unknown kind of scene; its name must end in "
                             "one of %s", path, known_endings);
        goto done;
    }
    text = turner_calloc(size, 1);
    TURNER_TRY_DONE(read_text(text, size, file, path));
    result = turner_scene_parse(out, text, size, path);
done:
    free(text);
    if (file >= 0)
        close(file);
    return result;
}
