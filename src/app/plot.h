/* Pictures of measurements, drawn by Python's matplotlib. */
#ifndef TURNER_APP_PLOT_H
#define TURNER_APP_PLOT_H

#include <stddef.h>

#include "base/result.h"

/* Runs src/app/plots/<script>.py, which is carried in the program, with those arguments. Not while
 * a device is open. When there is no python3 with matplotlib, warns that the pictures are missing
 * and what to install, and returns TURNER_OK: the numbers are what counts. TURNER_OUTPUT when the
 * script fails. */
enum turner_result turner_plot(const char *script, const char *const *arguments, size_t count);

#endif
