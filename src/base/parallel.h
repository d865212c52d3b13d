/* Loops on all cores. */
#ifndef TURNER_BASE_PARALLEL_H
#define TURNER_BASE_PARALLEL_H

#include <stdint.h>

/* Calls run(user, i) once for every i below `count`, in no order, on a thread a core and the
 * caller's own, and returns when all calls have. Where no thread can be made the caller does all.
 * What is computed must not depend on the order. */
void turner_parallel_for(uint32_t count, void (*run)(void *user, uint32_t i), void *user);

/* Threads such a loop takes from now on; 0, as at the start: one a core. */
void turner_parallel_limit(unsigned threads);

/* For loops over `count` things in pieces of `size`: how many pieces, and the ends of one. */
static inline uint32_t turner_pieces(uint32_t count, uint32_t size)
{
    return count / size + (count % size != 0);
}

static inline uint32_t turner_piece_end(uint32_t count, uint32_t size, uint32_t piece)
{
    return count - piece * size < size ? count : (piece + 1) * size;
}

#endif
