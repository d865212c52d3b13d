#include "base/watch.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"

/* Times of files come in steps: of a few milliseconds on most, two seconds on the coarsest. */
#define FRESH_SECONDS 0.1
#define HASHED_BYTES (1 << 20) /* at most: no hand changes more than that twice in a step */

static double seconds_between(struct timespec from, struct timespec to)
{
    return (double)(to.tv_sec - from.tv_sec) + 1e-9 * (double)(to.tv_nsec - from.tv_nsec);
}

struct timespec turner_watch_now(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return now;
}

static struct timespec later(struct timespec a, struct timespec b)
{
    return seconds_between(a, b) > 0 ? b : a;
}

static uint64_t hash_of(const char *path)
{
    uint64_t hash = TURNER_HASH_START;
    char bytes[4096];
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return 0;
    ssize_t got;
    for (int all = 0; all < HASHED_BYTES && (got = read(file, bytes, sizeof bytes)) > 0;
         all += (int)got)
        hash = turner_hash_bytes(hash, bytes, (size_t)got);
    close(file);
    return hash;
}

static struct turner_watched look_at(const char *path)
{
    struct turner_watched now = {0};
    now.there = stat(path, &now.status) == 0;
    if (now.there && S_ISDIR(now.status.st_mode))
        memset(&now.status, 0, sizeof now.status); /* it changes with each file in it */
    if (!now.there || !now.status.st_ino)
        return now;
    struct timespec changed = later(now.status.st_mtim, now.status.st_ctim);
    now.fresh = seconds_between(changed, turner_watch_now()) < FRESH_SECONDS;
    if (now.fresh)
        now.hash = hash_of(path);
    return now;
}

static bool same_time(struct timespec a, struct timespec b)
{
    return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec;
}

static bool same_file(const struct stat *a, const struct stat *b)
{
    return a->st_dev == b->st_dev && a->st_ino == b->st_ino && a->st_size == b->st_size &&
           same_time(a->st_mtim, b->st_mtim) && same_time(a->st_ctim, b->st_ctim);
}

void turner_watch_add(struct turner_watch *watch, const char *path, struct timespec since)
{
    for (size_t i = 0; i < watch->count; i++) {
        if (strcmp(watch->files[i].path, path) == 0)
            return;
    }
    struct turner_watched file = look_at(path);
    struct timespec changed = later(file.status.st_mtim, file.status.st_ctim);
    file.path = turner_strdup(path);
    /* the time of a file is that of the kernel's last tick, a little behind the clock's */
    file.dirty = file.there && file.status.st_ino && seconds_between(since, changed) > -0.02;
    *TURNER_PUSH(watch->files, watch->count, watch->capacity) = file;
}

static bool has_changed(struct turner_watched *file)
{
    bool was_fresh = file->fresh;
    struct turner_watched now = look_at(file->path);
    bool changed = file->dirty || now.there != file->there ||
                   (now.there && !same_file(&now.status, &file->status));
    if (!changed && was_fresh) { /* the same time: only what it holds can tell */
        if (!now.fresh)
            now.hash = hash_of(file->path);
        changed = now.hash != file->hash;
    }
    now.path = file->path;
    *file = now;
    return changed;
}

bool turner_watch_changed(struct turner_watch *watch)
{
    bool any = false;
    for (size_t i = 0; i < watch->count; i++) /* all of them: each remembers what it saw */
        any |= has_changed(&watch->files[i]);
    return any;
}

static _Thread_local struct turner_watch *noting;
static _Thread_local struct timespec noting_since;

void turner_watch_reads(struct turner_watch *watch, struct timespec since)
{
    noting = watch;
    noting_since = since;
}

void turner_watch_note(const char *path)
{
    if (noting)
        turner_watch_add(noting, path, noting_since);
}

void turner_watch_clear(struct turner_watch *watch)
{
    for (size_t i = 0; i < watch->count; i++)
        free(watch->files[i].path);
    free(watch->files);
    *watch = (struct turner_watch){0};
}
