/* The comparison is worth something: `turner compare`, with the tolerance of the golden tests, tells
 * any two goldens apart and none from itself. Arguments: folder, threshold, pixels.
 * The command's own code runs in this process, since starting it 153 times takes a minute. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>
#include <glob.h>

#include "app/app.h"

static const char *folder, *threshold, *pixels;

static int compare(char *a, char *b)
{
    char t[64], n[64];
    snprintf(t, sizeof t, "--threshold=%s", threshold);
    snprintf(n, sizeof n, "--pixels=%s", pixels);
    char *argv[] = {"compare", t, n, a, b, NULL};
    return (int)turner_cmd_compare(5, argv);
}

static void all_pairs(void **state)
{
    (void)state;
    char pattern[4096];
    glob_t goldens;
    snprintf(pattern, sizeof pattern, "%s/*.png", folder);
    assert_int_equal(glob(pattern, 0, NULL, &goldens), 0);
    assert_true(goldens.gl_pathc >= 2);

    fflush(stdout); /* the reports of the comparisons are not wanted */
    int out = dup(STDOUT_FILENO);
    assert_non_null(freopen("/dev/null", "w", stdout));
    int wrong = 0;
    for (size_t i = 0; i < goldens.gl_pathc; i++) {
        for (size_t k = i; k < goldens.gl_pathc; k++) {
            int expected = i == k ? TURNER_OK : TURNER_DIFFERS;
            int status = compare(goldens.gl_pathv[i], goldens.gl_pathv[k]);
            if (status == expected)
                continue;
            wrong++;
            fprintf(stderr, "%s %s: status %d instead of %d; %s\n", goldens.gl_pathv[i],
                    goldens.gl_pathv[k], status, expected, status ? turner_message() : "");
        }
    }
    fflush(stdout);
    dup2(out, STDOUT_FILENO);
    close(out);
    globfree(&goldens);
    assert_int_equal(wrong, 0);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: %s FOLDER THRESHOLD PIXELS\n", argv[0]);
        return 2;
    }
    folder = argv[1];
    threshold = argv[2];
    pixels = argv[3];
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_pairs)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
