#define _GNU_SOURCE /* dladdr */
#include "gpu/shader_object.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "gpu/cache.h"

#define KIND "driver"
#define PARTS 6

/* Which build of the driver it is. Its binaries carry Mesa's version alone, which those who build
 * their own do not always change. */
struct build {
    int64_t size, seconds, nanoseconds; /* of the file that the driver's functions are in */
};

static struct build build_of(const struct turner_gpu *gpu)
{
    Dl_info info;
    struct stat status;
    if (!dladdr((void *)gpu->create_shaders, &info) || stat(info.dli_fname, &status) != 0)
        return (struct build){0};
    return (struct build){status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
}

/* What the driver's form follows from; layouts follow from the SPIR-V. */
static void make_key(struct turner_cache_part key[PARTS], const struct turner_gpu_info *info,
                     const struct build *build, const VkShaderCreateInfoEXT *create)
{
    const VkSpecializationInfo *special = create->pSpecializationInfo;
    key[0] = (struct turner_cache_part){info->name, strlen(info->name)};
    key[1] = (struct turner_cache_part){info->driver, strlen(info->driver)};
    key[2] = (struct turner_cache_part){&create->flags, sizeof create->flags};
    key[3] = (struct turner_cache_part){special->pData, special->dataSize};
    key[4] = (struct turner_cache_part){create->pCode, create->codeSize};
    key[5] = (struct turner_cache_part){build, sizeof *build};
}

/* The driver's form, to be freed, or NULL. */
static void *binary_of(size_t *size, const struct turner_gpu *gpu, VkShaderEXT shader)
{
    if (gpu->get_shader_binary(gpu->device, shader, size, NULL) != VK_SUCCESS)
        return NULL;
    void *binary = turner_calloc(*size, 1);
    if (gpu->get_shader_binary(gpu->device, shader, size, binary) == VK_SUCCESS)
        return binary;
    free(binary);
    return NULL;
}

/* False where the driver does not take it, as one of another version. */
static bool create_from_binary(VkShaderEXT *shader, const struct turner_gpu *gpu,
                               const VkShaderCreateInfoEXT *create, const void *binary, size_t size)
{
    VkShaderCreateInfoEXT from = *create;
    from.codeType = VK_SHADER_CODE_TYPE_BINARY_EXT;
    from.codeSize = size;
    from.pCode = binary;
    return gpu->create_shaders(gpu->device, 1, &from, NULL, shader) == VK_SUCCESS;
}

enum turner_result turner_shader_object_create(VkShaderEXT *shader, struct turner_gpu *gpu,
                                               const VkShaderCreateInfoEXT *create, bool no_cache,
                                               bool *cached)
{
    const struct build build = build_of(gpu);
    struct turner_cache_part key[PARTS];
    void *binary;
    size_t size;
    *cached = false;
    make_key(key, &gpu->info, &build, create);
    if (!no_cache && turner_cache_load(&binary, &size, KIND, key, PARTS)) {
        *cached = create_from_binary(shader, gpu, create, binary, size);
        free(binary);
        if (*cached)
            return TURNER_OK;
    }
    VK_TRY(gpu->create_shaders(gpu->device, 1, create, NULL, shader));
    if (no_cache)
        return TURNER_OK;
    binary = binary_of(&size, gpu, *shader);
    if (binary)
        turner_cache_store(binary, size, KIND, key, PARTS);
    free(binary);
    return TURNER_OK;
}
