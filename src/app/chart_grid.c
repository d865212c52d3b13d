/* The grid file: {"axes": {"aa": ["1", 4], …}, "also": ["aa=4 sphere=textbook", …]}. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/chart.h"
#include "base/memory.h"
#include "scene/json.h"

/* ---- points ---- */

static bool same_settings(const struct turner_settings *a, const struct turner_settings *b)
{
    for (size_t i = 0; i < turner_method_count; i++) {
        char text_a[TURNER_METHOD_TEXT], text_b[TURNER_METHOD_TEXT];
        turner_method_text(text_a, a, turner_methods_list[i].name);
        turner_method_text(text_b, b, turner_methods_list[i].name);
        if (strcmp(text_a, text_b) != 0)
            return false;
    }
    return true;
}

/* The value as a person would write it: 0.004, not 0.0040000000000000001. */
static void shorten(char text[TURNER_METHOD_TEXT])
{
    char *end;
    double value = strtod(text, &end);
    if (end != text && !*end)
        snprintf(text, TURNER_METHOD_TEXT, "%.4g", value);
}

static void add_word(struct turner_chart_point *point, const char *name,
                     char text[TURNER_METHOD_TEXT])
{
    size_t used = strlen(point->label);
    shorten(text);
    snprintf(point->label + used, sizeof point->label - used, "%s%s=%s", used ? " " : "", name,
             text);
}

/* Names the samples, and all in which the point leaves the scene. */
static void make_label(struct turner_chart_point *point, const struct turner_settings *base)
{
    char text[TURNER_METHOD_TEXT], base_text[TURNER_METHOD_TEXT];
    if (point->settings.error == 0) { /* which chooses samples itself */
        turner_method_text(text, &point->settings, "aa");
        add_word(point, "aa", text);
    }
    for (size_t i = 0; i < turner_method_count; i++) {
        const char *name = turner_methods_list[i].name;
        turner_method_text(text, &point->settings, name);
        turner_method_text(base_text, base, name);
        bool departs = strcmp(text, base_text) != 0;
        point->departures += departs;
        if (departs && strcmp(name, "aa") != 0)
            add_word(point, name, text);
    }
}

/* Once each. */
static bool add_point(struct turner_chart *chart, const struct turner_settings *settings)
{
    for (size_t i = 0; i < chart->point_count; i++) {
        if (same_settings(&chart->points[i].settings, settings))
            return true;
    }
    if (chart->point_count == TURNER_CHART_MAX_POINTS)
        return false;
    struct turner_chart_point *point =
        TURNER_PUSH(chart->points, chart->point_count, chart->point_capacity);
    *point = (struct turner_chart_point){.settings = *settings};
    return true;
}

static enum turner_result too_many(const struct json_reader *reader,
                                   const struct json_value *value)
{
    return json_fail(reader, value, "the grid has more than %d points; leave out some values",
                     TURNER_CHART_MAX_POINTS);
}

/* Some settings are wrong only together with the scene, such as a great depth where rays branch. */
static enum turner_result check_point(struct turner_chart *chart,
                                      const struct turner_settings *settings,
                                      const struct json_reader *reader,
                                      const struct json_value *value)
{
    struct turner_scene with = *chart->scene;
    with.settings = *settings;
    if (turner_scene_validate(&with) != TURNER_OK)
        return json_fail_within(reader, value);
    return TURNER_OK;
}

/* ---- the file ---- */

struct axis {
    const char *name;
    struct json_value value;
};

/* A value is a text as --method takes it, or a number. */
static enum turner_result set_value(struct turner_settings *settings, const char *name,
                                    const struct json_reader *reader,
                                    const struct json_value *value)
{
    char number[TURNER_METHOD_TEXT];
    const char *text = number;
    if (cJSON_IsNumber(value->item))
        snprintf(number, sizeof number, "%.17g", value->item->valuedouble);
    else
        TURNER_TRY(json_read_string(&text, reader, value));
    if (turner_method_set(settings, name, text) != TURNER_OK)
        return json_fail_within(reader, value);
    return TURNER_OK;
}

/* Every combination of the values of axes[0 … count), from `settings` on. */
static enum turner_result add_product(struct turner_chart *chart,
                                      const struct turner_settings *settings,
                                      const struct axis *axes, size_t count,
                                      const struct json_reader *reader,
                                      const struct json_value *where)
{
    if (count == 0) {
        TURNER_TRY(check_point(chart, settings, reader, where));
        return add_point(chart, settings) ? TURNER_OK : too_many(reader, where);
    }
    for (struct json_value v = json_first(&axes->value); v.item; v = json_next(v)) {
        struct turner_settings with = *settings;
        TURNER_TRY(set_value(&with, axes->name, reader, &v));
        TURNER_TRY(add_product(chart, &with, axes + 1, count - 1, reader, &v));
    }
    return TURNER_OK;
}

/* json_fail_within, but pointing at the key. */
static enum turner_result fail_key_within(const struct json_reader *reader,
                                          const struct json_value *value)
{
    char message[512];
    snprintf(message, sizeof message, "%s", turner_message());
    return json_fail_key(reader, value, "%s", message);
}

static enum turner_result read_axes(struct turner_chart *chart, const struct json_reader *reader,
                                    const struct json_value *value)
{
    struct json_names names = {.kind = "method"};
    struct axis axes[TURNER_CHART_MAX_METHODS];
    size_t count;
    TURNER_TRY(json_expect_object(&count, reader, value, turner_method_count));
    enum turner_result twice = json_collect_names(&names, reader, value, turner_method_count);
    free(names.sorted);
    TURNER_TRY(twice);
    for (struct json_value v = json_first(value); v.item; v = json_next(v)) {
        const struct turner_method *method;
        size_t values;
        if (turner_method_find(&method, v.item->string) != TURNER_OK)
            return fail_key_within(reader, &v);
        TURNER_TRY(json_expect_list(&values, reader, &v, TURNER_CHART_MAX_POINTS));
        if (values == 0)
            return json_fail(reader, &v, "the list is empty; give at least one value of \"%s\" "
                                         "(%s)", method->name, method->values);
        axes[v.index] = (struct axis){method->name, v};
    }
    return add_product(chart, &chart->scene->settings, axes, count, reader, value);
}

/* "aa=4 sphere=textbook" */
static enum turner_result read_also(struct turner_chart *chart, const struct json_reader *reader,
                                    const struct json_value *value)
{
    struct turner_settings settings = chart->scene->settings;
    const char *text;
    TURNER_TRY(json_read_string(&text, reader, value));
    char *words = turner_strdup(text), *rest = words;
    enum turner_result result = TURNER_OK;
    for (char *word; (word = strtok_r(rest, " ", &rest));) {
        if (turner_method_assign(&settings, word) != TURNER_OK)
            result = json_fail_within(reader, value);
        if (result != TURNER_OK)
            goto done;
    }
    TURNER_TRY_DONE(check_point(chart, &settings, reader, value));
    if (!add_point(chart, &settings))
        result = too_many(reader, value);
done:
    free(words);
    return result;
}

static const struct json_key grid_keys[] = {
    JSON_KEY_ANY("axes", false),
    JSON_KEY_ANY("also", false),
};
static const struct json_table grid_table = JSON_TABLE("a grid", grid_keys);

static enum turner_result read_grid(struct turner_chart *chart, const struct json_reader *reader,
                                    const struct json_value *root)
{
    struct json_object grid;
    TURNER_TRY(json_read_object(&grid, NULL, reader, root, &grid_table));
    const struct json_value *axes = json_member(&grid, "axes"), *also = json_member(&grid, "also");
    if (axes)
        TURNER_TRY(read_axes(chart, reader, axes));
    if (also) {
        size_t count;
        TURNER_TRY(json_expect_list(&count, reader, also, TURNER_CHART_MAX_POINTS));
        for (struct json_value v = json_first(also); v.item; v = json_next(v))
            TURNER_TRY(read_also(chart, reader, &v));
    }
    if (chart->point_count == 0)
        return json_fail(reader, root, "the grid has no points; give \"axes\" or \"also\" (turner "
                                       "chart --help shows both)");
    for (size_t i = 0; i < chart->point_count; i++)
        make_label(&chart->points[i], &chart->scene->settings);
    return TURNER_OK;
}

enum turner_result turner_chart_read_grid(struct turner_chart *chart, const char *text,
                                          size_t length, const char *path)
{
    size_t start, values;
    cJSON *tree = NULL;
    TURNER_TRY(json_check_text(&start, &values, text, length, path));
    TURNER_TRY(json_parse(&tree, text, length, values, path));
    struct json_reader reader = {.text = text, .path = path, .length = length};
    struct json_value root = {.item = tree};
    enum turner_result result = read_grid(chart, &reader, &root);
    cJSON_Delete(tree);
    return result;
}
