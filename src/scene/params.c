#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/scene.h"

void turner_scene_set_param(struct turner_scene *scene, const char *name, const char *value)
{
    size_t i = 0;
    while (i < scene->param_count && strcmp(scene->params[i].name, name) != 0)
        i++;
    char *copy = turner_strdup(value); /* it may be the one that goes */
    if (i == scene->param_count)
        *TURNER_PUSH(scene->params, scene->param_count, scene->param_capacity) =
            (struct turner_scene_param){turner_strdup(name), NULL};
    free(scene->params[i].value);
    scene->params[i].value = copy;
}

enum turner_result turner_scene_assign_param(struct turner_scene *scene, const char *assignment)
{
    size_t length = strcspn(assignment, "=");
    if (!assignment[length] || length == 0)
        return turner_fail(TURNER_USAGE, "a parameter is set by name=value, as in scale=0.5, not "
                                         "by \"%.100s\"", assignment);
    char *name = turner_strdup(assignment);
    name[length] = 0;
    turner_scene_set_param(scene, name, assignment + length + 1);
    free(name);
    return TURNER_OK;
}
