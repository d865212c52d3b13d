/* Memory that is checked once, here, and growable arrays. */
#ifndef TURNER_BASE_MEMORY_H
#define TURNER_BASE_MEMORY_H

#include <stddef.h>
#include <stdint.h>

/* Like calloc, realloc and strdup, but end the program with a message and TURNER_DEVICE when the
 * system has no memory left: sizes that come from input are checked against limits before. */
void *turner_calloc(size_t count, size_t size);
void *turner_realloc(void *memory, size_t count, size_t size);
char *turner_strdup(const char *text);

/* Asks for large pages where an array is large: fewer faults when it is filled, and when it is read
 * at random. turner_calloc does. Before the array is touched. */
void turner_use_large_pages(void *memory, size_t bytes);

/* Makes room for one more element in an array that is described by (items, count, capacity).
 * Usage: *TURNER_PUSH(scene->spheres, scene->sphere_count, scene->sphere_capacity) = sphere; */
void *turner_grow(void *items, size_t count, size_t *capacity, size_t size);
#define TURNER_PUSH(items, count, capacity)                                                        \
    ((items) = turner_grow((items), (count), &(capacity), sizeof *(items)), &(items)[(count)++])

/* Bytes of physical memory this process may still take (available memory, or the limit of the
 * process if that is less). */
uint64_t turner_memory_available(void);

#endif
