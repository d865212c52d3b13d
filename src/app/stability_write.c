/* The figures as CSV and JSON. */
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/stability.h"
#include "image/atomic.h"

enum turner_result turner_stability_write_file(const char *folder, const char *name,
                                               const char *text)
{
    char path[4096];
    if ((size_t)snprintf(path, sizeof path, "%s/%s", folder, name) >= sizeof path)
        return turner_fail(TURNER_OUTPUT, "the name of the folder \"%s\" is too long", folder);
    return turner_atomic_write(path, text, strlen(text));
}

static void print_csv(FILE *out, const struct turner_stability_row *row)
{
    const struct turner_sweep *sweep = row->sweep;
    for (int m = 0; m < turner_sweep_method_count(sweep); m++) {
        for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
            const struct turner_stability_cell *cell = &row->cells[m][i];
            char text[64];
            if (!cell->asked)
                continue;
            turner_sweep_value_text(text, sweep, i);
            fprintf(out, "%s,\"%s\",\"%s\",\"%s\",", sweep->name, sweep->parameter, text,
                    sweep->methods[m].name);
            if (isnan(cell->error))
                fprintf(out, ",%.6g,%.6g,\n", cell->bound, cell->limit);
            else
                fprintf(out, "%.6g,%.6g,%.6g,%s\n", cell->error, cell->bound, cell->limit,
                        turner_stability_holds(cell) ? "holds" : "fails");
        }
    }
}

/* null where there is nothing to say */
static cJSON *cell_number(const struct turner_stability_cell *cell, double x)
{
    return cell->asked && isfinite(x) ? cJSON_CreateNumber(x) : cJSON_CreateNull();
}

static cJSON *method_json(const struct turner_stability_row *row, int m)
{
    const struct turner_sweep *sweep = row->sweep;
    struct turner_stability_verdict verdict = turner_stability_judge(row, m);
    cJSON *object = cJSON_CreateObject(), *errors = cJSON_CreateArray();
    cJSON_AddStringToObject(object, "name", sweep->methods[m].name);
    if (sweep->methods[m].assign)
        cJSON_AddStringToObject(object, "methods", sweep->methods[m].assign);
    for (int i = 0; i < turner_sweep_value_count(sweep); i++)
        cJSON_AddItemToArray(errors, cell_number(&row->cells[m][i], row->cells[m][i].error));
    cJSON_AddItemToObject(object, "errors", errors);
    cJSON_AddStringToObject(object, "verdict", verdict.text);
    cJSON_AddBoolToObject(object, "as_expected", verdict.expected);
    if (sweep->methods[m].note)
        cJSON_AddStringToObject(object, "note", sweep->methods[m].note);
    return object;
}

static cJSON *row_json(const struct turner_stability_row *row)
{
    const struct turner_sweep *sweep = row->sweep;
    cJSON *object = cJSON_CreateObject(), *values = cJSON_CreateArray();
    cJSON *bounds = cJSON_CreateArray(), *limits = cJSON_CreateArray();
    cJSON_AddStringToObject(object, "name", sweep->name);
    cJSON_AddStringToObject(object, "section", sweep->section);
    cJSON_AddStringToObject(object, "question", sweep->question);
    cJSON_AddStringToObject(object, "parameter", sweep->parameter);
    cJSON_AddStringToObject(object, "error", sweep->unit_of_error);
    cJSON_AddStringToObject(object, "bound", sweep->bound_words);
    if (sweep->published)
        cJSON_AddStringToObject(object, "published", sweep->published);
    for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
        const struct turner_stability_cell *cell = &row->cells[0][i];
        cJSON_AddItemToArray(values, sweep->labels ? cJSON_CreateString(sweep->labels[i])
                                                   : cJSON_CreateNumber(sweep->values[i]));
        cJSON_AddItemToArray(bounds, cell_number(cell, cell->bound));
        cJSON_AddItemToArray(limits, cell_number(cell, cell->limit));
    }
    cJSON_AddItemToObject(object, "values", values);
    cJSON_AddItemToObject(object, "bounds", bounds);
    cJSON_AddItemToObject(object, "limits", limits);
    cJSON *methods = cJSON_AddArrayToObject(object, "methods");
    for (int m = 0; m < turner_sweep_method_count(sweep); m++)
        cJSON_AddItemToArray(methods, method_json(row, m));
    return object;
}

static enum turner_result write_json(const struct turner_stability_report *report,
                                     const char *folder)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", turner_version());
    cJSON_AddStringToObject(root, "device", report->device);
    cJSON_AddStringToObject(root, "driver", report->driver);
    cJSON *sweeps = cJSON_AddArrayToObject(root, "sweeps");
    for (size_t i = 0; i < report->count; i++)
        cJSON_AddItemToArray(sweeps, row_json(&report->rows[i]));
    char *text = cJSON_Print(root);
    enum turner_result result = turner_stability_write_file(folder, "stability.json", text);
    cJSON_free(text);
    cJSON_Delete(root);
    return result;
}

enum turner_result turner_stability_write(const struct turner_stability_report *report,
                                          const char *folder)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out)
        return turner_fail(TURNER_OUTPUT, "no memory for the table");
    fprintf(out, "sweep,parameter,value,method,error,bound,limit,verdict\n");
    for (size_t i = 0; i < report->count; i++)
        print_csv(out, &report->rows[i]);
    fclose(out);
    enum turner_result result = turner_stability_write_file(folder, "stability.csv", text);
    free(text);
    return result == TURNER_OK ? write_json(report, folder) : result;
}
