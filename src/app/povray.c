#define _GNU_SOURCE /* posix_spawn_file_actions_addchdir_np; POSIX 2024 has it without _np */
#include "app/povray.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "image/image.h"
#include "scene/pov.h"

extern char **environ;

bool turner_povray_found(void)
{
    const char *path = getenv("PATH");
    while (path && *path) {
        size_t length = strcspn(path, ":");
        char file[4096];
        snprintf(file, sizeof file, "%.*s/povray", (int)length, length ? path : ".");
        if (access(file, X_OK) == 0)
            return true;
        path += length + (path[length] == ':');
    }
    return false;
}

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Waits for `child`, or ends it. The wait status, or −1 when its time was up. */
static int wait_for(pid_t child)
{
    double end = now() + TURNER_POVRAY_SECONDS;
    long pause = 1000000; /* ns, up to a twentieth of a second */
    int status;
    for (;;) {
        pid_t done = waitpid(child, &status, WNOHANG);
        if (done == child)
            return status;
        if ((done < 0 && errno != EINTR) || now() > end)
            break;
        nanosleep(&(struct timespec){.tv_nsec = pause}, NULL);
        pause = pause < 50000000 ? pause * 2 : 50000000;
    }
    kill(child, SIGKILL);
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    return -1;
}

/* In `folder`, since POV-Ray as it is packaged reads and writes no other; what it says goes to the
 * file `log` there. */
static enum turner_result run(const char *folder, const char *log, char *const arguments[])
{
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log, O_WRONLY | O_CREAT | O_TRUNC,
                                     0666);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t child;
    int error = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error)
        return turner_fail(TURNER_DEVICE, "povray could not be run: %s; install POV-Ray 3.7 "
                                          "(Debian: apt install povray) and see that %s/%s can be "
                                          "written", strerror(error), folder, log);
    int status = wait_for(child);
    if (status == -1)
        return turner_fail(TURNER_DEVICE, "povray took more than %d seconds; ask for a smaller "
                                          "picture or less depth", TURNER_POVRAY_SECONDS);
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return turner_fail(TURNER_DEVICE, "povray failed (%s %d); its words are in %s/%s",
                           WIFEXITED(status) ? "exit status" : "signal",
                           WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status), folder, log);
    return TURNER_OK;
}

enum turner_result turner_povray_render(struct turner_image *image,
                                        const struct turner_scene *scene, const char *folder,
                                        const char *name)
{
    *image = (struct turner_image){0};
    char pov[4096], exr[4096], log[256], input[256], output[256], width[32], height[32];
    if (snprintf(pov, sizeof pov, "%s/%s.pov", folder, name) >= (int)sizeof pov ||
        snprintf(exr, sizeof exr, "%s/%s.exr", folder, name) >= (int)sizeof exr ||
        snprintf(log, sizeof log, "%s.log", name) >= (int)sizeof log)
        return turner_fail(TURNER_USAGE, "%s/%s: this name is too long", folder, name);
    if (strchr(name, '"'))
        return turner_fail(TURNER_USAGE, "%s: povray takes no names with quotes", name);
    TURNER_TRY(turner_pov_write(scene, pov));
    if (unlink(exr) != 0 && errno != ENOENT)
        return turner_fail(TURNER_OUTPUT, "%s: cannot be replaced: %s", exr, strerror(errno));
    snprintf(input, sizeof input, "+I\"%s.pov\"", name); /* it takes such words apart at spaces */
    snprintf(output, sizeof output, "+O\"%s.exr\"", name);
    snprintf(width, sizeof width, "+W%d", scene->settings.width);
    snprintf(height, sizeof height, "+H%d", scene->settings.height);
    /* OpenEXR, best quality, no antialiasing, no window, no wait: whatever a povray.ini says. */
    char *arguments[] = {"povray", input, output, width, height, "+FE", "+Q9", "-A", "-D", "-P",
                         "-C", "-UA", "-GA", "+GF", "+GW", "+SR1", "+SC1", NULL};
    TURNER_TRY(run(folder, log, arguments));
    if (turner_image_read(image, exr, false) != TURNER_OK)
        return turner_fail_within(TURNER_DEVICE, "povray left no picture (its words are in %s/%s)",
                                  folder, log);
    if (image->width != scene->settings.width || image->height != scene->settings.height)
        return turner_fail(TURNER_DEVICE, "%s: povray drew %d×%d pixels, not %d×%d; its words are "
                           "in %s/%s", exr, image->width, image->height, scene->settings.width,
                           scene->settings.height, folder, log);
    return TURNER_OK;
}
