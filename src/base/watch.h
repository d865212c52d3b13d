/* Files that are watched for changes: each call looks at them anew (about 2 µs a file). This notices
 * what is saved by renaming, removed and put back, on every file system, in folders that are not
 * there yet; notices of the kernel (inotify) do not come from a network or through some containers,
 * and follow a file's number, not its name. */
#ifndef TURNER_BASE_WATCH_H
#define TURNER_BASE_WATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>
#include <time.h>

struct turner_watched {
    char *path;
    struct stat status; /* of all members only those that say which file and when */
    bool there;         /* there is such a file */
    bool fresh;         /* changed so lately that it could change again with the same time */
    bool dirty;         /* changed since the time given with it */
    uint64_t hash;      /* of what it holds, while it is fresh */
};

struct turner_watch {
    struct turner_watched *files;
    size_t count, capacity;
};

/* The time before something is read that is to be watched. */
struct timespec turner_watch_now(void);

/* Watches a file, be it there or not, or whether a folder is there; what is watched already is not
 * watched twice. A file counts as changed when that happened after `since`, the time before it was read. */
void turner_watch_add(struct turner_watch *watch, const char *path, struct timespec since);

/* Whether a file has changed, come or gone since the last call, or since it was added. */
bool turner_watch_changed(struct turner_watch *watch);

/* From here on what this thread's readers read is watched, found or not: they call
 * turner_watch_note. NULL ends it. `since` as above. */
void turner_watch_reads(struct turner_watch *watch, struct timespec since);
void turner_watch_note(const char *path);

/* Forgets all files, and frees everything. */
void turner_watch_clear(struct turner_watch *watch);

#endif
