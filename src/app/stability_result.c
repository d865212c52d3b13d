/* What the figures of a sweep say. */
#include <stdio.h>
#include <string.h>

#include "app/stability.h"

int turner_sweep_value_count(const struct turner_sweep *sweep)
{
    int count = 0;
    while (sweep->labels ? sweep->labels[count] != NULL
                         : count < TURNER_SWEEP_VALUES && !isnan(sweep->values[count]))
        count++;
    return count;
}

int turner_sweep_method_count(const struct turner_sweep *sweep)
{
    int count = 0;
    while (count < TURNER_SWEEP_METHODS && sweep->methods[count].name)
        count++;
    return count;
}

double turner_sweep_value(const struct turner_sweep *sweep, int i)
{
    return sweep->labels ? i : sweep->values[i];
}

void turner_sweep_value_text(char text[64], const struct turner_sweep *sweep, int i)
{
    if (sweep->labels)
        snprintf(text, 64, "%s", sweep->labels[i]);
    else
        snprintf(text, 64, "%g", sweep->values[i]);
}

enum turner_result turner_stability_measure(struct turner_stability_row *row, int method,
                                            int value, struct turner_stability *s)
{
    const struct turner_sweep *sweep = row->sweep;
    struct turner_stability_cell *cell = &row->cells[method][value];
    double x = turner_sweep_value(sweep, value);
    cell->asked = true;
    cell->error = NAN;
    enum turner_result result =
        sweep->measure(&cell->error, s, sweep, x, &sweep->methods[method]);
    if (result != TURNER_OK)
        return turner_fail_within(result, "%s at %g, %s", sweep->name, x,
                                  sweep->methods[method].name);
    cell->limit = sweep->limit ? sweep->limit(x) : s->truth_sweep == sweep ? s->truth_limit : 0;
    cell->bound = sweep->bound(x, isnan(cell->limit) ? 1 : cell->limit);
    return TURNER_OK;
}

bool turner_stability_holds(const struct turner_stability_cell *cell)
{
    return cell->error <= cell->bound;
}

static void append(char *text, size_t size, const char *more)
{
    strncat(text, more, size - strlen(text) - 1);
}

struct turner_stability_verdict turner_stability_judge(const struct turner_stability_row *row,
                                                       int method)
{
    struct turner_stability_verdict verdict = {.expected = true};
    const struct turner_sweep *sweep = row->sweep;
    const struct turner_sweep_method *m = &sweep->methods[method];
    char fails[110] = "", surprise[110] = "";
    int failed = 0, measured = 0;
    for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
        const struct turner_stability_cell *cell = &row->cells[method][i];
        char text[64];
        double x = turner_sweep_value(sweep, i);
        if (!cell->asked || isnan(cell->error))
            continue;
        bool holds = turner_stability_holds(cell);
        turner_sweep_value_text(text, sweep, i);
        measured++;
        if (!holds) {
            append(fails, sizeof fails, failed++ ? ", " : "");
            append(fails, sizeof fails, text);
        }
        bool must_hold = x >= m->holds[0] && x <= m->holds[1];
        bool must_fail = x == m->fails;
        if ((must_hold && !holds) || (must_fail && holds)) {
            verdict.expected = false;
            append(surprise, sizeof surprise, must_hold ? "; must hold at " : "; must fail at ");
            append(surprise, sizeof surprise, text);
        }
    }
    verdict.measured = measured > 0;
    snprintf(verdict.text, sizeof verdict.text, "%s%s%s",
             !measured ? "not measured here" : failed ? "fails at " : "holds", fails, surprise);
    if (measured && failed == measured && failed > 1)
        snprintf(verdict.text, sizeof verdict.text, "fails everywhere%s", surprise);
    return verdict;
}
