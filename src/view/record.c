/* Cameras on paper: printed, written into the scene's file, recorded. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "view/session.h"

#define RATE 30.0 /* cameras a second */

void turner_session_name(char name[1024], const char *output, const char *ending)
{
    const char *slash = strrchr(output, '/'), *dot = strrchr(slash ? slash : output, '.');
    if (dot && dot - output > 3 && strncmp(dot - 3, ".16", 3) == 0)
        dot -= 3;
    int stem = (int)(dot ? dot - output : (long)strlen(output));
    if (!ending)
        ending = dot ? dot : "";
    snprintf(name, 1024, "%.*s%s", stem, output, ending);
    for (int i = 2; access(name, F_OK) == 0 && i < 100000; i++)
        snprintf(name, 1024, "%.*s-%d%s", stem, output, i, ending);
}

void turner_session_print_camera(struct turner_session *session)
{
    char *json = turner_camera_json(&session->wish.camera, &session->scene);
    puts(json);
    fflush(stdout);
    turner_session_say(session, "%s", json);
    free(json);
}

void turner_session_store_camera(struct turner_session *session)
{
    const char *path = session->options->path;
    if (turner_camera_store(path, session->camera, &session->wish.camera) == TURNER_OK)
        turner_session_say(session, "camera %d of %s is this one now", session->camera, path);
    else
        turner_session_say(session, "%s", turner_message());
}

static void add_camera(struct turner_session *session)
{
    struct turner_camera_path *path = &session->recorded;
    if (path->count < TURNER_PATH_CAMERAS)
        *TURNER_PUSH(path->cameras, path->count, path->capacity) = session->wish.camera;
}

void turner_session_record(struct turner_session *session)
{
    struct turner_camera_path *path = &session->recorded;
    char name[1024];
    if (path->rate == 0) {
        path->rate = RATE;
        session->record_next = turner_seconds() + 1 / RATE;
        add_camera(session);
        turner_session_say(session, "recording; R ends it");
        return;
    }
    add_camera(session); /* where it came to rest */
    turner_session_name(name, session->options->output, "-path.json");
    if (turner_camera_path_write(path, name, &session->scene) == TURNER_OK)
        turner_session_say(session, "%zu cameras in %s; draw them with turner render --path",
                           path->count, name);
    else
        turner_session_say(session, "%s", turner_message());
    turner_camera_path_destroy(path);
}

void turner_session_record_frame(struct turner_session *session)
{
    if (session->recorded.rate == 0)
        return;
    for (double now = turner_seconds(); session->record_next <= now;
         session->record_next += 1 / RATE)
        add_camera(session);
}
