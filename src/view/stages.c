/* What the painter draws at each stage. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "render/adaptive.h"
#include "render/cells.h"
#include "render/contrast.h"
#include "render/features.h"
#include "render/layers.h"
#include "view/painter.h"

#define PIECE_SECONDS 0.012 /* what is submitted at once: a new wish waits for its end */
#define PART_SECONDS 0.15   /* parts of a picture are shown that often, */
#define PART_FIRST 0.1      /* and not before */
#define QUICK_DEPTH 8       /* where the depth is chosen by an error */

/* ---- the renderer ---- */

void turner_painter_clear(struct turner_painter *painter)
{
    turner_painter_unwatch(painter);
    turner_renderer_destroy(&painter->renderer);
    turner_kernel_destroy(&painter->kernel);
    turner_image_destroy(&painter->quick);
    turner_image_destroy(&painter->full);
    turner_image_destroy(&painter->colors);
    turner_image_destroy(&painter->plain);
    turner_image_destroy(&painter->soon);
    free(painter->materials);
    free(painter->lights);
    painter->materials = NULL;
    painter->lights = NULL;
    turner_sight_destroy(&painter->own);
    painter->ready = false;
}

static bool same_methods(const struct turner_methods *a, const struct turner_methods *b)
{
    return a->sphere == b->sphere && a->triangle == b->triangle && a->offset == b->offset &&
           a->tmin == b->tmin && a->fresnel_cosine == b->fresnel_cosine &&
           a->fresnel == b->fresnel && a->schlick_side == b->schlick_side &&
           a->precision == b->precision && a->traversal == b->traversal;
}

/* Whether what was made for the settings `built` can draw with `now`, too. */
static bool fits(const struct turner_settings *built, const struct turner_settings *now)
{
    return same_methods(&built->methods, &now->methods) && built->shading == now->shading &&
           built->shadows == now->shadows && built->spd_rays == now->spd_rays &&
           built->depth >= now->depth && (built->error > 0) == (now->error > 0) &&
           (turner_adaptive_wanted(built) || !turner_adaptive_wanted(now));
}

static enum turner_result create(struct turner_painter *painter)
{
    const struct turner_render_options *options = &painter->render;
    struct turner_statistics *made = &painter->made;
    struct turner_gpu *gpu = &painter->opening->gpu;
    const struct turner_methods *methods = &painter->scene.settings.methods;
    *made = (struct turner_statistics){0};
    if (painter->reload) /* its files may have changed since */
        turner_kernel_destroy(&painter->kernel);
    turner_painter_unwatch(painter);
    painter->since = turner_watch_now();
    turner_painter_find_shaders(painter);
    painter->own.changes.built++;
    struct turner_layers rays = {.wanted = TURNER_LAYERS_OF_RAYS};
    struct turner_render_options counting = *options;
    counting.layers = painter->counts ? &rays : NULL;
    if (!painter->count) {
        turner_renderer_destroy(&painter->renderer);
        TURNER_TRY(turner_opening_prepare(&painter->renderer, &painter->kernel, painter->opening,
                                          &painter->scene, &counting, made));
    } else {
        unsigned kind;
        TURNER_TRY(turner_choose_kernel(&kind, &gpu->info, methods, options->traversal));
        if (kind != painter->kernel.kind || !painter->kernel.spirv.words) {
            turner_kernel_destroy(&painter->kernel);
            TURNER_TRY(turner_kernel_create(&painter->kernel, kind, options));
        }
        turner_renderer_destroy(&painter->renderer);
        TURNER_TRY(turner_renderer_prepare(&painter->renderer, &painter->kernel, &painter->scene,
                                           &counting, made));
    }
    TURNER_TRY(turner_renderer_finish(&painter->renderer, gpu, &painter->kernel, &painter->scene,
                                      &counting, made));
    TURNER_TRY(turner_renderer_warm(&painter->renderer));
    painter->renderer.piece = PIECE_SECONDS;
    snprintf(made->device, sizeof made->device, "%s", gpu->info.name);
    snprintf(made->driver, sizeof made->driver, "%s", gpu->info.driver);
    made->traversal = turner_traversal_name(painter->kernel.kind);
    made->precision = methods->precision == TURNER_PRECISION_F64 ? "f64" : "f32";
    return TURNER_OK;
}

enum turner_result turner_painter_prepare(struct turner_painter *painter,
                                          const struct turner_wish *wish)
{
    bool counts = turner_seen_layers(wish->seen) & TURNER_LAYERS_OF_RAYS;
    bool ready = painter->ready && counts == painter->counts &&
                 fits(&painter->built, &wish->settings) &&
                 (!wish->camera.inside_count ||
                  painter->renderer.needs.bits & TURNER_NEEDS_MEDIA);
    painter->counts = counts;
    painter->scene.camera = wish->camera;
    painter->scene.settings = wish->settings;
    if (!ready) {
        painter->ready = false;
        TURNER_TRY(create(painter));
        painter->built = wish->settings;
        painter->ready = true;
    }
    int depth = wish->settings.error > 0 ? QUICK_DEPTH : wish->settings.depth;
    if (!ready || depth != painter->pace.depth[0])
        turner_pace_start(&painter->pace, depth);
    if (painter->options.turn && painter->pace.seconds == TURNER_PACE_SECONDS)
        painter->pace.seconds /= 2; /* the other one is to be drawn in a frame, too */
    return TURNER_OK;
}

enum turner_result turner_painter_take_paint(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = painter->fresh_painted;
    struct turner_scene painted = painter->painted, before = painter->scene;
    painter->fresh_painted = false;
    if (fresh)
        painter->painted = (struct turner_scene){0};
    pthread_mutex_unlock(&painter->mutex);
    if (!fresh)
        return TURNER_OK;
    painter->scene.materials = painted.materials;
    painter->scene.lights = painted.lights;
    painter->scene.ambient = painted.ambient;
    painter->scene.background = painted.background;
    bool fits = false;
    enum turner_result result = TURNER_OK;
    if (painter->ready)
        result = turner_renderer_paint(&painter->renderer, &before, &painter->scene, &fits);
    painter->ready = painter->ready && fits;
    free(painter->materials);
    free(painter->lights);
    painter->materials = painted.materials;
    painter->lights = painted.lights;
    return result;
}

/* ---- for the eye ---- */

struct rows {
    const struct turner_packer *packer;
    uint8_t *rgba;
    int rows; /* a piece */
};

static void pack_rows(void *user, uint32_t piece)
{
    const struct rows *rows = user;
    const struct turner_image *image = rows->packer->image;
    int first = (int)piece * rows->rows, end = first + rows->rows;
    uint8_t *line = turner_calloc((size_t)image->width * 3, 1);
    for (int y = first; y < end && y < image->height; y++) {
        uint8_t *to = rows->rgba + 4 * (size_t)y * (size_t)image->width;
        turner_packer_rows(line, rows->packer, y, 1);
        for (int x = 0; x < image->width; x++) {
            memcpy(to + 4 * x, line + 3 * x, 3);
            to[4 * x + 3] = 255;
        }
    }
    free(line);
}

/* The same bytes as in a PNG file. */
static void pack(struct turner_painter *painter, const struct turner_image *image)
{
    const struct turner_settings *settings = &painter->scene.settings;
    bool colors = image == &painter->colors; /* for the screen as they are */
    bool linear = colors || settings->transfer == TURNER_TRANSFER_LINEAR;
    double exposure = colors ? 0 : settings->exposure;
    struct turner_sight *own = &painter->own;
    if (!painter->packer.format || painter->exposure != exposure || painter->linear != linear) {
        struct turner_image_encoding encoding = {.exposure = exposure, .linear = linear};
        painter->exposure = exposure;
        painter->linear = linear;
        turner_packer_create(&painter->packer, turner_format_find("a.png"), image, &encoding);
    }
    painter->packer.image = image;
    own->width = image->width;
    own->height = image->height;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    if (own->room < pixels) {
        own->rgba = turner_realloc(own->rgba, pixels, 4);
        own->room = pixels;
    }
    struct rows rows = {&painter->packer, own->rgba, 32};
    turner_parallel_for((uint32_t)((image->height + rows.rows - 1) / rows.rows), pack_rows, &rows);
}

/* For the window to compare it with that of the other painter. */
static void keep_linear(struct turner_painter *painter, const struct turner_image *image,
                        enum turner_stage stage)
{
    struct turner_sight *own = &painter->own;
    size_t floats = 4 * (size_t)image->width * (size_t)image->height;
    if (!painter->options.turn || stage != TURNER_STAGE_DONE)
        return;
    if (own->linear_room < floats) {
        own->linear = turner_realloc(own->linear, floats, sizeof *own->linear);
        own->linear_room = floats;
    }
    memcpy(own->linear, image->rgba, floats * sizeof *own->linear);
}

void turner_painter_publish(struct turner_painter *painter, const struct turner_image *image,
                            const struct turner_settings *settings, enum turner_stage stage,
                            double share)
{
    pack(painter, image);
    struct turner_sight *own = &painter->own, old;
    own->settings = *settings;
    own->stage = stage;
    own->share = share;
    own->seconds = turner_seconds() - painter->started;
    own->count = painter->count;
    painter->last = image;
    keep_linear(painter, image, stage);
    struct turner_sight said = *own;
    pthread_mutex_lock(&painter->mutex);
    old = painter->sight;
    painter->sight = *own;
    painter->fresh_sight = true;
    pthread_mutex_unlock(&painter->mutex);
    *own = said;
    own->rgba = old.rgba;
    own->room = old.room;
    own->linear = old.linear;
    own->linear_room = old.linear_room;
    painter->shown = turner_seconds();
    painter->options.wake(painter->options.user);
}

/* ---- drawing ---- */

/* What stands between turner_renderer_draw and the world. */
struct drawing {
    struct turner_painter *painter;
    const struct turner_settings *settings;
    struct turner_image *image;
    enum turner_stage stage;
    bool gives_way; /* to the other painter */
};

static bool progress(double share, void *user)
{
    struct drawing *drawing = user;
    struct turner_painter *painter = drawing->painter;
    pthread_mutex_lock(&painter->mutex);
    bool quit = painter->quit, go_on = !quit && !painter->fresh_wish && !painter->pick;
    pthread_mutex_unlock(&painter->mutex);
    if (drawing->stage == TURNER_STAGE_QUICK)
        return !quit; /* soon finished: a frame that is given up is one that is missed */
    double now = turner_seconds();
    go_on = go_on && !turner_painter_outdated(painter) &&
            !(drawing->gives_way && turner_turn_wanted(painter->options.turn));
    if (go_on && share < 1 && drawing->image && now - painter->shown > PART_SECONDS &&
        now - painter->started > PART_FIRST)
        turner_painter_publish(painter, drawing->image, drawing->settings, drawing->stage, share);
    return go_on;
}

enum turner_result turner_painter_resize(struct turner_image *image, int width, int height)
{
    if (image->width == width && image->height == height)
        return TURNER_OK;
    turner_image_destroy(image);
    return turner_image_create(image, width, height);
}

static float mix(const float *a, const float *b, float t)
{
    return *a + t * (*b - *a);
}

/* `from` magnified, for the eye until something better is there. */
static void enlarge(struct turner_image *to, const struct turner_image *from)
{
    for (int y = 0; y < to->height; y++) {
        float v = ((float)y + 0.5f) * (float)from->height / (float)to->height - 0.5f;
        v = fminf(fmaxf(v, 0), (float)(from->height - 1));
        int row = (int)v, below = row + 1 < from->height ? row + 1 : row;
        for (int x = 0; x < to->width; x++) {
            float u = ((float)x + 0.5f) * (float)from->width / (float)to->width - 0.5f;
            u = fminf(fmaxf(u, 0), (float)(from->width - 1));
            int column = (int)u, right = column + 1 < from->width ? column + 1 : column;
            const float *a = from->rgba + 4 * ((size_t)row * (size_t)from->width);
            const float *b = from->rgba + 4 * ((size_t)below * (size_t)from->width);
            float *out = to->rgba + 4 * ((size_t)y * (size_t)to->width + (size_t)x);
            for (int i = 0; i < 4; i++) {
                float above = mix(a + 4 * column + i, a + 4 * right + i, u - (float)column);
                float under = mix(b + 4 * column + i, b + 4 * right + i, u - (float)column);
                out[i] = mix(&above, &under, v - (float)row);
            }
        }
    }
}

static struct turner_settings single(const struct turner_settings *full)
{
    struct turner_settings settings = *full;
    settings.spp = 1;
    settings.aa_threshold = 0;
    if (settings.error > 0 && settings.depth > QUICK_DEPTH)
        settings.depth = QUICK_DEPTH;
    settings.error = 0;
    return settings;
}

static bool is_single(const struct turner_settings *settings)
{
    return settings->spp == 1 && settings->aa_threshold == 0 && settings->error == 0;
}

static struct turner_settings quick(struct turner_painter *painter,
                                    const struct turner_settings *full)
{
    struct turner_settings settings = single(full);
    turner_pace_choose(&painter->pace, full->width, full->height, &settings.width,
                       &settings.height, &settings.depth);
    if (settings.spd_grid && settings.height < 3) /* that has no picture of fewer rows */
        settings.height = full->height < 3 ? full->height : 3;
    return settings;
}

enum turner_stage turner_painter_first(const struct turner_painter *painter,
                                       const struct turner_wish *wish)
{
    (void)painter;
    (void)wish;
    return TURNER_STAGE_QUICK;
}

enum turner_stage turner_painter_next(const struct turner_wish *wish, enum turner_stage stage)
{
    if (stage == TURNER_STAGE_QUICK)
        return TURNER_STAGE_SINGLE;
    return stage == TURNER_STAGE_SINGLE && !is_single(&wish->settings) ? TURNER_STAGE_FULL
                                                                       : TURNER_STAGE_DONE;
}

static bool same_picture(const struct turner_settings *a, const struct turner_settings *full)
{
    return is_single(full) && a->width == full->width && a->height == full->height &&
           a->depth == full->depth;
}

/* Something else than the picture, as colours. */
static enum turner_result draw_seen(struct turner_painter *painter,
                                    const struct turner_wish *wish, struct turner_image *image,
                                    const struct turner_scene *scene,
                                    struct turner_render_options *options)
{
    struct turner_layers layers = {.wanted = turner_seen_layers(wish->seen)};
    enum turner_result result = turner_layers_create(&layers, scene);
    options->layers = &layers;
    if (result == TURNER_OK && turner_layers_want(&layers, TURNER_LAYERS_OF_CENTER))
        result = turner_features_draw(&layers, &painter->renderer, &painter->kernel, scene,
                                      options, &painter->own.statistics);
    else if (result == TURNER_OK)
        result = turner_renderer_draw(&painter->renderer, image, options,
                                      &painter->own.statistics);
    TURNER_TRY_DONE(result);
    turner_layers_inspect(&layers, image);
    float *error = layers.real[TURNER_LAYER_ERROR];
    if (error && scene->settings.error == 0)
        turner_contrast_estimate(error, image, scene->settings.aa_threshold > 0
                                                   ? TURNER_CELL_SAMPLES : scene->settings.spp);
    TURNER_TRY_DONE(turner_painter_resize(&painter->colors, scene->settings.width, scene->settings.height));
    turner_false_color(&painter->colors, painter->own.legend, wish->seen, &layers, image);
    if (wish->seen == TURNER_SEEN_DIFFERENCE &&
        turner_painter_next(wish, painter->own.stage) == TURNER_STAGE_DONE)
        result = turner_painter_compare(painter, wish, options, &painter->colors);
done:
    turner_layers_destroy(&layers);
    return result;
}

enum turner_result turner_painter_draw(struct turner_painter *painter,
                                       const struct turner_wish *wish, enum turner_stage stage)
{
    const struct turner_settings *full = &wish->settings;
    struct turner_settings settings = stage == TURNER_STAGE_QUICK    ? quick(painter, full)
                                      : stage == TURNER_STAGE_SINGLE ? single(full)
                                                                     : *full;
    bool whole = stage == TURNER_STAGE_QUICK && same_picture(&settings, full) &&
                 wish->seen != TURNER_SEEN_DIFFERENCE;
    struct turner_image *image =
        stage == TURNER_STAGE_QUICK && !whole ? &painter->quick : &painter->full;
    TURNER_TRY(turner_painter_resize(image, settings.width, settings.height));
    if (stage == TURNER_STAGE_SINGLE && painter->quick.width)
        enlarge(image, &painter->quick);

    struct turner_scene scene = painter->scene;
    scene.settings = settings;
    struct drawing drawing = {painter, &settings, image, stage, false};
    struct turner_render_options options = painter->render;
    options.progress = progress;
    options.user = &drawing;
    painter->own.statistics = painter->made;
    painter->own.stage = stage;
    painter->own.quick = stage == TURNER_STAGE_QUICK;
    painter->started = painter->shown = turner_seconds();
    TURNER_TRY(turner_renderer_look(&painter->renderer, &scene));
    painter->renderer.before_post = NULL;
    if (image == &painter->full && painter->renderer.post.wanted) {
        TURNER_TRY(turner_painter_resize(&painter->plain, settings.width, settings.height));
        painter->renderer.before_post = &painter->plain;
    }
    if (painter->reload)
        turner_reload_forget(painter->reload);
    painter->own.preview = false;
    painter->own.seen = wish->seen;
    painter->own.legend[0] = 0;
    painter->own.compared = false;
    painter->own.hooked = painter->kernel.hooks || painter->renderer.post.wanted;
    painter->own.number = wish->number;
    if (wish->seen == TURNER_SEEN_PICTURE) {
        TURNER_TRY(turner_renderer_draw(&painter->renderer, image, &options,
                                        &painter->own.statistics));
    } else {
        drawing.image = NULL; /* parts of it are not what is shown */
        TURNER_TRY(draw_seen(painter, wish, image, &scene, &options));
        image = &painter->colors;
    }
    bool last = whole || turner_painter_next(wish, stage) == TURNER_STAGE_DONE;
    painter->count++;
    turner_painter_publish(painter, image, &settings, last ? TURNER_STAGE_DONE : stage, 1);
    if (stage == TURNER_STAGE_QUICK && wish->interval > 0)
        turner_pace_seen(&painter->pace, wish->interval);
    if (stage == TURNER_STAGE_QUICK)
        turner_pace_took(&painter->pace, settings.depth,
                         (double)settings.width * settings.height, painter->own.seconds);
    return TURNER_OK;
}

enum turner_result turner_painter_measure(struct turner_painter *painter,
                                          const struct turner_wish *wish)
{
    struct turner_sight *own = &painter->own;
    struct drawing drawing = {painter, &wish->settings, NULL, TURNER_STAGE_FULL,
                              painter->options.turn != NULL};
    struct turner_render_options options = painter->render;
    struct turner_settings settings = own->settings;
    if (!wish->measure || own->compared || own->hooked || !painter->last)
        return TURNER_OK;
    options.progress = progress;
    options.user = &drawing;
    double seconds = own->seconds;
    enum turner_result result = turner_painter_compare(painter, wish, &options, NULL);
    if (result == TURNER_INTERRUPTED)
        return TURNER_OK; /* later */
    TURNER_TRY(result);
    painter->started = turner_seconds() - seconds; /* it is the same picture */
    turner_painter_publish(painter, painter->last, &settings, TURNER_STAGE_DONE, 1);
    return TURNER_OK;
}
