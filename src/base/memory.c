#include "base/memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include "turner.h"

#define LARGE ((size_t)4 << 20)

void turner_use_large_pages(void *memory, size_t bytes)
{
#ifdef MADV_HUGEPAGE
    uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), begin = (uintptr_t)memory;
    uintptr_t aligned = (begin + page - 1) / page * page;
    if (memory && bytes >= LARGE) /* only a wish: what comes of it does not matter */
        madvise((void *)aligned, bytes - (aligned - begin), MADV_HUGEPAGE);
#else
    (void)memory, (void)bytes;
#endif
}

static void *checked(void *memory, size_t count, size_t size)
{
    if (memory || count == 0 || size == 0)
        return memory;
    fprintf(stderr, "turner: error: out of memory (%zu × %zu bytes); close other programs or "
                    "render a smaller scene\n", count, size);
    exit(TURNER_DEVICE);
}

void *turner_calloc(size_t count, size_t size)
{
    void *memory = checked(calloc(count, size), count, size);
    turner_use_large_pages(memory, count * size);
    return memory;
}

void *turner_realloc(void *memory, size_t count, size_t size)
{
    if (count > SIZE_MAX / (size ? size : 1))
        return checked(NULL, count, size);
    return checked(realloc(memory, count * size), count, size);
}

char *turner_strdup(const char *text)
{
    size_t length = strlen(text) + 1;
    return memcpy(turner_calloc(length, 1), text, length);
}

void *turner_grow(void *items, size_t count, size_t *capacity, size_t size)
{
    if (count < *capacity)
        return items;
    *capacity = *capacity ? *capacity * 2 : 8;
    return turner_realloc(items, *capacity, size);
}

uint64_t turner_memory_available(void)
{
    uint64_t available =
        (uint64_t)sysconf(_SC_AVPHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    FILE *file = fopen("/proc/meminfo", "r"); /* also counts what the file cache would give back */
    if (file) {
        char line[128];
        unsigned long long kilobytes;
        while (fgets(line, sizeof line, file)) {
            if (sscanf(line, "MemAvailable: %llu kB", &kilobytes) == 1)
                available = kilobytes * 1024;
        }
        fclose(file);
    }
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
        limit.rlim_cur < available)
        available = limit.rlim_cur;
    return available;
}
