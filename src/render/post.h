/* The last step on a picture, by shaders/post.comp: made only where the hook `post` is replaced. */
#ifndef TURNER_RENDER_POST_H
#define TURNER_RENDER_POST_H

#include "render/params.h"

struct turner_kernel; /* of post.comp (render/renderer.h) */

#define TURNER_POST_PIXELS (1u << 18) /* at once */

struct turner_post {
    bool wanted;
    uint64_t source; /* of post.comp, wanted or not (turner_source_hash) */
    struct turner_program program;
    struct turner_param_block params;
    struct turner_buffer pixels;
};

/* Compiles it where the options' folders replace the hook; else `wanted` is false. */
enum turner_result turner_post_create(struct turner_post *post, struct turner_gpu *gpu,
                                      const struct turner_scene *scene,
                                      const struct turner_render_options *options);
void turner_post_destroy(struct turner_gpu *gpu, struct turner_post *post);

/* The two halves of it: the program, which may be made in any thread, and what it works on. */
enum turner_result turner_post_create_program(struct turner_post *post, struct turner_gpu *gpu,
                                              const struct turner_kernel *kernel,
                                              const struct turner_scene *scene,
                                              bool no_cache);
enum turner_result turner_post_create_buffers(struct turner_post *post, struct turner_gpu *gpu,
                                              const struct turner_kernel *kernel,
                                              const struct turner_scene *scene);

/* Each pixel's colour through the hook; nothing when it is not wanted. */
enum turner_result turner_post_draw(struct turner_image *image, struct turner_post *post,
                                    struct turner_gpu *gpu);

#endif
