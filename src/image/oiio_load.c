#include "base/module.h"
#include "image/oiio.h"

const struct turner_oiio *turner_oiio_load(void)
{
#ifdef TURNER_OIIO_MODULE
    static struct turner_module module = {
        TURNER_OIIO_MODULE, "turner_oiio_module",
        "reads pictures and writes all but PNG and EXR", NULL};
    return turner_module_load(&module);
#else
    return turner_oiio_module();
#endif
}
