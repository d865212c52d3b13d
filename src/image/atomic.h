/* Files that appear whole or not at all. Also for what goes with pictures: statistics, reports. */
#ifndef TURNER_IMAGE_ATOMIC_H
#define TURNER_IMAGE_ATOMIC_H

#include "base/result.h"

/* Writes `size` bytes to "<path>.<pid>.part" (path with links followed), then renames it. May be
 * called from several threads; turner_image_abandon removes the file aside. TURNER_OUTPUT with the
 * reason and what to do. */
enum turner_result turner_atomic_write(const char *path, const void *bytes, size_t size);

/* Whether turner_atomic_write could create its file. TURNER_OUTPUT. */
enum turner_result turner_atomic_check(const char *path);

#endif
