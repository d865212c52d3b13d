/* How much to trace while the picture moves: as much as can be done in the time a frame has. */
#ifndef TURNER_VIEW_PACE_H
#define TURNER_VIEW_PACE_H

#define TURNER_PACE_SECONDS 0.026 /* of a frame, to trace, at first; the rest of 1/30 s is for
                                     showing it */
#define TURNER_PACE_RUNGS 4

/* What is given up, and in which order: first resolution down to a quarter, then depth, then what is
 * left of resolution. Costs are of a pixel, measured; 0: not known yet. */
struct turner_pace {
    double seconds; /* of a frame, to trace */
    int rungs;
    int depth[TURNER_PACE_RUNGS]; /* falling */
    double least[TURNER_PACE_RUNGS]; /* of the size of the picture, as long as it is at this depth */
    double cost[TURNER_PACE_RUNGS];
    int rung;     /* last chosen */
    double scale; /* the same; 0: none was */
    int spare;    /* frames in a row that left time over */
    int patience; /* so many until more depth is tried again */
    int measured; /* the rung that was drawn last, plus 1; or 0 */
    int probed;   /* the rung above that is being tried, plus 1; or 0 */
};

/* Of a picture that is followed to `depth` when nothing is given up. */
void turner_pace_start(struct turner_pace *pace, int depth);

/* Size and depth of the next frame of a picture of full_width × full_height; at least 1 × 1. */
void turner_pace_choose(struct turner_pace *pace, int full_width, int full_height, int *width,
                        int *height, int *depth);

/* Frames follow each other in so many seconds: when that is above 1/30 s there is less time to trace,
 * when it is well below there is more. */
void turner_pace_seen(struct turner_pace *pace, double interval);

/* A picture of so many pixels was traced to `depth` in so many seconds. */
void turner_pace_took(struct turner_pace *pace, int depth, double pixels, double seconds);

#endif
