#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/chart.h"
#include "base/hash.h"
#include "base/memory.h"

#define MAX_FILE_BYTES (16u << 20)

enum turner_result turner_chart_path(char path[PATH_MAX], const char *folder, const char *name)
{
    if (snprintf(path, PATH_MAX, "%s/%s", folder, name) >= PATH_MAX)
        return turner_fail(TURNER_USAGE, "%s: the name of the folder is too long", folder);
    return TURNER_OK;
}

enum turner_result turner_chart_make_folder(const char *folder)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path)
        return turner_fail(TURNER_USAGE, "%s: the name of the folder is too long", folder);
    for (char *end = path + 1; *end; end++) {
        if (*end != '/')
            continue;
        *end = 0;
        mkdir(path, 0777); /* where that fails the last one does, too, and says why */
        *end = '/';
    }
    struct stat status;
    if (mkdir(path, 0777) != 0 &&
        (errno != EEXIST || stat(path, &status) != 0 || !S_ISDIR(status.st_mode)))
        return turner_fail(TURNER_OUTPUT, "cannot make the folder %s: %s; choose another", folder,
                           strerror(errno));
    return TURNER_OK;
}

enum turner_result turner_chart_read_file(char **text, size_t *length, const char *path)
{
    *text = NULL;
    *length = 0;
    FILE *file = fopen(path, "rb");
    struct stat status;
    if (!file || fstat(fileno(file), &status) != 0 || S_ISDIR(status.st_mode)) {
        int error = file ? EISDIR : errno;
        if (file)
            fclose(file);
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be opened: %s", path, strerror(error));
    }
    char *bytes = turner_calloc(MAX_FILE_BYTES + 1, 1);
    size_t size = fread(bytes, 1, MAX_FILE_BYTES + 1, file);
    bool failed = ferror(file);
    fclose(file);
    if (failed || size > MAX_FILE_BYTES) {
        free(bytes);
        return turner_fail(TURNER_BAD_INPUT, failed ? "%s: cannot be read"
                                                    : "%s: is larger than 16 MiB", path);
    }
    *text = turner_realloc(bytes, size + 1, 1);
    (*text)[size] = 0;
    *length = size;
    return TURNER_OK;
}

uint64_t turner_chart_picture_hash(const struct turner_image *picture)
{
    uint64_t hash = TURNER_HASH_START;
    size_t count = (size_t)picture->width * (size_t)picture->height;
    for (size_t i = 0; i < count; i++)
        hash = turner_hash_bytes(hash, picture->rgba + 4 * i, 3 * sizeof(float));
    return hash;
}
