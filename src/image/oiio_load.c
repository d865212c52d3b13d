#include "image/oiio.h"

#ifdef TURNER_OIIO_MODULE

#include <dlfcn.h>
#include <pthread.h>
#include <stdio.h>
#include <string.h>

static pthread_once_t once = PTHREAD_ONCE_INIT;
static const struct turner_oiio *loaded;
static char reason[512];

/* The folder is in the run path of whatever this file is linked into. It stays loaded: libraries
 * it brings do not bear to be unloaded. */
static void load(void)
{
    void *module = dlopen(TURNER_OIIO_MODULE, RTLD_LAZY | RTLD_LOCAL);
    void *symbol = module ? dlsym(module, "turner_oiio_module") : NULL;
    if (!symbol) {
        const char *error = dlerror();
        snprintf(reason, sizeof reason, "%s", error ? error : "no reason given");
        return;
    }
    const struct turner_oiio *(*function)(void);
    memcpy(&function, &symbol, sizeof function); /* POSIX's way past ISO C */
    const struct turner_oiio *module_has = function();
    if (strcmp(module_has->version, TURNER_VERSION) == 0)
        loaded = module_has;
    else
        snprintf(reason, sizeof reason, "it is of turner %s", module_has->version);
}

const struct turner_oiio *turner_oiio_load(void)
{
    pthread_once(&once, load);
    if (!loaded)
        turner_fail(TURNER_DEVICE,
                    "%s, which reads pictures and writes all but PNG and EXR, cannot be loaded: "
                    "%s; install turner %s again",
                    TURNER_OIIO_MODULE, reason, TURNER_VERSION);
    return loaded;
}

#else

const struct turner_oiio *turner_oiio_load(void)
{
    return turner_oiio_module();
}

#endif
