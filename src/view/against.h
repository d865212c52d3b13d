/* turner view --against: a second picture of the scene beside the first, drawn in another way. */
#ifndef TURNER_VIEW_AGAINST_H
#define TURNER_VIEW_AGAINST_H

#include "image/image.h"
#include "view/view.h"

struct turner_session;

struct turner_against {
    const struct turner_against_options *options;
    struct turner_turn turn;
    struct turner_opening opening; /* begun when the first picture is there: of two devices that open */
    struct turner_painter painter; /* at once, neither is soon there */
    bool begun;
    struct turner_settings asked, adapted; /* the first's, and what they are here */
    bool known;                            /* these */
    struct turner_wish wish;
    struct turner_sight sight;
    char alert[2048];
    double split;             /* where the divider is: 0 left, 1 right */
    uint8_t *rgba;            /* both pictures in one */
    size_t room;              /* pixels */
    unsigned counts[2];       /* of the two that were compared last */
    bool compared;            /* they are those that are shown */
    struct turner_comparison difference;
    struct turner_image heat;
};

void turner_against_create(struct turner_against *against,
                           const struct turner_against_options *options);
void turner_against_destroy(struct turner_against *against);

/* All but the first two may be called of a session that has no second picture: they do nothing. */

/* Tells both painters the session's wish. */
void turner_against_wish(struct turner_session *session);
/* Takes what the second painter has drawn and read; true when there is a new picture. */
enum turner_result turner_against_take(struct turner_session *session, bool *fresh);
/* The bytes to be shown, of either picture or of both. */
void turner_against_compose(struct turner_session *session, const uint8_t **rgba, int *width,
                            int *height);
/* The painter of what is shown at x of the window. */
struct turner_painter *turner_against_at(struct turner_session *session, double x);
/* Whether x is on the divider; moves it there. */
bool turner_against_on(const struct turner_session *session, double x);
void turner_against_move(struct turner_session *session, double x);
/* The divider, and the figures of both sides, as boxes beside it or as rows of the panel. */
void turner_against_boxes(struct turner_session *session);
void turner_against_rows(struct turner_session *session);
/* What both painters complain of, or "". */
void turner_against_alert(const struct turner_session *session, char text[4200]);

#endif
