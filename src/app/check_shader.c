#include "app/check_shader.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "gpu/compiler.h"
#include "render/hooks.h"
#include "render/renderer.h"

/* A kernel to compile; `only` is the file for which the kind makes a difference, NULL any. */
struct variant {
    const char *file;
    unsigned kind;
    const char *only, *words; /* for messages */
};

static const struct variant variants[] = {
    {"render.comp", 0, NULL, NULL},
    {"render.comp", TURNER_F64, NULL, "with precision=f64, in which real is double"},
    {"render.comp", TURNER_PACKET, "packet.glsl", "with traversal bvh_packet"},
    {"render.comp", TURNER_RAY_QUERY, "ray_query.glsl", "with traversal ray_query"},
    {"render.comp", TURNER_SPHERE_F64, "sphere.glsl", "with sphere=f64"},
    {"render.comp", TURNER_RECORD, "record.glsl", "as turner explain compiles it"},
    {"render.comp", TURNER_RECORD, "whitted.glsl", "as turner explain compiles it"},
    {"render.comp", TURNER_RECORD, "meeting.glsl", "as turner explain compiles it"},
    {"features.comp", 0, "features.comp", NULL},
    {"visibility.comp", 0, "visibility.comp", NULL},
    {"deferred.comp", 0, "deferred.comp", NULL},
    {"post.comp", 0, "post.comp", NULL},
    {"post.comp", 0, "user/post.glsl", NULL},
    {"probe.comp", TURNER_PROBE_HITS, "probe.comp", NULL},
    {"probe.comp", TURNER_PROBE_RADIANCE, "probe.comp", NULL},
    {"rays.comp", 0, "rays.comp", NULL},
    {"rays.comp", TURNER_RAYS_SEND, "rays.comp", NULL},
};

static bool ends_with(const char *text, const char *ending)
{
    size_t length = strlen(text), size = strlen(ending);
    return length >= size && strcmp(text + length - size, ending) == 0;
}

/* Whether the text calls `name`, or defines it: for a file that is no other part, that is enough. */
static bool has_function(const char *text, const char *name)
{
    for (const char *at = text; (at = strstr(at, name)); at++) {
        const char *rest = at + strlen(name);
        if (*(rest + strspn(rest, " \t\r\n")) == '(')
            return true;
    }
    return false;
}

/* The hook whose function a file defines, as the file's name. */
static bool hook_of(char name[256], const struct turner_shader_source *source)
{
    for (enum turner_hook hook = 0; hook < TURNER_HOOKS; hook++) {
        char function[64];
        snprintf(function, sizeof function, "user_%s", turner_hook_name(hook));
        for (size_t i = 0; i < source->file_count; i++) {
            if (!has_function(source->files[i].text, function))
                continue;
            snprintf(name, 256, "user/%s.glsl", turner_hook_name(hook));
            return true;
        }
    }
    return false;
}

static bool is_built_in(const char *name)
{
    for (size_t i = 0; i < turner_embedded_shaders_count; i++) {
        if (strcmp(turner_embedded_shaders[i].name, name) == 0)
            return true;
    }
    return false;
}

struct file {
    const char *path;
    char name[256];        /* of turner's whose place it takes */
    char folder[PATH_MAX]; /* what it includes is looked for here first */
};

static enum turner_result identify(struct file *file)
{
    const char *slash = strrchr(file->path, '/');
    const char *base = slash ? slash + 1 : file->path;
    struct turner_shader_source source;
    int folder = slash ? (int)(slash - file->path) : 0;
    snprintf(file->folder, sizeof file->folder, "%.*s", folder, file->path);
    bool in_user = strcmp(file->folder, "user") == 0 || ends_with(file->folder, "/user");
    snprintf(file->name, sizeof file->name, "%s%s", in_user ? "user/" : "", base);
    if (in_user) /* names are relative to what holds user/ */
        file->folder[folder > 4 ? folder - 5 : 0] = 0;
    if (!*file->folder)
        strcpy(file->folder, slash == file->path ? "/" : ".");
    if (access(file->path, R_OK) != 0)
        return turner_fail(TURNER_BAD_INPUT, "%s:1:1: cannot be read: %s", file->path,
                           strerror(errno));
    if (is_built_in(file->name))
        return TURNER_OK;
    const char *const folders[] = {file->folder};
    const struct turner_shader_replacement self = {file->name, file->path};
    enum turner_result result =
        turner_shader_source_create_with(&source, file->name, folders, 1, &self);
    if (result == TURNER_OK && !hook_of(file->name, &source))
        result = turner_fail(TURNER_BAD_INPUT, "%s:1:1: the kernel includes no file of that name, "
                             "and none of the functions user_surface, user_brdf, user_background, "
                             "user_light, user_post is in it; a shader replaces a file of shaders/, "
                             "a hook has its function", file->path);
    turner_shader_source_destroy(&source);
    return result;
}

static bool includes(const struct turner_shader_source *source, const char *name)
{
    for (size_t i = 0; i < source->file_count; i++) {
        if (strcmp(source->files[i].name, name) == 0)
            return true;
    }
    return false;
}

static enum turner_result compile(size_t *words, struct turner_shader_source *source,
                                  const struct variant *variant)
{
    struct turner_kernel kernel;
    enum turner_result result = turner_kernel_compile(&kernel, variant->kind, source, true);
    if (result == TURNER_OK)
        result = turner_spirv_validate(&kernel.spirv);
    *words += kernel.spirv.count;
    turner_kernel_destroy(&kernel);
    return result;
}

static enum turner_result check_variant(size_t *words, int *count, const struct file *file,
                                        const struct variant *variant)
{
    const char *const folders[] = {file->folder};
    const struct turner_shader_replacement self = {file->name, file->path};
    struct turner_shader_source source;
    enum turner_result result =
        turner_shader_source_create_with(&source, variant->file, folders, 1, &self);
    if (result == TURNER_OK && includes(&source, file->name)) {
        ++*count;
        result = compile(words, &source, variant);
        if (result != TURNER_OK && variant->words) {
            char message[1800];
            snprintf(message, sizeof message, "%s", turner_message());
            result = turner_fail(result, "%s\n    (%s)", message, variant->words);
        }
    }
    turner_shader_source_destroy(&source);
    return result;
}

enum turner_result turner_check_shader(const char *path, bool quiet)
{
    struct file file = {.path = path};
    size_t words = 0;
    int count = 0;
    TURNER_TRY(identify(&file));
    bool all = strcmp(file.name, "shared.h") == 0 || strcmp(file.name, "scene.glsl") == 0;
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++) {
        const struct variant *variant = &variants[i];
        if (!variant->only || all || strcmp(variant->only, file.name) == 0)
            TURNER_TRY(check_variant(&words, &count, &file, variant));
    }
    if (count == 0)
        return turner_fail(TURNER_BAD_INPUT, "%s:1:1: no kernel includes %s", path, file.name);
    if (!quiet)
        printf("%s: takes the place of %s; %d kernel%s compile%s to %zu words of SPIR-V\n", path,
               file.name, count, count == 1 ? "" : "s", count == 1 ? "s" : "", words);
    return TURNER_OK;
}

enum turner_result turner_check_template(const char *name)
{
    char file[80];
    if (snprintf(file, sizeof file, "user/%.60s.glsl", name) < (int)sizeof file) {
        for (size_t i = 0; i < turner_embedded_shaders_count; i++) {
            if (strcmp(turner_embedded_shaders[i].name, file) == 0) {
                fputs(turner_embedded_shaders[i].text, stdout);
                return TURNER_OK;
            }
        }
    }
    return turner_fail(TURNER_USAGE, "--template takes surface, brdf, background, light or post, not "
                                     "\"%.60s\"", name);
}
