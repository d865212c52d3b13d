/* Files kept from one run to the next: what takes time to make and follows wholly from its key.
 *
 * A cache can be deleted, truncated, full, foreign or read-only at any time: then it has nothing
 * and keeps nothing, without a word. An entry holds its whole key, so none is ever taken for
 * another, and a checksum of its content. It is written aside and renamed: several processes may
 * share a folder. The oldest entries go when all of them together are more than TURNER_CACHE_BYTES.
 */
#ifndef TURNER_GPU_CACHE_H
#define TURNER_GPU_CACHE_H

#include <limits.h>
#include <stdbool.h>
#include <stddef.h>

#define TURNER_CACHE_BYTES (64u << 20)

/* Where turner keeps things: $TURNER_CACHE_DIR, else turner/ in $XDG_CACHE_HOME or ~/.cache. False
 * when that is nowhere: TURNER_CACHE_DIR is empty, or there is no home. */
bool turner_cache_folder(char folder[PATH_MAX]);

/* A piece of a key; NULL where its size is 0. */
struct turner_cache_part {
    const void *bytes;
    size_t size;
};

/* What was stored under the key, `count` parts that are taken as one, in order; the caller frees
 * *bytes. False when there is nothing of any use. `kind` is a word, part of the key. Thread-safe.
 */
bool turner_cache_load(void **bytes, size_t *size, const char *kind,
                       const struct turner_cache_part *key, size_t count);

/* Keeps it, if that can be. Thread-safe; leaves turner_message as it was. */
void turner_cache_store(const void *bytes, size_t size, const char *kind,
                        const struct turner_cache_part *key, size_t count);

#endif
