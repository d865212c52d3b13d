#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "app/app.h"

#define BAR_WIDTH 40

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

void turner_progress_begin(struct turner_progress_bar *bar, bool quiet)
{
    const char *terminal = getenv("TERM");
    *bar = (struct turner_progress_bar){.start = seconds()};
    bar->on = !quiet && isatty(STDERR_FILENO) && !(terminal && strcmp(terminal, "dumb") == 0);
}

bool turner_progress_show(double share, void *user)
{
    struct turner_progress_bar *bar = user;
    double now = seconds();
    if (!bar->on || (share < 1 && now - bar->shown < 0.05))
        return true;
    bar->shown = now;
    char cells[BAR_WIDTH + 1];
    int full = (int)(share * BAR_WIDTH);
    for (int i = 0; i < BAR_WIDTH; i++)
        cells[i] = i < full ? '#' : '.';
    cells[BAR_WIDTH] = 0;
    double elapsed = now - bar->start;
    fprintf(stderr, "\r[%s] %3.0f %%  %.1f s", cells, 100 * share, elapsed);
    if (share > 0.05 && share < 1)
        fprintf(stderr, ", %.0f s to go", elapsed * (1 - share) / share);
    fprintf(stderr, "%s%s\033[K", bar->what ? "  " : "", bar->what ? bar->what : "");
    fflush(stderr);
    return true;
}

void turner_progress_end(struct turner_progress_bar *bar)
{
    if (bar->on)
        fprintf(stderr, "\r\033[K");
    bar->on = false;
}
