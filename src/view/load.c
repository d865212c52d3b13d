#include "view/load.h"

#ifdef TURNER_VIEW_MODULE

#include <dlfcn.h>
#include <string.h>

/* The folder is in the run path of whatever this file is linked into. It stays loaded: libraries it
 * brings do not bear to be unloaded. */
const struct turner_window_functions *turner_window_load(void)
{
    void *module = dlopen(TURNER_VIEW_MODULE, RTLD_LAZY | RTLD_LOCAL);
    void *symbol = module ? dlsym(module, "turner_window_module") : NULL;
    if (!symbol) {
        const char *error = dlerror();
        turner_fail(TURNER_DEVICE, "%s, which opens windows, cannot be loaded: %s; install turner "
                                   "%s again, or draw with turner render", TURNER_VIEW_MODULE,
                    error ? error : "no reason given", TURNER_VERSION);
        return NULL;
    }
    const struct turner_window_functions *(*function)(void);
    memcpy(&function, &symbol, sizeof function); /* POSIX's way past ISO C */
    const struct turner_window_functions *window = function();
    if (strcmp(window->version, TURNER_VERSION) == 0)
        return window;
    turner_fail(TURNER_DEVICE, "%s is of turner %s; install turner %s again", TURNER_VIEW_MODULE,
                window->version, TURNER_VERSION);
    return NULL;
}

#else

const struct turner_window_functions *turner_window_load(void)
{
    return turner_window_module();
}

#endif
