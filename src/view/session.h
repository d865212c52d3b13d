/* What the window's thread keeps between events. */
#ifndef TURNER_VIEW_SESSION_H
#define TURNER_VIEW_SESSION_H

#include "render/params.h"
#include "scene/camera_file.h"
#include "view/against.h"
#include "view/load.h"
#include "view/view.h"

enum turner_drag {
    TURNER_DRAG_NONE,
    TURNER_DRAG_ORBIT,
    TURNER_DRAG_PAN,
    TURNER_DRAG_TURN,
    TURNER_DRAG_DIVIDER
};

struct turner_session {
    const struct turner_view_options *options;
    const struct turner_window_functions *functions;
    struct turner_window *window;
    struct turner_painter painter;
    struct turner_against *against; /* the second picture, or NULL */
    struct turner_view_report *report;

    struct turner_wish wish;    /* as last told to the painter, or about to be */
    struct turner_camera home;  /* it began with */
    int camera;                 /* the number of the scene's that was chosen last */
    struct turner_sight sight;  /* that the window shows */
    bool changed, moving;       /* the wish; it does so by hand or by itself */
    bool composed;              /* what the window has of the picture, or of both, is up to date */
    bool dirty;                 /* the window is to be shown anew */
    int settle;                 /* times it is to be shown after that: boxes find their size */
    bool quit, shoot;

    enum turner_drag drag;
    double x, y;                /* of the pointer, last */
    bool flying[6];             /* keys held down: right left up down forward back */
    bool fast, slow;
    struct turner_camera_path recorded; /* as it is recorded; rate 0: it is not */
    double record_next;         /* when the next camera is due */
    double click, click_x, click_y; /* when and where the last was */
    double clock;               /* when the camera was last moved by keys or by itself */

    struct turner_params params; /* of the shaders, as of a second ago; shown by the panel */
    double params_next;         /* when they are looked at again */
    struct turner_scene scene;  /* as the panel has changed it: shares all but `params` and, once
                                   `owns`, */
    char *explanation;          /* of a pixel, that is shown; or NULL */
    char alert[2048];           /* what is wrong with the files, or "" */
    bool owns;                  /* materials and lights */
    bool painted;               /* the painter is to have them */
    int material, light;        /* that the panel shows */
    double frame_seconds;       /* from the frame before the last to the last */
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
/* Asks for the picture to be saved, that of both sides where there are two, if S was pressed; after
 * the painters were told what it is to show. */
void turner_session_shoot(struct turner_session *session);
/* Moves the camera by what is held down, or by itself; true as long as it does. */
bool turner_session_animate(struct turner_session *session);

/* record.c: cameras on paper. */
void turner_session_print_camera(struct turner_session *session);
void turner_session_store_camera(struct turner_session *session);
void turner_session_record(struct turner_session *session); /* begins, or ends and writes */
void turner_session_record_frame(struct turner_session *session); /* in every turn of the loop */

/* `output`, or the first name like it, with a number, that is free. */
void turner_session_name(char name[1024], const char *output, const char *ending);

/* params.c */
void turner_session_params(struct turner_session *session, const struct turner_ui *ui);

/* panel.c */
void turner_panel(struct turner_session *session);
void turner_panel_close(struct turner_session *session);
int turner_session_kinds(const struct turner_session *session); /* that can be seen */
void turner_session_see(struct turner_session *session, enum turner_seen seen);

/* boxes.c: everything over the picture. */
void turner_session_boxes(struct turner_session *session);

#endif
