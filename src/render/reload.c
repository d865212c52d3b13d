#include "render/reload.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "render/hooks.h"
#include "render/rebuild.h"
#include "render/shader_watch.h"
#include "../shaders/shared.h"

#define STALE_MAX 4 /* a driver's compiler cannot be stopped, and each takes a core meanwhile */

struct turner_reload {
    struct turner_renderer *renderer;
    struct turner_scene *scene; /* what is kept of it: parameters, materials' names, folders */
    struct turner_render_options options;
    struct turner_watch watch;
    enum turner_reload_state state;
    uint64_t wanted;      /* hash of what the files say now */
    uint64_t current;     /* of what the renderer has, */
    uint64_t picture;     /* and without what follows the picture (the hook post) */
    struct turner_rebuild *build; /* under way, or finished and not taken, or NULL */
    struct turner_rebuild *stale; /* those under way that nobody waits for */
    char *message;
    double seconds;
    bool previews;                 /* are wanted */
    struct turner_preview preview;
    struct turner_lighting lighting; /* by the hooks that the renderer has */
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

static struct turner_scene *copy_of(const struct turner_scene *scene)
{
    struct turner_scene *copy = turner_scene_create();
    copy->settings = scene->settings;
    copy->path = scene->path ? turner_strdup(scene->path) : NULL;
    copy->shaders = scene->shaders ? turner_strdup(scene->shaders) : NULL;
    for (size_t i = 0; i < scene->param_count; i++)
        turner_scene_set_param(copy, scene->params[i].name, scene->params[i].value);
    return copy;
}

/* ---- the owner ---- */

static void set_message(struct turner_reload *reload, const char *message)
{
    free(reload->message);
    reload->message = turner_strdup(message);
}

/* `picture` is the hash of what decides the picture's kernel. */
static void start(struct turner_reload *reload, struct turner_sources *sources, uint64_t picture)
{
    if (turner_rebuild_create(&reload->build, reload->renderer, copy_of(reload->scene), sources,
                              reload->wanted, picture == reload->picture,
                              reload->options.no_cache, reload->preview.recorded) == TURNER_OK) {
        reload->build->picture = picture;
        return;
    }
    set_message(reload, turner_message());
    reload->state = TURNER_RELOAD_BROKEN;
}

static uint64_t add_kernel(uint64_t hash, const struct turner_shader_source *source,
                           const struct turner_scene *scene)
{
    uint64_t text = turner_source_hash(source);
    struct turner_constant constants[TURNER_PARAM_WORDS];
    size_t count = 0;
    turner_params_constants(constants, &count, &source->params, scene);
    hash = turner_hash_bytes(hash, &text, sizeof text);
    return turner_hash_bytes(hash, constants, count * sizeof *constants);
}

/* Everything that decides the kernels, and the values they begin with, but the renderer itself. */
static uint64_t hash_of(const struct turner_reload *reload, const struct turner_sources *sources,
                        uint64_t *picture)
{
    *picture = add_kernel(TURNER_HASH_START, &sources->picture, reload->scene);
    return add_kernel(*picture, &sources->post, reload->scene);
}

/* Reads the files, and watches them as they are now. */
static enum turner_result read_sources(struct turner_reload *reload,
                                       struct turner_sources *sources, struct timespec since)
{
    struct turner_render_options whole = reload->options;
    struct turner_shader_path path;
    turner_shader_path_create(&path, &whole, reload->scene);
    turner_watch_clear(&reload->watch);
    *sources = (struct turner_sources){0};
    enum turner_result result = turner_shader_source_create(
        &sources->picture, "render.comp", whole.shader_dirs, whole.shader_dir_count);
    turner_shader_watch_add(&reload->watch, &sources->picture, &path, since);
    if (result == TURNER_OK) {
        result = turner_shader_source_create(&sources->post, "post.comp", whole.shader_dirs,
                                             whole.shader_dir_count);
        turner_shader_watch_add(&reload->watch, &sources->post, &path, since);
    }
    turner_shader_watch_folder(&reload->watch, reload->scene, since);
    turner_shader_path_destroy(&path);
    return result;
}

/* The same for what shows a changed hook soon; what cannot be read stays without text. */
static void read_previews(const struct turner_reload *reload, struct turner_sources *sources,
                          bool first)
{
    struct turner_render_options whole = reload->options;
    struct turner_shader_path path;
    turner_shader_path_create(&path, &whole, reload->scene);
    if (turner_shader_source_create(&sources->lighting, "deferred.comp", whole.shader_dirs,
                                    whole.shader_dir_count) != TURNER_OK)
        turner_shader_source_destroy(&sources->lighting);
    if (first && turner_shader_source_create(&sources->visibility, "visibility.comp",
                                             whole.shader_dirs,
                                             whole.shader_dir_count) != TURNER_OK)
        turner_shader_source_destroy(&sources->visibility);
    turner_shader_path_destroy(&path);
}

static int stale_count(const struct turner_reload *reload)
{
    int count = 0;
    for (const struct turner_rebuild *one = reload->stale; one; one = one->next)
        count++;
    return count;
}

/* Those that have ended, or all. */
static void drop_stale(struct turner_reload *reload, bool all)
{
    struct turner_rebuild **at = &reload->stale;
    while (*at) {
        struct turner_rebuild *one = *at;
        if (all || atomic_load(&one->done)) {
            *at = one->next;
            turner_rebuild_destroy(one);
        } else {
            at = &one->next;
        }
    }
}

/* The files say something else, perhaps: what is to be done about it. */
static void look(struct turner_reload *reload)
{
    struct turner_sources sources;
    uint64_t picture = 0;
    enum turner_result result = read_sources(reload, &sources, turner_watch_now());
    reload->seconds = 0;
    if (result != TURNER_OK) {
        reload->wanted = 0;
        set_message(reload, turner_message());
        reload->state = TURNER_RELOAD_BROKEN;
    } else {
        uint64_t text = hash_of(reload, &sources, &picture);
        bool same = text == reload->wanted; /* saved, but as it was */
        reload->wanted = text;
        if (text == reload->current) {
            reload->state = TURNER_RELOAD_CURRENT;
            set_message(reload, "");
        } else if (!same || reload->state == TURNER_RELOAD_CURRENT) {
            reload->state = TURNER_RELOAD_BUILDING;
        }
    }
    struct turner_rebuild *build = reload->build;
    bool stale = build && build->sources.picture.text && build->text != reload->wanted;
    if (reload->state == TURNER_RELOAD_BUILDING && stale && stale_count(reload) < STALE_MAX) {
        turner_rebuild_give_up(build); /* what previews take is waited for: they would never be,
                                          with one save after the other */
        build->next = reload->stale;
        reload->stale = build;
        reload->build = NULL;
    }
    if (reload->state == TURNER_RELOAD_BUILDING && !reload->build) {
        if (turner_program_exists(&reload->preview.visibility) && picture != reload->picture)
            read_previews(reload, &sources, false);
        start(reload, &sources, picture);
    }
    turner_sources_destroy(&sources);
}

/* A build has ended: it counts if nothing has changed since it began. */
static void harvest(struct turner_reload *reload)
{
    struct turner_rebuild *build = reload->build;
    bool picture = build->sources.picture.text;
    if (picture && build->text == reload->wanted && build->result == TURNER_OK) {
        reload->seconds = build->seconds;
        reload->state = TURNER_RELOAD_READY;
        set_message(reload, "");
        return; /* it waits for the swap */
    }
    bool broken = picture && build->text == reload->wanted;
    if (broken) {
        set_message(reload, build->message);
        reload->state = TURNER_RELOAD_BROKEN;
    } else if (!picture) {
        reload->lighting = build->lighting;
        reload->preview.visibility = build->visibility;
        build->lighting = (struct turner_lighting){0};
        build->visibility = (struct turner_program){0};
    }
    reload->build = NULL;
    turner_rebuild_destroy(build);
    if (!broken && reload->state == TURNER_RELOAD_BUILDING)
        look(reload); /* for what the files say now */
}

enum turner_reload_state turner_reload_poll(struct turner_reload *reload)
{
    if (turner_watch_changed(&reload->watch))
        look(reload);
    drop_stale(reload, false);
    struct turner_rebuild *build = reload->build;
    if (build && atomic_load(&build->done) &&
        (reload->state == TURNER_RELOAD_BUILDING || build->text != reload->wanted ||
         !build->sources.picture.text))
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
static enum turner_result take_part(struct turner_renderer *renderer, struct turner_part *part,
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

static enum turner_result take(struct turner_reload *reload, struct turner_rebuild *build,
                               const struct turner_scene *scene)
{
    struct turner_renderer *renderer = reload->renderer;
    if (build->post.wanted)
        TURNER_TRY(turner_post_create_buffers(&build->post, renderer->gpu, &build->post_kernel,
                                              scene));
    if (build->part_count > 1)
        TURNER_TRY(take_part(renderer->accurate, &build->parts[1], &build->kernel, scene));
    if (build->part_count > 0)
        TURNER_TRY(take_part(renderer, &build->parts[0], &build->kernel, scene));
    turner_post_destroy(renderer->gpu, &renderer->post);
    if (!build->post.wanted) /* else it knows */
        build->post.source = turner_source_hash(&build->sources.post);
    renderer->post = build->post;
    renderer->source = build->kernel.source;
    build->post = (struct turner_post){0};
    return TURNER_OK;
}

static void take_lighting(struct turner_reload *reload, struct turner_rebuild *build)
{
    turner_lighting_destroy(reload->renderer->gpu, &reload->lighting);
    reload->lighting = build->lighting;
    build->lighting = (struct turner_lighting){0};
    reload->preview.recorded = false;
}

enum turner_result turner_reload_swap(struct turner_reload *reload, struct turner_kernel *kernel,
                                      const struct turner_scene *scene)
{
    struct turner_rebuild *build = reload->build;
    if (reload->state != TURNER_RELOAD_READY)
        return TURNER_OK;
    enum turner_result result = take(reload, build, scene);
    reload->build = NULL;
    reload->state = result == TURNER_OK ? TURNER_RELOAD_CURRENT : TURNER_RELOAD_BROKEN;
    if (result == TURNER_OK) {
        reload->current = build->text;
        reload->picture = build->picture;
        turner_kernel_destroy(kernel);
        *kernel = build->kernel;
        build->kernel = (struct turner_kernel){0};
        if (build->part_count > 0)
            take_lighting(reload, build);
    } else {
        set_message(reload, turner_message());
    }
    turner_rebuild_destroy(build);
    return result;
}

enum turner_result turner_reload_set_params(struct turner_reload *reload,
                                            const struct turner_scene *scene)
{
    TURNER_TRY(turner_renderer_set_params(reload->renderer, scene));
    turner_scene_destroy(reload->scene);
    reload->scene = copy_of(scene);
    if (reload->build || reload->state == TURNER_RELOAD_BROKEN)
        reload->wanted = 0;
    look(reload);
    return TURNER_OK;
}

/* ---- previews ---- */

void turner_reload_want_previews(struct turner_reload *reload, bool wanted)
{
    reload->previews = wanted;
    if (!wanted)
        turner_preview_destroy(reload->renderer->gpu, &reload->preview);
}

void turner_reload_forget(struct turner_reload *reload)
{
    reload->preview.recorded = false;
    if (reload->build)
        turner_rebuild_go_on(reload->build);
}

/* The kernels that previews take are made when nothing else is to be. */
static void prepare_previews(struct turner_reload *reload)
{
    struct turner_sources sources = {0};
    reload->previews = false; /* what fails once does so again */
    read_previews(reload, &sources, true);
    if (sources.lighting.text && sources.visibility.text)
        start(reload, &sources, 0);
    turner_sources_destroy(&sources);
}

enum turner_result turner_reload_rest(struct turner_reload *reload,
                                      const struct turner_scene *scene,
                                      const struct turner_render_options *options)
{
    if (reload->state != TURNER_RELOAD_CURRENT || reload->build)
        return TURNER_OK;
    if (reload->previews)
        prepare_previews(reload);
    if (reload->preview.recorded || !turner_program_exists(&reload->preview.visibility) ||
        !turner_program_exists(&reload->lighting.program))
        return TURNER_OK;
    return turner_preview_record(&reload->preview, reload->renderer, &reload->lighting, scene,
                                 options);
}

bool turner_reload_has_preview(const struct turner_reload *reload)
{
    const struct turner_rebuild *build = reload->build;
    return build && build->text == reload->wanted && reload->preview.recorded &&
           !build->lighting_shown && atomic_load(&build->lit) &&
           turner_program_exists(&build->lighting.program);
}

enum turner_result turner_reload_preview(struct turner_reload *reload, struct turner_image *image,
                                         const struct turner_scene *scene)
{
    struct turner_rebuild *build = reload->build;
    build->lighting_shown = true;
    enum turner_result result = turner_preview_light(&reload->preview, image, reload->renderer,
                                                     &build->lighting, scene);
    turner_rebuild_go_on(build);
    return result;
}

/* ---- its beginning and end ---- */

enum turner_result turner_reload_create(struct turner_reload **out,
                                        struct turner_renderer *renderer,
                                        const struct turner_scene *scene,
                                        const struct turner_render_options *options,
                                        struct timespec since)
{
    struct turner_reload *reload = turner_calloc(1, sizeof *reload);
    struct turner_sources sources;
    *out = reload;
    reload->renderer = renderer;
    copy_options(reload, options);
    reload->scene = copy_of(scene);
    /* what has changed since then is dirty, and seen at the first poll */
    enum turner_result result = read_sources(reload, &sources, since);
    if (result == TURNER_OK && turner_source_hash(&sources.picture) == renderer->source &&
        turner_source_hash(&sources.post) == renderer->post.source)
        reload->wanted = reload->current = hash_of(reload, &sources, &reload->picture);
    else if (result == TURNER_OK)
        look(reload); /* it is so already */
    turner_sources_destroy(&sources);
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
    drop_stale(reload, true);
    turner_rebuild_destroy(reload->build);
    turner_preview_destroy(reload->renderer->gpu, &reload->preview);
    turner_lighting_destroy(reload->renderer->gpu, &reload->lighting);
    turner_watch_clear(&reload->watch);
    turner_scene_destroy(reload->scene);
    for (size_t i = 0; i < reload->options.shader_dir_count; i++)
        free((char *)reload->options.shader_dirs[i]);
    free((void *)reload->options.shader_dirs);
    free(reload->message);
    free(reload);
}
