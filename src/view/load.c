#include "view/load.h"

#include "base/module.h"

const struct turner_window_functions *turner_window_load(void)
{
#ifdef TURNER_WINDOW_MODULE
    static struct turner_module module = {TURNER_WINDOW_MODULE, "turner_window_module",
                                          "opens windows", NULL};
    return turner_module_load(&module);
#else
    return turner_window_module();
#endif
}
