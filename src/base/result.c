#include "base/result.h"

#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

static _Thread_local char message[2048];
static atomic_bool quiet;

const char *turner_version(void)
{
    return TURNER_VERSION;
}

const char *turner_message(void)
{
    return message;
}

void turner_set_quiet(bool value)
{
    atomic_store(&quiet, value);
}

enum turner_result turner_fail(enum turner_result result, const char *format, ...)
{
    /* aside first: an argument may be the old message */
    char text[sizeof message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    memcpy(message, text, sizeof message);
    return result;
}

enum turner_result turner_fail_within(enum turner_result result, const char *format, ...)
{
    char prefix[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(prefix, sizeof prefix, format, arguments);
    va_end(arguments);
    return turner_fail(result, "%s: %s", prefix, message);
}

void turner_warn(const char *format, ...)
{
    if (atomic_load(&quiet))
        return;
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    fprintf(stderr, "turner: warning: %s\n", text); /* one call, so that lines stay whole */
}
