/* One page with everything. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/stability.h"

static const char head[] =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width\">\n<title>turner: stability</title>\n"
    "<style>\n"
    "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}\n"
    "h2{margin-top:2.5em;border-bottom:1px solid #bbb}h3{margin-top:2em}\n"
    "table{border-collapse:collapse;font-size:14px;display:block;overflow-x:auto}\n"
    "td,th{border:1px solid #ccc;padding:.25em .6em;text-align:right}\n"
    "td:first-child,th:first-child{text-align:left}\n"
    ".holds{background:#e3f3e3}.fails{background:#f9dcd8}.surprise{font-weight:bold;color:#a00}\n"
    "img{max-width:100%}p.small{font-size:14px;color:#555;margin:.3em 0}\n"
    "</style></head><body>\n<h1>Stability</h1>\n";

static void print_escaped(FILE *out, const char *text)
{
    for (; *text; text++) {
        if (*text == '<' || *text == '>' || *text == '&')
            fprintf(out, "&#%d;", *text);
        else
            fputc(*text, out);
    }
}

static void print_table(FILE *out, const struct turner_stability_row *row)
{
    const struct turner_sweep *sweep = row->sweep;
    fputs("<table><tr><th>", out);
    print_escaped(out, sweep->parameter);
    for (int m = 0; m < turner_sweep_method_count(sweep); m++) {
        fputs("</th><th>", out);
        print_escaped(out, sweep->methods[m].name);
    }
    fputs("</th><th>bound</th></tr>\n", out);
    for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
        char text[64];
        turner_sweep_value_text(text, sweep, i);
        fputs("<tr><td>", out);
        print_escaped(out, text);
        for (int m = 0; m < turner_sweep_method_count(sweep); m++) {
            const struct turner_stability_cell *cell = &row->cells[m][i];
            if (!cell->asked || isnan(cell->error))
                fputs("</td><td>", out);
            else
                fprintf(out, "</td><td class=\"%s\">%.3g",
                        turner_stability_holds(cell) ? "holds" : "fails", cell->error);
        }
        if (row->cells[0][i].asked)
            fprintf(out, "</td><td>%.3g</td></tr>\n", row->cells[0][i].bound);
        else
            fputs("</td><td></td></tr>\n", out);
    }
    fputs("</table>\n", out);
}

static void print_verdicts(FILE *out, const struct turner_stability_row *row)
{
    const struct turner_sweep *sweep = row->sweep;
    fputs("<ul>\n", out);
    for (int m = 0; m < turner_sweep_method_count(sweep); m++) {
        struct turner_stability_verdict verdict = turner_stability_judge(row, m);
        fprintf(out, "<li%s><b>", verdict.expected ? "" : " class=\"surprise\"");
        print_escaped(out, sweep->methods[m].name);
        fputs("</b> ", out);
        print_escaped(out, verdict.text);
        if (sweep->methods[m].note && strncmp(verdict.text, "fails", 5) == 0) {
            fputs(": ", out);
            print_escaped(out, sweep->methods[m].note);
        }
        fputs("</li>\n", out);
    }
    fputs("</ul>\n", out);
}

static bool has_picture(const char *folder, const char *name)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.png", folder, name);
    FILE *file = fopen(path, "rb");
    if (file)
        fclose(file);
    return file != NULL;
}

static void print_row(FILE *out, const struct turner_stability_row *row, const char *folder)
{
    const struct turner_sweep *sweep = row->sweep;
    fprintf(out, "<h3 id=\"%s\">", sweep->name);
    print_escaped(out, sweep->question);
    fputs("</h3>\n", out);
    print_verdicts(out, row);
    if (has_picture(folder, sweep->name))
        fprintf(out, "<p><img src=\"%s.png\" alt=\"%s against %s\"></p>\n", sweep->name,
                sweep->unit_of_error, sweep->parameter);
    fprintf(out, "<p class=\"small\">%s: ", sweep->name);
    print_escaped(out, sweep->unit_of_error);
    fputs(". Holds within ", out);
    print_escaped(out, sweep->bound_words);
    fputs(".</p>\n", out);
    print_table(out, row);
    if (sweep->published) {
        fputs("<p class=\"small\">Published: ", out);
        print_escaped(out, sweep->published);
        fputs("</p>\n", out);
    }
}

enum turner_result turner_stability_write_html(const struct turner_stability_report *report,
                                               const char *folder)
{
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    const char *section = "";
    if (!out)
        return turner_fail(TURNER_OUTPUT, "no memory for the page");
    fputs(head, out);
    fprintf(out, "<p>turner %s on ", turner_version());
    print_escaped(out, report->device);
    fputs(" (", out);
    print_escaped(out, report->driver);
    fputs("). Each method against the reference tracer in extended precision; green is within the "
          "bound. Defaults come first; the methods that fail stay because they teach.</p>\n", out);
    for (size_t i = 0; i < report->count; i++) {
        if (strcmp(section, report->rows[i].sweep->section) != 0) {
            section = report->rows[i].sweep->section;
            fputs("<h2>", out);
            print_escaped(out, section);
            fputs("</h2>\n", out);
        }
        print_row(out, &report->rows[i], folder);
    }
    fputs("</body></html>\n", out);
    fclose(out);
    enum turner_result result = turner_stability_write_file(folder, "index.html", text);
    free(text);
    return result;
}
