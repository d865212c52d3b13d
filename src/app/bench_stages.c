/* Whole pictures by `turner render`, each a process of its own: where the time goes, with empty
 * caches and with full ones. */
#define _XOPEN_SOURCE 700 /* nftw */
#include <cjson/cJSON.h>
#include <errno.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/bench.h"
#include "app/chart.h"
#include "app/process.h"
#include "base/memory.h"

static int remove_one(const char *path, const struct stat *status, int type, struct FTW *place)
{
    (void)status, (void)type, (void)place;
    return remove(path);
}

static void remove_folder(const char *folder)
{
    nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS);
}

/* The driver's cache and our own. */
static enum turner_result use_cache(const char *folder, bool empty)
{
    char cache[4096];
    snprintf(cache, sizeof cache, "%s/cache", folder);
    if (empty)
        remove_folder(cache);
    if (setenv("MESA_SHADER_CACHE_DIR", cache, 1) != 0 || setenv("TURNER_CACHE_DIR", cache, 1) != 0)
        return turner_fail(TURNER_DEVICE, "no memory for the environment");
    return TURNER_OK;
}

/* Reads "seconds" and the device of a statistics file into sample[] by the order of stages. */
static enum turner_result read_times(struct turner_bench *bench, struct turner_bench_stages *stages,
                                     const char *path, double *sample)
{
    char *text;
    size_t length;
    TURNER_TRY(turner_chart_read_file(&text, &length, path));
    cJSON *root = cJSON_Parse(text), *seconds = cJSON_GetObjectItemCaseSensitive(root, "seconds");
    const char *device = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, "device"));
    const char *driver = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(root, "driver"));
    snprintf(bench->device, sizeof bench->device, "%s", device ? device : "");
    snprintf(bench->driver, sizeof bench->driver, "%s", driver ? driver : "");
    stages->count = 0;
    for (cJSON *stage = seconds ? seconds->child : NULL; stage; stage = stage->next) {
        bool sum = strcmp(stage->string, "whole") == 0; /* measured here, from outside */
        if (stages->count == TURNER_BENCH_STAGES || !cJSON_IsNumber(stage) || sum)
            continue;
        snprintf(stages->names[stages->count], sizeof *stages->names, "%s", stage->string);
        sample[stages->count++] = stage->valuedouble;
    }
    cJSON_Delete(root);
    free(text);
    if (!stages->count)
        return turner_fail(TURNER_OUTPUT, "%s has no times", path);
    return TURNER_OK;
}

static enum turner_result render(struct turner_bench *bench, struct turner_bench_stages *stages,
                                 const char *folder, double *sample, double *wall)
{
    char picture[4096], statistics[4096], exe[] = "/proc/self/exe", command[] = "render",
        to[] = "-o", stats[] = "--stats", quiet[] = "-q", device[] = "--device";
    snprintf(picture, sizeof picture, "%s/picture.png", folder);
    snprintf(statistics, sizeof statistics, "%s/statistics.json", folder);
    char *scene = turner_strdup(stages->name);
    char *wanted = bench->wanted ? turner_strdup(bench->wanted) : NULL;
    char *arguments[] = {exe, command, scene, to, picture, stats, statistics, quiet,
                         wanted ? device : NULL, wanted, NULL};
    double start = turner_seconds();
    int status = turner_process_run(arguments, -1, -1);
    *wall = turner_seconds() - start;
    free(scene);
    free(wanted);
    if (status != 0)
        return turner_fail(status > 0 ? (enum turner_result)status : TURNER_DEVICE,
                           "%s cannot be rendered; what turner render says stands above",
                           stages->name);
    return read_times(bench, stages, statistics, sample);
}

/* The medians of every stage. */
static void sum_up(double *medians, double samples[][TURNER_BENCH_STAGES], int rounds,
                   size_t count)
{
    for (size_t stage = 0; stage < count; stage++) {
        double column[TURNER_BENCH_ROUNDS], quartiles[3];
        for (int round = 0; round < rounds; round++)
            column[round] = samples[round][stage];
        turner_chart_quartiles(quartiles, column, rounds);
        medians[stage] = quartiles[1];
    }
}

static enum turner_result measure(struct turner_bench *bench, struct turner_bench_stages *stages,
                                  const char *folder, double done, double share)
{
    double samples[TURNER_BENCH_ROUNDS][TURNER_BENCH_STAGES], walls[TURNER_BENCH_ROUNDS];
    for (int warm = 0; warm < 2; warm++) {
        for (int round = 0; round < bench->rounds; round++) {
            double part = (warm + (double)round / bench->rounds) / 2;
            turner_progress_show(done + share * part, &bench->bar);
            TURNER_TRY(use_cache(folder, !warm));
            TURNER_TRY(render(bench, stages, folder, samples[round], &walls[round]));
        }
        sum_up(stages->seconds[warm], samples, bench->rounds, stages->count);
        turner_chart_quartiles(stages->wall[warm], walls, bench->rounds);
    }
    return TURNER_OK;
}

enum turner_result turner_bench_measure_stages(struct turner_bench *bench)
{
    const char *temporary = getenv("TMPDIR");
    char folder[2048];
    snprintf(folder, sizeof folder, "%s/turner-bench-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder))
        return turner_fail(TURNER_OUTPUT, "cannot make the folder %s: %s; set TMPDIR", folder,
                           strerror(errno));
    enum turner_result result = TURNER_OK;
    double share = 1.0 / (double)bench->scene_count;
    for (size_t i = 0; result == TURNER_OK && i < bench->scene_count; i++) {
        bench->bar.what = bench->stages[i].name;
        result = measure(bench, &bench->stages[i], folder, (double)i * share, share);
    }
    remove_folder(folder);
    return result;
}

void turner_bench_print_stages(const struct turner_bench *bench)
{
    for (size_t i = 0; i < bench->scene_count; i++) {
        const struct turner_bench_stages *stages = &bench->stages[i];
        double sums[2] = {0};
        printf("\n%s\n%-12s  empty caches, ms  full caches, ms\n", stages->name, "stage");
        for (size_t k = 0; k < stages->count; k++) {
            printf("%-12s  %16.1f  %15.1f\n", stages->names[k], 1e3 * stages->seconds[0][k],
                   1e3 * stages->seconds[1][k]);
            sums[0] += stages->seconds[0][k];
            sums[1] += stages->seconds[1][k];
        }
        printf("%-12s  %16.1f  %15.1f\n", "rest", 1e3 * (stages->wall[0][1] - sums[0]),
               1e3 * (stages->wall[1][1] - sums[1]));
        printf("%-12s  %16.1f  %15.1f\n", "all", 1e3 * stages->wall[0][1],
               1e3 * stages->wall[1][1]);
        printf("%-12s  %7.1f…%8.1f  %6.1f…%8.1f\n", "quartiles", 1e3 * stages->wall[0][0],
               1e3 * stages->wall[0][2], 1e3 * stages->wall[1][0], 1e3 * stages->wall[1][2]);
    }
}

void turner_bench_print_stages_csv(FILE *out, const struct turner_bench *bench)
{
    fprintf(out, "scene,caches,stage,rounds,seconds\n");
    for (size_t i = 0; i < bench->scene_count; i++) {
        const struct turner_bench_stages *stages = &bench->stages[i];
        for (int warm = 0; warm < 2; warm++) {
            const char *caches = warm ? "full" : "empty";
            for (size_t k = 0; k < stages->count; k++)
                fprintf(out, "\"%s\",%s,%s,%d,%.6g\n", stages->name, caches, stages->names[k],
                        bench->rounds, stages->seconds[warm][k]);
            fprintf(out, "\"%s\",%s,all,%d,%.6g\n", stages->name, caches, bench->rounds,
                    stages->wall[warm][1]);
        }
    }
}
