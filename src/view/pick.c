/* What lies at a place in the picture. */
#include <math.h>

#include "render/features.h"
#include "render/layers.h"
#include "view/painter.h"

/* A camera at the same place whose middle is where (x, y) was (docs/model.md, "Camera"). */
static struct turner_camera towards(const struct turner_camera *camera,
                                    const struct turner_settings *settings, double x, double y)
{
    struct turner_camera to = *camera;
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_sub(camera->from, camera->at));
    struct turner_vec3 u = turner_vec3_normalize(turner_vec3_cross(camera->up, w));
    struct turner_vec3 v = turner_vec3_cross(w, u);
    double rows = settings->spd_grid ? settings->height - 2 : settings->height;
    double s = 2 * tan(camera->vfov / 2) / rows;
    struct turner_vec3 d = turner_vec3_scale(w, -1);
    d = turner_vec3_add(d, turner_vec3_scale(u, (x - 0.5 * settings->width) * s));
    d = turner_vec3_sub(d, turner_vec3_scale(v, (y - 0.5 * settings->height) * s));
    to.at = turner_vec3_add(camera->from, d);
    if (fabs(turner_vec3_dot(turner_vec3_normalize(d), turner_vec3_normalize(camera->up))) > 0.999)
        to.up = u; /* which way is up does not matter to one ray */
    return to;
}

enum turner_result turner_painter_meet(struct turner_painter *painter, double x, double y,
                                       struct turner_vec3 *point, bool *met)
{
    struct turner_scene scene = painter->scene;
    scene.camera = towards(&painter->scene.camera, &painter->scene.settings, x, y);
    scene.settings.width = scene.settings.height = 1;
    scene.settings.spd_grid = false;
    scene.settings.spp = 1;
    scene.settings.aa_threshold = scene.settings.error = 0;
    struct turner_layers layers = {.wanted = 1u << TURNER_LAYER_DEPTH};
    struct turner_statistics unused = {0};
    enum turner_result result;
    TURNER_TRY_DONE(turner_layers_create(&layers, &scene));
    TURNER_TRY_DONE(turner_renderer_look(&painter->renderer, &scene));
    TURNER_TRY_DONE(turner_features_draw(&layers, &painter->renderer, &painter->kernel, &scene,
                                         &painter->render, &unused));
    double depth = (double)layers.real[TURNER_LAYER_DEPTH][0];
    struct turner_vec3 d =
        turner_vec3_normalize(turner_vec3_sub(scene.camera.at, scene.camera.from));
    *met = isfinite(depth);
    *point = *met ? turner_vec3_add(scene.camera.from, turner_vec3_scale(d, depth))
                  : scene.camera.at;
done:
    turner_layers_destroy(&layers);
    return result;
}
