/* Methods by name: what is set is what is told, wrong names and values are refused. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "scene/methods.h"

static struct turner_settings standard(void)
{
    struct turner_scene *scene = turner_scene_create();
    struct turner_settings settings = scene->settings;
    turner_scene_destroy(scene);
    return settings;
}

static void assert_round(const char *name, const char *value)
{
    struct turner_settings settings = standard();
    char text[TURNER_METHOD_TEXT];
    assert_int_equal(turner_method_set(&settings, name, value), TURNER_OK);
    turner_method_text(text, &settings, name);
    assert_string_equal(text, value);
}

/* The words of the list are those that are understood, and the default is a new scene's. */
static void list_is_true(void **state)
{
    (void)state;
    struct turner_settings settings = standard();
    for (size_t i = 0; i < turner_method_count; i++) {
        const struct turner_method *method = &turner_methods_list[i];
        char text[TURNER_METHOD_TEXT];
        turner_method_text(text, &settings, method->name);
        assert_string_equal(text, method->standard);
        assert_true(strlen(method->sentence) > 20 && strlen(method->source) > 5);
        char words[128];
        snprintf(words, sizeof words, "%s", method->values);
        for (char *word = strtok(words, " |"); word; word = strtok(NULL, " |")) {
            if (!strpbrk(word, "<>") && strcmp(method->name, "depth") != 0 &&
                strcmp(method->name, "cutoff") != 0)
                assert_round(method->name, word);
        }
    }
}

static void values_with_numbers(void **state)
{
    (void)state;
    assert_round("offset", "tmin:0.001");
    assert_round("aa", "16");
    assert_round("aa", "adaptive:0.05,64");
    assert_round("depth", "0");
    assert_round("depth", "1024");
    assert_round("cutoff", "0.25");
    assert_round("error", "0.004");
    struct turner_settings settings = standard();
    assert_int_equal(turner_method_assign(&settings, "aa=adaptive:1e-2,256"), TURNER_OK);
    assert_int_equal(settings.spp, 256);
    assert_true(settings.aa_threshold == 1e-2);
    assert_int_equal(turner_method_assign(&settings, "aa=4"), TURNER_OK);
    assert_true(settings.spp == 4 && settings.aa_threshold == 0);
    assert_int_equal(turner_method_assign(&settings, "error=1/255"), TURNER_OK);
    assert_true(settings.error == 1.0 / 255);
    assert_int_equal(turner_method_assign(&settings, "sphere=textbook"), TURNER_OK);
    assert_true(settings.error > 0);
    assert_int_equal(turner_method_assign(&settings, "depth=3"), TURNER_OK);
    assert_true(settings.error == 0); /* whoever says depth, cutoff or samples chooses them */
}

static void refusals(void **state)
{
    (void)state;
    static const char *const wrong[] = {
        "sphere=", "sphere=Robust", "sphere=f640", "offset=tmin", "offset=tmin:", "offset=tmin:0",
        "offset=tmin:-1", "offset=tmin:nan", "offset=tmin:1x", "aa=0", "aa=-3", "aa=4x",
        "aa=adaptive", "aa=adaptive:", "aa=adaptive:0.1", "aa=adaptive:0.1,", "aa=adaptive:0,8",
        "aa=adaptive:inf,8", "aa=adaptive:0.1,4", "aa=adaptive:0.1,8,", "depth=-1", "depth=1025",
        "depth=1.5", "error=-1", "error=1/0", "error=1/", "error=nan", "error=inf",
        "error=1e-9", "error=1e9", "error=1/255x", "cutoff=-1", "cutoff=2", "cutoff=nan", "cutoff=", "shere=robust", "=",
        "sphere", ""};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct turner_settings settings = standard(), before = settings;
        if (turner_method_assign(&settings, wrong[i]) != TURNER_USAGE)
            fail_msg("\"%s\" was taken", wrong[i]);
        assert_memory_equal(&settings, &before, sizeof settings);
    }
    struct turner_settings settings = standard();
    turner_method_assign(&settings, "shere=robust");
    assert_non_null(strstr(turner_message(), "\"sphere\""));
    turner_method_assign(&settings, "sphere=f640");
    assert_non_null(strstr(turner_message(), "textbook | robust | f64"));
}

static void override_is_for_glass(void **state)
{
    (void)state;
    struct turner_settings settings = standard();
    struct turner_material glass = {.k_t = {1, 1, 1}, .fresnel = TURNER_FRESNEL_EXACT};
    struct turner_material metal = {.k_r = {1, 1, 1}, .fresnel = TURNER_FRESNEL_SCHLICK};
    assert_int_equal(turner_material_fresnel(&settings, &glass), TURNER_FRESNEL_EXACT);
    assert_int_equal(turner_method_set(&settings, "fresnel", "none"), TURNER_OK);
    assert_int_equal(turner_material_fresnel(&settings, &glass), TURNER_FRESNEL_NONE);
    assert_int_equal(turner_material_fresnel(&settings, &metal), TURNER_FRESNEL_SCHLICK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(list_is_true),
        cmocka_unit_test(values_with_numbers),
        cmocka_unit_test(refusals),
        cmocka_unit_test(override_is_for_glass),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
