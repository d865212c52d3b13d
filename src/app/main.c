#include <fcntl.h>
#include <locale.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/app.h"
#include "gpu/device.h"
#include "image/image.h"

static const struct {
    const char *name, *summary;
    enum turner_result (*run)(int argc, char **argv);
} commands[] = {
    {"render", "draw a scene into a picture", turner_cmd_render},
#ifdef TURNER_VIEW
    {"view", "show a scene in a window, and move through it", turner_cmd_view},
#else
    {"view", "(left out of this build) show a scene in a window", turner_cmd_view},
#endif
    {"compare", "say how much two pictures differ", turner_cmd_compare},
    {"compare-shaders", "say how two folders of shaders differ in speed and picture",
     turner_cmd_compare_shaders},
    {"explain", "list the rays that made a pixel, and where they go wrong", turner_cmd_explain},
    {"check", "read scenes or shaders and say what is wrong with them", turner_cmd_check},
    {"chart", "chart speed against accuracy for a grid of settings", turner_cmd_chart},
    {"params", "list the methods that can be chosen, and where they come from", turner_cmd_params},
    {"export", "write a scene for POV-Ray, a second opinion", turner_cmd_export},
    {"stability", "measure where methods fail, and that the defaults do not",
     turner_cmd_stability},
    {"bench", "measure rays a second, against other tracers", turner_cmd_bench},
    {"devices", "list the devices and what each can do", turner_cmd_devices},
};
enum { command_count = sizeof commands / sizeof *commands };

static void print_help(FILE *out)
{
    fprintf(out, "turner %s draws scenes by recursive ray tracing on Vulkan compute, "
                 "and says how fast and how wrong.\n\n"
                 "Usage: turner COMMAND [ARGUMENT]…\n\nCommands:\n", turner_version());
    for (int i = 0; i < command_count; i++)
        fprintf(out, "  %-15s %s\n", commands[i].name, commands[i].summary);
    fprintf(out, "\nTry: turner render scenes/whitted1980.json -o picture.png\n"
                 "Each command explains itself: turner render --help\n\n"
                 "Exit status: 0 done; 1 pictures differ or a check failed; 2 wrong command line; "
                 "3 wrong input;\n4 device, driver or memory; 5 could not write; "
                 "130 interrupted.\n");
}

/* A picture appears whole or not at all: what is half written goes, and so do we, at once. */
static void interrupted(int signal_number)
{
    turner_image_abandon();
    _exit(128 + signal_number);
}

static void catch_signals(void)
{
    static const int ends[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action = {.sa_handler = interrupted}, before;
    sigemptyset(&action.sa_mask);
    for (size_t i = 0; i < sizeof ends / sizeof *ends; i++) {
        if (sigaction(ends[i], NULL, &before) == 0 && before.sa_handler == SIG_IGN)
            continue; /* nohup, or a job in the background */
        sigaction(ends[i], &action, NULL);
    }
    signal(SIGPIPE, SIG_IGN);  /* a closed pipe becomes a failed write with a message */
    signal(SIGXFSZ, SIG_IGN);  /* so does the limit of file sizes */
}

/* A standard stream that came closed is opened the wrong way round, so that no file of ours takes
 * its number and gets our text; using it still fails. */
static void hold_standard_streams(void)
{
    for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; stream++) {
        if (fcntl(stream, F_GETFD) == -1)
            open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
}

/* While a device opens, memory is given back and wanted again many times, by two threads: for the
 * kernel to take it and clear new pages each time is a fiftieth of a short run. */
static void keep_memory(void)
{
#ifdef __GLIBC__
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_TOP_PAD, 4 << 20);
    mallopt(M_TRIM_THRESHOLD, 64 << 20);
    mallopt(M_MMAP_THRESHOLD, 2 << 20);
#endif
}

int main(int argc, char **argv)
{
    keep_memory();
    hold_standard_streams();
    setlocale(LC_ALL, "C");
    catch_signals();
    atexit(turner_image_abandon); /* memory may run out while a picture is written */
    turner_gpu_leave_out_absent();
    if (argc < 2) {
        print_help(stderr);
        return TURNER_USAGE;
    }
    if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0 ||
        strcmp(argv[1], "help") == 0) {
        print_help(stdout);
        return TURNER_OK;
    }
    if (strcmp(argv[1], "--version") == 0) {
        printf("turner %s\n", turner_version());
        return TURNER_OK;
    }
    for (int i = 0; i < command_count; i++) {
        if (strcmp(argv[1], commands[i].name) != 0)
            continue;
        enum turner_result result = commands[i].run(argc - 1, argv + 1);
        if (result == TURNER_OK && (fflush(stdout) != 0 || ferror(stdout)))
            result = turner_fail(TURNER_OUTPUT, "cannot write to standard output; is the disk "
                                                "full or the pipe closed?");
        if (result != TURNER_OK && *turner_message())
            fprintf(stderr, "turner: error: %s\n", turner_message());
        return (int)result;
    }
    fprintf(stderr, "turner: error: no command \"%s\"; see turner --help\n", argv[1]);
    return TURNER_USAGE;
}
