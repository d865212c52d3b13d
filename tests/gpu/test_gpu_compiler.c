/* From GLSL to SPIR-V and back by reflection: no device. */
#include "gpu_test.h"

#include "gpu/compiler.h"
#include "gpu/program.h"
#include "shader_files.h"

static const char *const folders[] = {shader_folder};

static int setup(void **state)
{
    (void)state;
    make_shader_folder("compiler");
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    remove_shader_folder();
    return 0;
}

static enum turner_result compile(struct turner_spirv *spirv, const char *name,
                                  const char *const *defines, size_t define_count)
{
    struct turner_shader_source source;
    *spirv = (struct turner_spirv){0};
    enum turner_result result = turner_shader_source_create(&source, name, folders, 1);
    if (result == TURNER_OK)
        result = turner_compile(spirv, &source, defines, define_count);
    turner_shader_source_destroy(&source);
    return result;
}

/* The message starts with `message`, where every "@" stands for the shader folder. */
static void expect_error(const char *name, const char *message)
{
    struct turner_spirv spirv;
    assert_int_equal(compile(&spirv, name, NULL, 0), TURNER_BAD_INPUT);
    assert_null(spirv.words);
    char expected[2048];
    size_t used = 0;
    for (; *message; message++) {
        if (*message == '@')
            used += (size_t)snprintf(expected + used, sizeof expected - used, "%s", shader_folder);
        else
            expected[used++] = *message;
    }
    expected[used] = 0;
    char start[2048];
    snprintf(start, sizeof start, "%.*s", (int)used, turner_message());
    assert_string_equal(start, expected);
}

static void the_kernel_compiles(void **state)
{
    (void)state;
    static const char *const ray_query[] = {"TURNER_RAY_QUERY"};
    for (size_t variant = 0; variant < 2; variant++) {
        struct turner_spirv spirv;
        struct turner_reflection reflection;
        assert_ok(compile(&spirv, "render.comp", ray_query, variant));
        assert_ok(turner_spirv_validate(&spirv));
        assert_int_equal(spirv.words[0], 0x07230203);
        assert_int_equal(spirv.words[1], 0x00010600);
        assert_ok(turner_reflect(&reflection, &spirv));
        assert_int_equal(reflection.binding_count, variant); /* the acceleration structure */
        assert_true(reflection.push_size > 0 && reflection.push_size <= 128);
        assert_true(reflection.constant_count > 0);
        turner_reflection_destroy(&reflection);
        turner_spirv_destroy(&spirv);
    }
}

static void defines_reach_the_shader(void **state)
{
    (void)state;
    write_shader("define.comp", "#version 460\n"
                                "#if !defined(A) || A != 1 || B != 7\n#error not defined\n#endif\n"
                                "layout(local_size_x = B, local_size_y = 2) in;\n"
                                "void main() {}\n");
    static const char *const defines[] = {"A", "B=7"};
    struct turner_spirv spirv;
    struct turner_reflection reflection;
    assert_ok(compile(&spirv, "define.comp", defines, 2));
    assert_ok(turner_reflect(&reflection, &spirv));
    assert_int_equal(reflection.local_size[0], 7);
    assert_int_equal(reflection.local_size[1], 2);
    assert_int_equal(reflection.local_size[2], 1);
    assert_int_equal(reflection.binding_count, 0);
    assert_int_equal(reflection.push_size, 0);
    turner_reflection_destroy(&reflection);
    turner_spirv_destroy(&spirv);
    expect_error("define.comp", "@/define.comp:3:1: '#error' : not defined");
}

static void errors_say_where(void **state)
{
    (void)state;
    write_shader("outer.comp", "#version 460\n"
                               "#include \"inner.glsl\"\n"
                               "void main()\n{\n    unknown = 1;\n}\n");
    write_shader("inner.glsl", "\n#include \"deepest.glsl\"\n\nfloat f()\n{\n    return g;\n}\n");
    write_shader("deepest.glsl", "// fine\n");
    expect_error("outer.comp", "@/inner.glsl:6:12: 'g' : undeclared identifier\n    return g;\n"
                               "@/outer.comp:5:5: 'unknown' : undeclared identifier");

    write_shader("inner.glsl", "float f() { return 1; }\n");
    expect_error("outer.comp",
                 "@/outer.comp:5:5: 'unknown' : undeclared identifier\n    unknown = 1;");

    /* a name with what a tool might trip over */
    write_shader("odd: \xc3\xa9 #'1.glsl", "int a = b;\n");
    write_shader("odd.comp", "#version 460\n#include \"odd: \xc3\xa9 #'1.glsl\"\nvoid main() {}\n");
    expect_error("odd.comp",
                 "@/odd: \xc3\xa9 #'1.glsl:1:9: 'b' : undeclared identifier\n    int a = b;");

    write_shader("no_main.comp", "#version 460\nvoid f() {}\n");
    expect_error("no_main.comp", "@/no_main.comp:1:1: ");
    assert_message_has("Missing entry point");
    write_shader("empty.comp", "");
    expect_error("empty.comp", "@/empty.comp:1:1: ");
    write_shader("c.comp", "#version 460\n\n#include <stdint.h>\nvoid main() {}\n");
    expect_error("c.comp", "@/c.comp:3:1: '#include' : ");
    write_shader("line.comp", "#version 460\n#line 7 99\nint a = b;\nvoid main() {}\n");
    expect_error("line.comp", "@/line.comp:1:1: 'b' : undeclared identifier");
}

static void a_missing_semicolon_is_explained(void **state)
{
    (void)state;
    write_shader("semicolon.comp", "#version 460\n#include \"open.glsl\"\n\nvoid main()\n{\n}\n");
    write_shader("open.glsl", "const float pi = 3.14\n");
    expect_error("semicolon.comp", "@/semicolon.comp:4:1: syntax error, unexpected VOID, expecting "
                                   "COMMA or SEMICOLON\n    void main()\n"
                                   "    (or a ';' or '}' is missing at the end of open.glsl)");
    write_shader("open.glsl", "const float pi = 3.14;\nint x = ;\n");
    expect_error("semicolon.comp",
                 "@/open.glsl:2:9: syntax error, unexpected SEMICOLON\n    int x = ;");
    assert_null(strstr(turner_message(), "is missing at the end"));
}

static void many_errors_are_cut(void **state)
{
    (void)state;
    char text[4096] = "#version 460\nvoid main()\n{\n";
    for (int i = 0; i < 20; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "    a%d = 1;\n", i);
    strcat(text, "}\n");
    write_shader("many.comp", text);
    expect_error("many.comp", "@/many.comp:4:5: 'a0' : undeclared identifier\n    a0 = 1;\n");
    assert_message_has(" more)");
    write_shader("long.comp", "#version 460\n"); /* a message that does not fit */
    for (size_t i = 0; i < sizeof text; i++)
        text[i] = i % 8 == 7 ? ' ' : 'x';
    memcpy(text, "#error ", 7);
    text[sizeof text - 1] = 0;
    write_shader("long.comp", text);
    expect_error("long.comp", "@/long.comp:1:1: '#error' : xxx");
}

static void broken_spirv_is_found(void **state)
{
    (void)state;
    struct turner_spirv spirv;
    struct turner_reflection reflection;
    write_shader("fine.comp", "#version 460\nlayout(local_size_x = 8) in;\nvoid main() {}\n");
    assert_ok(compile(&spirv, "fine.comp", NULL, 0));
    assert_ok(turner_spirv_validate(&spirv));
    spirv.count--; /* without OpFunctionEnd */
    assert_int_equal(turner_spirv_validate(&spirv), TURNER_BAD_INPUT);
    assert_message_has("the SPIR-V is not valid: ");
    spirv.count++;
    spirv.words[0] = 0;
    assert_int_equal(turner_reflect(&reflection, &spirv), TURNER_BAD_INPUT);
    assert_message_has("SPIR-V reflection: ");
    turner_reflection_destroy(&reflection);
    turner_spirv_destroy(&spirv);
}

static void what_cannot_be_bound_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *declaration, *message;
    } wrong[] = {
        {"layout(set = 1, binding = 0) buffer b { int a; };", "only set 0"},
        {"layout(binding = 0) buffer b { int a; } c[2];", "only set 0 and single"},
        {"layout(binding = 0) uniform b { int a; };", "only buffers and acceleration"},
        {"layout(binding = 0, r32f) uniform image2D b; int a = 0;", "only buffers and"},
        {"layout(binding = 3) buffer b { int a; }; layout(binding = 3) buffer d { int e; };",
         "binding 3 is declared twice"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char text[512];
        snprintf(text, sizeof text, "#version 460\n%s\nvoid main() {}\n", wrong[i].declaration);
        write_shader("bind.comp", text);
        struct turner_spirv spirv;
        struct turner_reflection reflection;
        assert_ok(compile(&spirv, "bind.comp", NULL, 0));
        assert_int_equal(turner_reflect(&reflection, &spirv), TURNER_BAD_INPUT);
        assert_message_has(wrong[i].message);
        turner_reflection_destroy(&reflection);
        turner_spirv_destroy(&spirv);
    }
}

static void reflection_finds_all(void **state)
{
    (void)state;
    write_shader("reflect.comp",
                 "#version 460\n"
                 "#extension GL_EXT_ray_query : require\n"
                 "layout(local_size_x = 4, local_size_x_id = 5, local_size_y = 3) in;\n"
                 "layout(constant_id = 1) const bool b = true;\n"
                 "layout(constant_id = 9) const float f = 2;\n"
                 "layout(binding = 6) uniform accelerationStructureEXT top;\n"
                 "layout(binding = 2) buffer out_block { float data[]; };\n"
                 "layout(push_constant) uniform push_block { uvec2 a; vec3 v; uint n; } push;\n"
                 "void main()\n{\n"
                 "    rayQueryEXT query;\n"
                 "    rayQueryInitializeEXT(query, top, 0, 255, vec3(0), 0, vec3(1), 1);\n"
                 "    if (b) data[push.n] = f;\n}\n");
    struct turner_spirv spirv;
    struct turner_reflection reflection;
    assert_ok(compile(&spirv, "reflect.comp", NULL, 0));
    assert_ok(turner_reflect(&reflection, &spirv));
    assert_int_equal(reflection.local_size[0], 4);
    assert_int_equal(reflection.local_size_id[0], 5);
    assert_int_equal(reflection.local_size[1], 3);
    assert_int_equal(reflection.local_size_id[1], UINT32_MAX);
    assert_int_equal(reflection.binding_count, 2);
    assert_int_equal(reflection.bindings[0].binding, 2);
    assert_int_equal(reflection.bindings[0].type, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER);
    assert_int_equal(reflection.bindings[1].binding, 6);
    assert_int_equal(reflection.bindings[1].type, VK_DESCRIPTOR_TYPE_ACCELERATION_STRUCTURE_KHR);
    assert_int_equal(reflection.push_size, 32); /* std430: vec3 at 16, n at 28 */
    uint32_t seen = 0;
    for (size_t i = 0; i < reflection.constant_count; i++)
        seen |= 1u << reflection.constant_ids[i];
    assert_int_equal(seen, 1u << 1 | 1u << 5 | 1u << 9);
    turner_reflection_destroy(&reflection);
    turner_spirv_destroy(&spirv);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_kernel_compiles),
        cmocka_unit_test(defines_reach_the_shader),
        cmocka_unit_test(errors_say_where),
        cmocka_unit_test(a_missing_semicolon_is_explained),
        cmocka_unit_test(many_errors_are_cut),
        cmocka_unit_test(broken_spirv_is_found),
        cmocka_unit_test(what_cannot_be_bound_is_refused),
        cmocka_unit_test(reflection_finds_all),
    };
    return cmocka_run_group_tests(tests, setup, teardown);
}
