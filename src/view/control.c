/* Mouse and keys. docs/view.md and the help of F1 (boxes.c) list them, too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/camera.h"
#include "view/session.h"

#define PI 3.14159265358979323846
#define CLICK_SECONDS 0.4 /* between two of a double click, */
#define CLICK_PIXELS 4    /* and how far apart they may be */
#define NOTCH 0.9       /* of the distance, that a notch of the wheel leaves */
#define FLIGHT 0.5      /* of the distance, in a second */
#define FASTER 4.0
#define MOST_STEP 0.1   /* seconds: after a pause the camera does not jump */

static void touched(struct turner_session *session)
{
    turner_camera_round(&session->wish.camera);
    session->changed = session->moving = true;
}

/* ---- mouse ---- */

static void press(struct turner_session *session, const struct turner_window_event *event)
{
    double now = turner_seconds();
    bool near = fabs(event->x - session->click_x) < CLICK_PIXELS &&
                fabs(event->y - session->click_y) < CLICK_PIXELS;
    session->x = event->x;
    session->y = event->y;
    if (event->button == GLFW_MOUSE_BUTTON_LEFT && event->mods & GLFW_MOD_CONTROL) {
        turner_painter_explain(turner_against_at(session, event->x), event->x, event->y);
        turner_session_say(session, "following the rays of pixel %d,%d", (int)event->x,
                           (int)event->y);
        return;
    }
    if (event->button == GLFW_MOUSE_BUTTON_LEFT && turner_against_on(session, event->x)) {
        session->drag = TURNER_DRAG_DIVIDER;
        return;
    }
    if (event->button == GLFW_MOUSE_BUTTON_LEFT && event->mods == 0) {
        if (near && now - session->click < CLICK_SECONDS)
            turner_painter_pick(turner_against_at(session, event->x), event->x, event->y);
        session->click = now;
        session->click_x = event->x;
        session->click_y = event->y;
    }
    if (event->button == GLFW_MOUSE_BUTTON_LEFT)
        session->drag = event->mods & GLFW_MOD_SHIFT ? TURNER_DRAG_PAN : TURNER_DRAG_ORBIT;
    else if (event->button == GLFW_MOUSE_BUTTON_MIDDLE)
        session->drag = TURNER_DRAG_PAN;
    else if (event->button == GLFW_MOUSE_BUTTON_RIGHT)
        session->drag = TURNER_DRAG_TURN;
}

static void move(struct turner_session *session, const struct turner_window_event *event)
{
    struct turner_camera *camera = &session->wish.camera;
    double dx = event->x - session->x, dy = event->y - session->y;
    double width = session->wish.settings.width, height = session->wish.settings.height;
    session->x = event->x;
    session->y = event->y;
    session->dirty = session->dirty || session->panel || session->against;
    if (session->drag == TURNER_DRAG_NONE || (dx == 0 && dy == 0))
        return;
    if (session->drag == TURNER_DRAG_DIVIDER) {
        turner_against_move(session, event->x);
        return;
    }
    if (session->drag == TURNER_DRAG_ORBIT) /* across the window is half around */
        turner_camera_orbit(camera, -dx / width * PI, dy / height * PI);
    else if (session->drag == TURNER_DRAG_TURN) /* what was under the pointer stays there */
        turner_camera_turn(camera, -dx / height * camera->vfov, dy / height * camera->vfov);
    else
        turner_camera_pan(camera, dx, dy, (int)height);
    session->click = 0; /* it was no click */
    touched(session);
}

static void lift(struct turner_session *session, const struct turner_window_event *event)
{
    bool turn = session->drag == TURNER_DRAG_TURN;
    if ((event->button == GLFW_MOUSE_BUTTON_RIGHT) == turn) {
        session->drag = TURNER_DRAG_NONE;
        if (turn)
            memset(session->flying, 0, sizeof session->flying);
    }
}

/* ---- keys ---- */

/* Which way a key flies, or −1: arrows always, letters while the right button is down. */
static int flight_of(const struct turner_session *session, int key)
{
    static const struct {
        int arrow, letter;
    } keys[6] = {{GLFW_KEY_RIGHT, GLFW_KEY_D},   {GLFW_KEY_LEFT, GLFW_KEY_A},
                 {GLFW_KEY_PAGE_UP, GLFW_KEY_E}, {GLFW_KEY_PAGE_DOWN, GLFW_KEY_Q},
                 {GLFW_KEY_UP, GLFW_KEY_W},      {GLFW_KEY_DOWN, GLFW_KEY_S}};
    for (int i = 0; i < 6; i++) {
        if (key == keys[i].arrow || (session->drag == TURNER_DRAG_TURN && key == keys[i].letter))
            return i;
    }
    return -1;
}

static bool is_flying(const struct turner_session *session)
{
    for (int i = 0; i < 6; i++) {
        if (session->flying[i])
            return true;
    }
    return false;
}

static void hold(struct turner_session *session, int key, int mods, bool down)
{
    int flight = flight_of(session, key);
    bool before = is_flying(session);
    session->fast = mods & GLFW_MOD_SHIFT;
    session->slow = mods & GLFW_MOD_CONTROL;
    if (flight < 0)
        return;
    session->flying[flight] = down;
    if (!before)
        session->clock = turner_seconds();
}

static void choose_camera(struct turner_session *session, int number)
{
    const struct turner_scene *scene = &session->scene;
    if ((size_t)number > scene->camera_count) {
        turner_session_say(session, "the scene has no camera %d; \"cameras\" in its file lists more",
                           number);
        return;
    }
    session->camera = number;
    session->wish.camera = number                       ? scene->cameras[number - 1]
                           : session->options->camera ? session->options->first
                                                      : session->home;
    session->changed = true;
}

static void against_key(struct turner_session *session, int key)
{
    double split = session->against->split, width = session->wish.settings.width;
    bool heat = session->wish.seen == TURNER_SEEN_AGAINST;
    if (key == GLFW_KEY_X)
        turner_against_move(session, split == 1 ? 0 : split == 0 ? width / 2 : width);
    else
        turner_session_see(session, heat ? TURNER_SEEN_PICTURE : TURNER_SEEN_AGAINST);
}

void turner_session_shoot(struct turner_session *session)
{
    char name[1024], ending[48];
    if (!session->shoot)
        return;
    session->shoot = false;
    if (session->against && session->against->begun) {
        const char *output = session->options->output, *dot = strrchr(output, '.');
        snprintf(ending, sizeof ending, "-against%.32s", dot ? dot : "");
        turner_session_name(name, output, ending);
        turner_painter_shoot(&session->against->painter, name);
    }
    turner_session_name(name, session->options->output, NULL);
    turner_painter_shoot(&session->painter, name);
    turner_session_say(session, "%s as soon as the picture is finished", name);
}

static void key(struct turner_session *session, const struct turner_window_event *event)
{
    unsigned kinds = (unsigned)turner_session_kinds(session);
    hold(session, event->key, event->mods, true);
    if (flight_of(session, event->key) >= 0 || event->again)
        return;
    switch (event->key) {
    case GLFW_KEY_ESCAPE:
        session->quit = !session->explanation;
        free(session->explanation);
        session->explanation = NULL;
        break;
    case GLFW_KEY_Q: session->quit = true; break;
    case GLFW_KEY_F1: session->keys = !session->keys; break;
    case GLFW_KEY_TAB:
    case GLFW_KEY_P: session->panel = !session->panel; break;
    case GLFW_KEY_HOME:
        session->wish.camera = session->home;
        session->camera = session->options->camera;
        session->changed = true;
        break;
    case GLFW_KEY_C:
        (event->mods & GLFW_MOD_SHIFT ? turner_session_store_camera
                                      : turner_session_print_camera)(session);
        break;
    case GLFW_KEY_R: turner_session_record(session); break;
    case GLFW_KEY_V:
        turner_session_see(session, (session->wish.seen +
                                     (event->mods & GLFW_MOD_SHIFT ? kinds - 1u : 1u)) % kinds);
        break;
    case GLFW_KEY_X:
    case GLFW_KEY_H:
        if (session->against)
            against_key(session, event->key);
        break;
    case GLFW_KEY_S: session->shoot = true; break;
    }
    if (event->key >= GLFW_KEY_0 && event->key <= GLFW_KEY_9)
        choose_camera(session, event->key - GLFW_KEY_0);
    session->dirty = true;
}

void turner_session_event(struct turner_session *session, const struct turner_window_event *event)
{
    session->dirty = session->dirty || ((session->panel || session->keys) &&
                                        event->kind != TURNER_WINDOW_RELEASE);
    switch (event->kind) {
    case TURNER_WINDOW_CLOSE: session->quit = true; break;
    case TURNER_WINDOW_UNCOVER: session->dirty = true; break;
    case TURNER_WINDOW_PRESS: press(session, event); break;
    case TURNER_WINDOW_LIFT: lift(session, event); break;
    case TURNER_WINDOW_MOVE: move(session, event); break;
    case TURNER_WINDOW_WHEEL:
        turner_camera_dolly(&session->wish.camera, pow(NOTCH, event->y));
        touched(session);
        break;
    case TURNER_WINDOW_KEY: key(session, event); break;
    case TURNER_WINDOW_RELEASE: hold(session, event->key, event->mods, false); break;
    }
}

/* ---- by itself ---- */

static void fly(struct turner_session *session, double seconds)
{
    const bool *f = session->flying;
    double step = seconds * FLIGHT * turner_camera_distance(&session->wish.camera);
    step *= session->fast ? FASTER : session->slow ? 1 / FASTER : 1;
    turner_camera_fly(&session->wish.camera, (f[0] - f[1]) * step, (f[2] - f[3]) * step,
                      (f[4] - f[5]) * step);
}

bool turner_session_animate(struct turner_session *session)
{
    double now = turner_seconds(), seconds = fmin(now - session->clock, MOST_STEP);
    bool flies = is_flying(session), spins = session->options->spin > 0;
    session->clock = now;
    if (flies)
        fly(session, seconds);
    if (spins)
        turner_camera_orbit(&session->wish.camera, 2 * PI * seconds / session->options->spin, 0);
    if (flies || spins)
        touched(session);
    return flies || spins;
}
