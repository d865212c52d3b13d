#include "scene/pov.h"

#include <stdio.h>
#include <stdlib.h>

#include "image/atomic.h"
#include "scene/pov_parts.h"

void turner_pov_vector(FILE *out, struct turner_vec3 v)
{
    fprintf(out, "<%.17g, %.17g, %.17g>", v.x, v.y, v.z);
}

bool turner_pov_zero(struct turner_vec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

const char *turner_pov_material_name(const struct turner_scene *scene, uint32_t material)
{
    static _Thread_local char text[256];
    if (scene->materials[material].name)
        snprintf(text, sizeof text, "material \"%.200s\"", scene->materials[material].name);
    else
        snprintf(text, sizeof text, "material %u", (unsigned)material);
    return text;
}

/* POV-Ray's pixel (i, j) looks along direction + ((i+½)/W − ½) right + (½ − (j+½)/H) up: centres,
 * as ours. Vectors given in full leave nothing to its left hand. */
static void write_camera(FILE *out, const struct turner_scene *scene)
{
    const struct turner_camera *camera = &scene->camera;
    const struct turner_settings *s = &scene->settings;
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_sub(camera->from, camera->at));
    struct turner_vec3 u = turner_vec3_normalize(turner_vec3_cross(camera->up, w));
    struct turner_vec3 v = turner_vec3_cross(w, u);
    double step = 2 * tan(camera->vfov / 2) / (s->spd_grid ? s->height - 2 : s->height);
    fputs("camera {\n  perspective\n  location ", out);
    turner_pov_vector(out, camera->from);
    fputs("\n  right ", out);
    turner_pov_vector(out, turner_vec3_scale(u, step * s->width));
    fputs("\n  up ", out);
    turner_pov_vector(out, turner_vec3_scale(v, step * s->height));
    fputs("\n  direction ", out);
    turner_pov_vector(out, turner_vec3_scale(w, -1));
    fputs("\n}\n", out);
}

/* The pattern is held inside [¼, ¾]: beyond 1 it would start again at 0. */
static void write_background(FILE *out, const struct turner_background *background)
{
    if (background->kind == TURNER_BACKGROUND_CONSTANT) {
        fputs("background { rgb ", out);
        turner_pov_vector(out, background->color);
        fputs(" }\n", out);
        return;
    }
    fputs("sky_sphere { pigment {\n  gradient ", out);
    turner_pov_vector(out, background->up);
    fputs("\n  color_map { [0.25 rgb ", out);
    turner_pov_vector(out, background->color);
    fputs("] [0.75 rgb ", out);
    turner_pov_vector(out, background->top);
    fputs("] }\n  scale 4 translate ", out);
    turner_pov_vector(out, turner_vec3_scale(background->up, -2));
    fputs("\n} }\n", out);
}

/* How far from the camera a sun is put. Its light is parallel all the same, but what lies beyond it
 * casts no shadow; POV-Ray follows no ray beyond 1e7. */
#define SUN_DISTANCE 1e9
/* POV-Ray's colour × 2/(1 + (d/fade)²) is J/d² but for a share fade²/d²; none smaller is taken. */
#define FADE_DISTANCE 1e-9

static void write_light(FILE *out, const struct turner_light *light, struct turner_vec3 eye)
{
    struct turner_vec3 position = light->position, color = light->power;
    bool fades = light->kind != TURNER_LIGHT_DIRECTIONAL &&
                 light->falloff == TURNER_FALLOFF_INVERSE_SQUARE;
    if (light->kind == TURNER_LIGHT_DIRECTIONAL)
        position = turner_vec3_sub(eye, turner_vec3_scale(light->direction, SUN_DISTANCE));
    if (fades)
        color = turner_vec3_scale(color, 0.5 / (FADE_DISTANCE * FADE_DISTANCE));
    fputs("light_source {\n  ", out);
    turner_pov_vector(out, position);
    fputs(", rgb ", out);
    turner_pov_vector(out, color);
    if (light->kind == TURNER_LIGHT_DIRECTIONAL) {
        fputs("\n  parallel point_at ", out);
        turner_pov_vector(out, eye);
    }
    if (light->kind == TURNER_LIGHT_SPOT) {
        fprintf(out, "\n  spotlight radius %.17g falloff %.17g tightness 0 point_at ",
                acos(light->cos_inner) * (180 / M_PI), acos(light->cos_outer) * (180 / M_PI));
        turner_pov_vector(out, turner_vec3_add(light->position, light->direction));
    }
    if (fades)
        fprintf(out, "\n  fade_distance %.17g fade_power 2", FADE_DISTANCE);
    fputs("\n}\n", out);
}

static void write_scene(FILE *out, const struct turner_scene *scene,
                        const struct turner_pov_holes *holes)
{
    const struct turner_settings *s = &scene->settings;
    fprintf(out,
            "// Written by turner %s for POV-Ray 3.7. One ray through the centre of each pixel:\n"
            "//   povray +Iscene.pov +Oscene.exr +FE +W%d +H%d +Q9 -A -D\n"
            "#version 3.7;\n"
            "global_settings {\n  assumed_gamma 1\n  max_trace_level %d\n  adc_bailout %.17g\n"
            "  ambient_light rgb 1\n}\n",
            turner_version(), s->width, s->height, s->depth + 1, s->cutoff);
    write_camera(out, scene);
    write_background(out, &scene->background);
    for (size_t i = 0; i < scene->light_count; i++)
        write_light(out, &scene->lights[i], scene->camera.from);
    turner_pov_declare_materials(out, scene);
    turner_pov_objects(out, scene, holes);
}

static enum turner_result check_settings(const struct turner_scene *scene)
{
    const struct turner_settings *s = &scene->settings;
    if (s->depth > 255)
        return turner_fail(TURNER_BAD_INPUT, "POV-Ray follows no more than 255 bounces, not %d: "
                                             "give the scene a smaller depth", s->depth);
    if (s->cutoff > 1)
        return turner_fail(TURNER_BAD_INPUT, "with a cutoff of %g POV-Ray would draw nothing: give "
                                             "the scene one of at most 1", s->cutoff);
    if (scene->background.kind == TURNER_BACKGROUND_ENVIRONMENT)
        return turner_fail(TURNER_BAD_INPUT, "POV-Ray does not filter a picture as turner does: an "
                           "environment background is not exported, use a constant or a gradient");
    for (size_t i = 0; i < scene->light_count; i++) {
        const struct turner_light *light = &scene->lights[i];
        if (light->kind == TURNER_LIGHT_SPOT && (light->cos_inner <= 0 || light->cos_outer < 0))
            return turner_fail(TURNER_BAD_INPUT, "light %zu: a spot light of POV-Ray is narrower "
                               "than a half space: give it angles below 90 degrees, or make it a "
                               "point light", i);
    }
    return TURNER_OK;
}

static enum turner_result check(struct turner_pov_holes *holes, const struct turner_scene *scene)
{
    TURNER_TRY(turner_pov_check_materials(scene));
    TURNER_TRY(turner_pov_check_patterns(scene));
    return turner_pov_check_solids(holes, scene);
}

static enum turner_result write_with(struct turner_pov_holes *holes,
                                     const struct turner_scene *scene, const char *path)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    bool whole = out != NULL;
    if (out) {
        write_scene(out, scene, holes);
        whole = !ferror(out);
        whole = fclose(out) == 0 && whole;
    }
    enum turner_result result =
        whole ? turner_atomic_write(path, text, size)
              : turner_fail(TURNER_DEVICE, "not enough memory for the POV-Ray scene");
    free(text);
    return result;
}

enum turner_result turner_pov_write(const struct turner_scene *scene, const char *path)
{
    struct turner_pov_holes holes = {0};
    TURNER_TRY(check_settings(scene));
    enum turner_result result = check(&holes, scene);
    if (result == TURNER_OK)
        result = write_with(&holes, scene, path);
    free(holes.list);
    return result;
}

enum turner_result turner_pov_write_anyway(const struct turner_scene *scene, const char *path)
{
    struct turner_pov_holes holes = {0};
    TURNER_TRY(check_settings(scene));
    if (check(&holes, scene) != TURNER_OK) {
        turner_warn("%s; written all the same, the picture will be another", turner_message());
        holes.count = 0;
    }
    enum turner_result result = write_with(&holes, scene, path);
    free(holes.list);
    return result;
}
