#include "render/adaptive.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/estimate.h"
#include "render/follow.h"
#include "render/layers.h"
#include "render/overview.h"
#include "render/surroundings.h"
#include "render/tally.h"

#define EDGE_MAX 128              /* of a tile, in pixels */
#define TILE_SAMPLES (1 << 22)    /* that a tile may come to take, where pixels take the most */
#define LEVEL_MAX 12
#define FIRST_ROUNDS 2            /* of divisions, that every pixel goes through for an error */
#define FIRST_CELLS 16            /* they lead to */
#define FIRST_CELLS_BUSY 64       /* that a pixel is divided into where much is around */
#define FLOAT_BITS 24
#define SPACINGS_LEAST 16        /* of floats, along the edge of a cell that is divided */
#define SPLIT_SHARE 0.25f         /* of the most that a cell of the pixel adds */
#define SAMPLING_LEAST 0.25f      /* of the error asked for */

struct picture {
    struct turner_renderer *renderer;
    struct turner_image *image;
    struct turner_layers *layers; /* or NULL */
    struct turner_statistics *statistics;
    struct turner_lattice lattice;
    struct turner_cells cells;
    int level_max;    /* of cells that are divided no more: their edges are floats that far */
    float area_least; /* of cells that are divided, where they are jittered */
    double samples; /* sum over pixels */
    struct turner_overview overview; /* where an error is asked for */
    struct turner_scale scale;       /* the same */
    float *errors;  /* the same, or NULL: the estimate of each pixel */
    float *shared;  /* the same: what it tells those around */
};

/* What is said of a pixel. */
struct verdict {
    float error, shared;
};

bool turner_adaptive_wanted(const struct turner_settings *settings)
{
    return settings->aa_threshold > 0 || settings->error > 0;
}

static bool is_divisible(const struct picture *picture, const struct turner_cell *cell)
{
    return cell->level < picture->level_max && cell->area >= picture->area_least;
}

/* ---- Whitted's rule ---- */

/* The largest difference in a channel between two of a cell's samples. */
static float spread(float (*const samples)[4], const struct turner_cell *cell)
{
    float largest = 0;
    for (int c = 0; c < 3; c++) {
        float low = samples[cell->center][c], high = low;
        for (int i = 0; i < 4; i++) {
            float value = samples[cell->corner[i]][c];
            low = fminf(low, value);
            high = fmaxf(high, value);
        }
        largest = fmaxf(largest, high - low);
    }
    return largest;
}

/* Cells of greater measure first, then in the order they stand in. */
static int compare_cells(const void *a, const void *b)
{
    const struct turner_cell *cell_a = *(struct turner_cell *const *)a;
    const struct turner_cell *cell_b = *(struct turner_cell *const *)b;
    if (cell_a->measure != cell_b->measure)
        return cell_a->measure > cell_b->measure ? -1 : 1;
    return cell_a < cell_b ? -1 : cell_a > cell_b;
}

/* Takes the mark from cells of least measure, where samples are not left for all. */
static void keep_to_budget(const struct picture *picture, const struct turner_patch *patch)
{
    struct turner_cell *cells = picture->cells.cells + patch->first;
    size_t room = (size_t)(picture->renderer->settings.spp - patch->samples) / TURNER_CELL_SPLIT;
    size_t count = 0;
    for (size_t i = 0; i < patch->count; i++)
        count += cells[i].split;
    if (count <= room)
        return;
    struct turner_cell **order = turner_calloc(count, sizeof *order);
    count = 0;
    for (size_t i = 0; i < patch->count; i++) {
        if (cells[i].split)
            order[count++] = &cells[i];
    }
    qsort(order, count, sizeof *order, compare_cells);
    for (size_t i = room; i < count; i++)
        order[i]->split = false;
    free(order);
}

static void mark_by_threshold(const struct picture *picture, const struct turner_patch *patch)
{
    double threshold = picture->renderer->settings.aa_threshold;
    struct turner_cell *cells = picture->cells.cells + patch->first;
    for (size_t i = 0; i < patch->count; i++) {
        cells[i].measure = spread(picture->lattice.values, &cells[i]);
        cells[i].split =
            (double)cells[i].measure > threshold && is_divisible(picture, &cells[i]);
    }
}

/* ---- an error on demand ---- */

/* The estimate of a patch; where it is too much, marks the cells that it comes from. */
static struct verdict mark_by_error(const struct picture *picture,
                                    const struct turner_patch *patch)
{
    struct turner_estimate estimate =
        turner_estimate_pixel(&picture->cells, patch, &picture->scale);
    struct turner_cell *cells = picture->cells.cells + patch->first;
    float most = 0;
    for (size_t i = 0; i < patch->count; i++) {
        cells[i].split = false;
        if (is_divisible(picture, &cells[i]))
            most = fmaxf(most, cells[i].measure);
    }
    /* what sampling may take; more samples do not help against the rest */
    float asked = (float)picture->renderer->settings.error;
    float rest = estimate.cut + estimate.methods + estimate.rounding;
    float left = fmaxf(asked - rest, SAMPLING_LEAST * fmaxf(asked, rest));
    size_t least = turner_overview_is_busy(&picture->overview, patch->x, patch->y)
                       ? FIRST_CELLS_BUSY
                       : FIRST_CELLS;
    bool first = patch->count < least;
    struct verdict verdict = {turner_estimate_total(&estimate),
                              turner_estimate_shared(&estimate, patch->count > least)};
    if (!first && fmaxf(turner_estimate_of_samples(&estimate), estimate.look) <= left)
        return verdict;
    for (size_t i = 0; i < patch->count; i++)
        cells[i].split = is_divisible(picture, &cells[i]) &&
                         (first || cells[i].measure >= SPLIT_SHARE * most);
    return verdict;
}

/* ---- a tile ---- */

static void finish(struct picture *picture, const struct turner_patch *patch,
                   struct verdict verdict)
{
    struct turner_statistics *statistics = picture->statistics;
    size_t at = (size_t)patch->y * (size_t)picture->image->width + (size_t)patch->x;
    turner_cells_value(picture->image->rgba + 4 * at, &picture->cells, patch);
    picture->samples += patch->samples;
    if (patch->samples > statistics->samples_max)
        statistics->samples_max = patch->samples;
    if (turner_layers_want(picture->layers, 1u << TURNER_LAYER_SAMPLES))
        picture->layers->whole[TURNER_LAYER_SAMPLES][at] = (uint32_t)patch->samples;
    if (picture->errors) {
        picture->errors[at] = verdict.error;
        picture->shared[at] = verdict.shared;
    }
}

/* What is said of the errors is said of the pooled ones. */
static void finish_errors(struct picture *picture)
{
    struct turner_statistics *statistics = picture->statistics;
    int width = picture->image->width, height = picture->image->height;
    size_t pixels = (size_t)width * (size_t)height;
    bool wanted = turner_layers_want(picture->layers, 1u << TURNER_LAYER_ERROR);
    float *pooled = wanted ? picture->layers->real[TURNER_LAYER_ERROR]
                           : turner_calloc(pixels, sizeof *pooled);
    double sum = 0;
    turner_estimate_pool(pooled, picture->errors, picture->shared, width, height);
    for (size_t i = 0; i < pixels; i++) {
        sum += (double)pooled[i];
        statistics->error_max = fmax(statistics->error_max, (double)pooled[i]);
        statistics->error_missed += (double)pooled[i] > picture->renderer->settings.error;
    }
    statistics->error_mean = sum / (double)pixels;
    if (!wanted)
        free(pooled);
}

static void finish_counts(const struct picture *picture, const struct turner_patch *patch)
{
    size_t at = (size_t)patch->y * (size_t)picture->image->width + (size_t)patch->x;
    struct turner_gpu_pixel_counts took = turner_tally_patch(&picture->cells, patch);
    if (turner_layers_want(picture->layers, 1u << TURNER_LAYER_RAYS))
        picture->layers->whole[TURNER_LAYER_RAYS][at] = took.rays;
    if (turner_layers_want(picture->layers, 1u << TURNER_LAYER_RECURSION))
        picture->layers->whole[TURNER_LAYER_RECURSION][at] = took.recursion;
}

/* Neighbours in the list are neighbours in the picture: along a Morton curve of 8×8 pixels. */
static void begin_block(struct picture *picture, struct turner_tile tile, int x, int y)
{
    for (int i = 0; i < 64; i++) {
        int px = x + ((i & 1) | (i >> 1 & 2) | (i >> 2 & 4));
        int py = y + ((i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4));
        if (turner_tile_has(&tile, px, py))
            turner_cells_begin(&picture->cells, px, py);
    }
}

/* The pixels of the tile and so many around it, be they in the picture or not; of one more, the
 * first samples. */
static void begin(struct picture *picture, struct turner_tile tile, int around)
{
    struct turner_cell cell;
    picture->cells.patch_count = picture->cells.cell_count = 0;
    tile = (struct turner_tile){tile.x - around, tile.y - around, tile.width + 2 * around,
                                tile.height + 2 * around};
    for (int y = tile.y; y < tile.y + tile.height; y += 8) {
        for (int x = tile.x; x < tile.x + tile.width; x += 8)
            begin_block(picture, tile, x, y);
    }
    for (int y = tile.y - 1; around && y <= tile.y + tile.height; y++) {
        for (int x = tile.x - 1; x <= tile.x + tile.width; x++) {
            if (!turner_tile_has(&tile, x, y))
                turner_cells_first(&cell, &picture->lattice, x, y);
        }
    }
}

/* Marks the cells of a patch that are to be divided; true if there are any. */
static bool mark(struct picture *picture, const struct turner_patch *patch,
                 struct verdict *verdict)
{
    *verdict = (struct verdict){0};
    if (picture->renderer->settings.error > 0)
        *verdict = mark_by_error(picture, patch);
    else
        mark_by_threshold(picture, patch);
    keep_to_budget(picture, patch);
    bool any = false;
    for (size_t i = 0; i < patch->count; i++)
        any = any || picture->cells.cells[patch->first + i].split;
    return any;
}

/* Those around the tile are there to be looked at. */
static void finish_round(struct picture *picture, const struct turner_tile *tile)
{
    struct turner_cells *cells = &picture->cells;
    for (size_t i = 0; i < cells->patch_count; i++) {
        const struct turner_patch *patch = &cells->patches[i];
        struct verdict verdict;
        bool within = turner_tile_has(tile, patch->x, patch->y);
        if ((!within && patch->count == FIRST_CELLS) || mark(picture, patch, &verdict))
            continue;
        finish(picture, patch, verdict);
        if (picture->lattice.counted)
            finish_counts(picture, patch);
    }
    turner_cells_divide(cells);
}

static enum turner_result draw_tile(struct picture *picture, struct turner_tile tile)
{
    struct turner_renderer *renderer = picture->renderer;
    struct turner_cells *cells = &picture->cells;
    bool on_demand = renderer->settings.error > 0;
    turner_lattice_clear(&picture->lattice);
    begin(picture, tile, on_demand ? 1 : 0);
    for (int round = 0; cells->patch_count; round++) {
        TURNER_TRY(turner_follow(&picture->lattice, renderer, picture->scale.bound,
                                 &picture->statistics->cutoff_least));
        if (on_demand && round == 0)
            TURNER_TRY(turner_surroundings_first(cells, &tile, renderer, picture->scale.bound));
        if (on_demand && round == FIRST_ROUNDS)
            turner_surroundings_fine(cells, &tile);
        finish_round(picture, &tile);
    }
    return TURNER_OK;
}

/* ---- the picture ---- */

/* An edge whose pixels, should all of them take the most samples, still fit into memory. */
static int tile_edge(const struct turner_renderer *renderer)
{
    if (renderer->tile)
        return renderer->tile;
    int edge = EDGE_MAX;
    while (edge > 8 && edge * edge > TILE_SAMPLES / renderer->settings.spp)
        edge /= 2;
    return edge;
}

/* Bits before the point that a position takes. */
static int position_bits(const struct turner_settings *settings)
{
    int size = settings->width > settings->height ? settings->width : settings->height;
    int bits = 0;
    while (1 << bits <= size)
        bits++;
    return bits;
}

/* The level down to which the centres of squares are floats. */
static int level_max(const struct turner_settings *settings)
{
    int level = FLOAT_BITS - position_bits(settings) - 1;
    return level < LEVEL_MAX ? level : LEVEL_MAX;
}

/* The square of what is left to place samples in. */
static float area_least(const struct turner_settings *settings)
{
    float edge = SPACINGS_LEAST * ldexpf(1, position_bits(settings) - FLOAT_BITS);
    return settings->error > 0 ? edge * edge : 0;
}

static enum turner_result draw(struct picture *picture, const struct turner_render_options *options)
{
    const struct turner_image *image = picture->image;
    int edge = tile_edge(picture->renderer);
    if (picture->renderer->settings.error > 0) {
        TURNER_TRY(turner_overview_create(&picture->overview, picture->renderer));
        picture->scale.bound =
            turner_overview_bound(&picture->overview, picture->renderer->glow);
        picture->scale.blend = picture->renderer->blend;
    }
    double pixels = (double)image->width * image->height, done = 0;
    for (int y = 0; y < image->height; y += edge) {
        for (int x = 0; x < image->width; x += edge) {
            struct turner_tile tile = {x, y, edge, edge};
            if (tile.width > image->width - x)
                tile.width = image->width - x;
            if (tile.height > image->height - y)
                tile.height = image->height - y;
            TURNER_TRY(draw_tile(picture, tile));
            done += (double)tile.width * tile.height;
            TURNER_TRY(turner_report(options, done / pixels));
        }
    }
    picture->statistics->samples_mean = picture->samples / pixels;
    if (picture->errors)
        finish_errors(picture);
    return TURNER_OK;
}

enum turner_result turner_adaptive_draw(struct turner_renderer *renderer,
                                        struct turner_image *image,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics)
{
    struct picture picture = {
        .renderer = renderer,
        .image = image,
        .layers = options->layers,
        .statistics = statistics,
        .level_max = level_max(&renderer->settings),
        .area_least = area_least(&renderer->settings),
    };
    statistics->samples_max = 0;
    statistics->cutoff_least = renderer->settings.cutoff;
    picture.scale.size = (float)(image->width > image->height ? image->width : image->height);
    picture.cells.lattice = &picture.lattice;
    picture.cells.jittered = renderer->settings.error > 0;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    if (renderer->settings.error > 0) {
        picture.errors = turner_calloc(pixels, sizeof *picture.errors);
        picture.shared = turner_calloc(pixels, sizeof *picture.shared);
    }
    turner_lattice_create(&picture.lattice, picture.level_max + 1);
    picture.lattice.counted = renderer->needs.pixel_counts;
    double start = turner_seconds();
    enum turner_result result = draw(&picture, options);
    statistics->seconds_trace += turner_seconds() - start;
    turner_cells_destroy(&picture.cells);
    turner_lattice_destroy(&picture.lattice);
    turner_overview_destroy(&picture.overview);
    free(picture.errors);
    free(picture.shared);
    return result;
}
