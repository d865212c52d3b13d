/* Files of transforms: 3 rows of 4 little-endian 32-bit floats each, and nothing else. */
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "scene/readers.h"

#define NUMBERS 12
#define BYTES (4 * NUMBERS)
#define AT_ONCE 4096

static double number_at(const unsigned char *bytes)
{
    uint32_t bits =
        bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
    float number;
    memcpy(&number, &bits, sizeof number);
    return (double)number;
}

static enum turner_result read_all(struct turner_instance *instances, size_t count, FILE *file,
                                   const struct turner_instance *like, const char *path)
{
    static const char hint[] = "it must hold 12 little-endian 32-bit floats for each instance, 3 "
                               "rows of 4";
    unsigned char bytes[AT_ONCE][BYTES];
    for (size_t done = 0; done < count;) {
        size_t wanted = count - done < AT_ONCE ? count - done : AT_ONCE;
        if (fread(bytes, BYTES, wanted, file) != wanted)
            return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read: %s", path,
                               ferror(file) ? strerror(errno) : "it became shorter meanwhile");
        for (size_t i = 0; i < wanted; i++, done++) {
            struct turner_affine *transform = &instances[done].transform;
            instances[done] = *like;
            for (int k = 0; k < NUMBERS; k++)
                transform->m[k / 4][k % 4] = number_at(bytes[i] + 4 * k);
            if (!turner_affine_usable(transform))
                return turner_fail(TURNER_BAD_INPUT,
                                   "%s: transform %zu (counted from 0) flattens "
                                   "space or is not finite; %s",
                                   path, done, hint);
        }
    }
    return TURNER_OK;
}

enum turner_result turner_scene_add_instances(struct turner_scene *scene,
                                              const struct turner_instance *like, const char *path)
{
    struct stat status;
    if (stat(path, &status) != 0)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot open the transforms: %s", path,
                           strerror(errno));
    if (!S_ISREG(status.st_mode))
        return turner_fail(TURNER_BAD_INPUT, "%s: not a file", path);
    if (status.st_size == 0 || status.st_size % BYTES != 0)
        return turner_fail(TURNER_BAD_INPUT,
                           "%s: %lld bytes are no whole number of transforms, "
                           "which have %d each (3 rows of 4 32-bit floats)",
                           path, (long long)status.st_size, BYTES);
    uint64_t count = (uint64_t)status.st_size / BYTES;
    if (count > TURNER_MAX_INSTANCES - scene->instance_count)
        return turner_fail(TURNER_BAD_INPUT,
                           "%s: with its transforms there are %llu instances, "
                           "and %u are the limit",
                           path, (unsigned long long)(scene->instance_count + count),
                           TURNER_MAX_INSTANCES);
    FILE *file = fopen(path, "rb");
    if (!file)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot open the transforms: %s", path,
                           strerror(errno));
    scene->instance_capacity = scene->instance_count + count;
    scene->instances =
        turner_realloc(scene->instances, scene->instance_capacity, sizeof *scene->instances);
    enum turner_result result =
        read_all(scene->instances + scene->instance_count, count, file, like, path);
    if (result == TURNER_OK)
        scene->instance_count += count;
    fclose(file);
    return result;
}
