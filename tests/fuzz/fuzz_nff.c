/* Any bytes as an NFF scene: they become a valid scene or a message that names the place. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "scene/readers.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char path[] = "fuzz.nff";
    struct turner_scene *scene;
    turner_set_quiet(true);
    enum turner_result result = turner_scene_parse(&scene, (const char *)data, size, path);
    if (result == TURNER_OK) {
        if (!scene || turner_scene_validate(scene) != TURNER_OK)
            abort();
        turner_scene_destroy(scene);
    } else if (result != TURNER_BAD_INPUT || scene ||
               strncmp(turner_message(), path, strlen(path)) != 0 ||
               turner_message()[strlen(path)] != ':') {
        abort(); /* every refusal is wrong input and says where */
    }
    return 0;
}
