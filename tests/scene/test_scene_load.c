/* Scenes from files: what is no scene file, what is found beside one, and bare meshes. */
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "scene_reading.h"

static char folder[] = "/tmp/turner-scene-XXXXXX";

static const char *write_file(const char *name, const char *text)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    return path;
}

/* The message is "folder/name" followed by `rest`. */
static void refused(const char *name, const char *rest)
{
    char path[256], expected[1024];
    struct turner_scene *scene;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(expected, sizeof expected, "%s%s", path, rest);
    assert_int_equal(turner_scene_load(&scene, path), TURNER_BAD_INPUT);
    assert_null(scene);
    assert_string_equal(turner_message(), expected);
}

static void not_a_scene_file(void **state)
{
    (void)state;
    char path[256];
    refused("none.json", ": cannot be opened: No such file or directory");
    refused("none.obj", ": cannot be opened: No such file or directory");
    snprintf(path, sizeof path, "%s/folder.json", folder);
    assert_int_equal(mkdir(path, 0700), 0);
    refused("folder.json", ": is a folder; give a scene file in it");
    snprintf(path, sizeof path, "%s/fifo.json", folder);
    assert_int_equal(mkfifo(path, 0600), 0);
    refused("fifo.json", ": is not a regular file");
    write_file("empty.json", "");
    refused("empty.json", ": the file is empty");
    write_file("scene.txt", HEAD "}");
    refused("scene.txt", ": unknown kind of scene; its name must end in one of .json, .nff, .obj, "
                         ".ply, .stl, .gltf and .glb");
    write_file("json", HEAD "}");
    refused("json", ": unknown kind of scene; its name must end in one of .json, .nff, .obj, .ply, "
                    ".stl, .gltf and .glb");
    /* a sparse file takes no room */
    snprintf(path, sizeof path, "%s/large.json", folder);
    write_file("large.json", " ");
    assert_int_equal(truncate(path, (off_t)TURNER_MAX_FILE_BYTES + 1), 0);
    refused("large.json", ": the file has 1073741825 bytes, but 1073741824 are the limit");
    if (geteuid() != 0) { /* root may read anything */
        assert_int_equal(chmod(path, 0), 0);
        refused("large.json", ": cannot be opened: Permission denied");
    }
}

static void endings(void **state)
{
    (void)state;
    struct turner_scene *scene;
    assert_int_equal(turner_scene_load(&scene, write_file("UPPER.JSON", HEAD "}\n")), TURNER_OK);
    assert_string_equal(strrchr(scene->path, '/'), "/UPPER.JSON");
    turner_scene_destroy(scene);
    assert_int_equal(turner_scene_load(&scene, write_file("scene.nff", "b .1 .2 .3\nv\nfrom 0 0 5\n"
                     "at 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\n")), TURNER_OK);
    same(scene->background.color, .1, .2, .3);
    turner_scene_destroy(scene);
}

static void files_beside(void **state)
{
    (void)state;
    struct turner_scene *scene;
    assert_int_equal(
        turner_scene_load(&scene, TURNER_SOURCE_DIR "/tests/scene/data/good/shapes.json"),
        TURNER_OK);
    assert_int_equal(scene->groups[0].mesh_count, 4);
    turner_scene_destroy(scene);
    assert_int_equal(
        turner_scene_load(&scene, TURNER_SOURCE_DIR "/tests/scene/data/good/materials.json"),
        TURNER_OK);
    assert_int_equal(scene->texture_image_count, 1);
    const struct turner_texture_image *wood = &scene->texture_images[0];
    assert_true(wood->width == 2 && wood->height == 2);
    assert_true(wood->rgb[0] == 1 && wood->rgb[1] == 0 && wood->rgb[4] == 1);
    turner_scene_destroy(scene);
    assert_int_equal(
        turner_scene_load(&scene, TURNER_SOURCE_DIR "/tests/scene/data/good/lights.json"),
        TURNER_OK);
    assert_int_equal(scene->background.kind, TURNER_BACKGROUND_ENVIRONMENT);
    assert_int_equal(scene->background.image, 0);
    assert_true(fabs(scene->background.rotation - acos(-1) / 2) < 1e-15);
    same(scene->background.scale, .5, .5, .5);
    turner_scene_destroy(scene);
}

static void transforms_beside(void **state)
{
    (void)state;
    struct turner_scene *scene;
    assert_int_equal(
        turner_scene_load(&scene, TURNER_SOURCE_DIR "/tests/scene/data/good/instances.json"),
        TURNER_OK);
    assert_int_equal(scene->instance_count, 4);
    const struct turner_instance *i = scene->instances;
    assert_true(i[0].material == TURNER_NONE && i[3].material == TURNER_NONE);
    assert_true(i[1].group == 1 && i[1].material == 0 && i[2].group == 1 && i[2].material == 0);
    same(turner_affine_point(&i[1].transform, turner_vec3_of(1, 2, 3)), 3, 1, 3.5);
    same(turner_affine_point(&i[2].transform, turner_vec3_of(1, 2, 3)), 6, 4, 5);
    same(turner_affine_point(&i[3].transform, turner_vec3_of(0, 0, 0)), 3, 0, 0);
    turner_scene_destroy(scene);
}

#define MANY HEAD ", \"groups\": {\"g\": []}, \"instances\": [\n{\"group\": \"g\", \"transforms\": \"m\"}]}"

/* A scene whose file of transforms has this content is refused with this reason. */
static void transforms_refused(const void *content, size_t size, off_t length, const char *reason)
{
    char rest[1024];
    const char *path = write_file("m", "");
    FILE *file = fopen(path, "wb");
    fwrite(content, 1, size, file);
    fclose(file);
    assert_int_equal(truncate(path, length), 0);
    write_file("many.json", MANY);
    snprintf(rest, sizeof rest, ":2:30: %s/m: %s (at $.instances[0].transforms)", folder, reason);
    refused("many.json", rest);
}

static void wrong_transforms(void **state)
{
    (void)state;
    float matrix[24] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
    const size_t size = sizeof matrix;
    const char *whole = "bytes are no whole number of transforms, which have 48 each (3 rows of 4 "
                        "32-bit floats)";
    const char *flat = "transform 1 (counted from 0) flattens space or is not finite; it must hold "
                       "12 little-endian 32-bit floats for each instance, 3 rows of 4";
    char reason[512];
    snprintf(reason, sizeof reason, "0 %s", whole);
    transforms_refused("", 0, 0, reason);
    snprintf(reason, sizeof reason, "95 %s", whole);
    transforms_refused(matrix, size, 95, reason);
    transforms_refused(matrix, size, (off_t)size, flat); /* the second has a row of zeros */
    matrix[22] = NAN;
    transforms_refused(matrix, size, (off_t)size, flat);
    transforms_refused(matrix, size, (off_t)48 << 24, "with its transforms there are 16777216 "
                       "instances, and 16777215 are the limit");
}

/* The place in the scene file stands around the message of whoever read the other file. */
static void files_missing_beside(void **state)
{
    (void)state;
    static const struct {
        const char *text, *place, *file, *way;
    } cases[] = {
        {HEAD ", \"meshes\": {\"a\": {\"file\": \"none.obj\"}}}", ":1:89: ", "/none.obj",
         "(at $.meshes.a.file)"},
        {HEAD ",\n\"background\": {\"type\": \"environment\", \"file\": \"none.exr\"}}", ":2:47: ",
         "/none.exr", "(at $.background.file)"},
        {HEAD ",\n\"materials\": {\"a\": {\"pattern\": {\"type\": \"image\", \"file\": "
              "\"none.png\"}}}}",
         ":2:58: ", "/none.png", "(at $.materials.a.pattern.file)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *path = write_file("beside.json", cases[i].text);
        struct turner_scene *scene;
        assert_int_equal(turner_scene_load(&scene, path), TURNER_BAD_INPUT);
        char begin[512], file[512];
        snprintf(begin, sizeof begin, "%s%s", path, cases[i].place);
        snprintf(file, sizeof file, "%s%s", folder, cases[i].file);
        const char *message = turner_message();
        size_t length = strlen(message), way = strlen(cases[i].way);
        if (strncmp(message, begin, strlen(begin)) != 0 || !strstr(message, file) ||
            length < way || strcmp(message + length - way, cases[i].way) != 0)
            fail_msg("%s\ninstead of\n%s… %s… %s", message, begin, file, cases[i].way);
    }
}

/* A mesh file alone: the camera sees its whole bounding sphere, and there is light. */
static void bare_meshes(void **state)
{
    (void)state;
    struct turner_scene *scene;
    const char *path = write_file("tetra.obj", "v 100 0 0\nv 101 0 0\nv 100 1 0\nv 100 0 1\n"
                                               "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    assert_int_equal(turner_scene_load(&scene, path), TURNER_OK);
    assert_int_equal(turner_group_primitive_count(&scene->groups[0]), 4);
    assert_true(scene->light_count == 1 && scene->material_count == 1);
    assert_true(scene->materials[0].k_d.x > 0);
    same(scene->camera.at, 100.5, .5, .5);
    double distance = turner_vec3_length(turner_vec3_sub(scene->camera.from, scene->camera.at));
    double radius = sqrt(.75);
    assert_true(radius / distance < sin(scene->camera.vfov / 2));
    assert_true(radius / distance > .9 * sin(scene->camera.vfov / 2));
    turner_scene_destroy(scene);
    path = write_file("empty.obj", "# nothing\n");
    assert_int_equal(turner_scene_load(&scene, path), TURNER_BAD_INPUT);
}

static int create_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[64];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(not_a_scene_file),
        cmocka_unit_test(endings),
        cmocka_unit_test(files_beside),
        cmocka_unit_test(transforms_beside),
        cmocka_unit_test(wrong_transforms),
        cmocka_unit_test(files_missing_beside),
        cmocka_unit_test(bare_meshes),
    };
    turner_set_quiet(true);
    return cmocka_run_group_tests(tests, create_folder, remove_folder);
}
