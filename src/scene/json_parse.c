/* cJSON behind what its users must know about it. */
#include <locale.h>

#include "base/memory.h"
#include "scene/json.h"

/* What cJSON takes for a value: its struct, and what the allocator adds. */
#define BYTES_PER_VALUE (sizeof(cJSON) + 16)
#define SMALL_FILE (16u << 20) /* not worth asking the system about */

enum turner_result json_parse(cJSON **tree, const char *text, size_t length, size_t values,
                              const char *path)
{
    *tree = NULL;
    double needed = (double)length + (double)values * (double)BYTES_PER_VALUE;
    if (length > SMALL_FILE && needed > (double)turner_memory_available())
        return turner_fail(TURNER_DEVICE, "%s: reading it needs %.0f MiB of memory, but only %.0f "
                           "are free; put large meshes into files of their own", path,
                           needed / (1 << 20), (double)turner_memory_available() / (1 << 20));
    /* cJSON reads numbers with strtod, and the program around may have set another locale. */
    locale_t c_locale = newlocale(LC_NUMERIC_MASK, "C", (locale_t)0);
    locale_t old = c_locale ? uselocale(c_locale) : (locale_t)0;
    *tree = cJSON_ParseWithLength(text, length);
    if (c_locale) {
        uselocale(old);
        freelocale(c_locale);
    }
    if (!*tree)
        return turner_fail(TURNER_DEVICE, "%s: no memory left while reading it", path);
    return TURNER_OK;
}
