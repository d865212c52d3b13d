/* //!PARAM lines: what is read from them, where they are wrong, and what stands in the shader. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "gpu/include.h"
#include "gpu/param.h"

static struct turner_param parse(const char *line)
{
    struct turner_param param;
    enum turner_result result = turner_param_parse(&param, line, strlen(line));
    if (result != TURNER_OK)
        fail_msg("%s: %s", line, turner_message());
    return param;
}

static void expect_glsl(const struct turner_param *param, const char *expected)
{
    char text[2048];
    turner_param_glsl(text, sizeof text, param);
    assert_string_equal(text, expected);
}

static void reads_each_type(void **state)
{
    (void)state;
    struct turner_param p = parse("  //!PARAM scale float 0.5 -1e-3 8 \"how large\"\r");
    assert_string_equal(p.name, "scale");
    assert_int_equal(p.type, TURNER_PARAM_FLOAT);
    assert_false(p.constant);
    assert_true(p.standard.number[0] == 0.5 && p.least == -1e-3 && p.most == 8);
    assert_string_equal(p.text, "how large");
    p.word = 7;
    expect_glsl(&p, "float scale = turner_param_float(7);");

    p = parse("//!PARAM n const int -3 -10 2147483647 \"\"");
    assert_true(p.constant && p.type == TURNER_PARAM_INT && p.standard.number[0] == -3);
    expect_glsl(&p, "layout(constant_id = TURNER_CONSTANT_PARAMS + 0) const int n = -3;");

    p = parse("//!PARAM on bool true \"x\"");
    assert_true(p.type == TURNER_PARAM_BOOL && p.standard.number[0] == 1);
    expect_glsl(&p, "bool on = turner_param_int(0) != 0;");

    p = parse("//!PARAM c color #ff8000 \"x\"");
    assert_true(p.standard.number[0] == 1 && p.standard.number[2] == 0);
    assert_true(p.standard.number[1] > 0.2158 && p.standard.number[1] < 0.2159); /* IEC 61966-2-1 */
    assert_true(p.least == 0 && p.most == 1);
    p = parse("//!PARAM c const color 0.25,2,3 0 10 \"x\"");
    assert_true(p.standard.number[0] == 0.25 && p.standard.number[2] == 3 && p.most == 10);
    p = parse("//!PARAM c color 0.25 \"x\"");
    assert_true(p.standard.number[0] == 0.25 && p.standard.number[2] == 0.25);
    assert_int_equal(turner_param_size(&p), 3);

    p = parse("//!PARAM kind choice b a|b|c_2 \"x\"");
    assert_int_equal(p.choice_count, 3);
    assert_true(p.standard.number[0] == 1);
    expect_glsl(&p, "const int kind_a = 0; const int kind_b = 1; const int kind_c_2 = 2; "
                    "int kind = turner_param_int(0);");

    p = parse("//!PARAM stone material \"green glass\" \"x\"");
    assert_string_equal(p.standard.name, "green glass");
    expect_glsl(&p, "uint stone = uint(turner_param_int(0));");
}

static void says_where_lines_are_wrong(void **state)
{
    (void)state;
    static const struct {
        const char *line;
        int column;
        const char *words;
    } wrong[] = {
        {"//!PARAM", 9, "name is missing"},
        {"//!PARAM 2x float 1 0 2 \"x\"", 10, "cannot be a name"},
        {"//!PARAM gl_x float 1 0 2 \"x\"", 10, "cannot be a name"},
        {"//!PARAM a__b float 1 0 2 \"x\"", 10, "cannot be a name"},
        {"//!PARAM x", 11, "type is missing"},
        {"//!PARAM x vec3 1 0 2 \"x\"", 12, "no type"},
        {"//!PARAM x const", 17, "type is missing"},
        {"//!PARAM x float", 17, "default is missing"},
        {"//!PARAM x float one 0 2 \"x\"", 18, "not \"one\""},
        {"//!PARAM x float 1 zero 2 \"x\"", 20, "least value must be a number"},
        {"//!PARAM x float nan 0 2 \"x\"", 18, "not \"nan\""},
        {"//!PARAM x float 1 0 1e99 \"x\"", 22, "the most must be a number"},
        {"//!PARAM x float 1 3 2 \"x\"", 22, "less than the least"},
        {"//!PARAM x float 3 0 2 \"x\"", 18, "from 0 to 2"},
        {"//!PARAM x int 1.5 0 2 \"x\"", 16, "whole number"},
        {"//!PARAM x int 1 0 2147483648 \"x\"", 20, "whole number"},
        {"//!PARAM x bool yes \"x\"", 17, "true or false"},
        {"//!PARAM x color #12345 \"x\"", 18, "a colour"},
        {"//!PARAM x color 1,2 \"x\"", 18, "a colour"},
        {"//!PARAM x color 1,2,3,4 \"x\"", 18, "a colour"},
        {"//!PARAM x color 2 \"x\"", 18, "from 0 to 1"},
        {"//!PARAM x choice d a|b \"x\"", 19, "one of a, b"},
        {"//!PARAM x choice a a|a \"x\"", 21, "twice"},
        {"//!PARAM x choice a a||b \"x\"", 21, "cannot be a choice"},
        {"//!PARAM x const material a \"x\"", 18, "cannot be const"},
        {"//!PARAM x bool true", 21, "text in quotes is missing"},
        {"//!PARAM x bool true \"x", 22, "closing quote"},
        {"//!PARAM x bool true \"x\" y", 26, "nothing may follow"},
        {"//!PARAM x float 1 0 2 3 \"x\"", 24, "text in quotes is missing"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct turner_param param;
        int column = 0;
        assert_int_equal(turner_param_parse(&param, wrong[i].line, strlen(wrong[i].line)),
                         TURNER_BAD_INPUT);
        sscanf(turner_message(), "%d:", &column);
        if (column != wrong[i].column || !strstr(turner_message(), wrong[i].words))
            fail_msg("%s: %s", wrong[i].line, turner_message());
    }
}

static void bounds_what_is_long(void **state)
{
    (void)state;
    char line[1200] = "//!PARAM ";
    struct turner_param param;
    memset(line + 9, 'a', 60);
    strcpy(line + 69, " bool true \"x\"");
    assert_int_equal(turner_param_parse(&param, line, strlen(line)), TURNER_BAD_INPUT);
    memset(line + 9, 'a', 1000);
    line[1009] = 0;
    assert_int_equal(turner_param_parse(&param, line, strlen(line)), TURNER_BAD_INPUT);
    strcpy(line, "//!PARAM x choice a a");
    for (int i = 0; i < 16; i++)
        sprintf(line + strlen(line), "|w%d", i);
    assert_int_equal(turner_param_parse(&param, line, strlen(line)), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "more than 16"));
}

static void values_print_as_they_are_read(void **state)
{
    (void)state;
    static const struct {
        const char *line, *value, *printed; /* NULL: refused */
    } values[] = {
        {"//!PARAM x float 1 0 2 \"\"", "0.1", "0.1"},
        {"//!PARAM x float 1 0 2 \"\"", "2.0000001", NULL},
        {"//!PARAM x float 1 0 2 \"\"", "0.1x", NULL},
        {"//!PARAM x float 1 0 2 \"\"", "", NULL},
        {"//!PARAM x float 1 0 2 \"\"", "0.30000000000000004", "0.30000000000000004"},
        {"//!PARAM x int 1 0 2000000001 \"\"", "2000000001", "2000000001"},
        {"//!PARAM x int 1 0 20 \"\"", "1e1", "10"},
        {"//!PARAM x bool true \"\"", "false", "false"},
        {"//!PARAM x bool true \"\"", "0", NULL},
        {"//!PARAM x color 1 \"\"", "#000000", "0,0,0"},
        {"//!PARAM x color 1 \"\"", "0.5,0.25,1", "0.5,0.25,1"},
        {"//!PARAM x color 1 \"\"", "0.5,-0.25,1", NULL},
        {"//!PARAM x color 1 \"\"", "#00000g", NULL},
        {"//!PARAM x choice a a|b \"\"", "b", "b"},
        {"//!PARAM x choice a a|b \"\"", "1", NULL},
        {"//!PARAM x material a \"\"", "any thing", "any thing"},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        struct turner_param param = parse(values[i].line);
        struct turner_param_value value;
        char text[TURNER_PARAM_VALUE];
        enum turner_result result = turner_param_read(&value, &param, values[i].value);
        assert_int_equal(result, values[i].printed ? TURNER_OK : TURNER_USAGE);
        if (!values[i].printed)
            continue;
        turner_param_print(text, &param, &value);
        assert_string_equal(text, values[i].printed);
    }
}

static enum turner_result expand(struct turner_shader_source *source, const char *text)
{
    return turner_shader_source_from_text(source, "own.glsl", text, NULL, 0);
}

static void stands_in_the_shader(void **state)
{
    (void)state;
    struct turner_shader_source source;
    assert_int_equal(expand(&source, "int a;\n"
                                     "//!PARAM c color 0 \"\"\n"
                                     "/*\n//!PARAM hidden bool true \"\"\n*/\n"
                                     "// //!PARAM comment bool true \"\"\n"
                                     "//!PARAMETERS are none\n"
                                     "\t//!PARAM x float 1 0 2 \"\"\nint b;\n"), TURNER_OK);
    assert_int_equal(source.params.count, 2);
    assert_int_equal(source.param_words, 4);
    assert_string_equal(source.params.at[1].name, "x");
    assert_string_equal(source.params.at[1].file, "own.glsl");
    assert_int_equal(source.params.at[1].line, 8);
    assert_int_equal(source.params.at[1].word, 3);
    assert_non_null(strstr(source.text, "\nvec3 c = turner_param_color(0);\n/*\n"));
    assert_non_null(strstr(source.text, "none\nfloat x = turner_param_float(3);\nint b;\n"));
    turner_shader_source_destroy(&source);

    assert_int_equal(expand(&source, "//!PARAM x bool true \"\"\n//!PARAM x int 1 0 2 \"\"\n"),
                     TURNER_BAD_INPUT);
    assert_string_equal(turner_message(),
                        "own.glsl:2:1: parameter \"x\" is declared before, in own.glsl:1");
    turner_shader_source_destroy(&source);
    assert_int_equal(expand(&source, "\n//!PARAM x bool yes \"\"\n"), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "own.glsl:2:17: parameter \"x\" takes true"));
    turner_shader_source_destroy(&source);
    assert_int_equal(expand(&source, "//!PARAM x bool true \"\" \\\nint a;\n"), TURNER_BAD_INPUT);
    turner_shader_source_destroy(&source);

    char many[8192] = "";
    for (int i = 0; i < TURNER_PARAM_WORDS / 3 + 1; i++)
        sprintf(many + strlen(many), "//!PARAM c%d color 1 \"\"\n", i);
    assert_int_equal(expand(&source, many), TURNER_BAD_INPUT);
    assert_non_null(strstr(turner_message(), "more than 192 numbers"));
    turner_shader_source_destroy(&source);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_each_type),
        cmocka_unit_test(says_where_lines_are_wrong),
        cmocka_unit_test(bounds_what_is_long),
        cmocka_unit_test(values_print_as_they_are_read),
        cmocka_unit_test(stands_in_the_shader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
