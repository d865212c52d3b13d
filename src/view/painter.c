/* The painter's thread: waits for wishes, goes from stage to stage, hands pictures over. */
#include "view/painter.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "base/memory.h"

#define POLL_SECONDS 0.05   /* files are looked at that often, */
#define MAKING_SECONDS 0.01 /* and what is made of them */
#define REST_SECONDS 0.15 /* without another wish until a moving picture is taken to be at rest */

/* ---- from the window's thread ---- */

void turner_painter_wish(struct turner_painter *painter, const struct turner_wish *wish)
{
    pthread_mutex_lock(&painter->mutex);
    painter->wish = *wish;
    painter->fresh_wish = true;
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

static void swap(struct turner_sight *a, struct turner_sight *b)
{
    struct turner_sight c = *a;
    *a = *b;
    *b = c;
}

bool turner_painter_take(struct turner_painter *painter, struct turner_sight *sight)
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = painter->fresh_sight;
    painter->fresh_sight = false;
    if (fresh)
        swap(sight, &painter->sight);
    pthread_mutex_unlock(&painter->mutex);
    return fresh;
}

void turner_sight_destroy(struct turner_sight *sight)
{
    free(sight->rgba);
    free(sight->linear);
    *sight = (struct turner_sight){0};
}

void turner_painter_shoot(struct turner_painter *painter, const char *path)
{
    pthread_mutex_lock(&painter->mutex);
    free(painter->shot);
    painter->shot = turner_strdup(path);
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

static void *copy_of(const void *items, size_t count, size_t size)
{
    void *copy = turner_calloc(count + 1, size);
    if (count)
        memcpy(copy, items, count * size);
    return copy;
}

void turner_painter_paint(struct turner_painter *painter, const struct turner_scene *scene)
{
    pthread_mutex_lock(&painter->mutex);
    free(painter->painted.materials);
    free(painter->painted.lights);
    painter->painted = *scene;
    painter->painted.materials =
        copy_of(scene->materials, scene->material_count, sizeof *scene->materials);
    painter->painted.lights = copy_of(scene->lights, scene->light_count, sizeof *scene->lights);
    painter->fresh_painted = true;
    painter->fresh_wish = true; /* the same once more */
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

static void ask(struct turner_painter *painter, double x, double y, bool explain)
{
    pthread_mutex_lock(&painter->mutex);
    painter->pick = true;
    painter->explain = explain;
    painter->pick_x = x;
    painter->pick_y = y;
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

void turner_painter_pick(struct turner_painter *painter, double x, double y)
{
    ask(painter, x, y, false);
}

void turner_painter_explain(struct turner_painter *painter, double x, double y)
{
    ask(painter, x, y, true);
}

char *turner_painter_explained(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    char *text = painter->explanation;
    painter->explanation = NULL;
    pthread_mutex_unlock(&painter->mutex);
    return text;
}

bool turner_painter_picked(struct turner_painter *painter, struct turner_vec3 *point, bool *met)
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = painter->fresh_picked;
    painter->fresh_picked = false;
    *point = painter->picked;
    *met = painter->met;
    pthread_mutex_unlock(&painter->mutex);
    return fresh;
}

bool turner_painter_reply(struct turner_painter *painter, char reply[1024])
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = painter->fresh_reply;
    painter->fresh_reply = false;
    if (fresh)
        memcpy(reply, painter->reply, sizeof painter->reply);
    pthread_mutex_unlock(&painter->mutex);
    return fresh;
}

enum turner_result turner_painter_result(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    enum turner_result result = painter->result;
    if (result != TURNER_OK)
        turner_fail(result, "%s", painter->failure);
    pthread_mutex_unlock(&painter->mutex);
    return result;
}

/* ---- in the thread ---- */

static void say(struct turner_painter *painter, const char *text)
{
    pthread_mutex_lock(&painter->mutex);
    snprintf(painter->reply, sizeof painter->reply, "%s", text);
    painter->fresh_reply = true;
    pthread_mutex_unlock(&painter->mutex);
    painter->options.wake(painter->options.user);
}

/* Parameters that these shaders do not have are those of the other side. */
static void keep_known(struct turner_scene *scene, const struct turner_render_options *render)
{
    struct turner_params params;
    size_t kept = 0;
    bool found = turner_params_find(&params, NULL, render) == TURNER_OK;
    for (size_t i = 0; i < scene->param_count && found; i++) {
        struct turner_scene_param param = scene->params[i];
        if (turner_params_get(&params, param.name)) {
            scene->params[kept++] = param;
        } else {
            free(param.name);
            free(param.value);
        }
    }
    scene->param_count = found ? kept : scene->param_count;
    turner_params_destroy(&params);
}

static void write_shot(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    char *path = painter->shot;
    painter->shot = NULL;
    pthread_mutex_unlock(&painter->mutex);
    if (!path)
        return;
    char text[1024];
    struct turner_statistics statistics = painter->own.statistics;
    struct turner_scene scene = painter->scene;
    const struct turner_image *image = &painter->full;
    turner_scene_own_params(&scene);
    if (painter->own.seen) { /* colours are as they are */
        image = &painter->colors;
        scene.settings.exposure = 0;
        scene.settings.transfer = TURNER_TRANSFER_LINEAR;
    }
    if (painter->options.turn)
        keep_known(&scene, &painter->render);
    if (turner_params_settle(&scene, &painter->render) == TURNER_OK &&
        painter->options.write(path, &scene, image, &statistics) == TURNER_OK)
        snprintf(text, sizeof text, "saved %s", path);
    else
        snprintf(text, sizeof text, "%s", turner_message());
    turner_scene_free_params(&scene);
    free(path);
    say(painter, text);
}

static void explain(struct turner_painter *painter, double x, double y)
{
    char *text = NULL;
    size_t size;
    struct turner_scene scene = painter->scene;
    scene.settings.error = 0; /* one tree, of the depth and cutoff that both sides can follow */
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return;
    if (painter->options.explain(out, &scene, &painter->render, (int)x, (int)y) !=
        TURNER_OK)
        fprintf(out, "%s\n", turner_message());
    fclose(out);
    pthread_mutex_lock(&painter->mutex);
    free(painter->explanation);
    painter->explanation = text;
    pthread_mutex_unlock(&painter->mutex);
    painter->options.wake(painter->options.user);
}

static enum turner_result answer_pick(struct turner_painter *painter)
{
    struct turner_vec3 point;
    bool met, asked, explains;
    pthread_mutex_lock(&painter->mutex);
    asked = painter->pick;
    explains = painter->explain;
    painter->pick = false;
    double x = painter->pick_x, y = painter->pick_y;
    pthread_mutex_unlock(&painter->mutex);
    if (asked && explains)
        explain(painter, x, y);
    if (!asked || explains)
        return TURNER_OK;
    TURNER_TRY(turner_painter_meet(painter, x, y, &point, &met));
    pthread_mutex_lock(&painter->mutex);
    painter->picked = point;
    painter->met = met;
    painter->fresh_picked = true;
    pthread_mutex_unlock(&painter->mutex);
    painter->options.wake(painter->options.user);
    return TURNER_OK;
}

/* Until there is a wish, a question, a picture to write when `done`, or `seconds` have gone by (< 0: for ever).
 * Takes the wish. False: the end. */
static bool wait_for(struct turner_painter *painter, struct turner_wish *wish, bool *fresh,
                     bool done, double seconds)
{
    struct timespec until;
    clock_gettime(CLOCK_MONOTONIC, &until);
    long nanoseconds = until.tv_nsec + (long)(seconds * 1e9);
    until.tv_sec += nanoseconds / 1000000000;
    until.tv_nsec = nanoseconds % 1000000000;
    pthread_mutex_lock(&painter->mutex);
    int over = 0;
    while (!painter->quit && !painter->fresh_wish && !painter->pick &&
           !(done && painter->shot) && over == 0) {
        if (seconds < 0)
            pthread_cond_wait(&painter->changed, &painter->mutex);
        else
            over = pthread_cond_timedwait(&painter->changed, &painter->mutex, &until);
    }
    *fresh = painter->fresh_wish;
    if (*fresh)
        *wish = painter->wish;
    painter->fresh_wish = false;
    bool quit = painter->quit;
    pthread_mutex_unlock(&painter->mutex);
    return !quit;
}

static void fail(struct turner_painter *painter, enum turner_result result)
{
    pthread_mutex_lock(&painter->mutex);
    painter->result = result;
    snprintf(painter->failure, sizeof painter->failure, "%s", turner_message());
    pthread_mutex_unlock(&painter->mutex);
    painter->options.wake(painter->options.user);
}

/* Makes everything ready for the wish. A broken shader keeps the picture that is there. */
static enum turner_result prepare(struct turner_painter *painter, const struct turner_wish *wish)
{
    turner_painter_take_scene(painter);
    TURNER_TRY(turner_painter_take_paint(painter));
    enum turner_result result = turner_painter_take_params(painter);
    if (result == TURNER_OK)
        result = turner_painter_prepare(painter, wish);
    bool broken = result == TURNER_BAD_INPUT || result == TURNER_USAGE;
    painter->blind = broken && painter->count > 0;
    if (!painter->blind && painter->watch.count > 1)
        turner_watch_clear(&painter->watch); /* the renderer's own shaders are watched again */
    if (!painter->blind)
        return result;
    turner_painter_say_alert(painter, turner_message());
    return TURNER_OK;
}

/* What is to be drawn, and how far it is. */
struct progress {
    struct turner_wish wish;
    enum turner_stage stage;
    bool waited; /* for another wish, before going on */
};

/* All that takes the device. `again`: the picture is to be begun anew. */
static enum turner_result go_on(struct turner_painter *painter, struct progress *at, bool again)
{
    if (again) {
        TURNER_TRY(prepare(painter, &at->wish));
        at->stage = painter->blind ? TURNER_STAGE_DONE : turner_painter_first(painter, &at->wish);
        at->waited = false;
    }
    if (painter->ready)
        TURNER_TRY(answer_pick(painter));
    if (at->stage == TURNER_STAGE_DONE)
        return painter->ready ? turner_painter_measure(painter, &at->wish) : TURNER_OK;
    enum turner_result result = turner_painter_draw(painter, &at->wish, at->stage);
    if (result == TURNER_INTERRUPTED)
        return TURNER_OK; /* a wish is there, or it is the end */
    TURNER_TRY(result);
    at->stage = painter->own.stage == TURNER_STAGE_DONE ? TURNER_STAGE_DONE
                                                        : turner_painter_next(&at->wish, at->stage);
    return TURNER_OK;
}

static bool has_work(struct turner_painter *painter, const struct progress *at)
{
    pthread_mutex_lock(&painter->mutex);
    bool asked = painter->pick;
    pthread_mutex_unlock(&painter->mutex);
    return asked || at->stage != TURNER_STAGE_DONE;
}

static bool may_measure(const struct turner_painter *painter, const struct turner_wish *wish)
{
    return wish->measure && !painter->own.compared && !painter->own.hooked && !painter->blind;
}

static enum turner_result work(struct turner_painter *painter)
{
    struct progress at = {.stage = TURNER_STAGE_DONE};
    struct turner_turn *turn = painter->options.turn;
    bool fresh, redraw;
    for (;;) {
        bool rest = at.stage == TURNER_STAGE_DONE;
        bool making = painter->reload &&
                      turner_reload_state(painter->reload) == TURNER_RELOAD_BUILDING;
        double seconds = rest && making                                               ? MAKING_SECONDS
                         : rest                                                       ? POLL_SECONDS
                         : at.stage == TURNER_STAGE_SINGLE && at.wish.moving && !at.waited
                             ? REST_SECONDS
                             : 0;
        at.waited = true;
        if (!wait_for(painter, &at.wish, &fresh, rest, seconds))
            return TURNER_OK;
        TURNER_TRY(turner_painter_poll(painter, &redraw));
        bool again = fresh || redraw, work = again || has_work(painter, &at);
        if (work || may_measure(painter, &at.wish)) {
            if (turn)
                turner_turn_take(turn, work);
            enum turner_result result = go_on(painter, &at, again);
            if (turn)
                turner_turn_give(turn);
            TURNER_TRY(result);
        }
        if (at.stage == TURNER_STAGE_DONE) {
            turner_painter_watch(painter);
            if (painter->ready)
                TURNER_TRY(turner_painter_rest(painter, &at.wish));
            if (painter->ready)
                write_shot(painter);
        }
    }
}

static void *run(void *user)
{
    struct turner_painter *painter = user;
    enum turner_result result = work(painter);
    turner_painter_clear(painter);
    if (result != TURNER_OK)
        fail(painter, result);
    return NULL;
}

enum turner_result turner_painter_start(struct turner_painter *painter,
                                        const struct turner_scene *scene,
                                        const struct turner_wish *first,
                                        struct turner_opening *opening,
                                        const struct turner_painter_options *options)
{
    *painter = (struct turner_painter){
        .options = *options, .opening = opening, .scene = *scene, .wish = *first,
        .fresh_wish = true, .since = turner_watch_now()};
    turner_scene_own_params(&painter->scene);
    pthread_condattr_t attributes;
    pthread_condattr_init(&attributes);
    pthread_condattr_setclock(&attributes, CLOCK_MONOTONIC);
    pthread_mutex_init(&painter->mutex, NULL);
    pthread_cond_init(&painter->changed, &attributes);
    pthread_condattr_destroy(&attributes);
    if (pthread_create(&painter->thread, NULL, run, painter) != 0)
        return turner_fail(TURNER_DEVICE, "no thread could be started: %s", strerror(errno));
    return TURNER_OK;
}

void turner_painter_stop(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    painter->quit = true;
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
    pthread_join(painter->thread, NULL);
    pthread_cond_destroy(&painter->changed);
    pthread_mutex_destroy(&painter->mutex);
    turner_sight_destroy(&painter->sight);
    free(painter->painted.materials);
    free(painter->painted.lights);
    free(painter->shot);
    free(painter->explanation);
    painter->shot = painter->explanation = NULL;
    struct turner_scene set = {.params = painter->params, .param_count = painter->param_count};
    turner_scene_free_params(&set);
    turner_scene_free_params(&painter->scene);
    turner_scene_destroy(painter->read);
    turner_scene_destroy(painter->next);
    turner_scene_destroy(painter->owned);
    turner_watch_clear(&painter->watch);
    turner_shader_path_destroy(&painter->path);
}
