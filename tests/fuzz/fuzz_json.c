/* Any bytes as a JSON scene: they become a valid scene or a message that names the place. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/readers.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* In place of the functions that open files (the linker's --wrap): files exist unless they are
 * called "missing". */
enum turner_result __wrap_turner_mesh_read_file(struct turner_mesh *mesh, const char *path,
                                                int smooth);
enum turner_result __wrap_turner_scene_texture(uint32_t *image, struct turner_scene *scene,
                                               const char *path);

enum turner_result __wrap_turner_mesh_read_file(struct turner_mesh *mesh, const char *path,
                                                int smooth)
{
    *mesh = (struct turner_mesh){0};
    if (strstr(path, "missing"))
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be opened", path);
    mesh->positions = turner_calloc(3, sizeof *mesh->positions);
    mesh->positions[1].x = mesh->positions[2].y = 1;
    mesh->triangles = turner_calloc(1, sizeof *mesh->triangles);
    mesh->triangles[0][1] = 1;
    mesh->triangles[0][2] = 2;
    mesh->vertex_count = 3;
    mesh->triangle_count = 1;
    if (smooth == 1)
        turner_mesh_smooth(mesh);
    return TURNER_OK;
}

enum turner_result __wrap_turner_scene_texture(uint32_t *image, struct turner_scene *scene,
                                               const char *path)
{
    if (strstr(path, "missing"))
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be opened", path);
    struct turner_texture_image texture = {.path = turner_strdup(path), .width = 1, .height = 1};
    texture.rgb = turner_calloc(3, sizeof *texture.rgb);
    *image = (uint32_t)scene->texture_image_count;
    *TURNER_PUSH(scene->texture_images, scene->texture_image_count,
                 scene->texture_image_capacity) = texture;
    return TURNER_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char path[] = "nowhere/fuzz.json";
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
