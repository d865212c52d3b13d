/* The window's thread: events, wishes for the painter, what it drew on the screen. */
#include "view/view.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "image/image.h"
#include "view/camera.h"
#include "view/session.h"

#define ANIMATE_SECONDS 0.008
/* How long events are waited for at most: drivers read from the display's connection as they present,
 * in threads of their own, and an event that came that way wakes nobody. */
#define BUSY_SECONDS 0.02
#define PRESENTED_SECONDS 1.0 /* after the last frame */
#define PRESENTED_WAIT 0.05
#define REST_WAIT 1.0
#define TOAST_SECONDS 3.0
#define PAUSE_SECONDS 0.25 /* frames that are farther apart are not of one motion */

void turner_session_say(struct turner_session *session, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(session->toast, sizeof session->toast, format, arguments);
    va_end(arguments);
    session->toast_end = turner_seconds() + TOAST_SECONDS;
    session->dirty = true;
    session->settle = 1;
}

static void display_gone(void)
{
    turner_image_abandon();
    fprintf(stderr, "turner: error: the display is gone, and the window with it\n");
    _exit(TURNER_DEVICE);
}

/* In any thread, from when the window is there. */
static void wake(void *user)
{
    struct turner_session *session = user;
    session->functions->wake(session->window);
}

/* ---- what the report says ---- */

static void count_moved(struct turner_session *session, double now)
{
    struct turner_view_report *report = session->report;
    double since = now - session->last_moved;
    bool moved = session->sight.quick && session->wish.moving;
    if (moved && session->last_moved > 0 && since < PAUSE_SECONDS) {
        size_t count = report->moved;
        *TURNER_PUSH(report->intervals, count, session->interval_room) = since;
        report->moved = (unsigned)count;
        report->moved_seconds += since;
        session->wish.interval = since;
        report->scale += (double)session->sight.width / session->wish.settings.width;
        report->depth += session->sight.settings.depth;
    }
    if (!moved)
        session->wish.interval = 0;
    session->last_moved = moved ? now : 0;
}

static void count_frame(struct turner_session *session, bool fresh)
{
    struct turner_view_report *report = session->report;
    double now = turner_seconds();
    report->frames++;
    session->frame_seconds = now - session->presented;
    session->presented = now;
    if (!fresh)
        return;
    if (report->first_picture == 0)
        report->first_picture = now - session->options->start;
    if (report->full_picture == 0 && session->sight.stage == TURNER_STAGE_DONE)
        report->full_picture = now - session->options->start;
    count_moved(session, now);
}

static void finish_report(struct turner_session *session)
{
    struct turner_view_report *report = session->report;
    struct turner_window_state state;
    session->functions->state(session->window, &state);
    const struct turner_statistics *statistics = &session->sight.statistics;
    snprintf(report->device, sizeof report->device, "%s", statistics->device);
    snprintf(report->traversal, sizeof report->traversal, "%s",
             statistics->traversal ? statistics->traversal : "");
    snprintf(report->presenting, sizeof report->presenting, "%s", state.device);
    report->width = session->wish.settings.width;
    report->height = session->wish.settings.height;
    report->changes = session->sight.changes;
    for (int i = 0; i < 2 && session->against; i++) {
        const struct turner_sight *sight = i ? &session->against->sight : &session->sight;
        report->sides = true;
        report->side[i] = (struct turner_report_side){sight->seconds, sight->statistics,
                                                      sight->compared, sight->comparison};
    }
    if (session->against) {
        report->differ_known = session->against->compared;
        report->difference = session->against->difference;
    }
    if (report->moved) {
        report->scale /= report->moved;
        report->depth /= report->moved;
    }
}

/* ---- the loop ---- */

static void follow_size(struct turner_session *session)
{
    struct turner_window_state state;
    session->functions->state(session->window, &state);
    struct turner_settings *settings = &session->wish.settings;
    if (!state.width || (state.width == settings->width && state.height == settings->height))
        return;
    settings->width = state.width < TURNER_MAX_SIZE ? state.width : TURNER_MAX_SIZE;
    settings->height = state.height < TURNER_MAX_SIZE ? state.height : TURNER_MAX_SIZE;
    if (settings->spd_grid && settings->height < 3)
        settings->height = 3;
    session->changed = session->moving = session->dirty = true;
}

static void send_wish(struct turner_session *session)
{
    if (session->painted)
        turner_painter_paint(&session->painter, &session->scene);
    if (session->painted && session->against && session->against->begun)
        turner_painter_paint(&session->against->painter, &session->scene);
    if (!session->changed && !session->painted)
        return;
    session->painted = false;
    session->wish.moving = session->moving;
    turner_against_wish(session);
    session->changed = session->moving = false;
}

/* `first`: what is new is of the first picture, where there are two. */
static enum turner_result present(struct turner_session *session, bool fresh, bool first)
{
    const struct turner_window_functions *functions = session->functions;
    if (!session->dirty && !fresh && !session->settle)
        return TURNER_OK;
    if ((fresh || !session->composed) && session->sight.rgba) {
        const uint8_t *rgba;
        int width, height;
        turner_against_compose(session, &rgba, &width, &height);
        session->composed = true;
        if (functions->picture(session->window, rgba, width, height) != TURNER_WINDOW_OK)
            return turner_fail(TURNER_DEVICE, "%s", functions->reason(session->window));
    }
    if (fresh && session->sight.quick && !session->wish.moving)
        session->params_next = 0; /* shaders may have been saved */
    bool boxes = fresh && (session->panel || session->against || session->wish.seen != TURNER_SEEN_PICTURE);
    session->settle = session->dirty || boxes ? 2 : session->settle > 0 ? session->settle - 1 : 0;
    session->dirty = false;
    turner_session_boxes(session);
    switch (functions->show(session->window)) {
    case TURNER_WINDOW_OK: count_frame(session, first); break;
    case TURNER_WINDOW_HIDDEN: session->settle = 0; break;
    case TURNER_WINDOW_FAILED:
        return turner_fail(TURNER_DEVICE, "%s", functions->reason(session->window));
    }
    return TURNER_OK;
}

/* How long nothing has to be done. */
static double idle_seconds(const struct turner_session *session, bool animated)
{
    double now = turner_seconds();
    bool busy = session->sight.stage != TURNER_STAGE_DONE ||
                (session->against && session->against->sight.stage != TURNER_STAGE_DONE);
    double seconds = busy ? BUSY_SECONDS
                     : now - session->presented < PRESENTED_SECONDS ? PRESENTED_WAIT
                                                                    : REST_WAIT;
    const struct turner_view_options *options = session->options;
    if (animated)
        seconds = ANIMATE_SECONDS;
    if (session->recorded.rate > 0)
        seconds = fmin(seconds, BUSY_SECONDS);
    if (session->settle || session->dirty)
        seconds = 0;
    if (session->toast_end > 0)
        seconds = fmin(seconds, fmax(session->toast_end - now, 0.001));
    if (options->seconds > 0)
        seconds = fmin(seconds, fmax(options->start + options->seconds - now, 0.001));
    return seconds;
}

static void end_toast(struct turner_session *session)
{
    if (session->toast_end > 0 && turner_seconds() >= session->toast_end) {
        session->toast_end = 0;
        session->dirty = true;
    }
}

static bool time_is_up(const struct turner_session *session)
{
    const struct turner_view_options *options = session->options;
    return options->seconds > 0 && turner_seconds() - options->start >= options->seconds;
}

/* What the double click was on. */
static void take_pick(struct turner_session *session)
{
    struct turner_vec3 point;
    bool met;
    bool second = session->against && session->against->begun;
    if (!turner_painter_picked(&session->painter, &point, &met) &&
        !(second && turner_painter_picked(&session->against->painter, &point, &met)))
        return;
    if (met && turner_camera_look_at(&session->wish.camera, point)) {
        turner_camera_round(&session->wish.camera);
        session->changed = session->moving = true;
    } else {
        turner_session_say(session, met ? "it cannot be looked at" : "there is nothing");
    }
}

static void take_explanation(struct turner_session *session)
{
    char *text = turner_painter_explained(&session->painter);
    if (!text && session->against && session->against->begun)
        text = turner_painter_explained(&session->against->painter);
    if (!text)
        return;
    fputs(text, stdout);
    fflush(stdout);
    free(session->explanation);
    session->explanation = text;
    session->toast_end = 0;
    session->dirty = true;
}

static bool same_camera(const struct turner_camera *a, const struct turner_camera *b)
{
    return memcmp(&a->from, &b->from, sizeof a->from) == 0 &&
           memcmp(&a->at, &b->at, sizeof a->at) == 0 &&
           memcmp(&a->up, &b->up, sizeof a->up) == 0 && a->vfov == b->vfov &&
           a->inside_count == b->inside_count &&
           memcmp(a->inside, b->inside, a->inside_count * sizeof *a->inside) == 0;
}

/* The file was saved: what it says anew counts; the view stays where its camera is the old one. */
static void take_scene(struct turner_session *session)
{
    struct turner_scene *scene = turner_painter_read(&session->painter);
    if (!scene)
        return;
    struct turner_wish *wish = &session->wish;
    int width = wish->settings.width, height = wish->settings.height;
    if (!same_camera(&scene->camera, &session->home)) {
        wish->camera = session->home = scene->camera;
        session->camera = session->options->camera;
    }
    wish->camera.inside_count = scene->camera.inside_count; /* numbers of media may be others */
    memcpy(wish->camera.inside, scene->camera.inside, sizeof scene->camera.inside);
    wish->settings = scene->settings;
    wish->settings.width = width;
    wish->settings.height = height;
    wish->moving = false;
    turner_panel_close(session);
    turner_scene_free_params(&session->scene);
    session->scene = *scene;
    turner_scene_own_params(&session->scene);
    session->material = session->light = 0;
    session->moving = session->painted = false;
    turner_painter_show(&session->painter, scene, wish);
    session->changed = session->against != NULL; /* both, with one number */
}

static enum turner_result loop(struct turner_session *session)
{
    const struct turner_window_functions *functions = session->functions;
    bool animated = false;
    double seconds = 0;
    char reply[1024];
    while (!session->quit && !time_is_up(session)) {
        struct turner_window_event event;
        functions->wait(session->window, seconds);
        while (functions->next(session->window, &event))
            turner_session_event(session, &event);
        if (turner_signals_caught())
            return turner_fail(TURNER_INTERRUPTED, "%s", "");
        animated = turner_session_animate(session);
        turner_session_record_frame(session);
        follow_size(session);
        send_wish(session);
        turner_session_shoot(session);
        bool fresh = turner_painter_take(&session->painter, &session->sight);
        bool first = fresh;
        TURNER_TRY(turner_painter_result(&session->painter));
        TURNER_TRY(turner_against_take(session, &fresh));
        take_pick(session);
        take_explanation(session);
        take_scene(session);
        if (turner_painter_alert(&session->painter, session->alert))
            session->dirty = true;
        if (turner_painter_reply(&session->painter, reply))
            turner_session_say(session, "%s", reply);
        end_toast(session);
        TURNER_TRY(present(session, fresh, first));
        seconds = idle_seconds(session, animated);
    }
    return TURNER_OK;
}

/* ---- from beginning to end ---- */

/* The painter draws already while the window opens. */
struct doorbell {
    pthread_mutex_t mutex;
    struct turner_session *session; /* NULL until the window is there */
};

static void ring(void *user)
{
    struct doorbell *bell = user;
    pthread_mutex_lock(&bell->mutex);
    if (bell->session)
        wake(bell->session);
    pthread_mutex_unlock(&bell->mutex);
}

static void answer(struct doorbell *bell, struct turner_session *session)
{
    pthread_mutex_lock(&bell->mutex);
    bell->session = session;
    pthread_mutex_unlock(&bell->mutex);
}

static enum turner_result open_window(struct turner_session *session)
{
    const struct turner_view_options *options = session->options;
    char title[512], reason[TURNER_WINDOW_REASON];
    const char *slash = strrchr(options->path, '/');
    const char *validation = getenv("TURNER_VALIDATION");
    snprintf(title, sizeof title, "%s – turner", slash ? slash + 1 : options->path);
    struct turner_window_options window = {
        .title = title,
        .width = session->wish.settings.width,
        .height = session->wish.settings.height,
        .device = options->render.device,
        .validation = validation && strcmp(validation, "1") == 0,
        .gone = display_gone,
    };
    session->functions = turner_window_load();
    if (!session->functions)
        return TURNER_DEVICE;
    session->window = session->functions->open(&window, reason);
    return session->window ? TURNER_OK
                           : turner_fail(TURNER_DEVICE, "%s; turner render draws without a window",
                                         reason);
}

enum turner_result turner_view(const struct turner_view_options *options,
                               struct turner_view_report *report)
{
    struct turner_session session = {
        .options = options,
        .report = report,
        .wish = {.camera = options->scene->camera, .settings = options->scene->settings,
                 .seen = options->seen},
        .scene = *options->scene,
        .home = options->scene->camera,
        .camera = options->camera,
        .clock = turner_seconds(),
    };
    turner_scene_own_params(&session.scene);
    struct turner_against against;
    if (options->against) {
        turner_against_create(&against, options->against);
        session.against = &against;
    }
    struct doorbell bell = {.mutex = PTHREAD_MUTEX_INITIALIZER};
    struct turner_painter_options painter = {
        .render = options->render, .path = options->path,
        .read = options->read, .reader = options->reader, .write = options->write,
        .explain = options->explain, .turn = options->against ? &against.turn : NULL,
        .wake = ring, .user = &bell};
    *report = (struct turner_view_report){0};
    TURNER_TRY(turner_signals_start());
    enum turner_result result = turner_painter_start(&session.painter, options->scene,
                                                     &session.wish, options->opening, &painter);
    if (result != TURNER_OK) {
        turner_signals_stop();
        return result;
    }
    TURNER_TRY_DONE(open_window(&session));
    answer(&bell, &session);
    turner_signals_to(wake, &session);
    if (!options->quiet)
        turner_session_say(&session, "F1: keys   Tab: panel");
    result = loop(&session);
    finish_report(&session);
    turner_signals_stop();
done:
    answer(&bell, NULL);
    turner_signals_stop();
    turner_painter_stop(&session.painter);
    if (session.against)
        turner_against_destroy(&against);
    if (session.window)
        session.functions->close(session.window);
    turner_sight_destroy(&session.sight);
    turner_camera_path_destroy(&session.recorded);
    turner_panel_close(&session);
    turner_scene_free_params(&session.scene);
    turner_params_destroy(&session.params);
    free(session.explanation);
    return result;
}
