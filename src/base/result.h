/* Results, the message that goes with a failure, and warnings. */
#ifndef TURNER_BASE_RESULT_H
#define TURNER_BASE_RESULT_H

#include "turner.h"

#if defined(__GNUC__)
#define TURNER_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define TURNER_PRINTF(text, first)
#endif

/* Sets this thread's message (turner_message) and returns `result`, so that a failing function
 * reads `return turner_fail(TURNER_BAD_INPUT, "%s:%d: …", …)`. The message is one sentence that
 * says what is wrong, where, and what to do. Not thread-shared. */
enum turner_result turner_fail(enum turner_result result, const char *format, ...)
    TURNER_PRINTF(2, 3);

/* Puts "prefix: " (formatted) before this thread's message; returns `result`. */
enum turner_result turner_fail_within(enum turner_result result, const char *format, ...)
    TURNER_PRINTF(2, 3);

/* One line to stderr, "turner: warning: …". Thread-safe. Silent after turner_set_quiet(true). */
void turner_warn(const char *format, ...) TURNER_PRINTF(1, 2);

/* Returns from the caller with the result of `call` unless it is TURNER_OK. */
#define TURNER_TRY(call)                                                                           \
    do {                                                                                           \
        enum turner_result turner_try_result = (call);                                             \
        if (turner_try_result != TURNER_OK)                                                        \
            return turner_try_result;                                                              \
    } while (0)

/* The same for functions with one cleanup tail: sets `result` and goes to `done`. */
#define TURNER_TRY_DONE(call)                                                                      \
    do {                                                                                           \
        result = (call);                                                                           \
        if (result != TURNER_OK)                                                                   \
            goto done;                                                                             \
    } while (0)

#endif
