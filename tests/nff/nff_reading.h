/* What the tests of the NFF reader share. */
#ifndef TURNER_TESTS_NFF_READING_H
#define TURNER_TESTS_NFF_READING_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "scene/readers.h"

#define VIEW "v from 1 2 3 at 0 0 0 up 0 0 1 angle 45 hither 1 resolution 20 10\n"

/* The scene in `text`, or NULL with the message. The text is handed over without a NUL behind it,
 * in memory of its own, so that a sanitizer sees the reader go too far. */
static inline struct turner_scene *read_nff(const char *text)
{
    size_t length = strlen(text);
    char *copy = malloc(length ? length : 1);
    if (!copy)
        abort();
    memcpy(copy, text, length);
    struct turner_scene *scene = turner_scene_create();
    if (turner_scene_read_nff(scene, copy, length, "test.nff") != TURNER_OK) {
        turner_scene_destroy(scene);
        scene = NULL;
    }
    free(copy);
    return scene;
}

/* The file's text, ended by NUL, to be freed; NULL when there is none. */
static inline char *file_text(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    fseek(file, 0, SEEK_END);
    size_t size = (size_t)ftell(file);
    rewind(file);
    char *text = malloc(size + 1);
    if (!text || fread(text, 1, size, file) != size)
        abort();
    text[size] = '\0';
    fclose(file);
    return text;
}

/* Sends stderr to a file until caught_end, which returns what came, to be freed. */
struct caught {
    FILE *file;
    int saved;
};

static inline struct caught caught_begin(void)
{
    struct caught caught = {tmpfile(), dup(STDERR_FILENO)};
    fflush(stderr);
    if (!caught.file || dup2(fileno(caught.file), STDERR_FILENO) < 0)
        abort();
    return caught;
}

static inline char *caught_end(struct caught *caught)
{
    fflush(stderr);
    dup2(caught->saved, STDERR_FILENO);
    close(caught->saved);
    fseek(caught->file, 0, SEEK_END);
    size_t size = (size_t)ftell(caught->file);
    rewind(caught->file);
    char *text = calloc(size + 1, 1);
    if (!text || fread(text, 1, size, caught->file) != size)
        abort();
    fclose(caught->file);
    return text;
}

#endif
