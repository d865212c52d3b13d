/* A window with a picture and a panel over it, as the rest of src/view sees it.
 *
 * GLFW, Dear ImGui and the Vulkan that presents are in src/view/window/. As with OpenImageIO
 * (image/oiio.h), that is a module where turner's library is a shared one, so that no other command
 * waits for what it brings; it calls nothing of turner's. All functions but `wake` belong to the
 * thread that opened the window. */
#ifndef TURNER_VIEW_WINDOW_H
#define TURNER_VIEW_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TURNER_WINDOW_REASON 1024

struct turner_window;

enum turner_window_event_kind {
    TURNER_WINDOW_KEY,     /* key, mods, again */
    TURNER_WINDOW_RELEASE, /* key, mods */
    TURNER_WINDOW_PRESS,   /* button, mods, x, y */
    TURNER_WINDOW_LIFT,    /* button, x, y */
    TURNER_WINDOW_MOVE,    /* x, y */
    TURNER_WINDOW_WHEEL,   /* y: notches, up positive */
    TURNER_WINDOW_CLOSE,
    TURNER_WINDOW_UNCOVER, /* it is to be shown anew */
};

/* What the panel took for itself is not among the events. Keys, buttons and mods are GLFW's. */
struct turner_window_event {
    enum turner_window_event_kind kind;
    int key, button, mods;
    bool again; /* the key is held down and repeats */
    double x, y; /* in the picture's pixels, from the top left */
};

/* How the window is opened. */
struct turner_window_options {
    const char *title;
    int width, height;  /* of the picture, pixels; smaller where the screen is */
    const char *device; /* part of a Vulkan device's name, or NULL: presents with it if it can */
    bool validation;    /* messages go to stderr as "turner: validation: …" */
    void (*gone)(void); /* called when the display closes the connection; must not return */
};

/* What the window is at present. */
struct turner_window_state {
    int width, height; /* of the picture it would show 1:1; 0 when there is nothing to see */
    bool closing;      /* its close button was pressed */
    double mouse_x, mouse_y;
    char device[256];  /* that presents */
};

enum turner_window_result {
    TURNER_WINDOW_OK,
    TURNER_WINDOW_HIDDEN, /* minimised: nothing was shown */
    TURNER_WINDOW_FAILED, /* turner_window_reason says why */
};

/* A colour is 3 floats, in the order RGB. */
struct turner_ui {
    /* A frame of the panel: widgets stand between `begin` and turner_window_functions.show. */
    void (*begin)(struct turner_window *window);
    /* A box at the left (place 0), right (1), bottom left (2), middle (3), top right (4), bottom middle (5),
     * at the divider (6, 7) or bottom right (8); those at the bottom stand on each other. False:
     * folded. Each `open` has its `close`. `width` 0: as wide as what is in it. */
    bool (*open)(const char *title, int place, float width, bool plain);
    void (*close)(void);
    void (*text)(const char *text);
    void (*code)(const char *text);  /* in letters of one width, in lines as they are */
    void (*note)(const char *text);  /* dimmed */
    void (*alert)(const char *text); /* red */
    void (*row)(const char *name, const char *text);
    bool (*section)(const char *title, bool open);
    bool (*slide)(const char *name, float *value, float least, float most, bool logarithmic);
    bool (*slide_whole)(const char *name, int *value, int least, int most);
    bool (*number)(const char *name, float *value, float speed);
    bool (*numbers)(const char *name, float value[3], float speed);
    bool (*color)(const char *name, float color[3]);
    bool (*check)(const char *name, bool *value);
    bool (*choose)(const char *name, int *value, const char *const *choices, int count);
    bool (*button)(const char *name);
    void (*beside)(void); /* the next widget goes beside the last */
    void (*push)(int id); /* what follows may have the same names as what was */
    void (*pop)(void);
    void (*bar)(float share, const char *text);
    /* A line from top to bottom; places 6 and 7 of `open` are at the top, left and right of it. */
    void (*divider)(float x);
};

struct turner_window_functions {
    const char *version; /* turner's, of the build it comes from */
    /* NULL with the reason. */
    struct turner_window *(*open)(const struct turner_window_options *options,
                                  char reason[TURNER_WINDOW_REASON]);
    void (*close)(struct turner_window *window);
    /* Waits for something to happen, `seconds` at most; 0 does not wait, below 0 for ever. */
    void (*wait)(struct turner_window *window, double seconds);
    /* Ends `wait`, from any thread. */
    void (*wake)(struct turner_window *window);
    bool (*next)(struct turner_window *window, struct turner_window_event *event);
    void (*state)(const struct turner_window *window, struct turner_window_state *state);
    /* Width × height × 4 bytes, RGB and one unused, as they are to go to the screen; kept. The
     * picture fills the window, magnified or reduced. */
    enum turner_window_result (*picture)(struct turner_window *window, const uint8_t *rgba,
                                         int width, int height);
    /* Presents picture and panel. */
    enum turner_window_result (*show)(struct turner_window *window);
    const char *(*reason)(const struct turner_window *window);
    void (*title)(struct turner_window *window, const char *title);
    void (*clipboard)(struct turner_window *window, const char *text);
    struct turner_ui ui;
};

/* The module's only function. */
const struct turner_window_functions *turner_window_module(void);

#ifdef __cplusplus
}
#endif
#endif
