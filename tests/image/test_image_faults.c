/* What a picture file can suffer: the message names the file, the reason and what to do, and nothing
 * half-written stays behind. */
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cmocka.h>

#include "folder.h"
#include "image/image.h"

static const struct turner_image_encoding plain = {.linear = true};

/* Noise, so that no format makes it small: about 48 kB as 8-bit RGB. */
static struct turner_image noise(void)
{
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 128, 128), TURNER_OK);
    uint32_t seed = 1;
    for (int i = 0; i < 128 * 128 * 4; i++) {
        seed = seed * 1664525 + 1013904223;
        image.rgba[i] = (float)(seed >> 8) / 16777216.f;
    }
    return image;
}

static void message_says(const char *what)
{
    if (!strstr(turner_message(), what))
        fail_msg("no \"%s\" in \"%s\"", what, turner_message());
}

static void cannot_write(const struct turner_image *image, const char *path,
                         enum turner_result expected, const char *reason)
{
    assert_int_equal(turner_image_check_writable(path), expected);
    message_says(path);
    message_says(reason);
    assert_int_equal(turner_image_write(image, path, &plain), expected);
    message_says(path);
    message_says(reason);
}

static void wrong_places(void **state)
{
    (void)state;
    struct turner_image image = noise();
    cannot_write(&image, in_folder("a.xyz"), TURNER_USAGE, ".exr");
    cannot_write(&image, in_folder("png"), TURNER_USAGE, ".exr");
    cannot_write(&image, in_folder(".png"), TURNER_USAGE, ".exr");
    cannot_write(&image, in_folder("nowhere/a.png"), TURNER_OUTPUT, "create the folder");
    assert_true(write_bytes(in_folder("file"), "x", 1));
    cannot_write(&image, in_folder("file/a.png"), TURNER_OUTPUT, "Not a directory");
    assert_int_equal(mkdir(in_folder("folder.png"), 0777), 0);
    cannot_write(&image, in_folder("folder.png"), TURNER_OUTPUT, "folder");
    /* replacing a device by a picture would be the end of it */
    assert_int_equal(symlink("/dev/null", in_folder("null.png")), 0);
    cannot_write(&image, in_folder("null.png"), TURNER_OUTPUT, "not an ordinary file");
    /* for root too, nothing can be created there */
    assert_int_equal(turner_image_check_writable("/proc/a.png"), TURNER_OUTPUT);
    assert_int_equal(turner_image_write(&image, "/proc/a.png", &plain), TURNER_OUTPUT);
    char name[300];
    memset(name, 'a', sizeof name);
    strcpy(name + 252, ".png");
    cannot_write(&image, in_folder(name), TURNER_OUTPUT, "shorter name");
    remove(in_folder("file"));
    remove(in_folder("folder.png"));
    remove(in_folder("null.png"));
    assert_int_equal(count_files(folder), 0);
    turner_image_destroy(&image);
}

static void read_only_folder(void **state)
{
    (void)state;
    if (geteuid() == 0) {
        print_message("skipped: folder permissions do not bind root\n");
        skip();
    }
    struct turner_image image = noise();
    assert_int_equal(mkdir(in_folder("closed"), 0555), 0);
    cannot_write(&image, in_folder("closed/a.png"), TURNER_OUTPUT, "may write to");
    assert_int_equal(rmdir(in_folder("closed")), 0);
    turner_image_destroy(&image);
}

static void check_leaves_nothing_and_touches_nothing(void **state)
{
    (void)state;
    assert_int_equal(turner_image_check_writable(in_folder("a.png")), TURNER_OK);
    assert_int_equal(count_files(folder), 0);
    assert_true(write_bytes(in_folder("a.png"), "old", 3));
    assert_int_equal(turner_image_check_writable(in_folder("a.png")), TURNER_OK);
    size_t size;
    char *bytes = read_bytes(in_folder("a.png"), &size);
    assert_string_equal(bytes, "old");
    free(bytes);
    remove(in_folder("a.png"));
}

static void link_is_followed(void **state)
{
    (void)state;
    struct turner_image image = noise();
    assert_true(write_bytes(in_folder("real.png"), "old", 3));
    assert_int_equal(symlink("real.png", in_folder("link.png")), 0);
    assert_int_equal(turner_image_write(&image, in_folder("link.png"), &plain), TURNER_OK);
    struct stat status;
    assert_int_equal(lstat(in_folder("link.png"), &status), 0);
    assert_true(S_ISLNK(status.st_mode));
    assert_int_equal(lstat(in_folder("real.png"), &status), 0);
    assert_true(status.st_size > 3);
    remove(in_folder("link.png"));
    remove(in_folder("real.png"));
    turner_image_destroy(&image);
}

static void full_disk(void **state)
{
    (void)state;
    const char *disk = in_folder("disk");
    assert_int_equal(mkdir(disk, 0777), 0);
    if (mount("tmpfs", disk, "tmpfs", 0, "size=32k") != 0) {
        rmdir(disk);
        print_message("skipped: mounting a small tmpfs needs root\n");
        skip();
    }
    struct turner_image image = noise();
    static const char *const names[] = {"disk/a.exr", "disk/a.hdr", "disk/a.tif",   "disk/a.png",
                                        "disk/a.jpg", "disk/a.ppm", "disk/a.16.png"};
    char messages[7][600];
    enum turner_result results[7];
    int files[7];
    for (int i = 0; i < 7; i++) {
        results[i] = turner_image_write(&image, in_folder(names[i]), &plain);
        strcpy(messages[i], turner_message());
        files[i] = count_files(in_folder("disk"));
    }
    umount(in_folder("disk")); /* before any assertion can leave the test */
    rmdir(in_folder("disk"));
    for (int i = 0; i < 7; i++) {
        assert_int_equal(results[i], TURNER_OUTPUT);
        assert_non_null(strstr(messages[i], names[i]));
        assert_non_null(strstr(messages[i], "No space left on device"));
        assert_non_null(strstr(messages[i], "free some space"));
        assert_int_equal(files[i], 0);
    }
    turner_image_destroy(&image);
}

static void abandon_and_leave(int number)
{
    (void)number;
    turner_image_abandon();
    _exit(130);
}

/* Writes noise over the file "old.png" in a child that gets SIGXFSZ in the middle of the write. */
static int interrupted_write(void (*handler)(int))
{
    assert_true(write_bytes(in_folder("old.png"), "old", 3));
    pid_t child = fork();
    if (child == 0) {
        struct turner_image image = noise();
        struct rlimit limit = {20000, 20000};
        signal(SIGXFSZ, handler);
        setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
        setrlimit(RLIMIT_FSIZE, &limit);
        _exit(turner_image_write(&image, in_folder("old.png"), &plain));
    }
    int status = 0;
    assert_int_equal(waitpid(child, &status, 0), child);
    size_t size;
    char *bytes = read_bytes(in_folder("old.png"), &size);
    assert_non_null(bytes);
    assert_string_equal(bytes, "old"); /* whatever happened */
    free(bytes);
    return status;
}

static void interrupted_and_killed(void **state)
{
    (void)state;
    int status = interrupted_write(SIG_IGN); /* the write fails with EFBIG */
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == TURNER_OUTPUT);
    assert_int_equal(count_files(folder), 1);
    status = interrupted_write(abandon_and_leave);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 130);
    assert_int_equal(count_files(folder), 1);
    status = interrupted_write(SIG_DFL); /* killed: the file aside stays, nothing else */
    assert_true(WIFSIGNALED(status));
    assert_int_equal(count_files(folder), 2);
}

static void cannot_read(const char *path, const char *reason)
{
    struct turner_image image;
    assert_int_equal(turner_image_read(&image, path, true), TURNER_BAD_INPUT);
    turner_image_destroy(&image);
    message_says(path);
    message_says(reason);
}

static void unreadable_files(void **state)
{
    (void)state;
    cannot_read(in_folder("missing.png"), "No such file");
    cannot_read(folder, "not an ordinary file");
    assert_true(write_bytes(in_folder("empty.png"), "", 0));
    cannot_read(in_folder("empty.png"), "");
    assert_true(write_bytes(in_folder("text.exr"), "not a picture", 13));
    cannot_read(in_folder("text.exr"), "");
    /* a plug-in of OpenImageIO would make a black picture out of any such name */
    assert_true(write_bytes(in_folder("a.null"), "", 0));
    cannot_read(in_folder("a.null"), "");
}

static void truncated_files(void **state)
{
    (void)state;
    static const char *const names[] = {"t.exr", "t.hdr", "t.tif", "t.png", "t.16.png", "t.ppm",
                                        "t.jpg"};
    struct turner_image image = noise();
    int wait_status = -1;
    for (size_t n = 0; n < sizeof names / sizeof *names; n++) {
        const char *path = in_folder(names[n]);
        assert_int_equal(turner_image_write(&image, path, &plain), TURNER_OK);
        struct stat status;
        assert_int_equal(stat(path, &status), 0);
        assert_int_equal(truncate(path, status.st_size / 2), 0);
        /* in a child, because OpenImageIO 2.4 leaks a string for each truncated PNG */
        pid_t child = fork();
        if (child == 0) {
            struct turner_image back;
            enum turner_result result = turner_image_read(&back, path, true);
            _exit(result != TURNER_BAD_INPUT || !strstr(turner_message(), path));
        }
        assert_int_equal(waitpid(child, &wait_status, 0), child);
        assert_int_equal(wait_status, 0);
    }
    turner_image_destroy(&image);
}

static void impossible_sizes(void **state)
{
    (void)state;
    struct turner_image image;
    assert_int_equal(turner_image_create(&image, 0, 4), TURNER_USAGE);
    assert_int_equal(turner_image_create(&image, 4, -1), TURNER_USAGE);
    assert_int_equal(turner_image_create(&image, 2147483647, 2147483647), TURNER_DEVICE);
    message_says("2147483647×2147483647");
    assert_null(image.rgba);
    turner_image_destroy(&image);
    /* a header that promises more than there is memory for */
    assert_true(write_bytes(in_folder("huge.ppm"), "P6 2000000000 2000000000 255\n", 29));
    assert_int_not_equal(turner_image_read(&image, in_folder("huge.ppm"), true), TURNER_OK);
    turner_image_destroy(&image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
#define IN_FOLDER(test) cmocka_unit_test_setup_teardown(test, folder_create, folder_destroy)
        IN_FOLDER(wrong_places),
        IN_FOLDER(read_only_folder),
        IN_FOLDER(check_leaves_nothing_and_touches_nothing),
        IN_FOLDER(link_is_followed),
        IN_FOLDER(full_disk),
        IN_FOLDER(interrupted_and_killed),
        IN_FOLDER(unreadable_files),
        IN_FOLDER(truncated_files),
        IN_FOLDER(impossible_sizes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
