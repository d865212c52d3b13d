#include "render/explain.h"

#include <float.h>
#include <stdio.h>
#include <string.h>

#include "render/renderer.h"

#define EVENTS_MAX (2 * TURNER_RAY_TREE_MAX) /* most rays take two: start and end */

/* ---- one dispatch ---- */

/* What the buffer holds: the kernel's one pixel, and behind it what it noted down. */
struct recording {
    float pixel[4];
    struct turner_gpu_records header;
    struct turner_gpu_record events[];
};
_Static_assert(offsetof(struct recording, header) == TURNER_RECORDS_OFFSET, "");
_Static_assert(offsetof(struct recording, events) ==
                   TURNER_RECORDS_OFFSET + TURNER_RECORDS_HEADER, "");

static enum turner_result trace_pixel(const struct turner_recorder *recorder, int x, int y,
                                      double sample_x, double sample_y)
{
    const struct turner_renderer *renderer = &recorder->renderer;
    const struct turner_settings *settings = &recorder->scene->settings;
    struct recording *recording = recorder->buffer.mapped;
    recording->header = (struct turner_gpu_records){.capacity = EVENTS_MAX};
    memset(renderer->counters.mapped, 0, sizeof(struct turner_gpu_counters));
    struct turner_gpu_dispatch push = {
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = recorder->buffer.address,
        .params = renderer->params.buffer.address,
        .counters = renderer->counters.address,
        .tile_x = (uint32_t)x,
        .tile_y = (uint32_t)y,
        .tile_width = 1,
        .tile_height = 1,
        .sample_x = (float)sample_x,
        .sample_y = (float)sample_y,
        .first = 1,
        .max_depth = (uint32_t)settings->depth,
        .cutoff = (float)settings->cutoff,
    };
    VkCommandBuffer commands;
    TURNER_TRY(turner_gpu_begin(renderer->gpu, &commands));
    turner_program_dispatch(commands, &renderer->program, &push, 1, 1, 1);
    return turner_gpu_submit_wait(renderer->gpu, commands);
}

/* ---- from events to a tree ---- */

struct reader {
    const struct turner_scene *scene;
    const struct recording *recording;
    struct turner_ray_tree *tree;
    uint32_t next, count;
    bool f64;
    bool broken;  /* the events make no sense */
    bool stopped; /* the loop ran into its bound, or the buffer was full */
};

/* The next event if it is one of those (a mask of 1 << what), which it then takes. */
static const struct turner_gpu_record *accept(struct reader *reader, unsigned whats)
{
    if (reader->broken || reader->next == reader->count)
        return NULL;
    const struct turner_gpu_record *event = &reader->recording->events[reader->next];
    if (event->what > TURNER_RECORD_UNFINISHED || !(whats & 1u << event->what))
        return NULL;
    reader->next++;
    return event;
}

static long double number(const struct reader *reader, const struct turner_gpu_record *event,
                          int value)
{
    double d;
    float f;
    uint32_t low = (uint32_t)event->value[value];
    memcpy(&d, &event->value[value], sizeof d);
    memcpy(&f, &low, sizeof f);
    return reader->f64 ? (long double)d : (long double)f;
}

static void numbers(long double out[3], const struct reader *reader,
                    const struct turner_gpu_record *event, int value)
{
    for (int i = 0; i < 3; i++)
        out[i] = number(reader, event, value + i);
}

static uint32_t material_of(const struct turner_scene *scene, const struct turner_ray_place *place)
{
    if (place->kind == TURNER_PRIMITIVE_PLANE)
        return scene->planes[place->index].material;
    const struct turner_instance *instance =
        place->instance ? &scene->instances[place->instance - 1] : NULL;
    if (instance && instance->material != TURNER_NONE)
        return instance->material;
    const struct turner_group *group = &scene->groups[instance ? instance->group : 0];
    if (place->kind == TURNER_PRIMITIVE_SPHERE)
        return group->spheres[place->index].material;
    if (place->kind == TURNER_PRIMITIVE_CONE)
        return group->cones[place->index].material;
    size_t mesh = 0;
    for (uint32_t i = place->index; i >= group->meshes[mesh].triangle_count; mesh++)
        i -= group->meshes[mesh].triangle_count;
    return group->meshes[mesh].material;
}

static struct turner_ray_place place_of(const struct reader *reader,
                                        const struct turner_gpu_record *event)
{
    static const enum turner_primitive_kind kinds[] = {
        [TURNER_KIND_SPHERE] = TURNER_PRIMITIVE_SPHERE,
        [TURNER_KIND_CONE] = TURNER_PRIMITIVE_CONE,
        [TURNER_KIND_TRIANGLE] = TURNER_PRIMITIVE_TRIANGLE,
        [TURNER_KIND_PLANE] = TURNER_PRIMITIVE_PLANE,
    };
    struct turner_ray_place place = {.kind = kinds[event->id >> TURNER_KIND_SHIFT],
                                     .index = event->id & ((1u << TURNER_KIND_SHIFT) - 1),
                                     .instance = event->instance};
    place.material = material_of(reader->scene, &place);
    return place;
}

/* The list as shaders/media.glsl keeps it. */
static void set_media(struct turner_ray_record *ray, uint64_t list)
{
    ray->media_count = 0;
    for (; list & 255; list >>= 8)
        ray->media[ray->media_count++] = (uint32_t)(list & 255) - 1;
}

static struct turner_ray_record *record_of(const struct reader *reader, uint32_t ray)
{
    static struct turner_ray_record beyond; /* what does not fit the tree goes here */
    return ray == TURNER_NONE ? &beyond : &reader->tree->rays[ray];
}

/* A ray that the stream ends in the middle of. */
static void stop(struct reader *reader, uint32_t ray)
{
    if (accept(reader, 1u << TURNER_RECORD_UNFINISHED)) {
        record_of(reader, ray)->end = TURNER_RAY_UNFINISHED;
    } else if (reader->next < reader->count || !reader->tree->truncated) {
        reader->broken = true;
    } else if (ray != TURNER_NONE) { /* the buffer was full: what is known of it is too little */
        reader->tree->count = ray;
        while (reader->tree->crossing_count &&
               reader->tree->crossings[reader->tree->crossing_count - 1].ray == ray)
            reader->tree->crossing_count--;
    }
    reader->stopped = true;
    reader->count = reader->next;
}

static void read_crossings(struct reader *reader, uint32_t ray)
{
    const struct turner_gpu_record *event;
    while ((event = accept(reader, 1u << TURNER_RECORD_CROSSING)))
        turner_ray_tree_cross(reader->tree, ray, place_of(reader, event),
                              number(reader, event, TURNER_RECORD_T),
                              event->flags & TURNER_RECORD_BOUNDARY);
}

/* Whether the kernel went on with something else; not so where it ran into the bound of a loop or
 * the buffer was full. */
static bool goes_on(const struct reader *reader)
{
    if (reader->next == reader->count)
        return !reader->tree->truncated;
    return reader->recording->events[reader->next].what != TURNER_RECORD_UNFINISHED;
}

/* A shadow ray that was sent, to its end. */
static void read_shadow(struct reader *reader, uint32_t shadow)
{
    read_crossings(reader, shadow);
    struct turner_ray_record *ray = record_of(reader, shadow);
    const struct turner_gpu_record *event =
        accept(reader, 1u << TURNER_RECORD_LIT | 1u << TURNER_RECORD_BLOCKED);
    size_t crossings = 0;
    const struct turner_ray_crossing *last = NULL;
    if (shadow != TURNER_NONE)
        last = turner_ray_tree_crossings(reader->tree, shadow, &crossings);
    if (event && event->what == TURNER_RECORD_LIT) {
        ray->end = TURNER_RAY_LIGHT;
        numbers(ray->through, reader, event, TURNER_RECORD_THROUGH);
        numbers(ray->contribution, reader, event, TURNER_RECORD_CONTRIBUTION);
    } else if (event) {
        ray->end = TURNER_RAY_BLOCKED;
        ray->place = place_of(reader, event);
        ray->t = number(reader, event, TURNER_RECORD_T);
    } else if (crossings && goes_on(reader)) {
        ray->end = TURNER_RAY_GIVEN_UP; /* after that crossing */
        ray->place = last[crossings - 1].place;
        ray->t = last[crossings - 1].t;
        reader->tree->crossing_count--;
    } else {
        stop(reader, shadow);
    }
}

static void read_light(struct reader *reader, const struct turner_gpu_record *event,
                       uint32_t depth)
{
    uint32_t index = turner_ray_tree_add(reader->tree, TURNER_RAY_SHADOW, depth);
    struct turner_ray_record *ray = record_of(reader, index);
    ray->light = event->light;
    ray->t = number(reader, event, TURNER_RECORD_T);
    ray->n_l = number(reader, event, TURNER_RECORD_N_L);
    ray->r_v = number(reader, event, TURNER_RECORD_R_V);
    numbers(ray->direction, reader, event, TURNER_RECORD_DIRECTION);
    numbers(ray->weight, reader, event, TURNER_RECORD_WEIGHT);
    numbers(ray->irradiance, reader, event, TURNER_RECORD_IRRADIANCE);
    if (!(event->flags & TURNER_RECORD_ASKED)) {
        bool reaches = ray->irradiance[0] > 0 || ray->irradiance[1] > 0 || ray->irradiance[2] > 0;
        ray->end = reaches ? TURNER_RAY_FACES_AWAY : TURNER_RAY_OUT_OF_REACH;
        return;
    }
    numbers(ray->origin, reader, event, TURNER_RECORD_ORIGIN);
    numbers(ray->diffuse, reader, event, TURNER_RECORD_DIFFUSE);
    numbers(ray->specular, reader, event, TURNER_RECORD_SPECULAR);
    set_media(ray, event->media);
    read_shadow(reader, index);
}

static void read_ray(struct reader *reader, enum turner_ray_kind kind, uint32_t depth);

/* What the surface of that event sends on, `followed` or not. */
static void read_secondary(struct reader *reader, const struct turner_gpu_record *surface,
                           uint32_t depth, bool refracted, uint64_t media)
{
    enum turner_ray_kind kind = refracted ? TURNER_RAY_REFRACTED : TURNER_RAY_REFLECTED;
    if (surface->flags & (refracted ? TURNER_RECORD_REFRACTS : TURNER_RECORD_REFLECTS)) {
        read_ray(reader, kind, depth);
        return;
    }
    long double weight[3];
    numbers(weight, reader, surface, refracted ? TURNER_RECORD_W_T : TURNER_RECORD_W_R);
    bool lost = reader->tree->truncated && reader->next == reader->count;
    if (!(weight[0] > 0 || weight[1] > 0 || weight[2] > 0) || reader->stopped || lost)
        return;
    struct turner_ray_record *ray =
        record_of(reader, turner_ray_tree_add(reader->tree, kind, depth));
    ray->end = TURNER_RAY_CUT;
    ray->through[0] = ray->through[1] = ray->through[2] = 1;
    memcpy(ray->weight, weight, sizeof weight);
    numbers(ray->origin, reader, surface,
            refracted ? TURNER_RECORD_REFRACTED_ORIGIN : TURNER_RECORD_REFLECTED_ORIGIN);
    numbers(ray->direction, reader, surface,
            refracted ? TURNER_RECORD_REFRACTED : TURNER_RECORD_REFLECTED);
    set_media(ray, media);
}

static void set_surface(struct turner_ray_record *ray, const struct reader *reader,
                        const struct turner_gpu_record *event)
{
    ray->place = place_of(reader, event);
    ray->place.material = event->material; /* what the device took */
    const struct turner_material *material = &reader->scene->materials[event->material];
    struct turner_vec3 k_r = material->k_r, k_t = material->k_t;
    numbers(ray->point, reader, event, TURNER_RECORD_POINT);
    numbers(ray->ng, reader, event, TURNER_RECORD_NG);
    numbers(ray->ns, reader, event, TURNER_RECORD_NS);
    ray->cosine = number(reader, event, TURNER_RECORD_COSINE);
    ray->secondary = k_r.x + k_r.y + k_r.z + k_t.x + k_t.y + k_t.z > 0;
    if (!ray->secondary)
        return;
    ray->n1 = number(reader, event, TURNER_RECORD_N1);
    ray->n2 = number(reader, event, TURNER_RECORD_N2);
    ray->total = event->flags & TURNER_RECORD_TOTAL;
    ray->has_fresnel = event->flags & TURNER_RECORD_FRESNEL_KNOWN;
    numbers(ray->fresnel, reader, event, TURNER_RECORD_FRESNEL);
}

/* A ray that is not a shadow ray, and all that comes of it. */
static void read_ray(struct reader *reader, enum turner_ray_kind kind, uint32_t depth)
{
    const struct turner_gpu_record *start = accept(reader, 1u << TURNER_RECORD_RAY);
    if (!start && reader->stopped)
        return;
    uint32_t index = turner_ray_tree_add(reader->tree, kind, depth);
    if (!start) {
        stop(reader, index);
        return;
    }
    struct turner_ray_record *ray = record_of(reader, index);
    numbers(ray->origin, reader, start, TURNER_RECORD_ORIGIN);
    numbers(ray->direction, reader, start, TURNER_RECORD_DIRECTION);
    numbers(ray->weight, reader, start, TURNER_RECORD_WEIGHT);
    set_media(ray, start->media);
    read_crossings(reader, index);
    const struct turner_gpu_record *end =
        accept(reader, 1u << TURNER_RECORD_BACKGROUND | 1u << TURNER_RECORD_SURFACE);
    if (!end) {
        stop(reader, index);
        return;
    }
    bool surface = end->what == TURNER_RECORD_SURFACE;
    ray->end = surface ? TURNER_RAY_SURFACE : TURNER_RAY_BACKGROUND;
    ray->t = surface ? number(reader, end, TURNER_RECORD_T) : (long double)INFINITY;
    numbers(ray->through, reader, end, TURNER_RECORD_THROUGH);
    numbers(ray->radiance, reader, end, TURNER_RECORD_RADIANCE);
    numbers(ray->contribution, reader, end, TURNER_RECORD_CONTRIBUTION);
    if (!surface)
        return;
    set_surface(ray, reader, end);
    const struct turner_gpu_record *light;
    while ((light = accept(reader, 1u << TURNER_RECORD_LIGHT)))
        read_light(reader, light, depth + 1);
    read_secondary(reader, end, depth + 1, false, start->media);
    read_secondary(reader, end, depth + 1, true, end->media);
}

static enum turner_result read_tree(struct turner_ray_tree *tree, const struct turner_scene *scene,
                                    const struct recording *recording, bool f64)
{
    uint32_t count = recording->header.count;
    struct reader reader = {.scene = scene, .recording = recording, .tree = tree, .f64 = f64};
    tree->truncated = count > EVENTS_MAX;
    reader.count = tree->truncated ? EVENTS_MAX : count;
    for (int i = 0; i < 3; i++)
        tree->radiance[i] = (long double)recording->pixel[i];
    tree->pruned = (long double)recording->pixel[3];
    tree->mantissa = f64 ? DBL_MANT_DIG : FLT_MANT_DIG;
    if (count > 0)
        read_ray(&reader, TURNER_RAY_CAMERA, 0);
    if (count == 0 || reader.broken || reader.next < reader.count)
        return turner_fail(TURNER_BAD_INPUT,
                           "the shaders note down %s; a whitted.glsl or meeting.glsl of one's own "
                           "must keep the RECORD(…) lines of turner's",
                           count == 0 ? "nothing" : "what makes no tree of rays");
    return TURNER_OK;
}

/* ---- all together ---- */

enum turner_result turner_recorder_create(struct turner_recorder *recorder,
                                          const struct turner_scene *scene,
                                          const struct turner_render_options *options)
{
    memset(recorder, 0, sizeof *recorder);
    recorder->scene = scene;
    struct turner_gpu *gpu = &recorder->gpu;
    struct turner_statistics statistics = {0};
    struct turner_render_options one_pixel = *options;
    one_pixel.tile = 1;
    TURNER_TRY(turner_gpu_create(gpu, options->device, false));
    TURNER_TRY(turner_choose_kernel(&recorder->kind, &gpu->info, &scene->settings.methods,
                                    options->traversal));
    TURNER_TRY(turner_kernel_create(&recorder->kernel, recorder->kind | TURNER_RECORD, options));
    TURNER_TRY(turner_renderer_create(&recorder->renderer, gpu, &recorder->kernel, scene,
                                      &one_pixel, &statistics));
    size_t bytes = sizeof(struct recording) + EVENTS_MAX * sizeof(struct turner_gpu_record);
    return turner_buffer_create(&recorder->buffer, gpu, bytes, 0, TURNER_MEMORY_HOST,
                                "what rays note down");
}

void turner_recorder_destroy(struct turner_recorder *recorder)
{
    turner_buffer_destroy(&recorder->gpu, &recorder->buffer);
    turner_renderer_destroy(&recorder->renderer);
    turner_kernel_destroy(&recorder->kernel);
    turner_gpu_destroy(&recorder->gpu);
}

enum turner_result turner_recorder_trace(struct turner_ray_tree *tree,
                                         struct turner_recorder *recorder, int x, int y,
                                         double sample_x, double sample_y)
{
    *tree = (struct turner_ray_tree){0};
    TURNER_TRY(trace_pixel(recorder, x, y, sample_x, sample_y));
    return read_tree(tree, recorder->scene, recorder->buffer.mapped, recorder->kind & TURNER_F64);
}
