#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/app.h"
#include "scene/scene.h"

enum turner_result turner_bad_option(char **argv)
{
    /* inside a cluster of short options (-xq) optind has not moved on yet */
    const char letter[] = {'-', (char)optopt, 0};
    bool is_short = optopt > 0 && optopt < 256 && strncmp(argv[optind - 1], "--", 2) != 0;
    return turner_fail(TURNER_USAGE, "option \"%s\" is unknown or lacks its value; see turner %s "
                                     "--help", is_short ? letter : argv[optind - 1], argv[0]);
}

enum turner_result turner_option_real(double *out, const char *option, const char *text,
                                      double least, double most)
{
    char *end;
    double value = strtod(text, &end);
    if (end == text || *end || !(value >= least && value <= most))
        return turner_fail(TURNER_USAGE, "%s takes a number from %g to %g, not \"%s\"", option,
                           least, most, text);
    *out = value;
    return TURNER_OK;
}

enum turner_result turner_option_int(int *out, const char *option, const char *text, int least,
                                     int most)
{
    char *end;
    errno = 0;
    long value = strtol(text, &end, 10);
    if (end == text || *end || errno || value < least || value > most)
        return turner_fail(TURNER_USAGE, "%s takes a whole number from %d to %d, not \"%s\"",
                           option, least, most, text);
    *out = (int)value;
    return TURNER_OK;
}

enum turner_result turner_option_size(int *width, int *height, const char *option,
                                      const char *text)
{
    char *end;
    errno = 0;
    long w = strtol(text, &end, 10), h = 0;
    if (end != text && *end == 'x' && end[1] >= '0' && end[1] <= '9')
        h = strtol(end + 1, &end, 10);
    if (*end || errno || w < 1 || h < 1 || w > TURNER_MAX_SIZE || h > TURNER_MAX_SIZE)
        return turner_fail(TURNER_USAGE, "%s takes WIDTHxHEIGHT, both from 1 to %d, as in "
                                         "640x480, not \"%s\"", option, TURNER_MAX_SIZE, text);
    *width = (int)w;
    *height = (int)h;
    return TURNER_OK;
}

enum turner_result turner_option_choice(int *out, const char *option, const char *text,
                                        const char *const *choices)
{
    char list[256] = "";
    for (int i = 0; choices[i]; i++) {
        if (strcmp(text, choices[i]) == 0) {
            *out = i;
            return TURNER_OK;
        }
        strncat(list, i ? ", " : "", sizeof list - strlen(list) - 1);
        strncat(list, choices[i], sizeof list - strlen(list) - 1);
    }
    return turner_fail(TURNER_USAGE, "%s takes one of %s, not \"%s\"", option, list, text);
}
