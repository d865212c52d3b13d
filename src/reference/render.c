#include "reference/reference.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/memory.h"
#include "reference/trace.h"
#include "scene/ids.h"

/* ---- camera ---- */

struct view {
    turner_vector from, u, v, w;
    turner_real spacing; /* of samples in the plane at distance 1 */
    turner_real half_width, half_height;
};

static struct view view_of(const struct turner_scene *scene)
{
    const struct turner_camera *camera = &scene->camera;
    const struct turner_settings *settings = &scene->settings;
    struct view view = {.from = widen(camera->from),
                        .half_width = settings->width / 2.0L,
                        .half_height = settings->height / 2.0L};
    view.w = normalize(sub(widen(camera->from), widen(camera->at)));
    view.u = normalize(cross(widen(camera->up), view.w));
    view.v = cross(view.w, view.u);
    int rows = settings->spd_grid ? settings->height - 2 : settings->height;
    view.spacing = 2 * tanl((turner_real)camera->vfov / 2) / rows;
    return view;
}

static turner_vector view_direction(const struct view *view, turner_real px, turner_real py)
{
    turner_real x = (px - view->half_width) * view->spacing;
    turner_real y = (view->half_height - py) * view->spacing;
    return normalize(sub(add(scale(view->u, x), scale(view->v, y)), view->w));
}

/* ---- sample positions ---- */

/* 64 bits that look like chance: the step of splitmix64 (Steele, Lea and Flood, OOPSLA 2014). */
static uint64_t scramble(uint64_t state)
{
    state += 0x9e3779b97f4a7c15u;
    state = (state ^ state >> 30) * 0xbf58476d1ce4e5b9u;
    state = (state ^ state >> 27) * 0x94d049bb133111ebu;
    return state ^ state >> 31;
}

struct shift {
    double x, y; /* [0,1) */
};

static struct shift shift_of(uint32_t pattern, int column, int row)
{
    if (pattern == 0)
        return (struct shift){0, 0};
    uint64_t bits = scramble(scramble(pattern) ^ ((uint64_t)row << 32 | (uint64_t)column));
    return (struct shift){(double)(bits >> 32) * 0x1p-32, (double)(bits & UINT32_MAX) * 0x1p-32};
}

static double wrap(double position)
{
    return position - floor(position);
}

/* ---- work shared between threads ---- */

struct job {
    const struct turner_world *world;
    struct turner_image *image;
    struct turner_layers *layers; /* or NULL */
    const struct turner_ids *ids; /* when they are wanted */
    struct view view;
    uint32_t pattern;
    atomic_int next_row;
    atomic_bool stop;
    pthread_mutex_t mutex; /* guards what follows */
    pthread_cond_t changed;
    int rows_done, workers;
    struct turner_reference_statistics statistics;
};

static void put(float *plane, size_t pixel, turner_vector v)
{
    if (!plane)
        return;
    plane[3 * pixel] = (float)v.x;
    plane[3 * pixel + 1] = (float)v.y;
    plane[3 * pixel + 2] = (float)v.z;
}

static uint32_t id_of(const struct job *job, const struct turner_place *place)
{
    return place->instance == TURNER_INSTANCE_PLANES
               ? 1 + place->primitive
               : turner_id_of(job->ids, (uint32_t)place->instance, place->primitive);
}

/* The layers that the ray through the pixel's centre decides. */
static void fill_center(const struct job *job, int column, int row, size_t pixel)
{
    const struct turner_layers *layers = job->layers;
    struct turner_first_hit first;
    turner_vector d = view_direction(&job->view, column + 0.5L, row + 0.5L);
    bool found = turner_trace_first_hit(&first, job->world, job->view.from, d);
    if (layers->real[TURNER_LAYER_DEPTH])
        layers->real[TURNER_LAYER_DEPTH][pixel] = found ? (float)first.depth : INFINITY;
    if (!found)
        return;
    put(layers->real[TURNER_LAYER_NORMAL], pixel, first.normal);
    put(layers->real[TURNER_LAYER_ALBEDO], pixel, first.albedo);
    put(layers->real[TURNER_LAYER_POSITION], pixel, first.position);
    if (layers->whole[TURNER_LAYER_ID])
        layers->whole[TURNER_LAYER_ID][pixel] = id_of(job, &first.place);
}

static uint64_t rays_of(const struct turner_reference_statistics *s)
{
    return s->camera_rays + s->reflected_rays + s->refracted_rays + s->shadow_rays;
}

/* The layers that count the pixel's rays: `before` is from before the first of them. */
static void fill_counts(const struct job *job, const struct turner_reference_statistics *before,
                        const struct turner_reference_statistics *now, size_t pixel)
{
    uint64_t rays = rays_of(now) - rays_of(before);
    uint32_t *const *whole = job->layers->whole;
    if (whole[TURNER_LAYER_RAYS])
        whole[TURNER_LAYER_RAYS][pixel] = rays < UINT32_MAX ? (uint32_t)rays : UINT32_MAX;
    if (whole[TURNER_LAYER_RECURSION])
        whole[TURNER_LAYER_RECURSION][pixel] = (uint32_t)now->largest_depth;
}

static void render_row(struct job *job, struct turner_tracer *tracer, int row)
{
    const struct turner_settings *settings = &job->world->scene->settings;
    for (int column = 0; column < settings->width; column++) {
        turner_vector sum = grey(0);
        struct shift shift = shift_of(job->pattern, column, row);
        struct turner_reference_statistics before = tracer->statistics;
        tracer->pruned = 0;
        tracer->statistics.largest_depth = 0;
        for (int i = 0; i < settings->spp; i++) {
            double sx, sy;
            turner_sample_position(&sx, &sy, i, settings->spp);
            turner_vector d = view_direction(&job->view, column + (turner_real)wrap(sx + shift.x),
                                             row + (turner_real)wrap(sy + shift.y));
            sum = add(sum, turner_trace_camera(tracer, job->view.from, d));
        }
        size_t pixel = (size_t)row * (size_t)settings->width + (size_t)column;
        float *rgba = job->image->rgba + 4 * pixel;
        rgba[0] = (float)(sum.x / settings->spp);
        rgba[1] = (float)(sum.y / settings->spp);
        rgba[2] = (float)(sum.z / settings->spp);
        rgba[3] = (float)(tracer->pruned / settings->spp);
        if (job->layers) {
            fill_center(job, column, row, pixel);
            fill_counts(job, &before, &tracer->statistics, pixel);
        }
        if (before.largest_depth > tracer->statistics.largest_depth)
            tracer->statistics.largest_depth = before.largest_depth;
    }
}

static void add_statistics(struct turner_reference_statistics *sum,
                           const struct turner_reference_statistics *part)
{
    sum->camera_rays += part->camera_rays;
    sum->reflected_rays += part->reflected_rays;
    sum->refracted_rays += part->refracted_rays;
    sum->shadow_rays += part->shadow_rays;
    sum->tir_rays += part->tir_rays;
    sum->camera_hits += part->camera_hits;
    if (part->largest_depth > sum->largest_depth)
        sum->largest_depth = part->largest_depth;
}

static void *work(void *argument)
{
    struct job *job = argument;
    struct turner_tracer tracer = {.world = job->world};
    while (!atomic_load(&job->stop)) {
        int row = atomic_fetch_add(&job->next_row, 1);
        if (row >= job->image->height)
            break;
        render_row(job, &tracer, row);
        pthread_mutex_lock(&job->mutex);
        job->rows_done++;
        pthread_cond_signal(&job->changed);
        pthread_mutex_unlock(&job->mutex);
    }
    pthread_mutex_lock(&job->mutex);
    add_statistics(&job->statistics, &tracer.statistics);
    job->workers--;
    pthread_cond_signal(&job->changed);
    pthread_mutex_unlock(&job->mutex);
    return NULL;
}

/* Starts a thread whose stack holds a recursion of that depth (a level takes about 3 KiB, several
 * times that under AddressSanitizer). */
static int start(pthread_t *thread, int depth, void *(*run)(void *), void *argument)
{
    pthread_attr_t attributes;
    int error = pthread_attr_init(&attributes);
    if (error)
        return error;
    error = pthread_attr_setstacksize(&attributes, (1u << 20) + (size_t)(depth + 1) * (32u << 10));
    if (!error)
        error = pthread_create(thread, &attributes, run, argument);
    pthread_attr_destroy(&attributes);
    return error;
}

/* Waits for the workers and reports how far they are. */
static void watch(struct job *job, turner_progress progress, void *user)
{
    int reported = 0;
    pthread_mutex_lock(&job->mutex);
    for (;;) {
        if (progress && job->rows_done > reported && !atomic_load(&job->stop)) {
            reported = job->rows_done;
            pthread_mutex_unlock(&job->mutex);
            if (!progress((double)reported / job->image->height, user))
                atomic_store(&job->stop, true);
            pthread_mutex_lock(&job->mutex);
        } else if (job->workers > 0) {
            pthread_cond_wait(&job->changed, &job->mutex);
        } else {
            break;
        }
    }
    pthread_mutex_unlock(&job->mutex);
}

static int thread_count(int asked, int rows)
{
    long cores = sysconf(_SC_NPROCESSORS_ONLN);
    int count = asked > 0 ? asked : cores > 0 ? (int)cores : 1;
    return count < rows ? count : rows;
}

static enum turner_result render(struct turner_image *image, struct turner_layers *layers,
                                 const struct turner_scene *scene, uint32_t pattern, int threads,
                                 struct turner_reference_statistics *statistics,
                                 turner_progress progress, void *user)
{
    struct turner_world world = {0};
    struct turner_ids ids = {0};
    pthread_t *handles = NULL;
    enum turner_result result = TURNER_OK;
    int started = 0;
    *image = (struct turner_image){0};
    TURNER_TRY_DONE(turner_world_create(&world, scene));
    TURNER_TRY_DONE(turner_image_create(image, scene->settings.width, scene->settings.height));
    if (layers && layers->whole[TURNER_LAYER_ID])
        TURNER_TRY_DONE(turner_ids_create(&ids, scene));

    struct job job = {.world = &world, .image = image, .layers = layers, .ids = &ids,
                      .view = view_of(scene), .pattern = pattern};
    threads = thread_count(threads, image->height);
    handles = turner_calloc((size_t)threads, sizeof *handles);
    pthread_mutex_init(&job.mutex, NULL);
    pthread_cond_init(&job.changed, NULL);
    for (; started < threads; started++) {
        pthread_mutex_lock(&job.mutex);
        job.workers++;
        pthread_mutex_unlock(&job.mutex);
        if (start(&handles[started], scene->settings.depth, work, &job)) {
            pthread_mutex_lock(&job.mutex);
            job.workers--;
            pthread_mutex_unlock(&job.mutex);
            break; /* fewer threads do the same work */
        }
    }
    watch(&job, progress, user);
    for (int i = 0; i < started; i++)
        pthread_join(handles[i], NULL);
    pthread_cond_destroy(&job.changed);
    pthread_mutex_destroy(&job.mutex);

    if (started == 0)
        result = turner_fail(TURNER_DEVICE, "cannot start a thread for the reference tracer; "
                                            "raise the limit of processes or memory");
    else if (atomic_load(&job.stop))
        result = turner_fail(TURNER_INTERRUPTED, "rendering was stopped");
    if (statistics)
        *statistics = job.statistics;
done:
    if (result != TURNER_OK)
        turner_image_destroy(image);
    free(handles);
    turner_ids_destroy(&ids);
    turner_world_destroy(&world);
    return result;
}

enum turner_result turner_reference_render(struct turner_image *image,
                                           const struct turner_scene *scene, int threads,
                                           struct turner_reference_statistics *statistics,
                                           turner_progress progress, void *user)
{
    return render(image, NULL, scene, 0, threads, statistics, progress, user);
}

enum turner_result turner_reference_render_pattern(struct turner_image *image,
                                                   const struct turner_scene *scene,
                                                   uint32_t pattern, int threads,
                                                   struct turner_reference_statistics *statistics,
                                                   turner_progress progress, void *user)
{
    return render(image, NULL, scene, pattern, threads, statistics, progress, user);
}

enum turner_result turner_reference_render_layers(struct turner_image *image,
                                                  struct turner_layers *layers,
                                                  const struct turner_scene *scene, int threads,
                                                  struct turner_reference_statistics *statistics,
                                                  turner_progress progress, void *user)
{
    return render(image, layers, scene, 0, threads, statistics, progress, user);
}

/* ---- one ray ---- */

struct probe {
    struct turner_tracer tracer;
    turner_vector origin, direction, radiance;
};

static void *run_probe(void *argument)
{
    struct probe *probe = argument;
    probe->radiance = turner_trace_camera(&probe->tracer, probe->origin, probe->direction);
    return NULL;
}

static enum turner_result probe_on_thread(struct probe *probe)
{
    pthread_t thread;
    if (start(&thread, probe->tracer.world->scene->settings.depth, run_probe, probe))
        return turner_fail(TURNER_DEVICE, "cannot start a thread for the reference tracer; "
                                          "raise the limit of processes or memory");
    pthread_join(thread, NULL);
    return TURNER_OK;
}

enum turner_result turner_reference_radiance(struct turner_vec3 *radiance, double *pruned,
                                             const struct turner_scene *scene,
                                             struct turner_vec3 origin,
                                             struct turner_vec3 direction)
{
    struct turner_world world = {0};
    enum turner_result result = TURNER_OK;
    TURNER_TRY_DONE(turner_world_create(&world, scene));
    struct probe probe = {.tracer = {.world = &world},
                          .origin = widen(origin),
                          .direction = normalize(widen(direction))};
    TURNER_TRY_DONE(probe_on_thread(&probe));
    *radiance = turner_vec3_of((double)probe.radiance.x, (double)probe.radiance.y,
                               (double)probe.radiance.z);
    if (pruned)
        *pruned = (double)probe.tracer.pruned;
done:
    turner_world_destroy(&world);
    return result;
}

enum turner_result turner_reference_explain(struct turner_ray_tree *tree,
                                            const struct turner_scene *scene, double px, double py)
{
    struct turner_world world = {0};
    enum turner_result result = TURNER_OK;
    *tree = (struct turner_ray_tree){.mantissa = LDBL_MANT_DIG};
    TURNER_TRY_DONE(turner_world_create(&world, scene));
    struct view view = view_of(scene);
    struct probe probe = {.tracer = {.world = &world, .tree = tree},
                          .origin = view.from,
                          .direction = view_direction(&view, px, py)};
    TURNER_TRY_DONE(probe_on_thread(&probe));
    tree->radiance[0] = probe.radiance.x;
    tree->radiance[1] = probe.radiance.y;
    tree->radiance[2] = probe.radiance.z;
    tree->pruned = probe.tracer.pruned;
done:
    turner_world_destroy(&world);
    return result;
}
