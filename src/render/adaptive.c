#include "render/adaptive.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "render/cells.h"
#include "render/layers.h"
#include "render/tally.h"

#define EDGE_MAX 128              /* of a tile, in pixels */
#define TILE_SAMPLES (1 << 22)    /* that a tile may come to take, where pixels take the most */
#define LEVEL_MAX 12
#define FLOAT_BITS 24

struct picture {
    struct turner_renderer *renderer;
    struct turner_image *image;
    struct turner_layers *layers; /* or NULL */
    struct turner_statistics *statistics;
    struct turner_lattice lattice;
    struct turner_cells cells;
    int level_max; /* positions are exact in float that far */
    double samples;
};

struct tile {
    int x, y, width, height;
};

bool turner_adaptive_wanted(const struct turner_settings *settings)
{
    return settings->aa_threshold > 0;
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

/* Of the patch's cells that differ by more than the threshold, marks as many as samples are left
 * for, those that differ most. */
static void decide(struct picture *picture, const struct turner_patch *patch)
{
    const struct turner_settings *settings = &picture->renderer->settings;
    struct turner_cell *cells = picture->cells.cells + patch->first;
    size_t room = (size_t)(settings->spp - patch->samples) / TURNER_CELL_SPLIT;
    size_t count = 0;
    for (size_t i = 0; i < patch->count; i++) {
        cells[i].measure = spread(picture->lattice.values, &cells[i]);
        cells[i].split = (double)cells[i].measure > settings->aa_threshold &&
                         cells[i].level < picture->level_max;
        count += cells[i].split;
    }
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

/* ---- a tile ---- */

static enum turner_result trace_new(struct picture *picture)
{
    const struct turner_settings *settings = &picture->renderer->settings;
    struct turner_lattice *lattice = &picture->lattice;
    size_t first = lattice->traced;
    TURNER_TRY(turner_renderer_trace_counted(
        picture->renderer, settings->depth, settings->cutoff, lattice->positions + first,
        lattice->count - first, lattice->values + first,
        lattice->counted ? lattice->counts + first : NULL));
    lattice->traced = lattice->count;
    return TURNER_OK;
}

static void finish(struct picture *picture, const struct turner_patch *patch)
{
    struct turner_statistics *statistics = picture->statistics;
    size_t at = (size_t)patch->y * (size_t)picture->image->width + (size_t)patch->x;
    turner_cells_value(picture->image->rgba + 4 * at, &picture->cells, patch);
    picture->samples += patch->samples;
    if (patch->samples > statistics->samples_max)
        statistics->samples_max = patch->samples;
    if (turner_layers_want(picture->layers, 1u << TURNER_LAYER_SAMPLES))
        picture->layers->whole[TURNER_LAYER_SAMPLES][at] = (uint32_t)patch->samples;
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
static void begin_block(struct picture *picture, struct tile tile, int x, int y)
{
    for (int i = 0; i < 64; i++) {
        int px = x + ((i & 1) | (i >> 1 & 2) | (i >> 2 & 4));
        int py = y + ((i >> 1 & 1) | (i >> 2 & 2) | (i >> 3 & 4));
        if (px < tile.x + tile.width && py < tile.y + tile.height)
            turner_cells_begin(&picture->cells, px, py);
    }
}

static enum turner_result draw_tile(struct picture *picture, struct tile tile)
{
    struct turner_cells *cells = &picture->cells;
    turner_lattice_clear(&picture->lattice);
    cells->patch_count = cells->cell_count = 0;
    for (int y = tile.y; y < tile.y + tile.height; y += 8) {
        for (int x = tile.x; x < tile.x + tile.width; x += 8)
            begin_block(picture, tile, x, y);
    }
    while (cells->patch_count) {
        TURNER_TRY(trace_new(picture));
        for (size_t i = 0; i < cells->patch_count; i++) {
            const struct turner_patch *patch = &cells->patches[i];
            decide(picture, patch);
            bool divided = false;
            for (size_t k = 0; k < patch->count; k++)
                divided = divided || cells->cells[patch->first + k].split;
            if (!divided)
                finish(picture, patch);
            if (!divided && picture->lattice.counted)
                finish_counts(picture, patch);
        }
        turner_cells_divide(cells);
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

/* The level down to which the centres of cells are floats. */
static int level_max(const struct turner_settings *settings)
{
    int size = settings->width > settings->height ? settings->width : settings->height;
    int bits = 0;
    while (1 << bits <= size)
        bits++;
    int level = FLOAT_BITS - bits - 1;
    return level < LEVEL_MAX ? level : LEVEL_MAX;
}

static enum turner_result draw(struct picture *picture, const struct turner_render_options *options)
{
    const struct turner_image *image = picture->image;
    int edge = tile_edge(picture->renderer);
    double pixels = (double)image->width * image->height, done = 0;
    for (int y = 0; y < image->height; y += edge) {
        for (int x = 0; x < image->width; x += edge) {
            struct tile tile = {x, y, edge, edge};
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
    };
    statistics->samples_max = 0;
    picture.cells.lattice = &picture.lattice;
    turner_lattice_create(&picture.lattice, picture.level_max + 1);
    picture.lattice.counted = renderer->needs.pixel_counts;
    double start = turner_seconds();
    enum turner_result result = draw(&picture, options);
    statistics->seconds_trace += turner_seconds() - start;
    turner_cells_destroy(&picture.cells);
    turner_lattice_destroy(&picture.lattice);
    return result;
}
