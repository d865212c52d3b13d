#include "gpu/param.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "image/image.h"

static const char *const types[] = {
    [TURNER_PARAM_FLOAT] = "float", [TURNER_PARAM_INT] = "int",
    [TURNER_PARAM_BOOL] = "bool",   [TURNER_PARAM_COLOR] = "color",
    [TURNER_PARAM_CHOICE] = "choice", [TURNER_PARAM_MATERIAL] = "material",
};

const char *turner_param_type_name(enum turner_param_type type)
{
    return types[type];
}

uint32_t turner_param_size(const struct turner_param *param)
{
    return param->type == TURNER_PARAM_COLOR ? 3 : 1;
}

/* ---- values ---- */

/* A whole text that is a finite number, also as a float. */
static bool read_number(double *out, const char *text)
{
    char *end;
    *out = strtod(text, &end);
    return end != text && !*end && isfinite((float)*out);
}

static bool read_hex(double out[3], const char *text)
{
    unsigned channel[3];
    if (strlen(text) != 7 || strspn(text + 1, "0123456789abcdefABCDEF") != 6)
        return false;
    sscanf(text + 1, "%2x%2x%2x", &channel[0], &channel[1], &channel[2]);
    for (int i = 0; i < 3; i++)
        out[i] = turner_srgb_to_linear(channel[i] / 255.0);
    return true;
}

static bool read_color(double out[3], const char *text)
{
    char copy[TURNER_PARAM_VALUE], *rest = copy;
    if (*text == '#')
        return read_hex(out, text);
    if (snprintf(copy, sizeof copy, "%s", text) >= (int)sizeof copy)
        return false;
    for (int i = 0; i < 3; i++) {
        char *comma = strchr(rest, ',');
        if (comma)
            *comma = 0;
        if (!read_number(&out[i], rest) || (i == 2 && comma) || (i == 1 && !comma))
            return false;
        if (!comma && i == 0) {
            out[1] = out[2] = out[0];
            return true;
        }
        rest = comma ? comma + 1 : rest;
    }
    return true;
}

static bool read_value(struct turner_param_value *value, const struct turner_param *param,
                       const char *text)
{
    double *number = value->number;
    *value = (struct turner_param_value){0};
    switch (param->type) {
    case TURNER_PARAM_FLOAT: return read_number(number, text);
    case TURNER_PARAM_INT: return read_number(number, text) && number[0] == floor(number[0]);
    case TURNER_PARAM_BOOL:
        number[0] = strcmp(text, "true") == 0;
        return number[0] != 0 || strcmp(text, "false") == 0;
    case TURNER_PARAM_COLOR: return read_color(number, text);
    case TURNER_PARAM_CHOICE:
        for (int i = 0; i < param->choice_count; i++) {
            number[0] = i;
            if (strcmp(param->choices[i], text) == 0)
                return true;
        }
        return false;
    case TURNER_PARAM_MATERIAL:
        return snprintf(value->name, sizeof value->name, "%s", text) < (int)sizeof value->name;
    }
    return false;
}

static bool in_range(const struct turner_param *param, const struct turner_param_value *value)
{
    if (param->type != TURNER_PARAM_FLOAT && param->type != TURNER_PARAM_INT &&
        param->type != TURNER_PARAM_COLOR)
        return true;
    for (uint32_t i = 0; i < turner_param_size(param); i++) {
        if (!(value->number[i] >= param->least && value->number[i] <= param->most))
            return false;
    }
    return true;
}

/* What a parameter takes, for messages. */
static void describe(char text[512], const struct turner_param *param)
{
    int used = 0;
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
        snprintf(text, 512, "a number from %.9g to %.9g", param->least, param->most);
        break;
    case TURNER_PARAM_INT:
        snprintf(text, 512, "a whole number from %.9g to %.9g", param->least, param->most);
        break;
    case TURNER_PARAM_BOOL: snprintf(text, 512, "true or false"); break;
    case TURNER_PARAM_COLOR:
        snprintf(text, 512, "a colour (#rrggbb, or linear r,g,b) with channels from %.9g to %.9g",
                 param->least, param->most);
        break;
    case TURNER_PARAM_CHOICE:
        used = snprintf(text, 512, "one of");
        for (int i = 0; i < param->choice_count && used < 512; i++)
            used += snprintf(text + used, 512 - (size_t)used, "%s %s", i ? "," : "",
                             param->choices[i]);
        break;
    case TURNER_PARAM_MATERIAL: snprintf(text, 512, "a material's name"); break;
    }
}

enum turner_result turner_param_read(struct turner_param_value *value,
                                     const struct turner_param *param, const char *text)
{
    struct turner_param_value read;
    char takes[512];
    if (read_value(&read, param, text) && in_range(param, &read)) {
        *value = read;
        return TURNER_OK;
    }
    describe(takes, param);
    return turner_fail(TURNER_USAGE, "parameter \"%s\" takes %s, not \"%.100s\"", param->name,
                       takes, text);
}

/* With as few digits as say the same number. */
static int print_number(char *text, size_t size, double number)
{
    int length = 0;
    for (int digits = 6; digits <= 17; digits++) {
        length = snprintf(text, size, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
    return length;
}

void turner_param_print(char text[TURNER_PARAM_VALUE], const struct turner_param *param,
                        const struct turner_param_value *value)
{
    const double *n = value->number;
    switch (param->type) {
    case TURNER_PARAM_FLOAT:
    case TURNER_PARAM_INT: print_number(text, TURNER_PARAM_VALUE, n[0]); break;
    case TURNER_PARAM_BOOL:
        snprintf(text, TURNER_PARAM_VALUE, "%s", n[0] != 0 ? "true" : "false");
        break;
    case TURNER_PARAM_COLOR:
        for (size_t i = 0, used = 0; i < 3; i++) {
            used += (size_t)print_number(text + used, TURNER_PARAM_VALUE - used, n[i]);
            if (i < 2)
                text[used++] = ',';
        }
        break;
    case TURNER_PARAM_CHOICE:
        snprintf(text, TURNER_PARAM_VALUE, "%s", param->choices[(int)n[0]]);
        break;
    case TURNER_PARAM_MATERIAL: snprintf(text, TURNER_PARAM_VALUE, "%s", value->name); break;
    }
}

/* ---- lists ---- */

const struct turner_param *turner_params_get(const struct turner_params *params, const char *name)
{
    for (size_t i = 0; i < params->count; i++) {
        if (strcmp(params->at[i].name, name) == 0)
            return &params->at[i];
    }
    return NULL;
}

void turner_params_destroy(struct turner_params *params)
{
    free(params->at);
    *params = (struct turner_params){0};
}
