#include "render/opening.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "render/renderer.h"

static void *open_device(void *user)
{
    struct turner_opening *opening = user;
    double start = turner_seconds();
    opening->result = turner_gpu_create(&opening->gpu, opening->device, false);
    opening->seconds = turner_seconds() - start;
    if (opening->result != TURNER_OK)
        opening->message = turner_strdup(turner_message()); /* each thread has its own */
    return NULL;
}

void turner_opening_start(struct turner_opening *opening, const char *device)
{
    *opening = (struct turner_opening){.device = device};
    if (device && strcmp(device, "reference") == 0)
        return;
    opening->begun = true;
    opening->threaded = pthread_create(&opening->thread, NULL, open_device, opening) == 0;
    if (!opening->threaded)
        open_device(opening);
}

static void wait_for(struct turner_opening *opening)
{
    if (opening->threaded)
        pthread_join(opening->thread, NULL);
    opening->threaded = false;
}

enum turner_result turner_opening_finish(struct turner_opening *opening)
{
    wait_for(opening);
    return opening->message ? turner_fail(opening->result, "%s", opening->message) : TURNER_OK;
}

static void *close_device(void *user)
{
    struct turner_opening *opening = user;
    if (opening->begun && opening->result == TURNER_OK)
        turner_gpu_destroy(&opening->gpu);
    opening->begun = false;
    return NULL;
}

void turner_opening_close(struct turner_opening *opening)
{
    wait_for(opening);
    opening->threaded = pthread_create(&opening->thread, NULL, close_device, opening) == 0;
}

void turner_opening_destroy(struct turner_opening *opening)
{
    wait_for(opening);
    close_device(opening);
    free(opening->message);
    *opening = (struct turner_opening){0};
}
