#include "gpu/cache.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/hash.h"
#include "base/memory.h"
#include "base/result.h"
#include "image/atomic.h"

#define ENTRY_BYTES (16u << 20) /* at most, of one entry: more is no shader */
#define DAY (24 * 60 * 60)

/* Ahead of key and content. What was written with another order of bytes has another magic. */
struct header {
    uint64_t magic, key_size, size;
    uint64_t checksum; /* of key and content */
};
#define MAGIC 0x3130656863616374u /* "tcache01", read as a little-endian number */

bool turner_cache_folder(char folder[PATH_MAX])
{
    const char *own = getenv("TURNER_CACHE_DIR"), *cache = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    int length = 0;
    if (own)
        length = snprintf(folder, PATH_MAX, "%s", own);
    else if (cache && *cache == '/') /* the XDG Base Directory Specification wants it absolute */
        length = snprintf(folder, PATH_MAX, "%s/turner", cache);
    else if (home && *home == '/')
        length = snprintf(folder, PATH_MAX, "%s/.cache/turner", home);
    return length > 0 && length < PATH_MAX;
}

static bool entries_folder(char folder[PATH_MAX])
{
    char base[PATH_MAX];
    return turner_cache_folder(base) && snprintf(folder, PATH_MAX, "%s/shaders", base) < PATH_MAX;
}

static uint64_t hash_parts(uint64_t hash, const struct turner_cache_part *key, size_t count)
{
    for (size_t i = 0; i < count; i++)
        hash = turner_hash_bytes(hash, key[i].bytes, key[i].size);
    return hash;
}

static size_t size_of_parts(const struct turner_cache_part *key, size_t count)
{
    size_t size = 0;
    for (size_t i = 0; i < count; i++)
        size += key[i].size;
    return size;
}

static bool entry_path(char path[PATH_MAX], const char *folder, const char *kind,
                       const struct turner_cache_part *key, size_t count)
{
    unsigned long long name = hash_parts(TURNER_HASH_START, key, count);
    return snprintf(path, PATH_MAX, "%s/%s-%016llx", folder, kind, name) < PATH_MAX;
}

/* Whether the file is an entry for the key, whole and unchanged. */
static bool is_entry(const uint8_t *file, size_t file_size, const struct turner_cache_part *key,
                     size_t count)
{
    struct header header;
    if (file_size < sizeof header)
        return false;
    memcpy(&header, file, sizeof header);
    size_t rest = file_size - sizeof header;
    if (header.magic != MAGIC || header.key_size != size_of_parts(key, count) ||
        header.key_size > rest || header.size != rest - header.key_size)
        return false;
    const uint8_t *at = file + sizeof header;
    if (turner_hash_bytes(TURNER_HASH_START, at, rest) != header.checksum)
        return false;
    for (size_t i = 0; i < count; i++) {
        if (key[i].size && memcmp(at, key[i].bytes, key[i].size) != 0)
            return false;
        at += key[i].size;
    }
    return true;
}

/* So that what is used stays: the oldest go first. Once a day is enough. */
static void mark_used(int file, const struct stat *status)
{
    if (time(NULL) - status->st_mtime > DAY)
        futimens(file, NULL);
}

/* The whole file, or NULL. One that somebody else made is not trusted. */
static uint8_t *read_file(size_t *size, const char *path)
{
    struct stat status;
    int file = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); /* a pipe is not waited for */
    if (file < 0)
        return NULL;
    uint8_t *bytes = NULL;
    size_t done = 0;
    if (fstat(file, &status) == 0 && S_ISREG(status.st_mode) && status.st_uid == geteuid() &&
        status.st_size > 0 && status.st_size <= (off_t)ENTRY_BYTES) {
        bytes = turner_calloc((size_t)status.st_size, 1);
        ssize_t got;
        while ((got = read(file, bytes + done, (size_t)status.st_size - done)) > 0)
            done += (size_t)got;
        mark_used(file, &status);
    }
    close(file);
    *size = done;
    return bytes;
}

bool turner_cache_load(void **bytes, size_t *size, const char *kind,
                       const struct turner_cache_part *key, size_t count)
{
    char folder[PATH_MAX], path[PATH_MAX];
    if (!entries_folder(folder) || !entry_path(path, folder, kind, key, count))
        return false;
    size_t file_size;
    uint8_t *file = read_file(&file_size, path);
    if (!file)
        return false;
    bool found = is_entry(file, file_size, key, count);
    if (found) {
        size_t before = sizeof(struct header) + size_of_parts(key, count);
        *size = file_size - before;
        *bytes = turner_calloc(*size, 1);
        memcpy(*bytes, file + before, *size);
    }
    free(file);
    return found;
}

/* As mkdir -p; where that fails, writing fails, too. */
static void make_folders(char *folder)
{
    for (char *end = folder + 1; *end; end++) {
        if (*end != '/')
            continue;
        *end = 0;
        mkdir(folder, 0777);
        *end = '/';
    }
    mkdir(folder, 0777);
}

struct file {
    char name[NAME_MAX + 1];
    struct timespec used;
    uint64_t size;
};

static int older_first(const void *a, const void *b)
{
    const struct timespec *x = &((const struct file *)a)->used,
                          *y = &((const struct file *)b)->used;
    if (x->tv_sec != y->tv_sec)
        return x->tv_sec < y->tv_sec ? -1 : 1;
    return (x->tv_nsec > y->tv_nsec) - (x->tv_nsec < y->tv_nsec);
}

/* Everything in the folder, what killed processes left aside too. */
static struct file *list_files(DIR *folder, size_t *count, uint64_t *total)
{
    struct file *files = NULL;
    size_t capacity = 0;
    *count = 0;
    *total = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        struct stat status;
        if (fstatat(dirfd(folder), entry->d_name, &status, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(status.st_mode))
            continue;
        struct file *file = TURNER_PUSH(files, *count, capacity);
        *file = (struct file){.used = status.st_mtim, .size = (uint64_t)status.st_size};
        snprintf(file->name, sizeof file->name, "%s", entry->d_name);
        *total += file->size;
    }
    return files;
}

/* Down to three quarters of the bound, so that it is not done at every store. */
static void remove_oldest(const char *path)
{
    DIR *folder = opendir(path);
    if (!folder)
        return;
    size_t count;
    uint64_t total;
    struct file *files = list_files(folder, &count, &total);
    if (total > TURNER_CACHE_BYTES) {
        qsort(files, count, sizeof *files, older_first);
        for (size_t i = 0; i < count && total > TURNER_CACHE_BYTES / 4 * 3; i++) {
            if (unlinkat(dirfd(folder), files[i].name, 0) == 0)
                total -= files[i].size;
        }
    }
    free(files);
    closedir(folder);
}

void turner_cache_store(const void *bytes, size_t size, const char *kind,
                        const struct turner_cache_part *key, size_t count)
{
    char folder[PATH_MAX], path[PATH_MAX], *message = turner_strdup(turner_message());
    size_t key_size = size_of_parts(key, count), total = sizeof(struct header) + key_size + size;
    if (total <= ENTRY_BYTES && entries_folder(folder) &&
        entry_path(path, folder, kind, key, count)) {
        uint8_t *file = turner_calloc(total, 1), *at = file + sizeof(struct header);
        for (size_t i = 0; i < count; i++) {
            if (key[i].size)
                memcpy(at, key[i].bytes, key[i].size);
            at += key[i].size;
        }
        memcpy(at, bytes, size);
        struct header header = {.magic = MAGIC, .key_size = key_size, .size = size};
        header.checksum =
            turner_hash_bytes(TURNER_HASH_START, file + sizeof header, total - sizeof header);
        memcpy(file, &header, sizeof header);
        make_folders(folder);
        if (turner_atomic_write(path, file, total) == TURNER_OK)
            remove_oldest(folder);
        free(file);
    }
    turner_fail(TURNER_OK, "%s", message);
    free(message);
}
