/* `turner view`: a window on a scene. docs/view.md says what it does. */
#ifndef TURNER_VIEW_VIEW_H
#define TURNER_VIEW_VIEW_H

#include "view/painter.h"

/* The second side of --against. */
struct turner_against_options {
    struct turner_scene *scene; /* as it has it; */
    struct turner_render_options render;
    turner_scene_reader read; /* and when its file changed */
    void *reader;
    void (*adapt)(void *user, struct turner_settings *settings); /* makes settings of the first its */
    bool (*keeps)(void *user, const char *param); /* it has its own value of this parameter */
    void *user;
    const char *name; /* for people: "B: …" */
};

struct turner_view_options {
    const struct turner_against_options *against; /* or NULL */
    struct turner_scene *scene;      /* as the options of the command line have it */
    const char *path;                /* its file */
    struct turner_opening *opening;  /* begun */
    struct turner_render_options render;
    turner_picture_writer write;
    turner_pixel_explainer explain;
    turner_scene_reader read; /* of the scene, when its file changed */
    void *reader;
    struct turner_camera first;  /* the scene's camera 0; scene->camera may be another */
    enum turner_seen seen;       /* what is shown at first */
    int camera;                  /* the number of scene->camera */
    const char *output; /* what S saves; numbered when it is there already */
    double start;       /* turner_seconds() when the program started */
    bool quiet;         /* no word on how to get help */
    double spin;        /* seconds to go once around, again and again; 0: does not */
    double seconds;     /* ends by itself; 0: does not */
};

/* What there is to say in the end. Frames that moved are those of a camera on its way, and their
 * intervals those between two of them that are presented one after the other. */
struct turner_view_report {
    char device[256], traversal[32], presenting[256];
    int width, height;     /* of the window */
    double first_picture;  /* seconds from the program's start until it was presented */
    double full_picture;   /* the same of the first that is as the settings say */
    unsigned frames;       /* presented */
    unsigned moved;        /* frames that moved, with an interval */
    double moved_seconds;  /* sum of the intervals */
    double *intervals;     /* `moved` of them; the caller frees them */
    double scale, depth;   /* of the picture in each direction, and of recursion: means of these */
    struct turner_changes changes; /* what was made anew for them */
    bool sides;            /* there are two pictures: */
    struct turner_report_side {
        double seconds; /* of the one that was shown last */
        struct turner_statistics statistics;
        bool compared;  /* with the reference */
        struct turner_comparison error;
    } side[2];
    bool differ_known;
    struct turner_comparison difference; /* of the second from the first, where both are finished */
};

/* Until it is closed. TURNER_DEVICE where there is no display or device; TURNER_INTERRUPTED, with
 * no message, when a signal ended it. Signals that end a process are to be blocked by
 * turner_signals_block before any thread starts. */
enum turner_result turner_view(const struct turner_view_options *options,
                               struct turner_view_report *report);

/* ---- signals.c ---- */
void turner_signals_block(void);

/* A thread that takes SIGINT, SIGTERM and SIGHUP. Until turner_signals_to is called, they end the
 * process; from then on they call `wake` and turner_signals_caught says so. */
enum turner_result turner_signals_start(void);
void turner_signals_to(void (*wake)(void *user), void *user);
bool turner_signals_caught(void);
void turner_signals_stop(void);

#endif
