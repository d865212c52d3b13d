#include "view/against.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "view/session.h"

#define GRIP 6      /* pixels beside the divider that move it */
#define BOX 19      /* width of a side's figures, in heights of letters */
#define NARROW 640  /* pixels: in windows below there is only room for a line each */

void turner_against_create(struct turner_against *against,
                           const struct turner_against_options *options)
{
    *against = (struct turner_against){.options = options, .split = 0.5};
    turner_turn_create(&against->turn);
}

void turner_against_destroy(struct turner_against *against)
{
    if (against->begun)
        turner_painter_stop(&against->painter);
    turner_opening_destroy(&against->opening);
    turner_sight_destroy(&against->sight);
    turner_image_destroy(&against->heat);
    free(against->rgba);
    turner_turn_destroy(&against->turn);
}

/* ---- wishes ---- */

/* The reference follows rays as far, and takes as many samples, as the side that does more. */
static struct turner_settings truth_of(const struct turner_settings *a,
                                       const struct turner_settings *b)
{
    struct turner_settings truth = *a;
    if (a->error > 0 || b->error > 0) {
        truth.error = 0;
        truth.spp = 64;
    }
    truth.depth = b->depth > a->depth ? b->depth : a->depth;
    truth.cutoff = fmin(a->cutoff, b->cutoff);
    truth.spp = b->spp > truth.spp ? b->spp : truth.spp;
    return truth;
}

static struct turner_wish derived(struct turner_against *against, const struct turner_wish *first)
{
    struct turner_wish wish = *first;
    if (!against->known || memcmp(&against->asked, &first->settings, sizeof against->asked) != 0) {
        memcpy(&against->asked, &first->settings, sizeof against->asked);
        against->adapted = first->settings;
        against->options->adapt(against->options->user, &against->adapted);
        against->known = true;
    }
    wish.settings = against->adapted;
    wish.settings.width = first->settings.width;
    wish.settings.height = first->settings.height;
    return wish;
}

static struct turner_wish first_wish(struct turner_session *session)
{
    struct turner_wish wish = session->wish;
    if (!session->against)
        return wish;
    struct turner_wish second = derived(session->against, &wish);
    wish.measure = true;
    wish.truth = truth_of(&wish.settings, &second.settings);
    if (wish.seen == TURNER_SEEN_AGAINST)
        wish.seen = TURNER_SEEN_PICTURE;
    return wish;
}

void turner_against_wish(struct turner_session *session)
{
    session->wish.number++;
    struct turner_wish wish = first_wish(session);
    turner_painter_wish(&session->painter, &wish);
    if (!session->against)
        return;
    session->against->wish = derived(session->against, &wish);
    if (session->against->begun)
        turner_painter_wish(&session->against->painter, &session->against->wish);
}

/* ---- what is drawn ---- */

static enum turner_result begin(struct turner_session *session)
{
    struct turner_against *against = session->against;
    const struct turner_against_options *options = against->options;
    struct turner_painter_options painter = session->painter.options;
    painter.render = options->render;
    painter.read = options->read;
    painter.reader = options->reader;
    struct turner_wish wish = first_wish(session);
    against->wish = derived(against, &wish);
    turner_opening_start(&against->opening, options->render.device);
    TURNER_TRY(turner_painter_start(&against->painter, options->scene, &against->wish,
                                    &against->opening, &painter));
    against->begun = true;
    turner_painter_wish(&session->painter, &wish); /* which is measured from now on */
    return TURNER_OK;
}

static void take_scene(struct turner_session *session)
{
    struct turner_against *against = session->against;
    struct turner_scene *scene = turner_painter_read(&against->painter);
    if (!scene)
        return;
    struct turner_wish wish = first_wish(session);
    against->wish = derived(against, &wish);
    turner_painter_show(&against->painter, scene, &against->wish);
}

static bool comparable(const struct turner_sight *a, const struct turner_sight *b)
{
    return a->stage == TURNER_STAGE_DONE && b->stage == TURNER_STAGE_DONE &&
           a->number == b->number && a->width == b->width && a->height == b->height && a->linear &&
           b->linear && a->seen == TURNER_SEEN_PICTURE && b->seen == TURNER_SEEN_PICTURE;
}

static void compare(struct turner_session *session)
{
    struct turner_against *against = session->against;
    const struct turner_sight *a = &session->sight, *b = &against->sight;
    if (!comparable(a, b)) {
        against->compared = false;
        return;
    }
    if (against->compared && against->counts[0] == a->count && against->counts[1] == b->count)
        return;
    struct turner_image x = {.width = a->width, .height = a->height, .rgba = a->linear};
    struct turner_image y = {.width = b->width, .height = b->height, .rgba = b->linear};
    turner_image_destroy(&against->heat);
    turner_image_compare(&against->difference, &y, &x, 0, 0);
    double full = against->difference.largest > 0 ? against->difference.largest : 1;
    against->compared = turner_image_heatmap(&against->heat, &y, &x, full) == TURNER_OK;
    against->counts[0] = a->count;
    against->counts[1] = b->count;
}

enum turner_result turner_against_take(struct turner_session *session, bool *fresh)
{
    struct turner_against *against = session->against;
    if (!against)
        return TURNER_OK;
    if (!against->begun && session->sight.rgba)
        TURNER_TRY(begin(session));
    if (!against->begun)
        return TURNER_OK;
    *fresh = turner_painter_take(&against->painter, &against->sight) || *fresh;
    TURNER_TRY(turner_painter_result(&against->painter));
    take_scene(session);
    if (turner_painter_alert(&against->painter, against->alert))
        session->dirty = true;
    if (*fresh)
        compare(session);
    return TURNER_OK;
}

/* ---- on the screen ---- */

static uint8_t *canvas(struct turner_against *against, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    if (against->room < pixels) {
        against->rgba = turner_realloc(against->rgba, pixels, 4);
        against->room = pixels;
    }
    return against->rgba;
}

/* The columns from `begin` to `end` of a picture of any size, spread over width × height. */
static void spread(uint8_t *to, int width, int height, const struct turner_sight *from, int begin,
                   int end)
{
    for (int y = 0; y < height && end > begin; y++) {
        uint8_t *row = to + 4 * (size_t)width * (size_t)y;
        if (!from->rgba) { /* not drawn yet */
            memset(row + 4 * begin, 0x18, 4 * (size_t)(end - begin));
            continue;
        }
        int v = (int)((int64_t)y * from->height / height);
        const uint8_t *source = from->rgba + 4 * (size_t)from->width * (size_t)v;
        if (from->width == width) {
            memcpy(row + 4 * begin, source + 4 * begin, 4 * (size_t)(end - begin));
            continue;
        }
        for (int x = begin; x < end; x++)
            memcpy(row + 4 * x, source + 4 * ((int64_t)x * from->width / width), 4);
    }
}

void turner_against_compose(struct turner_session *session, const uint8_t **rgba, int *width,
                            int *height)
{
    struct turner_against *against = session->against;
    const struct turner_sight *a = &session->sight, *b = against ? &against->sight : NULL;
    *rgba = a->rgba;
    *width = a->width;
    *height = a->height;
    if (!against)
        return;
    *width = b->width > a->width ? b->width : a->width;
    *height = b->height > a->height ? b->height : a->height;
    uint8_t *to = canvas(against, *width, *height);
    *rgba = to;
    if (session->wish.seen == TURNER_SEEN_AGAINST && against->compared) {
        size_t values = 4 * (size_t)*width * (size_t)*height;
        for (size_t i = 0; i < values; i++)
            to[i] = (uint8_t)(255 * fmin(fmax((double)against->heat.rgba[i], 0), 1) + 0.5);
        return;
    }
    int middle = (int)(against->split * *width + 0.5);
    spread(to, *width, *height, a, 0, middle);
    spread(to, *width, *height, b, middle, *width);
}

static bool splits(const struct turner_session *session)
{
    const struct turner_against *against = session->against;
    return against && !(session->wish.seen == TURNER_SEEN_AGAINST && against->compared);
}

struct turner_painter *turner_against_at(struct turner_session *session, double x)
{
    struct turner_against *against = session->against;
    bool second = against && against->begun &&
                  x >= against->split * session->wish.settings.width;
    return second ? &against->painter : &session->painter;
}

bool turner_against_on(const struct turner_session *session, double x)
{
    return splits(session) &&
           fabs(x - session->against->split * session->wish.settings.width) <= GRIP;
}

void turner_against_move(struct turner_session *session, double x)
{
    session->against->split = fmin(fmax(x / session->wish.settings.width, 0), 1);
    session->composed = false;
    session->dirty = true;
}

/* ---- figures ---- */

static double rays_of(const struct turner_sight *sight)
{
    const struct turner_statistics *s = &sight->statistics;
    return (double)(s->camera_rays + s->reflected_rays + s->refracted_rays + s->shadow_rays);
}

static void show_error(const struct turner_ui *ui, const struct turner_sight *sight)
{
    char text[128] = "…";
    if (sight->hooked)
        snprintf(text, sizeof text, "none: it has hooks");
    else if (sight->compared)
        snprintf(text, sizeof text, "%.3g", sight->comparison.rmse);
    ui->row("rms error", text);
    if (sight->compared)
        snprintf(text, sizeof text, "%.3g", sight->comparison.largest);
    if (!sight->hooked)
        ui->row("largest error", text);
}

static void show_side(struct turner_session *session, const struct turner_sight *sight)
{
    const struct turner_ui *ui = &session->functions->ui;
    char text[128];
    if (!sight->rgba) {
        ui->note("it is on its way");
        return;
    }
    double seconds = sight->statistics.seconds_trace > 0 ? sight->statistics.seconds_trace
                                                         : sight->seconds;
    snprintf(text, sizeof text, "%.1f ms", 1e3 * sight->seconds);
    ui->row(sight->quick ? "frame" : "picture", text);
    snprintf(text, sizeof text, "%dx%d, depth %d", sight->width, sight->height,
             sight->settings.depth);
    ui->row("resolution", text);
    double rays = rays_of(sight) / 1e6; /* 0 as long as it is being drawn */
    snprintf(text, sizeof text, rays > 0 ? "%.3f million" : "…", rays);
    ui->row("rays", text);
    snprintf(text, sizeof text, rays > 0 && seconds > 0 ? "%.2f million/s" : "…", rays / seconds);
    ui->row("speed", text);
    show_error(ui, sight);
}

static void show_difference(struct turner_session *session)
{
    const struct turner_against *against = session->against;
    const struct turner_comparison *d = &against->difference;
    const struct turner_ui *ui = &session->functions->ui;
    char text[160];
    if (!against->compared)
        snprintf(text, sizeof text, "…");
    else if (d->pixels_over == 0)
        snprintf(text, sizeof text, "none: the pictures are the same");
    else
        snprintf(text, sizeof text, "rms %.3g, %.1f %% of pixels", d->rmse,
                 100 * (double)d->pixels_over / (double)d->pixels);
    ui->row("difference", text);
}

void turner_against_rows(struct turner_session *session)
{
    const struct turner_ui *ui = &session->functions->ui;
    struct turner_against *against = session->against;
    if (!against)
        return;
    bool heat = session->wish.seen == TURNER_SEEN_AGAINST;
    if (!ui->section("A against B", true))
        return;
    ui->text("A, left");
    show_side(session, &session->sight);
    ui->text(against->options->name);
    show_side(session, &against->sight);
    show_difference(session);
    float split = (float)against->split;
    if (ui->slide("divider", &split, 0, 1, false))
        turner_against_move(session, (double)split * session->wish.settings.width);
    if (ui->check("heat map of the difference", &heat))
        turner_session_see(session, heat ? TURNER_SEEN_AGAINST : TURNER_SEEN_PICTURE);
}

static void show_line(struct turner_session *session, const struct turner_sight *sight,
                      const char *name)
{
    char text[128];
    snprintf(text, sizeof text, "%s  %.1f ms", name, 1e3 * sight->seconds);
    session->functions->ui.text(text);
}

void turner_against_boxes(struct turner_session *session)
{
    const struct turner_ui *ui = &session->functions->ui;
    struct turner_against *against = session->against;
    if (!splits(session))
        return;
    int width = session->wish.settings.width;
    ui->divider((float)(against->split * width));
    if (session->panel)
        return; /* they are in it */
    bool narrow = width < NARROW;
    ui->open("##a", 6, narrow ? 0 : BOX, true);
    if (narrow) {
        show_line(session, &session->sight, "A");
    } else {
        ui->text("A: as it stands");
        show_side(session, &session->sight);
    }
    ui->close();
    ui->open("##b", 7, narrow ? 0 : BOX, true);
    if (narrow) {
        show_line(session, &against->sight, "B");
    } else {
        ui->text(against->options->name);
        show_side(session, &against->sight);
        show_difference(session);
    }
    ui->close();
}

void turner_against_alert(const struct turner_session *session, char text[4200])
{
    const char *first = session->alert, *second = session->against ? session->against->alert : "";
    bool both = *first && *second && strcmp(first, second) != 0;
    snprintf(text, 4200, "%s%s%s", *first ? first : second, both ? "\n" : "", both ? second : "");
}
