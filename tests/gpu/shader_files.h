/* A temporary folder of shader files for one test. */
#ifndef TURNER_TESTS_SHADER_FILES_H
#define TURNER_TESTS_SHADER_FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char shader_folder[512];

/* Makes an empty folder inside the build tree; `name` keeps tests apart. */
static inline void make_shader_folder(const char *name)
{
    mkdir(TURNER_BINARY_DIR "/tests", 0777);
    mkdir(TURNER_BINARY_DIR "/tests/gpu", 0777);
    snprintf(shader_folder, sizeof shader_folder, "%s/tests/gpu/%s-XXXXXX", TURNER_BINARY_DIR,
             name);
    if (!mkdtemp(shader_folder)) {
        perror(shader_folder);
        exit(1);
    }
}

static inline void remove_shader_folder(void)
{
    char command[600];
    snprintf(command, sizeof command, "rm -rf '%s'", shader_folder);
    if (system(command) != 0)
        exit(1);
}

static inline void write_shader_bytes(const char *name, const char *text, size_t length)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", shader_folder, name);
    for (char *slash = strchr(path + strlen(shader_folder) + 1, '/'); slash;
         slash = strchr(slash + 1, '/')) {
        *slash = 0;
        mkdir(path, 0777);
        *slash = '/';
    }
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(text, 1, length, file) != length || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

static inline void write_shader(const char *name, const char *text)
{
    write_shader_bytes(name, text, strlen(text));
}

#endif
