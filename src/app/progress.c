#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <time.h>
#include <unistd.h>

#include "app/app.h"

#define BAR_WIDTH 40
#define BAR_WIDTH_BESIDE_TEXT 20

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

/* Of the terminal; what is longer would begin a line of its own and stay there. */
static int columns(void)
{
    struct winsize size;
    bool known = ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

bool turner_progress_show(double share, void *user)
{
    struct turner_progress_bar *bar = user;
    double now = seconds();
    if (!bar->on || (share < 1 && now - bar->shown < 0.05))
        return true;
    bar->shown = now;
    char cells[BAR_WIDTH + 1], line[256];
    int width = bar->what ? BAR_WIDTH_BESIDE_TEXT : BAR_WIDTH, full = (int)(share * width);
    for (int i = 0; i < width; i++)
        cells[i] = i < full ? '#' : '.';
    cells[width] = 0;
    double elapsed = now - bar->start;
    int used = snprintf(line, sizeof line, "[%s] %3.0f %%  %.1f s", cells, 100 * share, elapsed);
    if (share > 0.05 && share < 1)
        used += snprintf(line + used, sizeof line - (size_t)used, ", %.0f s to go",
                         elapsed * (1 - share) / share);
    if (bar->what)
        snprintf(line + used, sizeof line - (size_t)used, "  %s", bar->what);
    fprintf(stderr, "\r%.*s\033[K", columns() - 1, line);
    fflush(stderr);
    return true;
}

void turner_progress_end(struct turner_progress_bar *bar)
{
    if (bar->on)
        fprintf(stderr, "\r\033[K");
    bar->on = false;
}
