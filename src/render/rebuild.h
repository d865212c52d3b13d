/* Kernels being made, in a thread of their own (render/reload.h). */
#ifndef TURNER_RENDER_REBUILD_H
#define TURNER_RENDER_REBUILD_H

#include <pthread.h>
#include <semaphore.h>
#include <stdatomic.h>

#include "render/preview.h"

/* What is read of the files. A source without text is one that nothing is made of. */
struct turner_sources {
    struct turner_shader_source picture, post, lighting, visibility;
};

void turner_sources_destroy(struct turner_sources *sources);

/* A renderer's program to be made: that of the picture, or of its accurate twin. */
struct turner_part {
    struct turner_needs needs, needs_of_surface; /* the second when that hook is replaced */
    uint32_t bvh_depth;
    struct turner_program program;
};

/* The thread has it alone until `lit`, and all but `lighting` until `done`. What is made stands in
 * the order in which it is made. */
struct turner_rebuild {
    struct turner_rebuild *next; /* its owner's, as is this: */
    uint64_t picture;            /* hash of what decides the picture's kernel */
    pthread_t thread;
    atomic_bool lit, done, given_up; /* the last is for the thread to see, */
    sem_t go_on;                     /* and this, where a preview was promised */
    uint64_t text; /* hash of the source and of what else decides the kernel */
    struct turner_gpu *gpu;
    struct turner_scene *scene; /* with parameters, materials' names */
    unsigned kind;
    bool no_cache;
    struct turner_sources sources;
    struct turner_part parts[2]; /* the picture's first, */
    int part_count;              /* or none: only what follows the picture has changed */

    struct turner_lighting lighting;
    bool previewed;      /* the owner will show `lighting`, */
    bool lighting_shown; /* and has: its own */
    struct turner_kernel kernel, post_kernel;
    struct turner_post post;
    struct turner_program visibility;
    enum turner_result result; /* of the picture's and the post kernel */
    char *message;
    double start, seconds;
};

/* Starts the thread, which takes the sources and `scene`, also when it fails (TURNER_DEVICE). With
 * `post_only` the renderer keeps its programs, and only that of the hook post is made. Where
 * `lighting` will be shown (`previewed`) nothing more is made until turner_rebuild_go_on, or for
 * half a second: it would take a core from what one waits for. */
enum turner_result turner_rebuild_create(struct turner_rebuild **rebuild,
                                         const struct turner_renderer *renderer,
                                         struct turner_scene *scene,
                                         struct turner_sources *sources, uint64_t text,
                                         bool post_only, bool no_cache, bool previewed);
void turner_rebuild_go_on(struct turner_rebuild *rebuild);
/* Nobody wants it any more; the thread ends when it can. */
void turner_rebuild_give_up(struct turner_rebuild *rebuild);
/* Waits for what the thread is in the middle of. */
void turner_rebuild_destroy(struct turner_rebuild *rebuild);

#endif
