/* Parameters of the shaders, in the panel and on their way to the painter. */
#include "render/params.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/shader_path.h"
#include "view/session.h"

/* ---- to the painter ---- */

void turner_painter_set_param(struct turner_painter *painter, const char *name, const char *value)
{
    pthread_mutex_lock(&painter->mutex);
    *TURNER_PUSH(painter->params, painter->param_count, painter->param_capacity) =
        (struct turner_scene_param){turner_strdup(name), turner_strdup(value)};
    painter->fresh_wish = true; /* the same once more */
    pthread_cond_signal(&painter->changed);
    pthread_mutex_unlock(&painter->mutex);
}

enum turner_result turner_painter_take_params(struct turner_painter *painter)
{
    struct turner_scene set = {0}; /* of which only parameters are there */
    pthread_mutex_lock(&painter->mutex);
    set.params = painter->params;
    set.param_count = painter->param_count;
    painter->params = NULL;
    painter->param_count = painter->param_capacity = 0;
    pthread_mutex_unlock(&painter->mutex);
    for (size_t i = 0; i < set.param_count; i++)
        turner_scene_set_param(&painter->scene, set.params[i].name, set.params[i].value);
    enum turner_result result = TURNER_OK;
    if (set.param_count && painter->reload)
        result = turner_reload_set_params(painter->reload, &painter->scene);
    else if (set.param_count)
        painter->ready = false; /* some may be compiled in */
    turner_scene_free_params(&set);
    return result;
}

/* ---- in the panel ---- */

static bool change(const struct turner_ui *ui, struct turner_param_value *value,
                   const struct turner_param *param)
{
    const char *choices[TURNER_PARAM_CHOICES];
    float number = (float)value->number[0], rgb[3];
    int whole = (int)value->number[0];
    bool on = value->number[0] != 0, any = false;
    for (int i = 0; i < 3; i++)
        rgb[i] = (float)value->number[i];
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
        any = ui->slide(param->name, &number, (float)param->least, (float)param->most, false);
        value->number[0] = (double)number;
        break;
    case TURNER_PARAM_INT:
        any = ui->slide_whole(param->name, &whole, (int)param->least, (int)param->most);
        value->number[0] = whole;
        break;
    case TURNER_PARAM_BOOL:
        any = ui->check(param->name, &on);
        value->number[0] = on;
        break;
    case TURNER_PARAM_COLOR:
        any = ui->color(param->name, rgb);
        for (int i = 0; i < 3; i++)
            value->number[i] = fmin(fmax((double)rgb[i], param->least), param->most);
        break;
    case TURNER_PARAM_CHOICE:
        for (int i = 0; i < param->choice_count; i++)
            choices[i] = param->choices[i];
        any = ui->choose(param->name, &whole, choices, param->choice_count);
        value->number[0] = whole;
        break;
    case TURNER_PARAM_MATERIAL: ui->row(param->name, value->name); break;
    }
    return any;
}

/* A shader that was saved may have others. */
static void look(struct turner_session *session)
{
    double now = turner_seconds();
    struct turner_params found = {0};
    struct turner_render_options render = session->options->render;
    struct turner_shader_path path;
    if (now < session->params_next)
        return;
    session->params_next = now + 1;
    turner_shader_path_create(&path, &render, &session->scene);
    if (turner_params_find(&found, NULL, &render) == TURNER_OK) {
        turner_params_destroy(&session->params);
        session->params = found;
    } else {
        turner_params_destroy(&found);
    }
    turner_shader_path_destroy(&path);
}

static bool takes_too(const struct turner_against *against, const char *param)
{
    return against && against->begun &&
           !against->options->keeps(against->options->user, param);
}

static void set(struct turner_session *session, const struct turner_param *param,
                const struct turner_param_value *value)
{
    char text[TURNER_PARAM_VALUE];
    turner_param_print(text, param, value);
    turner_scene_set_param(&session->scene, param->name, text);
    turner_painter_set_param(&session->painter, param->name, text);
    if (takes_too(session->against, param->name))
        turner_painter_set_param(&session->against->painter, param->name, text);
    session->changed = session->moving = true;
}

void turner_session_params(struct turner_session *session, const struct turner_ui *ui)
{
    struct turner_param_value value;
    look(session);
    for (size_t i = 0; i < session->params.count; i++) {
        const struct turner_param *param = &session->params.at[i];
        if (turner_param_of_scene(&value, param, &session->scene) != TURNER_OK)
            set(session, param, &param->standard); /* the shader takes others by now */
    }
    if (!session->params.count || !ui->section("Shader parameters", true))
        return;
    for (size_t i = 0; i < session->params.count; i++) {
        const struct turner_param *param = &session->params.at[i];
        if (turner_param_of_scene(&value, param, &session->scene) == TURNER_OK &&
            change(ui, &value, param))
            set(session, param, &value);
        ui->note(param->text);
    }
}
