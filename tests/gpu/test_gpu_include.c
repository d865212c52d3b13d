/* The include expander: no device, no compiler. */
#include "gpu_test.h"

#include "base/memory.h"
#include "gpu/include.h"
#include "shader_files.h"

static const char *const folders[] = {shader_folder};

static int setup(void **state)
{
    (void)state;
    make_shader_folder("include");
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    remove_shader_folder();
    return 0;
}

static void expect(const char *name, const char *text)
{
    struct turner_shader_source source;
    assert_ok(turner_shader_source_create(&source, name, folders, 1));
    assert_string_equal(source.text, text);
    assert_int_equal(source.length, strlen(text));
    turner_shader_source_destroy(&source);
}

static void expect_failure(const char *name, const char *message)
{
    struct turner_shader_source source;
    assert_int_equal(turner_shader_source_create(&source, name, folders, 1), TURNER_BAD_INPUT);
    assert_message_has(message);
    turner_shader_source_destroy(&source);
}

static void lines_are_kept(void **state)
{
    (void)state;
    write_shader("a.comp", "#version 460\n#include \"b.glsl\"\nint a;\n");
    write_shader("b.glsl", "#pragma once\n  #  include \"c/d.glsl\" // why\nint b;");
    write_shader("c/d.glsl", "int d;\r\n");
    expect("a.comp", "#version 460\n"
                     "#ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\n"
                     "\n"
                     "  #ifndef TURNER_FILE_2\n#define TURNER_FILE_2\n#line 1 2\n"
                     "int d;\r\n"
                     "#endif\n#line 3 1\n"
                     "int b;\n"
                     "#endif\n#line 3 0\n"
                     "int a;\n");

    struct turner_shader_source source;
    assert_ok(turner_shader_source_create(&source, "a.comp", folders, 1));
    assert_int_equal(source.file_count, 3);
    const char *const names[] = {"a.comp", "b.glsl", "c/d.glsl"};
    for (int i = 0; i < 3; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", shader_folder, names[i]);
        assert_string_equal(source.files[i].name, names[i]);
        assert_string_equal(source.files[i].path, path);
        assert_false(source.files[i].embedded);
    }
    turner_shader_source_destroy(&source);
}

/* Of a pragma only the plain `once` is left out: with a comment that goes on, or as the beginning
 * of a longer word, the text stays. */
static void other_pragmas_are_kept(void **state)
{
    (void)state;
    write_shader("pragma.comp", "#pragma once // a\n#pragma oncea; /* b\n*/\n"
                                "#pragma once /* c\n*/\nend\n");
    expect("pragma.comp", "\n#pragma oncea; /* b\n*/\n#pragma once /* c\n*/\nend\n");
}

static void a_file_comes_once(void **state)
{
    (void)state;
    write_shader("twice.comp",
                 "#include \"x.glsl\"\n#include \"x.glsl\"\n#include \"y.glsl\"\nend\n");
    write_shader("x.glsl", "x\n#include \"y.glsl\"\n");
    write_shader("y.glsl",
                 "#include \"x.glsl\"\n#include \"y.glsl\"\n#include \"twice.comp\"\ny\n");
    expect("twice.comp", "#ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\nx\n"
                         "#ifndef TURNER_FILE_2\n#define TURNER_FILE_2\n#line 1 2\n\n\n\ny\n"
                         "#endif\n#line 3 1\n#endif\n#line 2 0\n\n\nend\n");
}

/* What an #if keeps out must still come in later: the file is there twice, each time guarded. */
static void conditions_are_left_to_the_compiler(void **state)
{
    (void)state;
    write_shader("if.comp", "#if 0\n#include \"once.glsl\"\n#endif\n"
                            "#include \"once.glsl\"\n#include \"once.glsl\"\n");
    write_shader("once.glsl", "once\n");
    expect("if.comp", "#if 0\n"
                      "#ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\nonce\n"
                      "#endif\n#line 3 0\n"
                      "#endif\n"
                      "#ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\nonce\n"
                      "#endif\n#line 5 0\n"
                      "\n");
}

static void comments_are_no_directives(void **state)
{
    (void)state;
    static const char text[] = "// #include \"none.glsl\"\n"
                               "/* #include \"none.glsl\"\n"
                               "#include \"none.glsl\" */ int a;\n"
                               "// continued \\\n"
                               "#include \"none.glsl\"\n"
                               "int b; #include \"none.glsl\"\n"
                               "#define A \\\n"
                               "#include \"none.glsl\"\n"
                               "a / b /* // */ // /* \n"
                               "#if(1)\n#elif 0\n#else\n#endif // }\n"
                               "#includes\n#include <stdint.h>\n";
    write_shader("comment.comp", text);
    expect("comment.comp", text);
    write_shader("after.comp", "/* */ /**/#include \"w.glsl\"\n");
    write_shader("w.glsl", "");
    expect("after.comp",
           "/* */ /**/#ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\n#endif\n"
           "#line 2 0\n");
    write_shader("closing.comp", "/*\n*/ #include \"w.glsl\"\n/*\n*/ #include \"w.glsl\"\n");
    expect("closing.comp",
           "/*\n*/ #ifndef TURNER_FILE_1\n#define TURNER_FILE_1\n#line 1 1\n#endif\n"
           "#line 3 0\n/*\n*/ \n");
}

static void folders_in_order_then_built_in(void **state)
{
    (void)state;
    char second[600];
    snprintf(second, sizeof second, "%s/second", shader_folder);
    write_shader("one.glsl", "first");
    write_shader("second/one.glsl", "second");
    write_shader("second/two.glsl", "second");
    const char *const both[] = {shader_folder, second};
    struct turner_shader_source source;
    assert_ok(turner_shader_source_create(&source, "one.glsl", both, 2));
    assert_string_equal(source.text, "first\n");
    turner_shader_source_destroy(&source);
    assert_ok(turner_shader_source_create(&source, "two.glsl", both, 2));
    assert_string_equal(source.text, "second\n");
    turner_shader_source_destroy(&source);

    /* shared.h is among the copies unless a folder has one */
    assert_true(turner_embedded_shaders_count > 0);
    assert_ok(turner_shader_source_create(&source, "shared.h", both, 2));
    assert_true(source.files[0].embedded);
    assert_string_equal(source.files[0].path, "built-in/shared.h");
    turner_shader_source_destroy(&source);
    write_shader("shared.h", "mine");
    assert_ok(turner_shader_source_create(&source, "shared.h", both, 2));
    assert_false(source.files[0].embedded);
    assert_string_equal(source.text, "mine\n");
    turner_shader_source_destroy(&source);
}

static void copies_are_exact(void **state)
{
    (void)state;
    for (size_t i = 0; i < turner_embedded_shaders_count; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/shaders/%s", TURNER_SOURCE_DIR,
                 turner_embedded_shaders[i].name);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        size_t length = strlen(turner_embedded_shaders[i].text);
        char *text = calloc(1, length + 2);
        assert_int_equal(fread(text, 1, length + 1, file), length);
        assert_string_equal(text, turner_embedded_shaders[i].text);
        free(text);
        fclose(file);
        if (i)
            assert_true(strcmp(turner_embedded_shaders[i - 1].name, turner_embedded_shaders[i].name) <
                        0);
    }
}

static void errors_say_where(void **state)
{
    (void)state;
    write_shader("outer.comp", "int a;\n#include \"inner.glsl\"\n");
    write_shader("inner.glsl", "\n\n#include \"gone.glsl\"\n");
    char where[1200];
    snprintf(where, sizeof where, "%s/inner.glsl:3:1: \"gone.glsl\" is neither in %s, nor built in",
             shader_folder, shader_folder);
    expect_failure("outer.comp", where);

    /* and what was read can be watched until it is repaired */
    struct turner_shader_source source;
    assert_int_equal(turner_shader_source_create(&source, "outer.comp", folders, 1),
                     TURNER_BAD_INPUT);
    assert_int_equal(source.file_count, 2);
    turner_shader_source_destroy(&source);

    static const struct {
        const char *text, *message;
    } wrong[] = {
        {"\n#include x.glsl\n", "wrong.comp:2:1: write #include \"name\""},
        {"#include\n", "wrong.comp:1:1: write #include \"name\""},
        {"#include \"x.glsl\nint a;\"\n", "wrong.comp:1:1: write #include \"name\""},
        {"#include \"x.glsl\" int a;\n", "wrong.comp:1:1: nothing may follow"},
        {"#include \"x.glsl\" /* a\n */\n", "wrong.comp:1:1: #include must end on its own line"},
        {"#include \"x.glsl\" // a \\\nb\n", "wrong.comp:1:1: #include must end on its own line"},
        {"#pragma once // a \\\nb\n", "wrong.comp:1:1: #pragma once must end on its own line"},
        {"#include \"\"\n", "must be a name relative to the shader folders"},
        {"#include \"/etc/passwd\"\n", "must be a name relative to the shader folders"},
        {"#include \"../x.glsl\"\n", "must be a name relative to the shader folders"},
        {"#include \"a/../x.glsl\"\n", "must be a name relative to the shader folders"},
        {"#include \"./x.glsl\"\n", "must be a name relative to the shader folders"},
        {"#include \"a//x.glsl\"\n", "must be a name relative to the shader folders"},
        {"#include \"a/\"\n", "must be a name relative to the shader folders"},
        {"#include \"a\\x.glsl\"\n", "must be a name relative to the shader folders"},
        {"#include \"folder\"\n", "is not a file"},
        {"#include \"zero.glsl\"\n", "holds a zero byte"},
        {"#endif\n", "wrong.comp:1:1: #endif without #if"},
        {"#ifdef A\n#if 1\n#endif\n", "wrong.comp:1:1: #if without #endif"},
        {"int a; /* \n", "wrong.comp:1:1: ends inside a comment"},
        {"int a; \\\n", "wrong.comp:1:1: ends inside a comment or a continued line"},
    };
    write_shader("folder/x", "");
    write_shader("x.glsl", "");
    write_shader_bytes("zero.glsl", "a\0b", 3);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        write_shader("wrong.comp", wrong[i].text);
        expect_failure("wrong.comp", wrong[i].message);
    }
    expect_failure("none.comp", "\"none.comp\" is neither in ");
}

static void unreadable_is_said(void **state)
{
    (void)state;
    if (geteuid() == 0)
        skip(); /* root reads everything */
    write_shader("locked.glsl", "");
    char path[600];
    snprintf(path, sizeof path, "%s/locked.glsl", shader_folder);
    chmod(path, 0);
    expect_failure("locked.glsl", "locked.glsl: cannot be read: Permission denied");
}

static void limits(void **state)
{
    (void)state;
    char name[32], text[64];
    for (int i = 0; i < 40; i++) {
        snprintf(name, sizeof name, "deep%d.glsl", i);
        snprintf(text, sizeof text, "#include \"deep%d.glsl\"\n", i + 1);
        write_shader(name, text);
    }
    write_shader("deep40.glsl", "");
    expect_failure("deep0.glsl", "deep31.glsl:1:1: more than 32 files inside each other");
    struct turner_shader_source source;
    assert_ok(turner_shader_source_create(&source, "deep10.glsl", folders, 1));
    turner_shader_source_destroy(&source);

    /* each file brings in the next ten times: without a limit it would never end */
    for (int i = 0; i < 20; i++) {
        char many[1024] = "#if 1\n";
        for (int j = 0; j < 10; j++) {
            snprintf(text, sizeof text, "#include \"wide%d.glsl\"\n", i + 1);
            strcat(many, text);
        }
        strcat(many, "#endif\n");
        snprintf(name, sizeof name, "wide%d.glsl", i);
        write_shader(name, many);
    }
    write_shader("wide20.glsl", "");
    expect_failure("wide0.glsl", "more than 4194304 bytes with everything it includes");

    char *large = turner_calloc(TURNER_SOURCE_BYTES + 1, 1);
    memset(large, ' ', TURNER_SOURCE_BYTES);
    write_shader("large.glsl", large);
    expect_failure("large.glsl", "4194304 bytes, shaders may have 4194304");
    large[TURNER_SOURCE_BYTES - 1] = 0;
    write_shader("large.glsl", large);
    expect_failure("large.glsl", "more than 4194304 bytes with everything");
    large[TURNER_SOURCE_BYTES - 2] = 0;
    write_shader("large.glsl", large); /* with the newline that is added it just fits */
    assert_ok(turner_shader_source_create(&source, "large.glsl", folders, 1));
    turner_shader_source_destroy(&source);
    free(large);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_are_kept),
        cmocka_unit_test(other_pragmas_are_kept),
        cmocka_unit_test(a_file_comes_once),
        cmocka_unit_test(conditions_are_left_to_the_compiler),
        cmocka_unit_test(comments_are_no_directives),
        cmocka_unit_test(folders_in_order_then_built_in),
        cmocka_unit_test(copies_are_exact),
        cmocka_unit_test(errors_say_where),
        cmocka_unit_test(unreadable_is_said),
        cmocka_unit_test(limits),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
