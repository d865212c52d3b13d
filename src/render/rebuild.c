#include "render/rebuild.h"

#include <errno.h>
#include <stdlib.h>
#include <time.h>

#include "base/memory.h"
#include "gpu/cached.h"
#include "gpu/compiler.h"
#include "gpu/translate.h"
#include "render/hooks.h"

void turner_sources_destroy(struct turner_sources *sources)
{
    turner_shader_source_destroy(&sources->picture);
    turner_shader_source_destroy(&sources->post);
    turner_shader_source_destroy(&sources->lighting);
    turner_shader_source_destroy(&sources->visibility);
}

/* ---- the thread ---- */

static enum turner_result still_wanted(const struct turner_rebuild *rebuild)
{
    return atomic_load(&rebuild->given_up) ? TURNER_INTERRUPTED : TURNER_OK;
}

static enum turner_result make_part(struct turner_rebuild *rebuild, struct turner_part *part)
{
    const struct turner_kernel *kernel = &rebuild->kernel;
    struct turner_constant constants[TURNER_KERNEL_CONSTANTS];
    size_t count;
    struct turner_spirv special;
    if (kernel->hooks & 1u << TURNER_HOOK_SURFACE)
        part->needs = part->needs_of_surface;
    TURNER_TRY(turner_kernel_specialisation(constants, &count, kernel, &part->needs,
                                            part->bvh_depth, rebuild->scene));
    TURNER_TRY(rebuild->no_cache
                   ? turner_spirv_reduce(&special, &kernel->spirv, constants, count, false)
                   : turner_spirv_reduce_cached(&special, NULL, &kernel->spirv, constants, count,
                                                false));
    enum turner_result result = still_wanted(rebuild);
    if (result == TURNER_OK)
        result = turner_spirv_validate(&special); /* half of what it was */
    if (result == TURNER_OK)
        result = turner_program_create(&part->program, rebuild->gpu, &special, NULL, 0,
                                       rebuild->no_cache);
    if (result == TURNER_OK && still_wanted(rebuild) == TURNER_OK)
        turner_gpu_translate(rebuild->gpu, &special);
    turner_spirv_destroy(&special);
    return result;
}

static enum turner_result make_picture(struct turner_rebuild *rebuild)
{
    struct turner_sources *sources = &rebuild->sources;
    TURNER_TRY(still_wanted(rebuild));
    TURNER_TRY(turner_kernel_compile(&rebuild->kernel, rebuild->kind, &sources->picture,
                                     rebuild->no_cache));
    TURNER_TRY(still_wanted(rebuild));
    for (int i = 0; i < rebuild->part_count; i++)
        TURNER_TRY(make_part(rebuild, &rebuild->parts[i]));
    if (!(turner_hooks_of(&sources->post) & 1u << TURNER_HOOK_POST))
        return TURNER_OK;
    TURNER_TRY(turner_kernel_compile(&rebuild->post_kernel, 0, &sources->post, rebuild->no_cache));
    TURNER_TRY(turner_spirv_validate(&rebuild->post_kernel.spirv));
    return turner_post_create_program(&rebuild->post, rebuild->gpu, &rebuild->post_kernel,
                                      rebuild->scene, rebuild->no_cache);
}

static struct turner_needs needs_for(const struct turner_part *part,
                                     const struct turner_shader_source *source)
{
    return turner_hooks_of(source) & 1u << TURNER_HOOK_SURFACE ? part->needs_of_surface
                                                              : part->needs;
}

/* The owner shows the preview; half a second is more than it takes. */
static void wait_for_owner(struct turner_rebuild *rebuild)
{
    struct timespec end;
    clock_gettime(CLOCK_REALTIME, &end);
    end.tv_nsec += 500000000;
    end.tv_sec += end.tv_nsec / 1000000000;
    end.tv_nsec %= 1000000000;
    while (sem_timedwait(&rebuild->go_on, &end) != 0 && errno == EINTR)
        ;
}

static void *run(void *user)
{
    struct turner_rebuild *rebuild = user;
    struct turner_sources *sources = &rebuild->sources;
    const struct turner_part *part = rebuild->parts;
    if (sources->lighting.text) { /* where it fails, there is no preview; the picture says why */
        struct turner_needs needs = needs_for(part, &sources->lighting);
        turner_lighting_create(&rebuild->lighting, rebuild->gpu, &sources->lighting, rebuild->kind,
                               &needs, rebuild->scene, rebuild->no_cache);
    }
    atomic_store(&rebuild->lit, true);
    if (rebuild->previewed && turner_program_exists(&rebuild->lighting.program))
        wait_for_owner(rebuild);
    if (sources->picture.text)
        rebuild->result = make_picture(rebuild);
    if (rebuild->result != TURNER_OK)
        rebuild->message = turner_strdup(turner_message()); /* each thread has its own */
    rebuild->seconds = turner_seconds() - rebuild->start;
    if (sources->visibility.text && still_wanted(rebuild) == TURNER_OK)
        turner_visibility_create(&rebuild->visibility, rebuild->gpu, &sources->visibility,
                                 rebuild->kind, &part->needs, part->bvh_depth, rebuild->scene,
                                 rebuild->no_cache);
    if (sources->visibility.text)
        turner_compiler_warm(); /* the cache may have had both */
    atomic_store(&rebuild->done, true);
    return NULL;
}

/* ---- its owner ---- */

static struct turner_part part_of(const struct turner_renderer *renderer)
{
    return (struct turner_part){.needs = renderer->needs_of_scene,
                                .needs_of_surface = renderer->needs_of_surface,
                                .bvh_depth = renderer->flat.max_depth};
}

static void release(struct turner_rebuild *rebuild)
{
    for (int i = 0; i < rebuild->part_count; i++)
        turner_program_destroy(rebuild->gpu, &rebuild->parts[i].program);
    turner_post_destroy(rebuild->gpu, &rebuild->post);
    turner_lighting_destroy(rebuild->gpu, &rebuild->lighting);
    turner_program_destroy(rebuild->gpu, &rebuild->visibility);
    turner_kernel_destroy(&rebuild->kernel);
    turner_kernel_destroy(&rebuild->post_kernel);
    turner_sources_destroy(&rebuild->sources);
    turner_scene_destroy(rebuild->scene);
    sem_destroy(&rebuild->go_on);
    free(rebuild->message);
    free(rebuild);
}

enum turner_result turner_rebuild_create(struct turner_rebuild **out,
                                         const struct turner_renderer *renderer,
                                         struct turner_scene *scene,
                                         struct turner_sources *sources, uint64_t text,
                                         bool post_only, bool no_cache, bool previewed)
{
    struct turner_rebuild *rebuild = turner_calloc(1, sizeof *rebuild);
    *out = rebuild;
    rebuild->text = text;
    rebuild->gpu = renderer->gpu;
    rebuild->scene = scene;
    rebuild->kind = renderer->kind;
    rebuild->no_cache = no_cache;
    rebuild->previewed = previewed;
    sem_init(&rebuild->go_on, 0, 0);
    rebuild->sources = *sources;
    *sources = (struct turner_sources){0};
    if (!post_only)
        rebuild->parts[rebuild->part_count++] = part_of(renderer);
    if (!post_only && renderer->accurate)
        rebuild->parts[rebuild->part_count++] = part_of(renderer->accurate);
    rebuild->start = turner_seconds();
    if (pthread_create(&rebuild->thread, NULL, run, rebuild) == 0)
        return TURNER_OK;
    release(rebuild);
    *out = NULL;
    return turner_fail(TURNER_DEVICE, "no thread can be started to compile shaders in");
}

void turner_rebuild_go_on(struct turner_rebuild *rebuild)
{
    sem_post(&rebuild->go_on);
}

void turner_rebuild_give_up(struct turner_rebuild *rebuild)
{
    atomic_store(&rebuild->given_up, true);
    turner_rebuild_go_on(rebuild);
}

void turner_rebuild_destroy(struct turner_rebuild *rebuild)
{
    if (!rebuild)
        return;
    turner_rebuild_give_up(rebuild);
    pthread_join(rebuild->thread, NULL);
    release(rebuild);
}
