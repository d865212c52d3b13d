/* The lines that note down rays are not in a kernel that does not: its SPIR-V is, to the word, that
 * of the shaders without them. No device. */
#include "explain_test.h"

#include <stdlib.h>

#include "gpu/compiler.h"

static void must(enum turner_result result)
{
    if (result != TURNER_OK)
        fail_msg("%s", turner_message());
}

/* Blanks out each "RECORD(…);" but those of the macro's definition; how many there were. */
static int blank_records(char *text)
{
    int count = 0;
    for (char *at = text; (at = strstr(at, "RECORD(")); ) {
        if (at > text && at[-1] != ' ') {
            at++;
            continue; /* part of a longer word */
        }
        if (at >= text + 8 && strncmp(at - 8, "#define ", 8) == 0) {
            at++;
            continue;
        }
        char *end = strchr(at, ';');
        assert_non_null(end);
        memset(at, ' ', (size_t)(end + 1 - at));
        count++;
    }
    return count;
}

static void leaves_no_trace(void **state)
{
    (void)state;
    const char *const folders[] = {TURNER_SOURCE_DIR "/shaders"};
    static const char *const defines[] = {"TURNER_F64", "TURNER_RECORD"};
    for (int f64 = 0; f64 < 2; f64++) {
        struct turner_shader_source source;
        struct turner_spirv with, without, recording;
        must(turner_shader_source_create(&source, "render.comp", folders, 1));
        must(turner_compile(&with, &source, defines, (size_t)f64));
        must(turner_compile(&recording, &source, defines + (1 - f64), (size_t)f64 + 1));
        assert_true(blank_records(source.text) >= 10);
        must(turner_compile(&without, &source, defines, (size_t)f64));
        assert_int_equal(with.count, without.count);
        assert_memory_equal(with.words, without.words, with.count * sizeof *with.words);
        assert_true(recording.count > with.count);
        must(turner_spirv_validate(&recording));
        turner_spirv_destroy(&with);
        turner_spirv_destroy(&without);
        turner_spirv_destroy(&recording);
        turner_shader_source_destroy(&source);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(leaves_no_trace)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
