#include "base/hash.h"

#include <string.h>

uint64_t turner_hash_bytes(uint64_t hash, const void *bytes, size_t size)
{
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ byte[i]) * 0x100000001b3u;
    return hash;
}

uint64_t turner_hash_text(uint64_t hash, const char *text)
{
    return text ? turner_hash_bytes(hash, text, strlen(text) + 1) : turner_hash_bytes(hash, "\1", 1);
}
