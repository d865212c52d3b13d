/* Decimal numbers out of a text, whatever the locale. */
#ifndef TURNER_BASE_NUMBER_H
#define TURNER_BASE_NUMBER_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#define TURNER_NUMBER_LENGTH 255

/* Reads the decimal number that `text` begins with, as in "-1.5e3", correctly rounded; it need not
 * end in NUL. Returns how many characters it has, 0 when there is none, or when there are more
 * than TURNER_NUMBER_LENGTH. What is too large for a double is infinite, what is too small is 0. */
size_t turner_number_read(double *value, const char *text, size_t length);

#ifdef __cplusplus
}
#endif
#endif
