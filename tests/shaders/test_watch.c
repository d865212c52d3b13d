/* Files that are watched: what counts as a change, and that none is missed. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/watch.h"

static char folder[64], file[96], other[96];

static void write_file(const char *path, const char *text)
{
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void pause_ms(long ms)
{
    nanosleep(&(struct timespec){.tv_nsec = ms * 1000000}, NULL);
}

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/turner-watch-XXXXXX");
    assert_non_null(mkdtemp(folder));
    snprintf(file, sizeof file, "%s/file", folder);
    snprintf(other, sizeof other, "%s/other", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    unlink(file);
    unlink(other);
    return rmdir(folder);
}

static void sees_each_kind_of_change(void **state)
{
    (void)state;
    struct turner_watch watch = {0};
    write_file(file, "one");
    pause_ms(200);
    turner_watch_add(&watch, file, turner_watch_now());
    turner_watch_add(&watch, file, turner_watch_now());
    turner_watch_add(&watch, other, turner_watch_now()); /* not there */
    assert_int_equal(watch.count, 2);
    assert_false(turner_watch_changed(&watch));
    write_file(file, "two and more");
    assert_true(turner_watch_changed(&watch));
    assert_false(turner_watch_changed(&watch));
    write_file(other, "three");
    assert_true(turner_watch_changed(&watch));
    assert_int_equal(rename(other, file), 0); /* two at once */
    assert_true(turner_watch_changed(&watch));
    assert_false(turner_watch_changed(&watch));
    unlink(file);
    assert_true(turner_watch_changed(&watch));
    assert_false(turner_watch_changed(&watch));
    assert_int_equal(mkdir(other, 0700), 0);
    assert_true(turner_watch_changed(&watch));
    char inside[128];
    snprintf(inside, sizeof inside, "%s/inside", other);
    write_file(inside, "of a folder only whether it is there counts");
    assert_false(turner_watch_changed(&watch));
    unlink(inside);
    rmdir(other);
    assert_true(turner_watch_changed(&watch));
    turner_watch_clear(&watch);
    assert_int_equal(watch.count, 0);
}

/* Each write has the same length, and most the same time as the one before it. */
static void sees_quick_changes(void **state)
{
    (void)state;
    struct turner_watch watch = {0};
    write_file(file, "000");
    turner_watch_add(&watch, file, turner_watch_now());
    while (turner_watch_changed(&watch)) /* it may be taken for changed after `since` */
        pause_ms(10);
    for (int i = 1; i < 300; i++) {
        char text[8];
        snprintf(text, sizeof text, "%03d", i);
        write_file(file, text);
        assert_true(turner_watch_changed(&watch));
    }
    for (int i = 0; i < 20; i++) { /* and then rests */
        pause_ms(10);
        assert_false(turner_watch_changed(&watch));
    }
    turner_watch_clear(&watch);
}

/* What changes between being read and being watched is not missed. */
static void sees_what_changed_before(void **state)
{
    (void)state;
    struct turner_watch watch = {0};
    write_file(file, "read");
    pause_ms(200);
    struct timespec since = turner_watch_now();
    pause_ms(30);
    write_file(file, "late");
    turner_watch_add(&watch, file, since);
    assert_true(turner_watch_changed(&watch));
    assert_false(turner_watch_changed(&watch));
    turner_watch_clear(&watch);
    pause_ms(200);
    turner_watch_add(&watch, file, turner_watch_now());
    assert_false(turner_watch_changed(&watch));
    turner_watch_clear(&watch);
}

static void notes_what_is_read(void **state)
{
    (void)state;
    struct turner_watch watch = {0};
    turner_watch_note("nobody listens");
    turner_watch_reads(&watch, turner_watch_now());
    turner_watch_note(file);
    turner_watch_note(other);
    turner_watch_reads(NULL, turner_watch_now());
    turner_watch_note("nobody listens any more");
    assert_int_equal(watch.count, 2);
    assert_string_equal(watch.files[1].path, other);
    turner_watch_clear(&watch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(sees_each_kind_of_change, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sees_quick_changes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sees_what_changed_before, set_up, tear_down),
        cmocka_unit_test_setup_teardown(notes_what_is_read, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
