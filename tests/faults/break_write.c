/* Loaded into the command with LD_PRELOAD: breaks the writing of files aside (*.part).
 *
 * TURNER_BREAK=write  half of the first write arrives, then …
 * TURNER_BREAK=rename nothing is renamed, but …
 * TURNER_BREAK_SIGNAL=n … the process gets signal n;
 * TURNER_BREAK_ERRNO=n … or the call fails with errno n. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>

static bool is_part(const char *name)
{
    size_t length = strlen(name);
    return length > 5 && strcmp(name + length - 5, ".part") == 0;
}

static bool breaks(const char *call)
{
    const char *wanted = getenv("TURNER_BREAK");
    return wanted && strcmp(wanted, call) == 0;
}

/* What the broken call returns, when the signal does not end the process. */
static int break_now(void)
{
    const char *number = getenv("TURNER_BREAK_SIGNAL"), *error = getenv("TURNER_BREAK_ERRNO");
    if (number)
        kill(getpid(), atoi(number));
    errno = error ? atoi(error) : EIO;
    return -1;
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t offset)
{
    char link[64], path[4096];
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t length = readlink(link, path, sizeof path - 1);
    path[length > 0 ? length : 0] = 0;
    if (!breaks("write") || !is_part(path))
        return syscall(SYS_pwrite64, file, bytes, size, offset);
    syscall(SYS_pwrite64, file, bytes, size / 2, offset);
    return break_now();
}

int rename(const char *from, const char *to)
{
    if (!breaks("rename") || !is_part(from))
        return renameat(AT_FDCWD, from, AT_FDCWD, to);
    return break_now();
}
