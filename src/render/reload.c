#include "render/reload.h"

#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "gpu/cached.h"
#include "render/hooks.h"
#include "render/shader_watch.h"
#include "../shaders/shared.h"

/* A renderer's program to be made: that of the picture, or of its accurate twin. */
struct part {
    struct turner_needs needs, needs_of_surface; /* the second when that hook is replaced */
    uint32_t bvh_depth;
    struct turner_program program;
};

/* One kernel being made. The thread has it alone until `done`. */
struct build {
    pthread_t thread;
    atomic_bool done;
    uint64_t text; /* hash of the source and of what else decides the kernel */
    struct turner_shader_source source, post_source;
    struct turner_kernel kernel, post_kernel;
    struct part parts[2];
    int part_count;
    struct turner_post post;
    enum turner_result result;
    char *message;
    double start, seconds;
};

struct turner_reload {
    struct turner_renderer *renderer;
    struct turner_scene *scene; /* what is kept of it: parameters, materials' names, folders */
    struct turner_render_options options;
    struct turner_watch watch;
    enum turner_reload_state state;
    uint64_t wanted;      /* hash of what the files say now */
    uint64_t current;     /* of what the renderer has */
    struct build *build;  /* under way, or finished and not taken, or NULL */
    char *message;
    double seconds;
};

/* ---- what is kept of options and scene ---- */

static void copy_options(struct turner_reload *reload, const struct turner_render_options *options)
{
    reload->options = *options;
    char **dirs = turner_calloc(options->shader_dir_count + 1, sizeof *dirs);
    for (size_t i = 0; i < options->shader_dir_count; i++)
        dirs[i] = turner_strdup(options->shader_dirs[i]);
    reload->options.shader_dirs = (const char *const *)dirs;
    reload->options.layers = NULL;
    reload->options.progress = NULL;
}

static void copy_scene(struct turner_reload *reload, const struct turner_scene *scene)
{
    struct turner_scene *copy = turner_scene_create();
    copy->settings = scene->settings;
    copy->path = scene->path ? turner_strdup(scene->path) : NULL;
    copy->shaders = scene->shaders ? turner_strdup(scene->shaders) : NULL;
    for (size_t i = 0; i < scene->param_count; i++)
        turner_scene_set_param(copy, scene->params[i].name, scene->params[i].value);
    turner_scene_destroy(reload->scene);
    reload->scene = copy;
}

/* ---- the thread ---- */

static enum turner_result make_part(struct part *part, struct turner_gpu *gpu,
                                    const struct turner_kernel *kernel,
                                    const struct turner_scene *scene, bool no_cache)
{
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    struct turner_spirv special;
    if (kernel->hooks & 1u << TURNER_HOOK_SURFACE)
        part->needs = part->needs_of_surface;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, kernel, &part->needs,
                                            part->bvh_depth, scene));
    TURNER_TRY(no_cache ? turner_spirv_reduce(&special, &kernel->spirv, constants, count)
                        : turner_spirv_reduce_cached(&special, NULL, &kernel->spirv, constants,
                                                     count));
    enum turner_result result = turner_spirv_validate(&special); /* half of what it was */
    if (result == TURNER_OK)
        result = turner_program_create(&part->program, gpu, &special, NULL, 0, VK_NULL_HANDLE);
    turner_spirv_destroy(&special);
    return result;
}

struct work {
    struct build *build;
    struct turner_gpu *gpu;
    const struct turner_scene *scene; /* nobody else changes it while this runs */
    unsigned kind;
    bool no_cache;
};

static enum turner_result make(const struct work *work)
{
    struct build *build = work->build;
    TURNER_TRY(turner_kernel_compile(&build->kernel, work->kind, &build->source, work->no_cache));
    for (int i = 0; i < build->part_count; i++)
        TURNER_TRY(make_part(&build->parts[i], work->gpu, &build->kernel, work->scene,
                             work->no_cache));
    if (!(turner_hooks_of(&build->post_source) & 1u << TURNER_HOOK_POST))
        return TURNER_OK;
    TURNER_TRY(turner_kernel_compile(&build->post_kernel, 0, &build->post_source, work->no_cache));
    TURNER_TRY(turner_spirv_validate(&build->post_kernel.spirv));
    return turner_post_create_program(&build->post, work->gpu, &build->post_kernel, work->scene);
}

static void *run(void *user)
{
    struct work *work = user;
    struct build *build = work->build;
    build->result = make(work);
    if (build->result != TURNER_OK)
        build->message = turner_strdup(turner_message()); /* each thread has its own */
    build->seconds = turner_seconds() - build->start;
    free(work);
    atomic_store(&build->done, true);
    return NULL;
}

static void build_destroy(struct build *build, struct turner_gpu *gpu)
{
    if (!build)
        return;
    pthread_join(build->thread, NULL);
    for (int i = 0; i < build->part_count; i++)
        turner_program_destroy(gpu, &build->parts[i].program);
    turner_post_destroy(gpu, &build->post);
    turner_kernel_destroy(&build->kernel);
    turner_kernel_destroy(&build->post_kernel);
    turner_shader_source_destroy(&build->source);
    turner_shader_source_destroy(&build->post_source);
    free(build->message);
    free(build);
}

/* ---- the owner ---- */

static void set_message(struct turner_reload *reload, const char *message)
{
    free(reload->message);
    reload->message = turner_strdup(message);
}

static struct part part_of(const struct turner_renderer *renderer)
{
    return (struct part){.needs = renderer->needs_of_scene,
                         .needs_of_surface = renderer->needs_of_surface,
                         .bvh_depth = renderer->flat.max_depth};
}

static void start(struct turner_reload *reload, struct turner_shader_source *source,
                  struct turner_shader_source *post_source)
{
    struct turner_renderer *renderer = reload->renderer;
    struct build *build = turner_calloc(1, sizeof *build);
    struct work *work = turner_calloc(1, sizeof *work);
    build->text = reload->wanted;
    build->source = *source;
    build->post_source = *post_source;
    *source = *post_source = (struct turner_shader_source){0};
    build->parts[build->part_count++] = part_of(renderer);
    if (renderer->accurate)
        build->parts[build->part_count++] = part_of(renderer->accurate);
    build->start = turner_seconds();
    *work = (struct work){.build = build,
                          .gpu = renderer->gpu,
                          .scene = reload->scene,
                          .kind = renderer->kind,
                          .no_cache = reload->options.no_cache};
    reload->build = build;
    reload->state = TURNER_RELOAD_BUILDING;
    if (pthread_create(&build->thread, NULL, run, work) == 0)
        return;
    reload->build = NULL;
    free(build);
    free(work);
    set_message(reload, "no thread can be started to compile shaders in");
    reload->state = TURNER_RELOAD_BROKEN;
}

/* Everything that decides the kernel, and the values it begins with, but the renderer itself. */
static uint64_t hash_of(const struct turner_reload *reload,
                        const struct turner_shader_source *source,
                        const struct turner_shader_source *post_source)
{
    const uint64_t sources[2] = {turner_source_hash(source), turner_source_hash(post_source)};
    uint64_t hash = turner_hash_bytes(TURNER_HASH_START, sources, sizeof sources);
    struct turner_constant constants[2 * TURNER_PARAM_WORDS];
    size_t count = 0;
    enum turner_result result =
        turner_params_constants(constants, &count, &source->params, reload->scene);
    if (result == TURNER_OK)
        turner_params_constants(constants, &count, &post_source->params, reload->scene);
    return turner_hash_bytes(hash, constants, count * sizeof *constants);
}

/* Reads the files, and watches them as they are now. */
static enum turner_result read_sources(struct turner_reload *reload,
                                       struct turner_shader_source *source,
                                       struct turner_shader_source *post_source,
                                       struct timespec since)
{
    struct turner_render_options whole = reload->options;
    struct turner_shader_path path;
    turner_shader_path_create(&path, &whole, reload->scene);
    turner_watch_clear(&reload->watch);
    *post_source = (struct turner_shader_source){0};
    enum turner_result result = turner_shader_source_create(
        source, "render.comp", whole.shader_dirs, whole.shader_dir_count);
    turner_shader_watch_add(&reload->watch, source, &path, since);
    if (result == TURNER_OK) {
        result = turner_shader_source_create(post_source, "post.comp", whole.shader_dirs,
                                             whole.shader_dir_count);
        turner_shader_watch_add(&reload->watch, post_source, &path, since);
    }
    turner_shader_watch_folder(&reload->watch, reload->scene, since);
    turner_shader_path_destroy(&path);
    return result;
}

/* The files say something else, perhaps: what is to be done about it. */
static void look(struct turner_reload *reload)
{
    struct turner_shader_source source, post_source;
    enum turner_result result =
        read_sources(reload, &source, &post_source, turner_watch_now());
    reload->seconds = 0;
    if (result != TURNER_OK) {
        reload->wanted = 0;
        set_message(reload, turner_message());
        reload->state = TURNER_RELOAD_BROKEN;
    } else {
        uint64_t text = hash_of(reload, &source, &post_source);
        bool same = text == reload->wanted; /* saved, but as it was */
        reload->wanted = text;
        if (text == reload->current) {
            reload->state = TURNER_RELOAD_CURRENT;
            set_message(reload, "");
        } else if (!same || reload->state == TURNER_RELOAD_CURRENT) {
            reload->state = TURNER_RELOAD_BUILDING;
        }
    }
    bool begin = reload->state == TURNER_RELOAD_BUILDING && !reload->build;
    if (begin)
        start(reload, &source, &post_source);
    turner_shader_source_destroy(&source);
    turner_shader_source_destroy(&post_source);
}

/* A build has ended: it counts if nothing has changed since it began. */
static void harvest(struct turner_reload *reload)
{
    struct build *build = reload->build;
    if (build->text == reload->wanted && build->result == TURNER_OK) {
        reload->seconds = build->seconds;
        reload->state = TURNER_RELOAD_READY;
        set_message(reload, "");
        return; /* it waits for the swap */
    }
    bool broken = build->text == reload->wanted;
    if (broken) {
        set_message(reload, build->message);
        reload->state = TURNER_RELOAD_BROKEN;
    }
    reload->build = NULL;
    build_destroy(build, reload->renderer->gpu);
    if (!broken && reload->state == TURNER_RELOAD_BUILDING)
        look(reload); /* for what the files say now */
}

enum turner_reload_state turner_reload_poll(struct turner_reload *reload)
{
    if (turner_watch_changed(&reload->watch))
        look(reload);
    struct build *build = reload->build;
    bool stale = build && build->text != reload->wanted;
    if (build && atomic_load(&build->done) && (reload->state == TURNER_RELOAD_BUILDING || stale))
        harvest(reload);
    return reload->state;
}

enum turner_reload_state turner_reload_state(const struct turner_reload *reload)
{
    return reload->state;
}

const char *turner_reload_message(const struct turner_reload *reload)
{
    return reload->state == TURNER_RELOAD_BROKEN && reload->message ? reload->message : "";
}

double turner_reload_seconds(const struct turner_reload *reload)
{
    return reload->seconds;
}

/* ---- the swap ---- */

/* A renderer takes a program; buffers are made before anything of the old goes. */
static enum turner_result take_part(struct turner_renderer *renderer, struct part *part,
                                    const struct turner_kernel *kernel,
                                    const struct turner_scene *scene)
{
    struct turner_gpu *gpu = renderer->gpu;
    struct turner_param_block params;
    enum turner_result result;
    TURNER_TRY_DONE(turner_param_block_create(&params, gpu, &kernel->params, scene));
    if (renderer->ray_query)
        TURNER_TRY_DONE(turner_program_bind_acceleration(
            &part->program, gpu, TURNER_BINDING_TLAS, renderer->scene.top.handle));
    TURNER_TRY_DONE(turner_renderer_set_bounds(renderer, &part->needs));
    turner_param_block_destroy(gpu, &renderer->params);
    turner_program_destroy(gpu, &renderer->program);
    renderer->params = params;
    renderer->program = part->program;
    renderer->needs = part->needs;
    part->program = (struct turner_program){0};
    return TURNER_OK;
done:
    turner_param_block_destroy(gpu, &params);
    return result;
}

static enum turner_result take(struct turner_reload *reload, struct build *build,
                               const struct turner_scene *scene)
{
    struct turner_renderer *renderer = reload->renderer;
    if (build->post.wanted)
        TURNER_TRY(turner_post_create_buffers(&build->post, renderer->gpu, &build->post_kernel,
                                              scene));
    if (renderer->accurate)
        TURNER_TRY(take_part(renderer->accurate, &build->parts[1], &build->kernel, scene));
    TURNER_TRY(take_part(renderer, &build->parts[0], &build->kernel, scene));
    turner_post_destroy(renderer->gpu, &renderer->post);
    if (!build->post.wanted) /* else it knows */
        build->post.source = turner_source_hash(&build->post_source);
    renderer->post = build->post;
    renderer->source = build->kernel.source;
    build->post = (struct turner_post){0};
    return TURNER_OK;
}

enum turner_result turner_reload_swap(struct turner_reload *reload, struct turner_kernel *kernel,
                                      const struct turner_scene *scene)
{
    struct build *build = reload->build;
    if (reload->state != TURNER_RELOAD_READY)
        return TURNER_OK;
    enum turner_result result = take(reload, build, scene);
    reload->build = NULL;
    reload->state = result == TURNER_OK ? TURNER_RELOAD_CURRENT : TURNER_RELOAD_BROKEN;
    if (result == TURNER_OK) {
        reload->current = build->text;
        turner_kernel_destroy(kernel);
        *kernel = build->kernel;
        build->kernel = (struct turner_kernel){0};
    } else {
        set_message(reload, turner_message());
    }
    build_destroy(build, reload->renderer->gpu);
    return result;
}

enum turner_result turner_reload_set_params(struct turner_reload *reload,
                                            const struct turner_scene *scene)
{
    TURNER_TRY(turner_renderer_set_params(reload->renderer, scene));
    struct build *build = reload->build; /* reads the scene that goes */
    reload->build = NULL;
    build_destroy(build, reload->renderer->gpu);
    copy_scene(reload, scene);
    if (build || reload->state == TURNER_RELOAD_BROKEN)
        reload->wanted = 0;
    look(reload);
    return TURNER_OK;
}

enum turner_result turner_reload_create(struct turner_reload **out,
                                        struct turner_renderer *renderer,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct timespec since)
{
    struct turner_reload *reload = turner_calloc(1, sizeof *reload);
    struct turner_shader_source source, post_source;
    *out = reload;
    reload->renderer = renderer;
    copy_options(reload, options);
    copy_scene(reload, scene);
    /* what has changed since then is dirty, and seen at the first poll */
    enum turner_result result = read_sources(reload, &source, &post_source, since);
    if (result == TURNER_OK && turner_source_hash(&source) == renderer->source &&
        turner_source_hash(&post_source) == renderer->post.source)
        reload->wanted = reload->current = hash_of(reload, &source, &post_source);
    else if (result == TURNER_OK)
        look(reload); /* it is so already */
    turner_shader_source_destroy(&source);
    turner_shader_source_destroy(&post_source);
    if (result != TURNER_OK) {
        turner_reload_destroy(reload);
        *out = NULL;
    }
    return result;
}

void turner_reload_destroy(struct turner_reload *reload)
{
    if (!reload)
        return;
    build_destroy(reload->build, reload->renderer->gpu);
    turner_watch_clear(&reload->watch);
    turner_scene_destroy(reload->scene);
    for (size_t i = 0; i < reload->options.shader_dir_count; i++)
        free((char *)reload->options.shader_dirs[i]);
    free((void *)reload->options.shader_dirs);
    free(reload->message);
    free(reload);
}
