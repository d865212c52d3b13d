#include "image/atomic.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/image.h"

/* The file aside that exists now. One at a time: the lock is held while `pending` is set, and the
 * name changes only while it is not, so a signal handler finds a whole name or none. */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static char part[PATH_MAX];
static atomic_bool pending;

void turner_image_abandon(void)
{
    if (pending)
        unlink(part);
}

static const char *advice(int error)
{
    switch (error) {
    case ENOSPC:
    case EDQUOT:
        return "free some space or write to another disk";
    case ENOENT:
    case ENOTDIR:
        return "create the folder first or choose another";
    case EACCES:
    case EPERM:
    case EROFS:
        return "choose a folder that you may write to";
    case EFBIG:
        return "raise the limit on file sizes (ulimit -f)";
    case ENAMETOOLONG:
        return "choose a shorter name";
    default:
        return "choose another folder";
    }
}

static enum turner_result cannot(const char *path, int error)
{
    return turner_fail(TURNER_OUTPUT, "cannot write %s: %s; %s", path, strerror(error),
                       advice(error));
}

/* Where the file really is to appear (a link is followed, not replaced) into `target`, and its
 * name aside into `part`. */
static enum turner_result aim(char target[PATH_MAX], const char *path)
{
    struct stat status;
    if (stat(path, &status) == 0) {
        if (!S_ISREG(status.st_mode)) {
            return turner_fail(TURNER_OUTPUT, "cannot write %s: it is %s; name a file", path,
                               S_ISDIR(status.st_mode) ? "a folder" : "not an ordinary file");
        }
        if (access(path, W_OK) != 0)
            return cannot(path, errno);
        if (!realpath(path, target))
            return cannot(path, errno);
    } else if (snprintf(target, PATH_MAX, "%s", path) >= PATH_MAX) {
        return cannot(path, ENAMETOOLONG);
    }
    if (snprintf(part, sizeof part, "%s.%ld.part", target, (long)getpid()) >= (int)sizeof part)
        return cannot(path, ENAMETOOLONG);
    return TURNER_OK;
}

static int open_part(void)
{
    /* pending first: a signal between the two finds nothing to unlink, which does no harm */
    pending = true;
    return open(part, O_WRONLY | O_CREAT | O_TRUNC | O_NOFOLLOW | O_CLOEXEC, 0666);
}

enum turner_result turner_atomic_begin(struct turner_atomic *atomic, const char *path)
{
    *atomic = (struct turner_atomic){.path = path, .file = -1};
    pthread_mutex_lock(&lock);
    enum turner_result result = aim(atomic->target, path);
    if (result == TURNER_OK) {
        atomic->file = open_part();
        if (atomic->file < 0)
            result = cannot(path, errno);
    }
    if (result != TURNER_OK) {
        pending = false;
        pthread_mutex_unlock(&lock);
    }
    return result;
}

bool turner_atomic_put(struct turner_atomic *atomic, const void *bytes, size_t size,
                       uint64_t offset)
{
    const char *from = bytes;
    while (size && !atomic->error) {
        ssize_t written = pwrite(atomic->file, from, size, (off_t)offset);
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0) {
            atomic->error = written < 0 ? errno : ENOSPC;
            break;
        }
        from += written;
        offset += (uint64_t)written;
        size -= (size_t)written;
    }
    return !atomic->error;
}

enum turner_result turner_atomic_end(struct turner_atomic *atomic, enum turner_result result)
{
    int error = atomic->error;
    if (close(atomic->file) != 0 && !error)
        error = errno;
    bool keep = !error && result == TURNER_OK;
    if (keep && rename(part, atomic->target) != 0)
        error = errno;
    if (error || !keep)
        unlink(part);
    pending = false;
    pthread_mutex_unlock(&lock);
    return error ? cannot(atomic->path, error) : result;
}

enum turner_result turner_atomic_write(const char *path, const void *bytes, size_t size)
{
    struct turner_atomic atomic;
    TURNER_TRY(turner_atomic_begin(&atomic, path));
    turner_atomic_put(&atomic, bytes, size, 0);
    return turner_atomic_end(&atomic, TURNER_OK);
}

enum turner_result turner_atomic_check(const char *path)
{
    char target[PATH_MAX];
    pthread_mutex_lock(&lock);
    enum turner_result result = aim(target, path);
    if (result == TURNER_OK) {
        int file = open_part();
        if (file < 0) {
            result = cannot(path, errno);
        } else {
            close(file);
            unlink(part);
        }
        pending = false;
    }
    pthread_mutex_unlock(&lock);
    return result;
}
