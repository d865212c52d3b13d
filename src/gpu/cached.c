#include "gpu/cached.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/memory.h"
#include "gpu/cache.h"
#include "gpu/prebuilt.h"

/* What makes the things that are kept: they are good as long as it is the same.
 * TURNER_COMPILER_SOURCES is a hash of turner's part of it. */
static struct turner_cache_part maker(char text[512])
{
    char libraries[256];
    turner_compiler_libraries(libraries);
    snprintf(text, 512, "%s %s", TURNER_COMPILER_SOURCES, libraries);
    return (struct turner_cache_part){text, strlen(text) + 1};
}

uint64_t turner_compile_key(const struct turner_shader_source *source, const char *const *defines,
                            size_t define_count)
{
    char made_by[512];
    struct turner_cache_part by = maker(made_by);
    uint64_t key = turner_hash_bytes(TURNER_HASH_START, by.bytes, by.size);
    for (size_t i = 0; i < define_count; i++)
        key = turner_hash_text(key, defines[i]);
    return turner_hash_bytes(key, source->text, source->length);
}

/* What was compiled when turner was built. */
static bool load_prebuilt(struct turner_spirv *out, uint64_t key)
{
    if (!&turner_prebuilt || turner_prebuilt.key != key)
        return false;
    const size_t size = turner_prebuilt.count * sizeof *out->words;
    *out = (struct turner_spirv){turner_calloc(size, 1), turner_prebuilt.count};
    memcpy(out->words, turner_prebuilt.words, size);
    return true;
}

static bool load(struct turner_spirv *out, const char *kind, const struct turner_cache_part *key,
                 size_t count)
{
    void *words;
    size_t size;
    if (!turner_cache_load(&words, &size, kind, key, count))
        return false;
    *out = (struct turner_spirv){words, size / sizeof *out->words};
    return true;
}

static void store(const struct turner_spirv *spirv, const char *kind,
                  const struct turner_cache_part *key, size_t count)
{
    turner_cache_store(spirv->words, spirv->count * sizeof *spirv->words, kind, key, count);
}

enum turner_result turner_compile_cached(struct turner_spirv *out, bool *found,
                                         const struct turner_shader_source *source,
                                         const char *const *defines, size_t define_count)
{
    char made_by[512];
    size_t count = 0;
    struct turner_cache_part *key = turner_calloc(define_count + 2, sizeof *key);
    key[count++] = maker(made_by);
    for (size_t i = 0; i < define_count; i++)
        key[count++] = (struct turner_cache_part){defines[i], strlen(defines[i]) + 1};
    key[count++] = (struct turner_cache_part){source->text, source->length};
    enum turner_result result = TURNER_OK;
    bool cached = load_prebuilt(out, turner_compile_key(source, defines, define_count)) ||
                  load(out, "spirv", key, count);
    if (found)
        *found = cached;
    if (cached) {
        if (turner_spirv_wants_validation())
            result = turner_spirv_validate(out);
    } else {
        result = turner_compile(out, source, defines, define_count);
        if (result == TURNER_OK)
            store(out, "spirv", key, count);
    }
    free(key);
    return result;
}

enum turner_result turner_spirv_reduce_cached(struct turner_spirv *out, bool *found,
                                              const struct turner_spirv *spirv,
                                              const struct turner_constant *constants,
                                              size_t count, bool soon)
{
    char made_by[512];
    const struct turner_cache_part key[] = {
        maker(made_by),
        {&soon, sizeof soon},
        {constants, count * sizeof *constants},
        {spirv->words, spirv->count * sizeof *spirv->words},
    };
    const size_t parts = sizeof key / sizeof *key;
    bool cached = load(out, "reduced", key, parts);
    if (found)
        *found = cached;
    if (cached)
        return TURNER_OK;
    TURNER_TRY(turner_spirv_reduce(out, spirv, constants, count, soon));
    store(out, "reduced", key, parts);
    return TURNER_OK;
}
