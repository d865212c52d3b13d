/* --against of turner view: what the second picture is drawn with. */
#ifndef TURNER_APP_AGAINST_H
#define TURNER_APP_AGAINST_H

#include "app/scene_options.h"

struct turner_second_side {
    const struct turner_scene_options *first; /* options of both, */
    struct turner_scene_options other;        /* then what differs; */
    const char *folder;                       /* of shaders, in place of those of `first`; or NULL */
    const char *path;                         /* of the scene */
    struct turner_render_options render;      /* of the second */
    const char *folders[1];
    char name[256]; /* "B: …" */
    bool given;
};

/* Takes one --against: a folder, "-" for turner's own shaders, or "name=value" of a method, a setting
 * or a parameter of shaders; `text` lives as long as the side. */
enum turner_result turner_side_take(struct turner_second_side *side, const char *text,
                                       char **argv);
/* When all are taken, and the options of both: sets `render` and `name`. */
void turner_side_finish(struct turner_second_side *side);

/* The scene as the second side has it. */
enum turner_result turner_side_load(struct turner_scene **scene,
                                       const struct turner_second_side *side);
/* Settings of the first as the second has them. */
void turner_side_adapt(void *side, struct turner_settings *settings);
/* Whether the second has its own value of a parameter of shaders. */
bool turner_side_keeps(void *side, const char *param);

#endif
