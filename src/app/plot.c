#include "app/plot.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/process.h"
#include "base/embedded.h"
#include "base/memory.h"

extern const struct turner_embedded_file turner_embedded_plots[];
extern const size_t turner_embedded_plots_count;

/* A python3 of one's own often comes first in PATH, and the system's has the packages. */
static const char *const pythons[] = {"python3", "/usr/bin/python3"};

static char *find_python(void)
{
    for (size_t i = 0; i < sizeof pythons / sizeof *pythons; i++) {
        char *python = turner_strdup(pythons[i]);
        char option[] = "-c", script[] = "import sys\n"
                                         "try:\n"
                                         "    import matplotlib, numpy\n"
                                         "except ImportError:\n"
                                         "    sys.exit(86)\n";
        char *const arguments[] = {python, option, script, NULL};
        if (turner_process_run(arguments, -1, -1) == 0)
            return python;
        free(python);
    }
    return NULL;
}

static const char *find_script(const char *name)
{
    char file[64];
    snprintf(file, sizeof file, "%s.py", name);
    for (size_t i = 0; i < turner_embedded_plots_count; i++) {
        if (strcmp(turner_embedded_plots[i].name, file) == 0)
            return turner_embedded_plots[i].text;
    }
    return NULL;
}

enum turner_result turner_plot(const char *script, const char *const *arguments, size_t count)
{
    const char *text = find_script(script);
    if (!text)
        return turner_fail(TURNER_OUTPUT, "this turner carries no script \"%s\" to plot with; "
                                          "build it again", script);
    char *python = find_python();
    if (!python) {
        turner_warn("no pictures are drawn: there is no python3 with matplotlib; install it "
                    "(Debian: apt install python3-matplotlib)");
        return TURNER_OK;
    }
    char **all = turner_calloc(count + 4, sizeof *all);
    all[0] = python;
    all[1] = turner_strdup("-c");
    all[2] = turner_strdup(text);
    for (size_t i = 0; i < count; i++)
        all[3 + i] = turner_strdup(arguments[i]);
    int status = turner_process_run(all, -1, -1);
    for (char **argument = all; *argument; argument++)
        free(*argument);
    free(all);
    if (status == 0)
        return TURNER_OK;
    return turner_fail(TURNER_OUTPUT, "the script that draws the pictures failed (%s); its own "
                                      "message stands above",
                       status < 0 ? strerror(errno) : "exit status not 0");
}
