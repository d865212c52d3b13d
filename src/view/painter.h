/* Draws what is wished to be seen, in a thread of its own that owns the device: at first roughly and
 * soon, then, when no other wish comes, as the settings say. */
#ifndef TURNER_VIEW_PAINTER_H
#define TURNER_VIEW_PAINTER_H

#include <pthread.h>
#include <stdio.h>

#include "base/watch.h"
#include "image/codec.h"
#include "render/opening.h"
#include "render/reload.h"
#include "render/shader_path.h"
#include "scene/scene.h"
#include "view/pace.h"
#include "view/turn.h"

/* What is shown of the scene. */
enum turner_seen {
    TURNER_SEEN_PICTURE,
    TURNER_SEEN_NORMAL,
    TURNER_SEEN_DEPTH,
    TURNER_SEEN_ID,
    TURNER_SEEN_RAYS,
    TURNER_SEEN_RECURSION,
    TURNER_SEEN_PRUNED,
    TURNER_SEEN_ERROR,
    TURNER_SEEN_NONFINITE,
    TURNER_SEEN_DIFFERENCE, /* to the reference, of a small picture */
    TURNER_SEEN_AGAINST,    /* of the two pictures of --against: to a painter the same as PICTURE */
    TURNER_SEEN_KINDS
};

/* What is to be seen. The size is that of the settings. */
struct turner_wish {
    enum turner_seen seen;
    struct turner_camera camera;
    struct turner_settings settings;
    double interval; /* of the frames that were shown last, seconds; 0: not known */
    bool moving; /* there is more to come: wait a little before going on to better pictures */
    bool measure; /* when it is finished, find its error, too: against the reference with */
    struct turner_settings truth;
    unsigned number; /* of the window's wishes; those of two painters that belong together have one */
};

enum turner_stage {
    TURNER_STAGE_QUICK,  /* as good as the time of a frame allows */
    TURNER_STAGE_SINGLE, /* one sample for every pixel */
    TURNER_STAGE_FULL,   /* what turner render draws with these settings */
    TURNER_STAGE_DONE,   /* that is finished */
};

/* What can be seen. */
struct turner_sight {
    uint8_t *rgba; /* width × height × 4: RGB and one unused */
    int width, height;
    size_t room; /* pixels `rgba` holds */
    struct turner_settings settings; /* it is drawn with, or is being drawn with */
    enum turner_stage stage;         /* DONE: this is the last for this wish */
    bool quick;                      /* drawn in the time of a frame */
    double share;                    /* of the stage that is under way */
    double seconds; /* it took, or so far */
    struct turner_statistics statistics;
    enum turner_seen seen;
    char legend[160]; /* what its colours mean; of the picture: "" */
    bool compared;    /* DIFFERENCE, or it was to be measured: these are known, of a small picture */
    struct turner_comparison comparison;
    double compared_seconds, reference_seconds; /* that the two took */
    bool preview;     /* of hooks that were saved: what is lit directly is new */
    bool hooked;      /* shaders that the reference knows nothing of: it is not compared */
    float *linear;    /* of the full picture, RGB and one unused, where there are two painters; */
    size_t linear_room; /* or nothing, 0 */
    unsigned number;  /* of the wish */
    struct turner_changes {
        unsigned built;   /* renderers that were made, */
        unsigned painted; /* times that one got other materials and lights, */
        unsigned moved;   /* and other places for its instances */
        unsigned previewed; /* saved hooks that were seen before their kernel was there */
    } changes;
    unsigned count; /* of pictures before it that were not parts of one */
};

/* A picture that turner render would write. */
typedef enum turner_result (*turner_picture_writer)(const char *path,
                                                    const struct turner_scene *scene,
                                                    const struct turner_image *image,
                                                    const struct turner_statistics *statistics);

/* Reads the scene's file again, and does with it what the command line says. */
typedef enum turner_result (*turner_scene_reader)(void *user, struct turner_scene **scene);

/* Writes what turner explain says of the middle of pixel (x, y). */
typedef enum turner_result (*turner_pixel_explainer)(FILE *out, const struct turner_scene *scene,
                                                     const struct turner_render_options *options,
                                                     int x, int y);

struct turner_painter_options {
    turner_pixel_explainer explain;
    struct turner_render_options render; /* without the scene's shaders */
    const char *path; /* of the scene's file, which is watched, */
    turner_scene_reader read;
    void *reader;
    turner_picture_writer write;
    struct turner_turn *turn; /* of two painters; or NULL */
    void (*wake)(void *user); /* there is something new; called in the painter's thread */
    void *user;
};

struct turner_painter {
    struct turner_painter_options options;
    struct turner_opening *opening; /* not owned */
    pthread_t thread;
    pthread_mutex_t mutex; /* of what stands here down to `reply` */
    pthread_cond_t changed;
    bool quit, fresh_wish, fresh_sight;
    struct turner_wish wish;
    struct turner_sight sight;      /* the newest, to be taken */
    struct turner_scene_param *params; /* that were set, to be taken */
    size_t param_count, param_capacity;
    bool explain;                   /* the pick is of what turner explain says */
    char *explanation;              /* that, to be taken */
    bool pick, fresh_picked, met;   /* what lies at a place is asked for; the answer is there */
    double pick_x, pick_y;
    struct turner_vec3 picked;
    struct turner_scene *read, *next; /* from the file: to be looked at by the window, and what that
                                         wants to be drawn from now on */
    bool fresh_alert;
    char alert[2048];               /* what is wrong with the files; "" when nothing is */
    struct turner_scene painted;    /* of which only materials and lights are there; */
    bool fresh_painted;             /* owned here, until they are taken */
    char *shot;                     /* NULL, or where the full picture is to be written */
    char reply[1024], failure[2048]; /* for people: what became of it; why nothing can be drawn */
    bool fresh_reply;
    enum turner_result result;

    /* The thread's own. */
    struct turner_scene scene; /* shares all but camera, settings and parameters with that of the
                                  caller */
    struct turner_shader_path path;      /* where its shaders are, now that they were looked for */
    struct turner_render_options render; /* with that */
    struct turner_kernel kernel;
    struct turner_renderer renderer;
    struct turner_statistics made; /* what making the renderer took */
    struct turner_material *materials; /* that the panel changed; else NULL */
    struct turner_light *lights;
    bool counts; /* the renderer counts the rays of each pixel */
    struct turner_settings built;  /* the settings it was made with */
    bool ready;
    struct turner_pace pace;
    struct turner_watch watch;     /* the scene's file, and shaders that could not be compiled */
    struct turner_reload *reload;  /* of the renderer's shaders; NULL until it is at rest */
    struct timespec since;         /* before the shaders were read */
    struct turner_scene *owned;    /* NULL, or the one that `scene` is of */
    double polled;                 /* when the files were last looked at in the middle of a picture */
    bool file_changed;             /* they had */
    bool blind;                    /* there is no renderer for the wish: a file is broken */
    char file_alert[2048];         /* of the scene's file */
    struct turner_image quick, full, colors; /* the last: layers as colours */
    struct turner_image plain, soon; /* `full` before the hook `post`; a preview of saved hooks */
    const struct turner_image *last; /* of them, that was shown last */
    struct turner_sight own; /* being filled */
    struct turner_packer packer;
    double exposure;
    bool linear;
    double started, shown; /* the drawing under way, and when a part of it was last seen */
    unsigned count;
};

/* Starts the thread. `scene` and `opening` live until turner_painter_stop. */
enum turner_result turner_painter_start(struct turner_painter *painter,
                                        const struct turner_scene *scene,
                                        const struct turner_wish *first,
                                        struct turner_opening *opening,
                                        const struct turner_painter_options *options);
/* Ends what it draws and the thread. */
void turner_painter_stop(struct turner_painter *painter);

void turner_painter_wish(struct turner_painter *painter, const struct turner_wish *wish);

/* Exchanges *sight for the newest, if there is one that was not taken. */
bool turner_painter_take(struct turner_painter *painter, struct turner_sight *sight);
void turner_sight_destroy(struct turner_sight *sight);

/* Has the picture of the wish written as soon as it is full. */
void turner_painter_shoot(struct turner_painter *painter, const char *path);

/* Has the materials and lights of `scene` drawn, which has as many as that of the painter. */
void turner_painter_paint(struct turner_painter *painter, const struct turner_scene *scene);

/* A scene that was read again because its file changed, once, or NULL. It is the painter's: the
 * window hands it back by turner_painter_show. */
struct turner_scene *turner_painter_read(struct turner_painter *painter);
/* Has it drawn, as the wish says, in place of the one before, which ceases to be. */
void turner_painter_show(struct turner_painter *painter, struct turner_scene *scene,
                         const struct turner_wish *wish);

/* What is wrong with the scene or its shaders, as they are on disk, when that has changed; "": no
 * more. */
bool turner_painter_alert(struct turner_painter *painter, char alert[2048]);

/* Gives a parameter of the shaders another value. */
void turner_painter_set_param(struct turner_painter *painter, const char *name, const char *value);

/* Asks for the point that is seen at (x, y) of the picture of the wish, in pixels. */
void turner_painter_pick(struct turner_painter *painter, double x, double y);
/* The same for what turner explain says; turner_painter_explained returns it, once, to be freed. */
void turner_painter_explain(struct turner_painter *painter, double x, double y);
char *turner_painter_explained(struct turner_painter *painter);
/* The answer, once: false as long as there is none. `met`: there is something. */
bool turner_painter_picked(struct turner_painter *painter, struct turner_vec3 *point, bool *met);

/* What the painter has to say, once: what became of a picture that was to be written. */
bool turner_painter_reply(struct turner_painter *painter, char reply[1024]);

/* TURNER_OK, or why nothing more can be drawn, with turner_message. */
enum turner_result turner_painter_result(struct turner_painter *painter);

/* stages.c, in the thread: draws `stage` of painter->wish, which the thread has a copy of.
 * TURNER_INTERRUPTED when another wish came. */
enum turner_result turner_painter_draw(struct turner_painter *painter,
                                       const struct turner_wish *wish, enum turner_stage stage);
/* What the picture of the wish begins with and, after `stage`, goes on with. */
enum turner_stage turner_painter_first(const struct turner_painter *painter,
                                       const struct turner_wish *wish);
enum turner_stage turner_painter_next(const struct turner_wish *wish, enum turner_stage stage);
/* Makes the renderer fit the settings of the wish. */
enum turner_result turner_painter_prepare(struct turner_painter *painter,
                                          const struct turner_wish *wish);
/* files.c, in the thread: begins to watch; looks at the files, `redraw` says that they changed. */
void turner_painter_watch(struct turner_painter *painter);
enum turner_result turner_painter_poll(struct turner_painter *painter, bool *redraw);
bool turner_painter_outdated(struct turner_painter *painter); /* what is being drawn is */
void turner_painter_unwatch(struct turner_painter *painter);
void turner_painter_say_alert(struct turner_painter *painter, const char *alert);
/* Looks where the scene's shaders are. */
void turner_painter_find_shaders(struct turner_painter *painter);
/* Takes what turner_painter_show left. */
void turner_painter_take_scene(struct turner_painter *painter);

/* params.c: takes what turner_painter_set_param left. */
enum turner_result turner_painter_take_params(struct turner_painter *painter);
/* Takes what turner_painter_paint left. */
enum turner_result turner_painter_take_paint(struct turner_painter *painter);
void turner_painter_clear(struct turner_painter *painter);
/* pick.c, in the thread: what the ray through (x, y) meets. */
enum turner_result turner_painter_meet(struct turner_painter *painter, double x, double y,
                                       struct turner_vec3 *point, bool *met);

/* falsecolor.c: layers as colours for the screen, of the picture `image` they belong to. */
struct turner_layers;
const char *turner_seen_name(enum turner_seen seen);
uint32_t turner_seen_layers(enum turner_seen seen); /* that it takes: turner_layers.wanted */
void turner_false_color(struct turner_image *colors, char legend[160], enum turner_seen seen,
                        const struct turner_layers *layers, const struct turner_image *image);

/* compare.c: fills what `own` says of the comparison and, unless NULL, a heat map. */
enum turner_result turner_painter_compare(struct turner_painter *painter,
                                          const struct turner_wish *wish,
                                          const struct turner_render_options *options,
                                          struct turner_image *heat);
/* soon.c: what is to be done for previews of saved hooks while the finished picture rests. */
enum turner_result turner_painter_rest(struct turner_painter *painter,
                                       const struct turner_wish *wish);
/* stages.c: shows an image. */
void turner_painter_publish(struct turner_painter *painter, const struct turner_image *image,
                            const struct turner_settings *settings, enum turner_stage stage,
                            double share);
enum turner_result turner_painter_resize(struct turner_image *image, int width, int height);
/* stages.c: compares the finished picture if it is to be measured, and shows it once more; puts it
 * off when there is a wish or the other painter wants its turn. */
enum turner_result turner_painter_measure(struct turner_painter *painter,
                                          const struct turner_wish *wish);

#endif
