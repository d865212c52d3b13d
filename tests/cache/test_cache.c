/* gpu/cache.h: what was stored comes back, and nothing else ever does. */
#include <dirent.h>
#include <fcntl.h>
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

#include "base/memory.h"
#include "base/result.h"
#include "gpu/cache.h"
#include "gpu/fastest.h"

static char folder[64], entries[128];

static void empty(const char *path)
{
    DIR *directory = opendir(path);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        char name[512];
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0)
            remove(name);
    }
    if (directory)
        closedir(directory);
}

static int set_up(void **state)
{
    (void)state;
    strcpy(folder, "/tmp/turner-cache-XXXXXX");
    if (!mkdtemp(folder))
        return -1;
    snprintf(entries, sizeof entries, "%s/shaders", folder);
    return setenv("TURNER_CACHE_DIR", folder, 1);
}

static int tear_down(void **state)
{
    (void)state;
    empty(entries);
    rmdir(entries);
    empty(folder);
    return rmdir(folder);
}

/* The only entry's path. */
static const char *only_entry(void)
{
    static char path[512];
    int count = 0;
    DIR *directory = opendir(entries);
    assert_non_null(directory);
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (entry->d_name[0] == '.')
            continue;
        count++;
        snprintf(path, sizeof path, "%s/%s", entries, entry->d_name);
    }
    closedir(directory);
    assert_int_equal(count, 1);
    return path;
}

static void store(const char *key, const char *content)
{
    turner_cache_store(content, strlen(content), "kind",
                       &(struct turner_cache_part){key, strlen(key)}, 1);
}

static bool found(const char *key, const char *content)
{
    void *bytes = NULL;
    size_t size = 0;
    bool loaded =
        turner_cache_load(&bytes, &size, "kind", &(struct turner_cache_part){key, strlen(key)}, 1);
    if (loaded) {
        assert_int_equal(size, strlen(content));
        assert_memory_equal(bytes, content, size);
        free(bytes);
    }
    return loaded;
}

static uint8_t *read_entry(size_t *size)
{
    FILE *file = fopen(only_entry(), "rb");
    assert_non_null(file);
    uint8_t *bytes = turner_calloc(4096, 1);
    *size = fread(bytes, 1, 4096, file);
    fclose(file);
    assert_true(*size > 0 && *size < 4096);
    return bytes;
}

static void write_entry(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    fclose(file);
}

static void comes_back(void **state)
{
    (void)state;
    assert_false(found("a", "alpha"));
    store("a", "alpha");
    assert_true(found("a", "alpha"));
    assert_false(found("b", "alpha"));
    assert_false(found("aa", "alpha"));
    assert_false(found("", "alpha"));
    store("a", "other");
    assert_true(found("a", "other"));
    /* parts are taken as one, but a kind is a kind */
    const struct turner_cache_part parts[] = {{"x", 1}, {"yz", 2}};
    void *bytes;
    size_t size;
    turner_cache_store("both", 4, "kind", parts, 2);
    assert_true(found("xyz", "both"));
    assert_false(turner_cache_load(&bytes, &size, "sort", parts, 2));
    empty(entries);
    assert_false(found("a", "other"));
}

static void the_fastest_of_a_device(void **state)
{
    (void)state;
    struct turner_gpu_info info = {.name = "a", .driver = "b", .ray_query = true};
    assert_int_equal(turner_fastest_load(&info), TURNER_TRAVERSAL_AUTO);
    turner_fastest_store(&info, TURNER_TRAVERSAL_RAY_QUERY);
    assert_int_equal(turner_fastest_load(&info), TURNER_TRAVERSAL_RAY_QUERY);
    turner_fastest_store(&info, TURNER_TRAVERSAL_BVH_LANE);
    assert_int_equal(turner_fastest_load(&info), TURNER_TRAVERSAL_BVH_LANE);

    struct turner_gpu_info other = info;
    strcpy(other.driver, "c");
    assert_int_equal(turner_fastest_load(&other), TURNER_TRAVERSAL_AUTO);
    turner_fastest_store(&info, TURNER_TRAVERSAL_RAY_QUERY);
    info.ray_query = false; /* no longer */
    assert_int_equal(turner_fastest_load(&info), TURNER_TRAVERSAL_AUTO);
    turner_fastest_store(&info, TURNER_TRAVERSAL_BVH); /* which is none of the three */
    assert_int_equal(turner_fastest_load(&info), TURNER_TRAVERSAL_AUTO);
    empty(entries);
}

static void no_broken_entry_is_used(void **state)
{
    (void)state;
    size_t size;
    store("key", "content");
    uint8_t *whole = read_entry(&size);
    const char *path = only_entry();
    for (size_t length = 0; length < size; length++) {
        write_entry(path, whole, length);
        assert_false(found("key", "content"));
    }
    for (size_t i = 0; i < size; i++) { /* every byte wrong in turn, by one bit */
        whole[i] ^= 1u << i % 8;
        write_entry(path, whole, size);
        assert_false(found("key", "content"));
        whole[i] ^= 1u << i % 8;
    }
    uint8_t *longer = turner_calloc(size + 1, 1);
    memcpy(longer, whole, size);
    write_entry(path, longer, size + 1);
    assert_false(found("key", "content"));
    write_entry(path, whole, size);
    assert_true(found("key", "content"));
    free(longer);
    free(whole);
    empty(entries);
}

/* As if two keys had the same hash. */
static void no_entry_is_taken_for_another(void **state)
{
    (void)state;
    size_t size;
    store("one", "first");
    uint8_t *whole = read_entry(&size);
    empty(entries);
    store("two", "second");
    char path[512];
    snprintf(path, sizeof path, "%s", only_entry());
    write_entry(path, whole, size);
    assert_false(found("two", "second"));
    store("two", "second"); /* replaces it */
    assert_true(found("two", "second"));
    free(whole);
    empty(entries);
}

static void odd_files(void **state)
{
    (void)state;
    store("key", "content");
    char path[512];
    snprintf(path, sizeof path, "%s", only_entry());
    if (geteuid() == 0) { /* somebody else's */
        assert_int_equal(chown(path, 65534, (gid_t)-1), 0);
        assert_false(found("key", "content"));
    }
    remove(path);
    assert_int_equal(mkfifo(path, 0600), 0); /* is not waited for */
    assert_false(found("key", "content"));
    remove(path);
    assert_int_equal(mkdir(path, 0700), 0);
    assert_false(found("key", "content"));
    store("key", "content"); /* cannot be */
    assert_false(found("key", "content"));
    rmdir(path);
    assert_int_equal(symlink("/nowhere/at/all", path), 0);
    assert_false(found("key", "content"));
    empty(entries);
}

static void places_that_cannot_be_written(void **state)
{
    (void)state;
    turner_fail(TURNER_BAD_INPUT, "what was said before");
    char file[128], below[192];
    snprintf(file, sizeof file, "%s/file", folder);
    write_entry(file, "x", 1);
    snprintf(below, sizeof below, "%s/cache", file);
    setenv("TURNER_CACHE_DIR", below, 1);
    store("key", "content");
    assert_false(found("key", "content"));
    setenv("TURNER_CACHE_DIR", "/proc/turner", 1);
    store("key", "content");
    assert_false(found("key", "content"));
    setenv("TURNER_CACHE_DIR", "", 1);
    store("key", "content");
    assert_false(found("key", "content"));
    assert_string_equal(turner_message(), "what was said before");
    setenv("TURNER_CACHE_DIR", folder, 1);
    remove(file);
}

static void where_it_is(void **state)
{
    (void)state;
    char path[PATH_MAX];
    assert_true(turner_cache_folder(path));
    assert_string_equal(path, folder);
    unsetenv("TURNER_CACHE_DIR");
    setenv("XDG_CACHE_HOME", "/xdg", 1);
    setenv("HOME", "/me", 1);
    assert_true(turner_cache_folder(path));
    assert_string_equal(path, "/xdg/turner");
    setenv("XDG_CACHE_HOME", "relative", 1); /* to be ignored, says the specification */
    assert_true(turner_cache_folder(path));
    assert_string_equal(path, "/me/.cache/turner");
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    assert_false(turner_cache_folder(path));
    setenv("TURNER_CACHE_DIR", folder, 1);
}

/* Six of nearly the most an entry may have are more than all may have together. */
static void the_oldest_go(void **state)
{
    (void)state;
    const size_t size = (16u << 20) - 1024;
    char *content = turner_calloc(size, 1);
    for (char name = 'a'; name <= 'f'; name++) {
        turner_cache_store(content, size, "kind", &(struct turner_cache_part){&name, 1}, 1);
        DIR *directory = opendir(entries);
        uint64_t total = 0;
        for (struct dirent *entry; (entry = readdir(directory));) {
            struct stat status;
            if (entry->d_name[0] != '.' &&
                fstatat(dirfd(directory), entry->d_name, &status, 0) == 0)
                total += (uint64_t)status.st_size;
        }
        closedir(directory);
        assert_true(total > 0 && total <= TURNER_CACHE_BYTES);
        nanosleep(&(struct timespec){.tv_nsec = 20000000}, NULL); /* the file system's clock */
    }
    void *bytes;
    size_t got;
    assert_false(turner_cache_load(&bytes, &got, "kind", &(struct turner_cache_part){"a", 1}, 1));
    assert_true(turner_cache_load(&bytes, &got, "kind", &(struct turner_cache_part){"f", 1}, 1));
    assert_int_equal(got, size);
    free(bytes);
    /* one that is too large is not kept at all */
    turner_cache_store(content, size, "kind", &(struct turner_cache_part){content, size}, 1);
    assert_false(
        turner_cache_load(&bytes, &got, "kind", &(struct turner_cache_part){content, size}, 1));
    free(content);
    empty(entries);
}

/* What is used does not go: reading an old entry makes it young again. */
static void use_keeps(void **state)
{
    (void)state;
    store("key", "content");
    const char *path = only_entry();
    struct timespec old[2] = {{.tv_sec = 1000000000}, {.tv_sec = 1000000000}};
    assert_int_equal(utimensat(AT_FDCWD, path, old, 0), 0);
    assert_true(found("key", "content"));
    struct stat status;
    assert_int_equal(stat(path, &status), 0);
    assert_true(time(NULL) - status.st_mtime < 1000);
    empty(entries);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fastest_of_a_device),
        cmocka_unit_test(comes_back),
        cmocka_unit_test(no_broken_entry_is_used),
        cmocka_unit_test(no_entry_is_taken_for_another),
        cmocka_unit_test(odd_files),
        cmocka_unit_test(places_that_cannot_be_written),
        cmocka_unit_test(where_it_is),
        cmocka_unit_test(the_oldest_go),
        cmocka_unit_test(use_keeps),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
