/* The panel: figures, and everything that can be changed while looking. Each thing in it can be said
 * on the command line or in the scene file, too. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/adaptive.h"
#include "scene/methods.h"
#include "view/session.h"

#define WIDE 25 /* of the panel, in heights of its letters */
#define DEGREE (3.14159265358979323846 / 180)
#define MOST_VALUES 8

TURNER_PRINTF(3, 4)
static void row(const struct turner_ui *ui, const char *name, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    ui->row(name, text);
}

static void changed(struct turner_session *session)
{
    session->changed = session->moving = true;
}

/* ---- figures ---- */

static void show_rays(const struct turner_session *session, const struct turner_ui *ui)
{
    const struct turner_statistics *s = &session->sight.statistics;
    const struct {
        const char *name;
        uint64_t count;
    } kinds[] = {{"camera", s->camera_rays}, {"reflected", s->reflected_rays},
                 {"refracted", s->refracted_rays}, {"shadow", s->shadow_rays}};
    double seconds = s->seconds_trace > 0 ? s->seconds_trace : session->sight.seconds;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds && seconds > 0 && s->camera_rays; i++)
        row(ui, kinds[i].name, "%.2f million rays/s", (double)kinds[i].count / seconds / 1e6);
}

static void show_figures(const struct turner_session *session, const struct turner_ui *ui)
{
    static const char *const stages[] = {"moving", "one sample a pixel", "as the settings say",
                                         "finished"};
    const struct turner_sight *sight = &session->sight;
    const struct turner_statistics *s = &sight->statistics;
    char text[64];
    if (sight->quick && session->frame_seconds > 0 && session->frame_seconds < 1)
        row(ui, "frame", "%.1f ms, %.0f a second", 1e3 * session->frame_seconds,
            1 / session->frame_seconds);
    else
        row(ui, "picture", "%.3f s", sight->seconds);
    row(ui, "resolution", "%dx%d of %dx%d", sight->width, sight->height,
        session->wish.settings.width, session->wish.settings.height);
    row(ui, "depth", "%d", sight->settings.depth);
    ui->row("state", sight->preview ? "saved hooks, direct light" : stages[sight->stage]);
    if (sight->stage != TURNER_STAGE_DONE && sight->share < 1) {
        snprintf(text, sizeof text, "%.0f %%", 100 * sight->share);
        ui->bar((float)sight->share, text);
    }
    show_rays(session, ui);
    if (sight->settings.error > 0 && sight->stage == TURNER_STAGE_DONE)
        row(ui, "estimated error", "%.2g at most, %.2g mean", s->error_max, s->error_mean);
    ui->row("device", s->device);
    row(ui, "traversal", "%s, %s", s->traversal ? s->traversal : "", s->precision ? s->precision : "");
}

static void show_comparison(struct turner_session *session, const struct turner_ui *ui)
{
    const struct turner_sight *sight = &session->sight;
    ui->note("A small picture with these settings beside the reference in extended precision.");
    bool on = session->wish.seen == TURNER_SEEN_DIFFERENCE;
    if (ui->button(on ? "show the picture" : "measure"))
        turner_session_see(session, on ? TURNER_SEEN_PICTURE : TURNER_SEEN_DIFFERENCE);
    if (on && !sight->compared)
        ui->note("The reference is at work.");
    if (!sight->compared)
        return;
    row(ui, "largest", "%.3g at %d,%d", sight->comparison.largest, sight->comparison.largest_x,
        sight->comparison.largest_y);
    row(ui, "rmse", "%.3g", sight->comparison.rmse);
    row(ui, "off by > 1/255", "%llu of %llu pixels",
        (unsigned long long)sight->comparison.pixels_over,
        (unsigned long long)sight->comparison.pixels);
    row(ui, "seconds", "%.3f, reference %.2f", sight->compared_seconds,
        sight->reference_seconds);
}

/* ---- settings ---- */

static void show_settings(struct turner_session *session, const struct turner_ui *ui)
{
    static const char *const shadings[] = {"phong", "energy_conserving"};
    static const char *const shadows[] = {"opaque", "tinted"};
    static const char *const transfers[] = {"srgb", "linear"};
    struct turner_settings *s = &session->wish.settings;
    bool any = false, to_error = s->error > 0;
    int shading = (int)s->shading, shadow = (int)s->shadows, transfer = (int)s->transfer;
    float cutoff = (float)s->cutoff, exposure = (float)s->exposure, error = (float)s->error;
    if (ui->check("choose all by an error", &to_error)) {
        s->error = to_error ? 1.0 / 64 : 0;
        any = true;
    }
    if (to_error) {
        if (ui->slide("error", &error, 1.0f / 1024, 0.25f, true))
            s->error = (double)error, any = true;
    } else {
        any |= ui->slide_whole("depth", &s->depth, 0, 16);
        if (ui->slide("cutoff", &cutoff, 0, 0.25f, true))
            s->cutoff = (double)cutoff, any = true;
        any |= ui->slide_whole("samples", &s->spp, 1, 64);
    }
    if (ui->slide("exposure", &exposure, -8, 8, false))
        s->exposure = (double)exposure, any = true;
    if (ui->choose("shading", &shading, shadings, 2))
        s->shading = (enum turner_shading)shading, any = true;
    if (ui->choose("shadows", &shadow, shadows, 2))
        s->shadows = (enum turner_shadows)shadow, any = true;
    if (ui->choose("transfer", &transfer, transfers, 2))
        s->transfer = (enum turner_transfer)transfer, any = true;
    if (any)
        changed(session);
}

/* Words of "a | b | c"; 0 when there are others than words among them. */
static int split(char words[MOST_VALUES][32], const char *values)
{
    int count = 0;
    for (const char *at = values; *at && count < MOST_VALUES; count++) {
        size_t length = strcspn(at, " |");
        if (!length || length >= sizeof words[0])
            return 0;
        snprintf(words[count], sizeof words[0], "%.*s", (int)length, at);
        at += length;
        if (strcspn(words[count], "<>:,…") != length)
            return 0;
        if (strncmp(at, " | ", 3) == 0)
            at += 3;
        else if (*at)
            return 0;
    }
    return count;
}

static void show_method(struct turner_session *session, const struct turner_ui *ui,
                        const struct turner_method *method)
{
    char words[MOST_VALUES][32], text[TURNER_METHOD_TEXT];
    const char *choices[MOST_VALUES];
    int count = split(words, method->values), chosen = -1;
    turner_method_text(text, &session->wish.settings, method->name);
    for (int i = 0; i < count; i++) {
        choices[i] = words[i];
        if (strcmp(words[i], text) == 0)
            chosen = i;
    }
    if (!count || !ui->choose(method->name, &chosen, choices, count))
        return;
    struct turner_settings settings = session->wish.settings;
    if (turner_method_set(&settings, method->name, choices[chosen]) != TURNER_OK) {
        turner_session_say(session, "%s", turner_message());
        return;
    }
    session->wish.settings = settings;
    changed(session);
}

/* ---- scene ---- */

/* The session's own materials and lights, from the first change on. */
static void own(struct turner_session *session)
{
    struct turner_scene *scene = &session->scene;
    session->painted = true;
    changed(session);
    if (session->owns)
        return;
    struct turner_material *materials = turner_calloc(scene->material_count + 1, sizeof *materials);
    struct turner_light *lights = turner_calloc(scene->light_count + 1, sizeof *lights);
    if (scene->material_count)
        memcpy(materials, scene->materials, scene->material_count * sizeof *materials);
    if (scene->light_count)
        memcpy(lights, scene->lights, scene->light_count * sizeof *lights);
    scene->materials = materials;
    scene->lights = lights;
    session->owns = true;
}

void turner_panel_close(struct turner_session *session)
{
    if (session->owns) {
        free(session->scene.materials);
        free(session->scene.lights);
    }
    session->owns = false;
}

static void to_floats(float out[3], struct turner_vec3 v)
{
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static bool color(const struct turner_ui *ui, const char *name, struct turner_vec3 *v)
{
    float rgb[3];
    to_floats(rgb, *v);
    if (!ui->color(name, rgb))
        return false;
    *v = turner_vec3_of(fmax(0, (double)rgb[0]), fmax(0, (double)rgb[1]), fmax(0, (double)rgb[2]));
    return true;
}

static bool vector(const struct turner_ui *ui, const char *name, struct turner_vec3 *v, float speed)
{
    float xyz[3];
    to_floats(xyz, *v);
    if (!ui->numbers(name, xyz, speed))
        return false;
    *v = turner_vec3_of((double)xyz[0], (double)xyz[1], (double)xyz[2]);
    return true;
}

static void show_materials(struct turner_session *session, const struct turner_ui *ui)
{
    struct turner_scene *scene = &session->scene;
    if (!scene->material_count)
        return;
    if (scene->material_count > 1)
        ui->slide_whole("material", &session->material, 0, (int)scene->material_count - 1);
    struct turner_material m = scene->materials[session->material];
    ui->row("name", m.name ? m.name : "(none)");
    struct turner_vec3 *const terms[] = {&m.k_d, &m.k_s, &m.k_r, &m.k_t, &m.k_a, &m.k_e};
    static const char *const names[] = {"k_d", "k_s", "k_r", "k_t", "k_a", "k_e"};
    bool any = false;
    for (int i = 0; i < 6; i++) {
        if (i == 3 && m.medium == TURNER_NONE)
            continue; /* there is nothing behind its surface */
        struct turner_vec3 before = *terms[i];
        if (color(ui, names[i], terms[i]))
            any = true;
        struct turner_vec3 now = *terms[i];
        if (i == 3 && now.x == 0 && now.y == 0 && now.z == 0)
            *terms[i] = before; /* it would need no medium then */
    }
    float exponent = (float)m.exponent;
    if (ui->slide("exponent", &exponent, 0, 2000, true))
        m.exponent = (double)exponent, any = true;
    if (m.pattern == TURNER_PATTERN_CHECKER) {
        any |= color(ui, "checker, even", &m.checker[0]);
        any |= color(ui, "checker, odd", &m.checker[1]);
    }
    if (any) {
        own(session);
        scene->materials[session->material] = m;
    }
}

static void show_lights(struct turner_session *session, const struct turner_ui *ui)
{
    static const char *const kinds[] = {"directional", "point", "spot"};
    struct turner_scene *scene = &session->scene;
    bool any = color(ui, "ambient", &scene->ambient);
    if (scene->background.kind != TURNER_BACKGROUND_ENVIRONMENT)
        any |= color(ui, "background", &scene->background.color);
    if (scene->background.kind == TURNER_BACKGROUND_GRADIENT)
        any |= color(ui, "its top", &scene->background.top);
    if (any)
        own(session);
    if (!scene->light_count)
        return;
    if (scene->light_count > 1)
        ui->slide_whole("light", &session->light, 0, (int)scene->light_count - 1);
    struct turner_light l = scene->lights[session->light];
    ui->row("kind", kinds[l.kind]);
    any = color(ui, l.kind == TURNER_LIGHT_DIRECTIONAL ? "irradiance" : "intensity", &l.power);
    if (l.kind != TURNER_LIGHT_DIRECTIONAL)
        any |= vector(ui, "position", &l.position, 0.02f);
    if (l.kind != TURNER_LIGHT_POINT && vector(ui, "direction", &l.direction, 0.01f)) {
        struct turner_vec3 d = turner_vec3_normalize(l.direction);
        any = true;
        l.direction = turner_vec3_length(d) > 0.5 ? d : scene->lights[session->light].direction;
    }
    if (any) {
        own(session);
        scene->lights[session->light] = l;
    }
}

static void show_camera(struct turner_session *session, const struct turner_ui *ui)
{
    struct turner_camera camera = session->wish.camera;
    float vfov = (float)(camera.vfov / DEGREE);
    bool any = vector(ui, "from", &camera.from, 0.02f);
    any |= vector(ui, "at", &camera.at, 0.02f);
    if (ui->slide("vfov", &vfov, 1, 170, false))
        camera.vfov = (double)vfov * DEGREE, any = true;
    struct turner_vec3 view = turner_vec3_normalize(turner_vec3_sub(camera.at, camera.from));
    struct turner_vec3 side = turner_vec3_cross(view, turner_vec3_normalize(camera.up));
    if (any && turner_vec3_length(side) > 1e-3) {
        session->wish.camera = camera;
        changed(session);
    }
}

int turner_session_kinds(const struct turner_session *session)
{
    return session->against ? TURNER_SEEN_KINDS : TURNER_SEEN_AGAINST;
}

void turner_session_see(struct turner_session *session, enum turner_seen seen)
{
    enum turner_seen before = session->wish.seen;
    bool same = (seen == TURNER_SEEN_PICTURE && before == TURNER_SEEN_AGAINST) ||
                (seen == TURNER_SEEN_AGAINST && before == TURNER_SEEN_PICTURE);
    session->wish.seen = seen;
    session->changed = session->changed || !same; /* the painters draw the same for both */
    session->dirty = true;
    session->composed = false;
}

static void show_seen(struct turner_session *session, const struct turner_ui *ui)
{
    const char *names[TURNER_SEEN_KINDS];
    int seen = (int)session->wish.seen, kinds = turner_session_kinds(session);
    for (int i = 0; i < kinds; i++)
        names[i] = turner_seen_name((enum turner_seen)i);
    if (ui->choose("show", &seen, names, kinds))
        turner_session_see(session, (enum turner_seen)seen);
}

void turner_panel(struct turner_session *session)
{
    const struct turner_ui *ui = &session->functions->ui;
    if (ui->open("turner", 0, WIDE, false)) {
        show_figures(session, ui);
        show_seen(session, ui);
        turner_against_rows(session);
        turner_session_params(session, ui);
        if (ui->section("Settings", true))
            show_settings(session, ui);
        if (ui->section("Methods", false)) {
            for (size_t i = 0; i < turner_method_count; i++)
                show_method(session, ui, &turner_methods_list[i]);
        }
        if (ui->section("Camera", false))
            show_camera(session, ui);
        if (ui->section("Materials", false))
            show_materials(session, ui);
        if (ui->section("Lights", false))
            show_lights(session, ui);
        if (ui->section("Error and speed", false))
            show_comparison(session, ui);
    }
    ui->close();
}
