/* Parameters of shaders (gpu/param.h) with the values that a scene gives them. */
#ifndef TURNER_RENDER_PARAMS_H
#define TURNER_RENDER_PARAMS_H

#include "gpu/memory.h"
#include "gpu/param.h"
#include "gpu/program.h"
#include "scene/scene.h"

/* The scene's value of a parameter, or its default. TURNER_USAGE when the scene's does not fit. */
enum turner_result turner_param_of_scene(struct turner_param_value *value,
                                         const struct turner_param *param,
                                         const struct turner_scene *scene);

/* All that the shaders of a picture have, those of the last step too. Nothing is compiled. In *hash,
 * unless NULL, one number for all files with another text than turner's own; 0 when there are none.
 * Results as of turner_shader_source_create; TURNER_BAD_INPUT also where two kernels have different
 * ones of the same name. The caller destroys `params`, also after a failure. */
enum turner_result turner_params_find(struct turner_params *params, uint64_t *hash,
                                      const struct turner_render_options *options);

/* Every value the scene gives is one of a parameter there is, and fits. TURNER_USAGE names it and
 * the nearest there is. */
enum turner_result turner_params_check(const struct turner_params *params,
                                       const struct turner_scene *scene);

/* The same, and the scene then has a value for each, the default where it gave none, and the hash
 * of its shaders. */
enum turner_result turner_params_settle(struct turner_scene *scene,
                                        const struct turner_render_options *options);

/* Appends the const ones as specialisation constants; room for TURNER_PARAM_WORDS. */
enum turner_result turner_params_constants(struct turner_constant *constants, size_t *count,
                                           const struct turner_params *params,
                                           const struct turner_scene *scene);

/* The live ones of a kernel, on the device. */
struct turner_param_block {
    struct turner_params params;
    struct turner_buffer buffer; /* its address is 0 where there are none */
};

enum turner_result turner_param_block_create(struct turner_param_block *block,
                                             struct turner_gpu *gpu,
                                             const struct turner_params *params,
                                             const struct turner_scene *scene);
void turner_param_block_destroy(struct turner_gpu *gpu, struct turner_param_block *block);

/* Takes the scene's values, not while a dispatch runs. They stay as they were when one does not
 * fit. */
enum turner_result turner_param_block_set(struct turner_param_block *block,
                                          const struct turner_scene *scene);

#endif
