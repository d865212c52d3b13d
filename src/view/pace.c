#include "view/pace.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#define LEAST_SCALE 0.03
#define SLOW_INTERVAL 0.0325 /* seconds */
#define GOOD_INTERVAL 0.030
#define LEAST_SECONDS 0.012
#define MOST_SECONDS 0.029
#define HOLD 0.12 /* a change of scale by less is not worth the flicker */
#define PATIENCE 15 /* frames */
#define SPARE 0.7 /* of the time of a frame: so much is left over that more can be tried */
#define TRUST 0.5 /* of the last measurement against those before */

void turner_pace_start(struct turner_pace *pace, int depth)
{
    static const struct {
        int depth;
        double least;
    } rungs[] = {{4, 0.22}, {2, 0.17}, {1, LEAST_SCALE}}; /* at 0 mirrors are black */
    memset(pace, 0, sizeof *pace);
    pace->depth[0] = depth;
    pace->least[0] = 0.25;
    pace->rungs = 1;
    pace->seconds = TURNER_PACE_SECONDS;
    pace->patience = PATIENCE;
    for (int i = 0; i < 3; i++) {
        if (rungs[i].depth >= depth)
            continue;
        pace->depth[pace->rungs] = rungs[i].depth;
        pace->least[pace->rungs++] = rungs[i].least;
    }
    pace->least[pace->rungs - 1] = LEAST_SCALE;
}

/* Of a rung that was not tried yet: rays are in proportion to the depth they are followed to. */
static double cost_of(const struct turner_pace *pace, int rung)
{
    if (pace->cost[rung] > 0)
        return pace->cost[rung];
    for (int far = 1; far < pace->rungs; far++) {
        for (int other = rung - far; other <= rung + far; other += 2 * far) {
            if (other >= 0 && other < pace->rungs && pace->cost[other] > 0)
                return pace->cost[other] * (pace->depth[rung] + 1) / (pace->depth[other] + 1);
        }
    }
    return 0;
}

static int scaled(int full, double scale)
{
    int size = (int)(full * scale + 0.5);
    return size < 1 ? 1 : size > full ? full : size;
}

void turner_pace_choose(struct turner_pace *pace, int full_width, int full_height, int *width,
                        int *height, int *depth)
{
    double pixels = (double)full_width * full_height, scale = 1;
    int rung = 0;
    for (; rung < pace->rungs; rung++) {
        double cost = cost_of(pace, rung);
        /* nothing is known: the first frame ever, which is to come at once */
        scale = cost > 0 ? sqrt(pace->seconds / (cost * pixels)) : 0.25;
        /* what was given up comes back when there is room for it with some to spare */
        double least = pace->least[rung] * (rung < pace->rung ? 1 + HOLD : 1);
        if (scale >= least || cost == 0 || rung == pace->rungs - 1)
            break;
    }
    scale = scale > 1 ? 1 : scale < LEAST_SCALE ? LEAST_SCALE : scale;
    bool same = rung == pace->rung && pace->scale > 0;
    if (same && scale > pace->scale && scale < pace->scale * (1 + HOLD) && scale < 1)
        scale = pace->scale;
    if (same && scale < pace->scale && scale > pace->scale * (1 - HOLD / 3))
        scale = pace->scale;
    pace->rung = rung;
    pace->scale = scale;
    *width = scaled(full_width, scale);
    *height = scaled(full_height, scale);
    *depth = pace->depth[rung];
}

/* What was measured of the depth above a while ago may no longer be so: when there is time left over,
 * it is tried again, more rarely each time that was in vain. */
static void probe(struct turner_pace *pace, int rung, double seconds)
{
    if (pace->probed == rung + 1) {
        bool vain = seconds > pace->seconds;
        pace->patience = !vain ? PATIENCE : pace->patience < 1000 ? 2 * pace->patience : 1000;
    }
    pace->probed = 0;
    bool spare = rung > 0 && pace->scale == 1 && seconds < SPARE * pace->seconds;
    pace->spare = spare ? pace->spare + 1 : 0;
    if (pace->spare < pace->patience)
        return;
    double likely = pace->cost[rung] * (pace->depth[rung - 1] + 1) / (pace->depth[rung] + 1);
    if (cost_of(pace, rung - 1) > likely)
        pace->cost[rung - 1] = likely;
    pace->probed = rung;
    pace->spare = 0;
}

void turner_pace_took(struct turner_pace *pace, int depth, double pixels, double seconds)
{
    for (int i = 0; i < pace->rungs; i++) {
        if (pace->depth[i] != depth || pixels <= 0 || seconds <= 0)
            continue;
        double cost = seconds / pixels, before = cost_of(pace, i);
        double now = before > 0 ? before + TRUST * (cost - before) : cost;
        if (pace->cost[i] == 0)
            now = cost;
        for (int j = 0; j < pace->rungs && pace->measured == i + 1; j++) {
            if (j != i)
                pace->cost[j] *= now / before; /* they look at the same things */
        }
        pace->cost[i] = now;
        pace->measured = i + 1;
        probe(pace, i, seconds);
    }
}

void turner_pace_seen(struct turner_pace *pace, double interval)
{
    if (interval > SLOW_INTERVAL)
        pace->seconds = fmax(pace->seconds * 0.97, LEAST_SECONDS);
    else if (interval < GOOD_INTERVAL)
        pace->seconds = fmin(pace->seconds * 1.01, MOST_SECONDS);
}
