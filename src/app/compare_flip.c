#include "app/compare_flip.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "app/process.h"

enum { NO_PACKAGE = 86 }; /* exit status of the script below */

/* Arguments: width, height, LDR or HDR; both pictures on standard input as float RGBA. */
static const char script[] =
    "import sys\n"
    "try:\n"
    "    import numpy, flip_evaluator\n"
    "except ImportError:\n"
    "    sys.exit(86)\n"
    "width, height, kind = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]\n"
    "pixels = numpy.frombuffer(sys.stdin.buffer.read(), numpy.float32)\n"
    "picture, reference = (numpy.ascontiguousarray(p)\n"
    "                      for p in pixels.reshape(2, height, width, 4)[..., :3])\n"
    "result = flip_evaluator.evaluate(reference, picture, kind, inputsRGB=False,\n"
    "                                 applyMagma=False)\n"
    "print(repr(float(result[1])))\n";

static bool within_unit(const struct turner_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * 4;
    for (size_t i = 0; i < count; i++) {
        if (i % 4 != 3 && !(image->rgba[i] >= 0 && image->rgba[i] <= 1))
            return false;
    }
    return true;
}

static bool put(FILE *file, const struct turner_image *image)
{
    size_t count = (size_t)image->width * (size_t)image->height;
    return fwrite(image->rgba, 4 * sizeof(float), count, file) == count;
}

/* Runs the script with files instead of pipes, so that neither side can wait for the other. */
static enum turner_result run(FILE *input, FILE *output, char *const arguments[])
{
    int status = turner_process_run(arguments, fileno(input), fileno(output));
    if (status == 0)
        return TURNER_OK;
    if (status < 0)
        return turner_fail(TURNER_BAD_INPUT, "--flip: python3 did not end well: %s",
                           strerror(errno));
    if (status == NO_PACKAGE || status == 127) {
        return turner_fail(TURNER_BAD_INPUT, "--flip needs python3 with the package "
                                             "flip-evaluator; install it with \"python3 -m pip "
                                             "install flip-evaluator numpy\"");
    }
    return turner_fail(TURNER_BAD_INPUT, "--flip: flip-evaluator failed, its own message stands "
                                         "above; leave --flip out or update the package");
}

enum turner_result turner_compare_flip(const struct turner_image *a,
                                       const struct turner_image *reference, double *mean,
                                       const char **kind)
{
    *kind = within_unit(a) && within_unit(reference) ? "LDR" : "HDR";
    char width[16], height[16], mode[4];
    snprintf(width, sizeof width, "%d", a->width);
    snprintf(height, sizeof height, "%d", a->height);
    snprintf(mode, sizeof mode, "%s", *kind);
    char python[] = "python3", option[] = "-c", code[sizeof script];
    memcpy(code, script, sizeof script);
    char *const arguments[] = {python, option, code, width, height, mode, NULL};

    FILE *input = tmpfile(), *output = tmpfile();
    enum turner_result result;
    if (!input || !output || !put(input, a) || !put(input, reference) || fflush(input) != 0 ||
        fseek(input, 0, SEEK_SET) != 0) {
        result = turner_fail(TURNER_OUTPUT, "--flip: cannot write a temporary file: %s; free some "
                                            "space in its folder", strerror(errno));
    } else {
        result = run(input, output, arguments);
    }
    if (result == TURNER_OK) {
        rewind(output);
        if (fscanf(output, "%lf", mean) != 1)
            result = turner_fail(TURNER_BAD_INPUT, "--flip: flip-evaluator gave no number; update "
                                                   "the package");
    }
    if (input)
        fclose(input);
    if (output)
        fclose(output);
    return result;
}
