/* turner params for a scene or a folder of shaders: the parameters that their //!PARAM lines declare. */
#include "app/params_list.h"

#include <cjson/cJSON.h>
#include <stdio.h>
#include <string.h>

#include "render/params.h"
#include "render/shader_path.h"

static void print_range(const struct turner_param *param)
{
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
    case TURNER_PARAM_INT:
    case TURNER_PARAM_COLOR: printf(" %.6g … %.6g", param->least, param->most); break;
    case TURNER_PARAM_CHOICE:
        for (int i = 0; i < param->choice_count; i++)
            printf("%s%s", i ? " | " : " ", param->choices[i]);
        break;
    case TURNER_PARAM_BOOL: printf(" true | false"); break;
    case TURNER_PARAM_MATERIAL: break;
    }
}

static void print_param(const struct turner_param *param, const struct turner_param_value *value)
{
    char standard[TURNER_PARAM_VALUE], now[TURNER_PARAM_VALUE];
    turner_param_print(standard, param, &param->standard);
    turner_param_print(now, param, value);
    printf("%s = %s   (%s%s", param->name, now, param->constant ? "const " : "",
           turner_param_type_name(param->type));
    print_range(param);
    printf(", default %s)\n    %s\n    %s:%d\n\n", standard, param->text, param->file, param->line);
}

static void add_json(cJSON *list, const struct turner_param *param,
                     const struct turner_param_value *value)
{
    char text[TURNER_PARAM_VALUE];
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "name", param->name);
    cJSON_AddStringToObject(object, "type", turner_param_type_name(param->type));
    cJSON_AddBoolToObject(object, "const", param->constant);
    turner_param_print(text, param, &param->standard);
    cJSON_AddStringToObject(object, "default", text);
    turner_param_print(text, param, value);
    cJSON_AddStringToObject(object, "value", text);
    if (param->type == TURNER_PARAM_FLOAT || param->type == TURNER_PARAM_INT ||
        param->type == TURNER_PARAM_COLOR) {
        cJSON_AddNumberToObject(object, "least", param->least);
        cJSON_AddNumberToObject(object, "most", param->most);
    }
    cJSON *choices = param->choice_count ? cJSON_AddArrayToObject(object, "choices") : NULL;
    for (int i = 0; i < param->choice_count; i++)
        cJSON_AddItemToArray(choices, cJSON_CreateString(param->choices[i]));
    cJSON_AddStringToObject(object, "text", param->text);
    cJSON_AddStringToObject(object, "file", param->file);
    cJSON_AddNumberToObject(object, "line", param->line);
    cJSON_AddItemToArray(list, object);
}

static enum turner_result list(const struct turner_params *params, const struct turner_scene *scene,
                               bool json)
{
    TURNER_TRY(turner_params_check(params, scene)); /* nothing below fails */
    cJSON *array = cJSON_CreateArray();
    for (size_t i = 0; i < params->count; i++) {
        struct turner_param_value value;
        turner_param_of_scene(&value, &params->at[i], scene);
        if (json)
            add_json(array, &params->at[i], &value);
        else
            print_param(&params->at[i], &value);
    }
    if (json) {
        char *text = cJSON_Print(array);
        puts(text);
        cJSON_free(text);
    } else if (params->count == 0) {
        puts("The shaders declare no parameters (docs/shaders.md).");
    }
    cJSON_Delete(array);
    return TURNER_OK;
}

enum turner_result turner_params_list(const struct turner_scene_options *options,
                                      struct turner_scene *scene, bool json)
{
    struct turner_render_options render = options->render;
    struct turner_shader_path path;
    struct turner_params params = {0};
    enum turner_result result;
    turner_shader_path_create(&path, &render, scene);
    for (size_t i = 0; i < options->param_count; i++)
        TURNER_TRY_DONE(turner_scene_assign_param(scene, options->params[i]));
    TURNER_TRY_DONE(turner_params_find(&params, NULL, &render));
    result = list(&params, scene, json);
done:
    turner_params_destroy(&params);
    turner_shader_path_destroy(&path);
    return result;
}
