/* What turner has of OpenImageIO. That brings two hundred libraries, and loading them takes longer
 * than drawing a small picture: where turner's own library is a shared one, oiio.cpp is a module
 * that is loaded when a file asks for it. It calls nothing of turner's. */
#ifndef TURNER_IMAGE_OIIO_H
#define TURNER_IMAGE_OIIO_H

#include "image/codec.h"

#define TURNER_OIIO_REASON 1024

struct turner_oiio_picture {
    const char *codec; /* OpenImageIO's name of the format */
    int width, height;
    enum turner_sample sample;
    const void *samples; /* width × height × 3 */
    bool srgb;           /* they are under the sRGB curve */
    const struct turner_image_text *texts;
    size_t text_count;
};

enum turner_oiio_result {
    TURNER_OIIO_OK,
    TURNER_OIIO_FAILED,  /* why is in `reason` */
    TURNER_OIIO_REFUSED, /* `begin` did not want it */
};

struct turner_oiio {
    const char *version; /* turner's, of the build it comes from */
    /* The file in memory goes to `take`, once. */
    enum turner_oiio_result (*encode)(const struct turner_oiio_picture *picture,
                                      void (*take)(void *user, const void *bytes, size_t size),
                                      void *user, char reason[TURNER_OIIO_REASON]);
    /* Reads as turner_codec_read does. `begin` is told the size and returns where width × height × 4
     * floats go, or NULL. */
    enum turner_oiio_result (*decode)(const char *path,
                                      float *(*begin)(void *user, int width, int height),
                                      void *user, int *channels, int *steps,
                                      char reason[TURNER_OIIO_REASON]);
};

/* The module's only function. */
const struct turner_oiio *turner_oiio_module(void);

/* The same, loaded first if need be; NULL with turner_message (TURNER_DEVICE) when it cannot be.
 * Thread-safe. */
const struct turner_oiio *turner_oiio_load(void);

#endif
