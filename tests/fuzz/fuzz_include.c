/* Any bytes as shader files that include each other. The input is split at lines "---": the first
 * part is expanded, the others are called a, b, c… and stand in for the copies inside the program
 * (the linker's --wrap), so that no file is opened. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "gpu/include.h"

#define FILES 8

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

extern struct turner_embedded_file __wrap_turner_embedded_shaders[];
extern size_t __wrap_turner_embedded_shaders_count;
struct turner_embedded_file __wrap_turner_embedded_shaders[FILES];
size_t __wrap_turner_embedded_shaders_count;

static void require(int condition)
{
    if (!condition)
        abort();
}

/* A failure is wrong input and names a file; success has kept every promise of the header. */
static void check(enum turner_result result, const struct turner_shader_source *source)
{
    if (result != TURNER_OK) {
        require(result == TURNER_BAD_INPUT);
        require(strncmp(turner_message(), "first:", 6) == 0 ||
                strncmp(turner_message(), "built-in/", 9) == 0);
        return;
    }
    require(source->file_count >= 1 && source->file_count <= FILES + 1);
    require(source->length < TURNER_SOURCE_BYTES);
    require(source->length == 0 || strlen(source->text) == source->length);
    for (size_t i = 0; i < source->file_count; i++)
        require(source->files[i].name && source->files[i].path && source->files[i].text);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const names[FILES] = {"a", "b", "c", "d", "e", "f", "g/h", "g/i"};
    static const char separator[] = "\n---\n";
    char *text = calloc(size + 1, 1);
    require(text != NULL);
    memcpy(text, data, size);
    __wrap_turner_embedded_shaders_count = 0;
    for (char *next = text; __wrap_turner_embedded_shaders_count < FILES;) {
        next = strstr(next, separator);
        if (!next)
            break;
        next[1] = 0; /* the newline before it stays */
        next += sizeof separator - 1;
        size_t i = __wrap_turner_embedded_shaders_count++;
        __wrap_turner_embedded_shaders[i] = (struct turner_embedded_file){names[i], next};
    }

    struct turner_shader_source source, again;
    enum turner_result result = turner_shader_source_from_text(&source, "first", text, NULL, 0);
    check(result, &source);
    if (result == TURNER_OK && source.text) {
        /* what came out includes nothing more, so it expands to itself */
        result = turner_shader_source_from_text(&again, "first", source.text, NULL, 0);
        check(result, &again);
        require(result == TURNER_OK && again.file_count == 1);
        require(strcmp(source.text, again.text) == 0);
        turner_shader_source_destroy(&again);
    }
    turner_shader_source_destroy(&source);
    free(text);
    return 0;
}
