/* Files that the program carries in itself (cmake/EmbedFiles.cmake). */
#ifndef TURNER_BASE_EMBEDDED_H
#define TURNER_BASE_EMBEDDED_H

#include <stddef.h>

struct turner_embedded_file {
    const char *name, *text;
};

#endif
