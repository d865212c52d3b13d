/* Parameters of shaders. A line of a shader declares one:
 *     //!PARAM name [const] float|int default least most "text"
 *     //!PARAM name [const] bool true|false "text"
 *     //!PARAM name [const] color default [least most] "text"     0 to 1 unless it says otherwise
 *     //!PARAM name [const] choice word word|word|… "text"        the default, then all
 *     //!PARAM name material "its name" "text"                    a material of the scene
 * and the scene or the command line gives it another value, as text:
 *     0.25    3    true    #rrggbb (sRGB) or 1,0.5,0 (linear) or 0.5    word    name
 * What is declared stands in the shader as a variable from that line on: float, int, bool, vec3
 * (linear), int (the word's place from 0, and constants name_word), uint (the material's place in
 * the scene; TURNER_NO_INDEX where it has none of that name). docs/shaders.md */
#ifndef TURNER_GPU_PARAM_H
#define TURNER_GPU_PARAM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/result.h"

#define TURNER_PARAM_NAME 48   /* bytes of a name, with the zero */
#define TURNER_PARAM_TEXT 160  /* of the text for people */
#define TURNER_PARAM_VALUE 128 /* of a value as text */
#define TURNER_PARAM_WORDS 192 /* 32-bit words of all values of a kernel; a colour takes three */
#define TURNER_PARAM_CHOICES 16

enum turner_param_type {
    TURNER_PARAM_FLOAT,
    TURNER_PARAM_INT,
    TURNER_PARAM_BOOL,
    TURNER_PARAM_COLOR,
    TURNER_PARAM_CHOICE,
    TURNER_PARAM_MATERIAL
};

struct turner_param_value {
    double number[3]; /* bool 0, 1; choice: the place of the word; a colour is linear */
    char name[TURNER_PARAM_VALUE]; /* of the material */
};

struct turner_param {
    char name[TURNER_PARAM_NAME];
    enum turner_param_type type;
    bool constant; /* specialises the kernel: another value makes another one. Else it is live */
    struct turner_param_value standard;
    double least, most; /* float, int, color: of each channel */
    char choices[TURNER_PARAM_CHOICES][TURNER_PARAM_NAME];
    int choice_count;
    char text[TURNER_PARAM_TEXT];
    uint32_t word;      /* its place among the values, in 32-bit words */
    char file[256];     /* where it is declared, "path" and line */
    int line;
};

struct turner_params {
    struct turner_param *at;
    size_t count, capacity;
};

/* Whether a line declares one: it starts with //!PARAM, spaces before it do not count. */
bool turner_param_is_line(const char *line, size_t length);

/* Reads such a line; name, file, line and word of the place are the caller's. TURNER_BAD_INPUT with
 * "column: message" in bytes from 1. */
enum turner_result turner_param_parse(struct turner_param *param, const char *line, size_t length);

/* Appends to `text` (of `size` bytes) the declaration in GLSL, one line without its end. */
void turner_param_glsl(char *text, size_t size, const struct turner_param *param);

/* "float", "int" … */
const char *turner_param_type_name(enum turner_param_type type);

/* Words a value takes: 3 or 1. */
uint32_t turner_param_size(const struct turner_param *param);

/* Reads a value. TURNER_USAGE with the type and the range. */
enum turner_result turner_param_read(struct turner_param_value *value,
                                     const struct turner_param *param, const char *text);
/* The other way round: what turner_param_read takes for the same value. */
void turner_param_print(char text[TURNER_PARAM_VALUE], const struct turner_param *param,
                        const struct turner_param_value *value);

const struct turner_param *turner_params_get(const struct turner_params *params, const char *name);
void turner_params_destroy(struct turner_params *params);

#endif
