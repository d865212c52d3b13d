#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "app/app.h"
#include "app/plot.h"
#include "app/povray.h"
#include "app/stability.h"
#include "base/memory.h"

static void print_help(void)
{
    puts("Usage: turner stability [-o FOLDER] [OPTION]… [ROW]…\n\n"
         "Measures where methods fail: each row is a sweep over one parameter (distance, scale,\n"
         "index …), each method of it is compared with the reference tracer, and a verdict says\n"
         "where it holds within the stated bound. Defaults must hold, naive methods must fail\n"
         "where they are known to; status 1 says that one of them did otherwise.\n"
         "docs/stability.md says how to read it.\n\n"
         "  -o, --output FOLDER  write stability.csv, stability.json, a picture for each row\n"
         "                       (python3 with matplotlib) and index.html with all of it; rows of\n"
         "                       pictures are drawn by POV-Ray, too, where it is installed\n"
         "      --list           print the rows there are, and stop\n"
         "      --quick          of each method only the values that decide its verdict\n"
         "      --no-povray      do without POV-Ray\n"
         "  -d, --device D       index or part of the name (turner devices)\n"
         "  -q, --quiet          no progress bar, only what is not as expected\n"
         "  -h, --help           this text\n\n"
         "ROW is a name of --list or the beginning of some (sphere, fresnel-c).\n\n"
         "Examples:\n"
         "  turner stability -o stability && xdg-open stability/index.html\n"
         "  turner stability --quick leave-radius leave-shell");
}

struct arguments {
    const char *output, *device;
    char **names; /* of rows, up to a NULL; none: all */
    bool list, quick, no_povray, quiet, help;
};

static enum turner_result parse(struct arguments *a, int argc, char **argv)
{
    enum { OPTION_LIST = 256, OPTION_QUICK, OPTION_NO_POVRAY };
    static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                            {"device", required_argument, NULL, 'd'},
                                            {"list", no_argument, NULL, OPTION_LIST},
                                            {"quick", no_argument, NULL, OPTION_QUICK},
                                            {"no-povray", no_argument, NULL, OPTION_NO_POVRAY},
                                            {"quiet", no_argument, NULL, 'q'},
                                            {"help", no_argument, NULL, 'h'},
                                            {0}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "o:d:qh", options, NULL)) != -1;) {
        switch (option) {
        case 'o': a->output = optarg; break;
        case 'd': a->device = optarg; break;
        case 'q': a->quiet = true; break;
        case 'h': a->help = true; return TURNER_OK;
        case OPTION_LIST: a->list = true; break;
        case OPTION_QUICK: a->quick = true; break;
        case OPTION_NO_POVRAY: a->no_povray = true; break;
        default: return turner_bad_option(argv);
        }
    }
    a->names = argv + optind;
    return TURNER_OK;
}

static bool starts_with(const char *text, const char *beginning)
{
    return strncmp(text, beginning, strlen(beginning)) == 0;
}

static bool wanted(const struct turner_sweep *sweep, char **names)
{
    for (char **name = names; *name; name++) {
        if (starts_with(sweep->name, *name))
            return true;
    }
    return !*names;
}

/* The rows asked for. The caller frees *rows. */
static enum turner_result choose_rows(struct turner_stability_row **rows, size_t *count,
                                      char **names)
{
    const struct turner_sweep *const lists[] = {
        turner_sweeps_sphere,    turner_sweeps_ground,  turner_sweeps_leave,
        turner_sweeps_triangle,  turner_sweeps_fresnel, turner_sweeps_phong,
        turner_sweeps_place,     turner_sweeps_recursion, turner_sweeps_aa};
    size_t capacity = 0;
    *rows = NULL;
    *count = 0;
    for (char **name = names; *name; name++) {
        char *one[] = {*name, NULL};
        bool found = false;
        for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
            for (const struct turner_sweep *sweep = lists[i]; sweep->name; sweep++)
                found = found || wanted(sweep, one);
        }
        if (!found)
            return turner_fail(TURNER_USAGE, "no row is called \"%s\" or begins so; see turner "
                                             "stability --list", *name);
    }
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        for (const struct turner_sweep *sweep = lists[i]; sweep->name; sweep++) {
            if (wanted(sweep, names))
                *TURNER_PUSH(*rows, *count, capacity) =
                    (struct turner_stability_row){.sweep = sweep};
        }
    }
    return TURNER_OK;
}

static bool must_hold(const struct turner_sweep_method *method, double x)
{
    return x >= method->holds[0] && x <= method->holds[1];
}

/* Whether the verdict on a method is decided at value i: where it must fail, and at both ends of
 * where it must hold. Cases without order decide one by one. */
static bool decides(const struct turner_sweep *sweep, int m, int i)
{
    const struct turner_sweep_method *method = &sweep->methods[m];
    double x = turner_sweep_value(sweep, i);
    bool first = i == 0 || !must_hold(method, turner_sweep_value(sweep, i - 1));
    bool last = i + 1 == turner_sweep_value_count(sweep) ||
                !must_hold(method, turner_sweep_value(sweep, i + 1));
    return x == method->fails || (must_hold(method, x) && (sweep->labels || first || last));
}

struct progress {
    struct turner_progress_bar bar;
    int done, all;
};

static int cells_of(const struct turner_sweep *sweep, bool quick)
{
    int cells = 0;
    for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
        for (int m = 0; m < turner_sweep_method_count(sweep); m++)
            cells += !quick || decides(sweep, m, i);
    }
    return cells;
}

/* Measures the cells of a row, those by POV-Ray or all others. */
static enum turner_result measure_row(struct turner_stability_row *row, struct turner_stability *s,
                                      bool povray, bool quick, struct progress *progress)
{
    const struct turner_sweep *sweep = row->sweep;
    for (int i = 0; i < turner_sweep_value_count(sweep); i++) {
        for (int m = 0; m < turner_sweep_method_count(sweep); m++) {
            if ((strcmp(sweep->methods[m].name, TURNER_POVRAY) == 0) != povray)
                continue;
            if (quick && !decides(sweep, m, i))
                continue;
            TURNER_TRY(turner_stability_measure(row, m, i, s));
            turner_progress_show((double)++progress->done / progress->all, &progress->bar);
        }
    }
    return TURNER_OK;
}

static bool print_row(const struct turner_stability_row *row, bool quiet)
{
    bool expected = true;
    if (!quiet)
        printf("%s: %s\n", row->sweep->name, row->sweep->question);
    for (int m = 0; m < turner_sweep_method_count(row->sweep); m++) {
        struct turner_stability_verdict verdict = turner_stability_judge(row, m);
        const struct turner_sweep_method *method = &row->sweep->methods[m];
        expected = expected && verdict.expected;
        if (quiet && !verdict.expected)
            printf("%s, ", row->sweep->name);
        if (!quiet || !verdict.expected)
            printf("  %-26s %s%s\n", method->name, verdict.expected ? "" : "NOT AS EXPECTED: ",
                   verdict.text);
        if (!quiet && method->note && starts_with(verdict.text, "fails"))
            printf("  %-26s   %s\n", "", method->note);
    }
    return expected;
}

static enum turner_result make_folder(const char *folder)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return turner_fail(TURNER_OUTPUT, "cannot make the folder \"%s\": %s; choose another",
                           folder, strerror(errno));
    return TURNER_OK;
}

static enum turner_result report(const struct turner_stability_report *report, const char *folder)
{
    char json[4096];
    TURNER_TRY(turner_stability_write(report, folder));
    snprintf(json, sizeof json, "%s/stability.json", folder);
    const char *const arguments[] = {json, folder};
    TURNER_TRY(turner_plot("stability", arguments, 2));
    return turner_stability_write_html(report, folder);
}

/* POV-Ray's column, after the device is closed: it is a process of its own. */
static enum turner_result ask_povray(struct turner_stability_row *rows, size_t count,
                                     const struct arguments *a, struct progress *progress)
{
    char folder[4096];
    if (a->no_povray || !a->output || !turner_povray_found())
        return TURNER_OK;
    snprintf(folder, sizeof folder, "%s/povray", a->output);
    TURNER_TRY(make_folder(folder));
    struct turner_stability s = {.povray = folder};
    enum turner_result result = TURNER_OK;
    for (size_t i = 0; result == TURNER_OK && i < count; i++)
        result = measure_row(&rows[i], &s, true, a->quick, progress);
    turner_image_destroy(&s.truth);
    return result;
}

static enum turner_result run(struct turner_stability_row *rows, size_t count,
                              const struct arguments *a)
{
    struct turner_stability s;
    struct progress progress = {.all = 0};
    char device[256], driver[512];
    for (size_t i = 0; i < count; i++)
        progress.all += cells_of(rows[i].sweep, a->quick);
    TURNER_TRY(turner_stability_create(&s, a->device));
    snprintf(device, sizeof device, "%s", s.gpu.info.name);
    snprintf(driver, sizeof driver, "%s", s.gpu.info.driver);
    turner_progress_begin(&progress.bar, a->quiet);
    enum turner_result result = TURNER_OK;
    for (size_t i = 0; result == TURNER_OK && i < count; i++)
        result = measure_row(&rows[i], &s, false, a->quick, &progress);
    turner_stability_destroy(&s);
    if (result == TURNER_OK)
        result = ask_povray(rows, count, a, &progress);
    turner_progress_end(&progress.bar);
    TURNER_TRY(result);

    int surprises = 0;
    for (size_t i = 0; i < count; i++)
        surprises += !print_row(&rows[i], a->quiet);
    if (a->output) {
        struct turner_stability_report all = {rows, count, device, driver};
        TURNER_TRY(report(&all, a->output));
    }
    if (surprises)
        return turner_fail(TURNER_DIFFERS, "%d of %zu rows did not come out as stated; "
                                           "docs/stability.md says what that means", surprises,
                           count);
    return TURNER_OK;
}

enum turner_result turner_cmd_stability(int argc, char **argv)
{
    struct arguments a = {0};
    TURNER_TRY(parse(&a, argc, argv));
    if (a.help) {
        print_help();
        return TURNER_OK;
    }
    turner_set_quiet(a.quiet);
    struct turner_stability_row *rows;
    size_t count;
    enum turner_result result = choose_rows(&rows, &count, a.names);
    for (size_t i = 0; result == TURNER_OK && a.list && i < count; i++)
        printf("%-22s %s\n", rows[i].sweep->name, rows[i].sweep->question);
    if (result == TURNER_OK && !a.list && a.output)
        result = make_folder(a.output);
    if (result == TURNER_OK && !a.list)
        result = run(rows, count, &a);
    free(rows);
    return result;
}
