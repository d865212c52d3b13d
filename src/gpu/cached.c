#include "gpu/cached.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/cache.h"

/* What makes the things that are kept: they are good as long as it is the same.
 * TURNER_COMPILER_SOURCES is a hash of turner's part of it. */
static struct turner_cache_part maker(char text[512])
{
    char libraries[256];
    turner_compiler_libraries(libraries);
    snprintf(text, 512, "%s %s", TURNER_COMPILER_SOURCES, libraries);
    return (struct turner_cache_part){text, strlen(text) + 1};
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
    bool cached = load(out, "spirv", key, count);
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
                                              const struct turner_constant *constants, size_t count)
{
    char made_by[512];
    const struct turner_cache_part key[] = {
        maker(made_by),
        {constants, count * sizeof *constants},
        {spirv->words, spirv->count * sizeof *spirv->words},
    };
    const size_t parts = sizeof key / sizeof *key;
    bool cached = load(out, "reduced", key, parts);
    if (found)
        *found = cached;
    if (cached)
        return TURNER_OK;
    TURNER_TRY(turner_spirv_reduce(out, spirv, constants, count));
    store(out, "reduced", key, parts);
    return TURNER_OK;
}
