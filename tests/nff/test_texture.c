/* Pictures as textures: decoded once, linear, row 0 at the top. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "image/image.h"
#include "scene/readers.h"

#define PNG TURNER_BINARY_DIR "/texture_test.png"
#define EXR TURNER_BINARY_DIR "/texture_test.exr"

/* Red grows to the right, green downwards, blue is ½. */
static void write_picture(const char *path)
{
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 3, 2), TURNER_OK);
    for (int i = 0; i < 6; i++) {
        image.rgba[4 * i] = (float)(i % 3) / 2;
        image.rgba[4 * i + 1] = (float)(i / 3);
        image.rgba[4 * i + 2] = .5f;
        image.rgba[4 * i + 3] = 9;
    }
    struct turner_image_encoding encoding = {0};
    assert_int_equal(turner_image_write(&image, path, &encoding), TURNER_OK);
    turner_image_destroy(&image);
}

static void linear_from_either_kind(void **state)
{
    (void)state;
    write_picture(PNG);
    write_picture(EXR);
    struct turner_scene *scene = turner_scene_create();
    uint32_t png, exr, again;
    assert_int_equal(turner_scene_texture(&png, scene, PNG), TURNER_OK);
    assert_int_equal(turner_scene_texture(&exr, scene, EXR), TURNER_OK);
    assert_int_equal(turner_scene_texture(&again, scene, PNG), TURNER_OK);
    assert_true(png == 0 && exr == 1 && again == 0 && scene->texture_image_count == 2);
    for (uint32_t k = 0; k < 2; k++) {
        const struct turner_texture_image *t = &scene->texture_images[k];
        assert_string_equal(t->path, k ? EXR : PNG);
        assert_true(t->width == 3 && t->height == 2);
        float tolerance = k ? 0 : .005f; /* 8 bits */
        for (int i = 0; i < 6; i++) {
            assert_true(fabsf(t->rgb[3 * i] - (float)(i % 3) / 2) <= tolerance);
            assert_true(fabsf(t->rgb[3 * i + 1] - (float)(i / 3)) <= tolerance);
            assert_true(fabsf(t->rgb[3 * i + 2] - .5f) <= tolerance);
        }
    }
    turner_scene_destroy(scene);
}

static void missing(void **state)
{
    (void)state;
    struct turner_scene *scene = turner_scene_create();
    uint32_t image;
    assert_int_equal(turner_scene_texture(&image, scene, "nowhere/texture.png"), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "nowhere/texture.png"));
    assert_int_equal(scene->texture_image_count, 0);
    turner_scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(linear_from_either_kind),
        cmocka_unit_test(missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
