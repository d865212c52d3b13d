/* What lies over the picture: the list of keys, the panel, what just happened. */
#include <stdio.h>

#include "view/session.h"

static const char *const keys[][2] = {
    {"left drag", "orbit around what is looked at"},
    {"middle or Shift+left drag", "pan"},
    {"right drag", "look around; with W A S D Q E: fly"},
    {"wheel", "nearer, farther"},
    {"arrows, Page up, Page down", "fly (Shift faster, Ctrl slower)"},
    {"double click", "look at what is there"},
    {"Ctrl+click", "the rays of that pixel, as turner explain; Esc closes it"},
    {"Home", "back to where it began"},
    {"0 1 … 9", "the scene's cameras"},
    {"C", "print the camera as JSON"},
    {"Shift+C", "write it into the scene file"},
    {"R", "record a path of cameras, and end it"},
    {"V, Shift+V", "what is shown: picture, normal, depth …"},
    {"S", "save the picture, once it is finished"},
    {"X; H", "--against: the divider to the middle or an edge; heat map"},
    {"Tab, P", "panel"},
    {"F1", "these keys"},
    {"Esc, Q", "quit"},
};

static void show_keys(const struct turner_ui *ui)
{
    if (ui->open("Keys", 3, 34, false)) {
        for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
            ui->row(keys[i][0], keys[i][1]);
    }
    ui->close();
}

static void show_toast(const struct turner_session *session, const struct turner_ui *ui)
{
    if (turner_seconds() >= session->toast_end)
        return;
    ui->open("##toast", session->panel ? 8 : 2, 0, true);
    ui->text(session->toast);
    ui->close();
}

static void show_alert(const struct turner_session *session, const struct turner_ui *ui)
{
    char text[4200];
    turner_against_alert(session, text);
    if (!text[0])
        return;
    ui->open("##alert", session->panel ? 8 : 5, 44, true);
    ui->alert(text);
    ui->close();
}

static void show_legend(const struct turner_session *session, const struct turner_ui *ui)
{
    char text[256];
    const struct turner_against *against = session->against;
    if (session->wish.seen == TURNER_SEEN_PICTURE)
        return;
    snprintf(text, sizeof text, "%s%s%s", turner_seen_name(session->wish.seen),
             session->sight.legend[0] ? ": " : "", session->sight.legend);
    if (session->wish.seen == TURNER_SEEN_DIFFERENCE && !session->sight.compared)
        snprintf(text, sizeof text, "difference: the reference is at work");
    if (session->wish.seen == TURNER_SEEN_AGAINST && against->compared)
        snprintf(text, sizeof text, "A against B: white %.3g, rms %.3g; %llu of %llu pixels differ",
                 against->difference.largest, against->difference.rmse,
                 (unsigned long long)against->difference.pixels_over,
                 (unsigned long long)against->difference.pixels);
    ui->open("##legend", 4, 0, true);
    ui->text(text);
    ui->close();
}

void turner_session_boxes(struct turner_session *session)
{
    const struct turner_ui *ui = &session->functions->ui;
    ui->begin(session->window);
    turner_against_boxes(session);
    if (session->panel)
        turner_panel(session);
    if (session->keys)
        show_keys(ui);
    if (session->explanation) {
        if (ui->open("Rays of a pixel", 1, 47, false))
            ui->code(session->explanation);
        ui->close();
    }
    show_legend(session, ui);
    show_toast(session, ui);
    show_alert(session, ui);
}
