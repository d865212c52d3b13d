/* Saved hooks are seen soon, before their kernel is there (render/preview.h). */
#include <string.h>

#include "view/painter.h"

/* Nobody waits for what is remembered. */
static bool go_on(double share, void *user)
{
    struct turner_painter *painter = user;
    (void)share;
    pthread_mutex_lock(&painter->mutex);
    bool go_on = !painter->quit && !painter->fresh_wish && !painter->pick;
    pthread_mutex_unlock(&painter->mutex);
    return go_on && !turner_painter_outdated(painter);
}

static void show(struct turner_painter *painter, const struct turner_image *image,
                 const struct turner_wish *wish, bool preview)
{
    painter->own.preview = preview;
    turner_painter_publish(painter, image, &wish->settings, TURNER_STAGE_DONE, 1);
}

static enum turner_result show_preview(struct turner_painter *painter,
                                       const struct turner_wish *wish,
                                       const struct turner_scene *scene)
{
    struct turner_renderer *renderer = &painter->renderer;
    const struct turner_image *picture = renderer->post.wanted ? &painter->plain : &painter->full;
    TURNER_TRY(turner_painter_resize(&painter->soon, picture->width, picture->height));
    memcpy(painter->soon.rgba, picture->rgba,
           4 * sizeof *picture->rgba * (size_t)picture->width * (size_t)picture->height);
    TURNER_TRY(turner_reload_preview(painter->reload, &painter->soon, scene));
    TURNER_TRY(turner_post_draw(&painter->soon, &renderer->post, renderer->gpu));
    painter->own.changes.previewed++;
    show(painter, &painter->soon, wish, true);
    return TURNER_OK;
}

enum turner_result turner_painter_rest(struct turner_painter *painter,
                                       const struct turner_wish *wish)
{
    struct turner_reload *reload = painter->reload;
    struct turner_scene scene = painter->scene;
    struct turner_render_options options = painter->render;
    if (!reload || painter->options.turn || painter->blind)
        return TURNER_OK;
    if (wish->seen != TURNER_SEEN_PICTURE) {
        turner_reload_forget(reload);
        return TURNER_OK;
    }
    scene.settings = wish->settings;
    if (turner_reload_has_preview(reload))
        return show_preview(painter, wish, &scene);
    bool building = turner_reload_state(reload) == TURNER_RELOAD_BUILDING;
    if (painter->own.preview && !building) /* it comes to nothing */
        show(painter, &painter->full, wish, false);
    options.progress = go_on;
    options.user = painter;
    enum turner_result result = turner_reload_rest(reload, &scene, &options);
    if (result == TURNER_OK || result == TURNER_INTERRUPTED)
        return TURNER_OK;
    turner_reload_want_previews(reload, false); /* no room: nothing else is lost */
    return TURNER_OK;
}
