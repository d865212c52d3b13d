#include "render/overview.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

#define GRID 4            /* pixels between samples */
#define RAYS_MEAN_MAX 256 /* of a sample; bubbles in bubbles take 8 */
#define CONTRAST 4.0      /* errors asked for, that a busy sample is off from its neighbours' mean */
#define REACH 2           /* samples to each side, of which a share is busy */
#define BUSY 0.5

static double rays_so_far(const struct turner_renderer *renderer)
{
    const struct turner_gpu_counters *counters = renderer->counters.mapped;
    static const int kinds[] = {TURNER_COUNT_CAMERA, TURNER_COUNT_REFLECTED,
                                TURNER_COUNT_REFRACTED, TURNER_COUNT_SHADOW};
    double rays = 0;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++)
        rays += counters->low[kinds[i]] + ldexp(counters->high[kinds[i]], 32);
    return rays;
}

static int clamp(int i, int count)
{
    return i < 0 ? 0 : i < count ? i : count - 1;
}

static const float *value_at(const struct turner_overview *overview, int column, int row)
{
    return overview->values[clamp(row, overview->rows) * overview->columns +
                            clamp(column, overview->columns)];
}

static bool is_contrast(const struct turner_overview *overview, int column, int row, double least)
{
    const float *own = value_at(overview, column, row);
    const float *around[4] = {
        value_at(overview, column - 1, row), value_at(overview, column + 1, row),
        value_at(overview, column, row - 1), value_at(overview, column, row + 1)};
    for (int c = 0; c < 3; c++) {
        float mean = 0.25f * (around[0][c] + around[1][c] + around[2][c] + around[3][c]);
        if (!((double)fabsf(mean - own[c]) <= least))
            return true;
    }
    return false;
}

static void find_busy(struct turner_overview *overview, double error)
{
    int columns = overview->columns, rows = overview->rows;
    bool *contrast = turner_calloc((size_t)columns * (size_t)rows, sizeof *contrast);
    for (int i = 0; i < columns * rows; i++)
        contrast[i] = is_contrast(overview, i % columns, i / columns, CONTRAST * error);
    for (int i = 0; i < columns * rows; i++) {
        int busy = 0, count = 0;
        for (int y = i / columns - REACH; y <= i / columns + REACH; y++) {
            for (int x = i % columns - REACH; x <= i % columns + REACH; x++) {
                if (x < 0 || x >= columns || y < 0 || y >= rows)
                    continue;
                busy += contrast[y * columns + x];
                count++;
            }
        }
        overview->busy[i] = (double)busy / count;
    }
    free(contrast);
}

enum turner_result turner_overview_create(struct turner_overview *overview,
                                          struct turner_renderer *renderer)
{
    const struct turner_settings *settings = &renderer->settings;
    int columns = (settings->width + GRID - 1) / GRID, rows = (settings->height + GRID - 1) / GRID;
    size_t count = (size_t)columns * (size_t)rows;
    *overview = (struct turner_overview){columns, rows,
                                         turner_calloc(count, sizeof *overview->values),
                                         turner_calloc(count, sizeof *overview->busy)};
    float(*positions)[2] = turner_calloc(count, sizeof *positions);
    double before = rays_so_far(renderer);
    enum turner_result result;
    for (size_t i = 0; i < count; i++) {
        positions[i][0] = (float)(i % (size_t)columns * GRID) + 0.5f * GRID;
        positions[i][1] = (float)(i / (size_t)columns * GRID) + 0.5f * GRID;
    }
    TURNER_TRY_DONE(turner_renderer_trace(renderer, settings->depth, settings->cutoff,
                                          (const float(*)[2])positions, count, overview->values));
    double mean = (rays_so_far(renderer) - before) / (double)count;
    if (mean > RAYS_MEAN_MAX)
        TURNER_TRY_DONE(turner_fail(
            TURNER_USAGE, "an error cannot be asked for here: a sample takes %.0f rays on average, "
            "cut short, before their weights fall to %g; give --spp, --depth and --cutoff instead, "
            "or materials whose rays lose weight (--method fresnel=exact)", mean,
            settings->cutoff));
    find_busy(overview, settings->error);
done:
    free(positions);
    return result;
}

void turner_overview_destroy(struct turner_overview *overview)
{
    free(overview->values);
    free(overview->busy);
    *overview = (struct turner_overview){0};
}

float turner_overview_bound(const struct turner_overview *overview, float glow)
{
    float bound = glow;
    for (int i = 0; i < overview->columns * overview->rows; i++) {
        for (int c = 0; c < 3; c++) {
            float value = overview->values[i][c];
            bound = isfinite(value) ? fmaxf(bound, value) : bound;
        }
    }
    return bound;
}

bool turner_overview_is_busy(const struct turner_overview *overview, int x, int y)
{
    int column = clamp(x < 0 ? 0 : x / GRID, overview->columns);
    int row = clamp(y < 0 ? 0 : y / GRID, overview->rows);
    return overview->busy[row * overview->columns + column] >= BUSY;
}
