#include "gpu/fastest.h"

#include <stdlib.h>
#include <string.h>

#include "gpu/cache.h"

#define KIND "fastest"
#define PARTS 4

/* What a measurement holds for. */
static void make_key(struct turner_cache_part key[PARTS], const struct turner_gpu_info *info)
{
    key[0] = (struct turner_cache_part){info->name, strlen(info->name)};
    key[1] = (struct turner_cache_part){info->driver, strlen(info->driver)};
    key[2] = info->packets ? (struct turner_cache_part){"packets", 7}
                           : (struct turner_cache_part){"lanes", 5};
    key[3] = (struct turner_cache_part){TURNER_SHADER_SOURCES, sizeof TURNER_SHADER_SOURCES - 1};
}

enum turner_traversal turner_fastest_load(const struct turner_gpu_info *info)
{
    struct turner_cache_part key[PARTS];
    enum turner_traversal fastest = TURNER_TRAVERSAL_AUTO;
    void *bytes;
    size_t size;
    make_key(key, info);
    if (!turner_cache_load(&bytes, &size, KIND, key, PARTS))
        return fastest;
    for (int t = TURNER_TRAVERSAL_RAY_QUERY; t <= TURNER_TRAVERSAL_BVH_PACKET; t++) {
        bool can = t == TURNER_TRAVERSAL_BVH_LANE ||
                   (t == TURNER_TRAVERSAL_RAY_QUERY ? info->ray_query : info->packets);
        if (size == 1 && can && *(const char *)bytes == '0' + t)
            fastest = (enum turner_traversal)t;
    }
    free(bytes);
    return fastest;
}

void turner_fastest_store(const struct turner_gpu_info *info, enum turner_traversal fastest)
{
    struct turner_cache_part key[PARTS];
    char digit = (char)('0' + (int)fastest);
    make_key(key, info);
    turner_cache_store(&digit, 1, KIND, key, PARTS);
}
