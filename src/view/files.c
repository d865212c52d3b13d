/* Files that change while their picture is shown: the scene, and its shaders. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/shader_watch.h"
#include "scene/hash.h"
#include "view/painter.h"

#define POLL_SECONDS 0.1 /* while a picture is drawn */

/* ---- from the window's thread ---- */

struct turner_scene *turner_painter_read(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    struct turner_scene *scene = painter->read;
    painter->read = NULL;
    pthread_mutex_unlock(&painter->mutex);
    return scene;
}

void turner_painter_show(struct turner_painter *painter, struct turner_scene *scene,
                         const struct turner_wish *wish)
{
    pthread_mutex_lock(&painter->mutex);
    turner_scene_destroy(painter->next); /* it was never drawn */
    painter->next = scene;
    painter->wish = *wish;
    painter->fresh_wish = true;
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

bool turner_painter_alert(struct turner_painter *painter, char alert[2048])
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = painter->fresh_alert;
    painter->fresh_alert = false;
    if (fresh)
        memcpy(alert, painter->alert, sizeof painter->alert);
    pthread_mutex_unlock(&painter->mutex);
    return fresh;
}

/* ---- in the painter's ---- */

void turner_painter_find_shaders(struct turner_painter *painter)
{
    turner_shader_path_destroy(&painter->path);
    painter->render = painter->options.render;
    turner_shader_path_create(&painter->path, &painter->render, &painter->scene);
}

void turner_painter_say_alert(struct turner_painter *painter, const char *alert)
{
    pthread_mutex_lock(&painter->mutex);
    bool fresh = strcmp(painter->alert, alert) != 0;
    snprintf(painter->alert, sizeof painter->alert, "%s", alert);
    painter->fresh_alert = painter->fresh_alert || fresh;
    pthread_mutex_unlock(&painter->mutex);
    if (fresh)
        painter->options.wake(painter->options.user);
}

void turner_painter_unwatch(struct turner_painter *painter)
{
    if (painter->reload)
        turner_reload_destroy(painter->reload);
    painter->reload = NULL;
}

void turner_painter_watch(struct turner_painter *painter)
{
    turner_watch_add(&painter->watch, painter->options.path, painter->since);
    if (painter->blind && painter->watch.count == 1)
        turner_shader_watch_all(&painter->watch, &painter->options.render, &painter->scene,
                                painter->since);
    if (painter->reload || !painter->ready)
        return;
    if (turner_reload_create(&painter->reload, &painter->renderer, &painter->scene,
                             &painter->options.render, painter->since) != TURNER_OK)
        painter->reload = NULL; /* what is shown stays as it is */
    else if (!painter->options.turn)
        turner_reload_want_previews(painter->reload, true);
}

/* A number for all that a renderer has to be made anew for: what is left when materials, lights,
 * places of instances and what stands in the scene once are taken away. */
static uint64_t shape_of(const struct turner_scene *scene)
{
    struct turner_scene plain = *scene;
    plain.camera = (struct turner_camera){0};
    plain.ambient = (struct turner_vec3){0, 0, 0};
    plain.background = (struct turner_background){0};
    plain.param_count = 0;
    plain.lights = turner_calloc(scene->light_count + 1, sizeof *plain.lights);
    plain.materials = turner_calloc(scene->material_count + 1, sizeof *plain.materials);
    for (size_t i = 0; i < scene->material_count; i++)
        plain.materials[i].pattern = scene->materials[i].pattern;
    plain.instances = turner_calloc(scene->instance_count + 1, sizeof *plain.instances);
    for (size_t i = 0; i < scene->instance_count; i++) {
        plain.instances[i].group = scene->instances[i].group;
        plain.instances[i].material = scene->instances[i].material;
    }
    uint64_t hash = turner_scene_hash(&plain);
    free(plain.instances);
    free(plain.lights);
    free(plain.materials);
    return hash;
}

static bool same_places(const struct turner_scene *a, const struct turner_scene *b)
{
    bool same = true; /* there are as many */
    for (size_t i = 0; i < a->instance_count && same; i++)
        same = memcmp(&a->instances[i].transform, &b->instances[i].transform,
                      sizeof a->instances[i].transform) == 0;
    return same;
}

/* The renderer takes what is new in the scene, unless that is too much for it. */
static bool adapt(struct turner_painter *painter, const struct turner_scene *before)
{
    const struct turner_scene *scene = &painter->scene;
    bool fits = false;
    if (shape_of(before) != shape_of(scene) ||
        turner_renderer_paint(&painter->renderer, before, scene, &fits) != TURNER_OK || !fits)
        return false;
    painter->own.changes.painted++;
    if (same_places(before, scene))
        return true;
    painter->own.changes.moved++;
    return turner_renderer_move(&painter->renderer, scene, &fits) == TURNER_OK && fits;
}

void turner_painter_take_scene(struct turner_painter *painter)
{
    pthread_mutex_lock(&painter->mutex);
    struct turner_scene *next = painter->next;
    painter->next = NULL;
    pthread_mutex_unlock(&painter->mutex);
    if (!next)
        return;
    struct turner_scene before = painter->scene;
    painter->scene = *next;
    turner_scene_own_params(&painter->scene);
    bool fits = painter->ready && adapt(painter, &before);
    if (fits && painter->reload) /* other parameters, names of materials, folder of shaders */
        fits = turner_reload_set_params(painter->reload, &painter->scene) == TURNER_OK;
    else if (fits)
        fits = before.param_count == 0 && next->param_count == 0 && !before.shaders &&
               !next->shaders;
    painter->ready = painter->ready && fits;
    turner_scene_free_params(&before);
    free(painter->materials); /* the panel's: the file has the last word */
    free(painter->lights);
    painter->materials = NULL;
    painter->lights = NULL;
    turner_scene_destroy(painter->owned);
    painter->owned = next;
}

/* Hands the scene over to the window, which knows whether its camera is to be taken. */
static void read_scene(struct turner_painter *painter)
{
    struct turner_scene *scene = NULL, *old;
    if (painter->options.read(painter->options.reader, &scene) != TURNER_OK) {
        snprintf(painter->file_alert, sizeof painter->file_alert, "%s", turner_message());
        return;
    }
    painter->file_alert[0] = 0;
    pthread_mutex_lock(&painter->mutex);
    old = painter->read;
    painter->read = scene;
    pthread_mutex_unlock(&painter->mutex);
    turner_scene_destroy(old);
    painter->options.wake(painter->options.user);
}

bool turner_painter_outdated(struct turner_painter *painter)
{
    double now = turner_seconds();
    if (now - painter->polled < POLL_SECONDS)
        return false;
    painter->polled = now;
    painter->file_changed = painter->file_changed || turner_watch_changed(&painter->watch);
    return painter->file_changed ||
           (painter->reload && turner_reload_poll(painter->reload) == TURNER_RELOAD_READY);
}

enum turner_result turner_painter_poll(struct turner_painter *painter, bool *redraw)
{
    const char *alert = painter->file_alert;
    *redraw = false;
    if (turner_watch_changed(&painter->watch) || painter->file_changed) {
        painter->file_changed = false;
        *redraw = painter->blind; /* perhaps it is mended */
        read_scene(painter);
    }
    if (painter->reload && turner_reload_poll(painter->reload) == TURNER_RELOAD_READY) {
        if (turner_reload_swap(painter->reload, &painter->kernel, &painter->scene) == TURNER_OK)
            *redraw = true;
        turner_painter_find_shaders(painter); /* a folder of them may be new */
        if (painter->file_alert[0])
            read_scene(painter); /* it may be right with these */
    }
    if (!*alert && painter->reload &&
        turner_reload_state(painter->reload) == TURNER_RELOAD_BROKEN)
        alert = turner_reload_message(painter->reload);
    if (!painter->blind || *alert)
        turner_painter_say_alert(painter, alert);
    return TURNER_OK;
}
