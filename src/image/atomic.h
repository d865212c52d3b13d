/* Files that appear whole or not at all. Also for what goes with pictures: statistics, reports. */
#ifndef TURNER_IMAGE_ATOMIC_H
#define TURNER_IMAGE_ATOMIC_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/result.h"

/* A file that is being written aside, as "<path>.<pid>.part" (path with links followed). There is
 * one at a time: begin waits for another thread's to end. turner_image_abandon removes it. */
struct turner_atomic {
    const char *path;
    char target[PATH_MAX];
    int file, error;
};

/* To be followed by turner_atomic_end when it succeeds. TURNER_OUTPUT with the reason and what to
 * do, here and below. */
enum turner_result turner_atomic_begin(struct turner_atomic *atomic, const char *path);

/* False when it could not be written; turner_atomic_end says why. */
bool turner_atomic_put(struct turner_atomic *atomic, const void *bytes, size_t size,
                       uint64_t offset);

/* Gives the file its name if `result`, which what wrote it returned, is TURNER_OK, or else removes
 * it. Returns `result`, or TURNER_OUTPUT when the system refused something. */
enum turner_result turner_atomic_end(struct turner_atomic *atomic, enum turner_result result);

/* All three with `size` bytes. May be called from several threads. */
enum turner_result turner_atomic_write(const char *path, const void *bytes, size_t size);

/* Whether turner_atomic_write could create its file. TURNER_OUTPUT. */
enum turner_result turner_atomic_check(const char *path);

#endif
