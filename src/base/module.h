/* Modules: parts of turner whose libraries take longer to load than most pictures take to draw. They
 * are loaded when something needs them, and call nothing of turner's. Static builds have them linked
 * in. */
#ifndef TURNER_BASE_MODULE_H
#define TURNER_BASE_MODULE_H

struct turner_module {
    const char *file;     /* its name, in a folder of the run path of what this is linked into */
    const char *function; /* its only one; the struct it returns begins with turner's version */
    const char *does;     /* for messages: "which … cannot be loaded" */
    const void *loaded;   /* NULL at first */
};

/* What the function returns, loaded first if need be; NULL with turner_message (TURNER_DEVICE) when
 * it cannot be. Thread-safe. It stays loaded: libraries that modules bring do not bear to be
 * unloaded. */
const void *turner_module_load(struct turner_module *module);

#endif
