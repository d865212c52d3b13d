/* What the window's thread keeps between events. */
#ifndef TURNER_VIEW_SESSION_H
#define TURNER_VIEW_SESSION_H

#include "view/load.h"
#include "view/view.h"

enum turner_drag { TURNER_DRAG_NONE, TURNER_DRAG_ORBIT, TURNER_DRAG_PAN, TURNER_DRAG_TURN };

struct turner_session {
    const struct turner_view_options *options;
    const struct turner_window_functions *functions;
    struct turner_window *window;
    struct turner_painter painter;
    struct turner_view_report *report;

    struct turner_wish wish;    /* as last told to the painter, or about to be */
    struct turner_camera home;  /* the scene's */
    struct turner_sight sight;  /* that the window shows */
    bool changed, moving;       /* the wish; it does so by hand or by itself */
    bool dirty;                 /* the window is to be shown anew */
    int settle;                 /* times it is to be shown after that: boxes find their size */
    bool quit;

    enum turner_drag drag;
    double x, y;                /* of the pointer, last */
    bool flying[6];             /* keys held down: right left up down forward back */
    bool fast, slow;
    double clock;               /* when the camera was last moved by keys or by itself */

    bool keys, panel;           /* boxes that are open */
    char toast[1200];           /* what just happened, until `toast_end` */
    double toast_end;
    double presented;           /* when a frame was, last */
    double last_moved;          /* when a frame that moved was presented last, or 0 */
    size_t interval_room;
};

void turner_session_say(struct turner_session *session, const char *format, ...)
    TURNER_PRINTF(2, 3);

/* control.c */
void turner_session_event(struct turner_session *session, const struct turner_window_event *event);
/* Moves the camera by what is held down, or by itself; true as long as it does. */
bool turner_session_animate(struct turner_session *session);

/* boxes.c: everything over the picture. */
void turner_session_boxes(struct turner_session *session);

#endif
