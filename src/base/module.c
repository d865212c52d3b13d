#include "base/module.h"

#include <dlfcn.h>
#include <pthread.h>
#include <string.h>

#include "base/result.h"

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static const void *load(const struct turner_module *module)
{
    void *library = dlopen(module->file, RTLD_LAZY | RTLD_LOCAL);
    void *symbol = library ? dlsym(library, module->function) : NULL;
    if (!symbol) {
        const char *error = dlerror();
        turner_fail(TURNER_DEVICE, "%s, which %s, cannot be loaded: %s; install turner %s again",
                    module->file, module->does, error ? error : "no reason given", TURNER_VERSION);
        return NULL;
    }
    const void *(*function)(void);
    memcpy(&function, &symbol, sizeof function); /* POSIX's way past ISO C */
    const void *has = function();
    const char *const *version = has;
    if (strcmp(*version, TURNER_VERSION) == 0)
        return has;
    turner_fail(TURNER_DEVICE, "%s, which %s, is of turner %s; install turner %s again",
                module->file, module->does, *version, TURNER_VERSION);
    return NULL;
}

const void *turner_module_load(struct turner_module *module)
{
    pthread_mutex_lock(&lock);
    if (!module->loaded)
        module->loaded = load(module);
    const void *loaded = module->loaded;
    pthread_mutex_unlock(&lock);
    return loaded;
}
