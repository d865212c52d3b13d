#ifndef TURNER_VIEW_LOAD_H
#define TURNER_VIEW_LOAD_H

#include "base/result.h"
#include "view/window.h"

/* The window's module, loaded first if need be; NULL with turner_message (TURNER_DEVICE) when it
 * cannot be. */
const struct turner_window_functions *turner_window_load(void);

#endif
