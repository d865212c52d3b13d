/* A hash for names of cached files and for telling whether bytes are still what they were: FNV-1a,
 * 64 bits (Fowler, Noll, Vo). It does not withstand somebody who wants two things to agree. */
#ifndef TURNER_BASE_HASH_H
#define TURNER_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define TURNER_HASH_START 0xcbf29ce484222325u

/* `hash`, continued over the bytes. */
uint64_t turner_hash_bytes(uint64_t hash, const void *bytes, size_t size);

/* A text with the zero that ends it; NULL is not the same as "". */
uint64_t turner_hash_text(uint64_t hash, const char *text);

#endif
