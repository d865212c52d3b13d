/* Tracing: tiles of the picture or lists of samples, in pieces of bounded time, and the picture made
 * of them. */
#include <assert.h>
#include <stddef.h>
#include <string.h>

#include "render/adaptive.h"
#include "render/layers.h"
#include "render/renderer.h"
#include "render/tally.h"

/* What is submitted at once should take about this long: short for a watchdog and for Ctrl-C, long
 * beside the cost of a submission. */
#define SECONDS_LONG 0.4
#define SECONDS_SHORT 0.1
#define TILE_FIRST 128
#define TILE_MIN 16
#define LIST_FIRST 4096
#define LIST_MIN 256

static double seconds_long(const struct turner_renderer *renderer)
{
    return renderer->piece > 0 ? renderer->piece : SECONDS_LONG;
}

static double seconds_short(const struct turner_renderer *renderer)
{
    return renderer->piece > 0 ? renderer->piece / 4 : SECONDS_SHORT;
}

struct tile {
    int x, y, width, height;
};

static struct turner_gpu_dispatch dispatch_of(const struct turner_renderer *renderer)
{
    return (struct turner_gpu_dispatch){
        .scene = renderer->scene.arrays[TURNER_ARRAY_SCENE].address,
        .pixels = renderer->pixels.address,
        .params = renderer->params.buffer.address,
        .pixel_counts = renderer->pixel_counts.address,
        .first = 1,
        .max_depth = (uint32_t)renderer->settings.depth,
        .cutoff = (float)renderer->settings.cutoff,
    };
}

void turner_renderer_dispatch(VkCommandBuffer commands, const struct turner_renderer *renderer,
                              struct turner_gpu_dispatch push, uint32_t groups)
{
    const struct turner_gpu_info *info = &renderer->gpu->info;
    push.counters = renderer->counters.address;
    if (info->software) {
        push.groups = groups;
        groups = groups < info->threads ? groups : info->threads;
        vkCmdFillBuffer(commands, renderer->counters.buffer,
                        offsetof(struct turner_gpu_counters, group), sizeof(uint32_t), 0);
        turner_gpu_barrier(commands);
    }
    uint32_t rows = (groups - 1) / info->max_workgroup_count[0] + 1;
    turner_program_dispatch(commands, &renderer->program, &push, (groups + rows - 1) / rows, rows,
                            1);
}

static enum turner_result submit(struct turner_renderer *renderer,
                                 const struct turner_gpu_dispatch *push, uint32_t groups)
{
    VkCommandBuffer commands;
    TURNER_TRY(turner_gpu_begin(renderer->gpu, &commands));
    turner_renderer_dispatch(commands, renderer, *push, groups);
    return turner_gpu_submit_wait(renderer->gpu, commands);
}

enum turner_result turner_renderer_warm(struct turner_renderer *renderer)
{
    struct turner_gpu_dispatch push = dispatch_of(renderer); /* of a tile without pixels */
    TURNER_TRY(submit(renderer, &push, 1));
    return renderer->accurate ? turner_renderer_warm(renderer->accurate) : TURNER_OK;
}

static enum turner_result trace_sample(struct turner_renderer *renderer, struct tile tile,
                                       int sample)
{
    double sample_x, sample_y;
    turner_sample_position(&sample_x, &sample_y, sample, renderer->settings.spp);
    struct turner_gpu_dispatch push = dispatch_of(renderer);
    push.tile_x = (uint32_t)tile.x;
    push.tile_y = (uint32_t)tile.y;
    push.tile_width = (uint32_t)tile.width;
    push.tile_height = (uint32_t)tile.height;
    push.sample_x = (float)sample_x;
    push.sample_y = (float)sample_y;
    push.first = sample == 0;
    uint32_t columns = (push.tile_width + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP;
    uint32_t rows = (push.tile_height + TURNER_WORKGROUP - 1) / TURNER_WORKGROUP;
    return submit(renderer, &push, columns * rows);
}

static enum turner_result trace_list(struct turner_renderer *renderer, int depth, double cutoff,
                                     const float (*positions)[2], size_t count,
                                     float (*results)[4], struct turner_gpu_pixel_counts *counts)
{
    const uint32_t group = TURNER_WORKGROUP * TURNER_WORKGROUP;
    struct turner_gpu_dispatch push = dispatch_of(renderer);
    assert(count <= TURNER_LIST_MAX);
    push.positions = renderer->positions.address;
    push.count = (uint32_t)count;
    push.max_depth = (uint32_t)depth;
    push.cutoff = (float)cutoff;
    memcpy(renderer->positions.mapped, positions, count * sizeof *positions);
    TURNER_TRY(submit(renderer, &push, (push.count + group - 1) / group));
    memcpy(results, renderer->pixels.mapped, count * sizeof *results);
    const struct turner_gpu_pixel_counts *took = renderer->pixel_counts.mapped;
    for (size_t i = 0; counts && i < count; i++)
        turner_tally_add(&counts[i], took[i]);
    return TURNER_OK;
}

enum turner_result turner_renderer_trace(struct turner_renderer *renderer, int depth, double cutoff,
                                         const float (*positions)[2], size_t count,
                                         float (*results)[4])
{
    return turner_renderer_trace_counted(renderer, depth, cutoff, positions, count, results, NULL);
}

enum turner_result turner_renderer_trace_counted(struct turner_renderer *renderer, int depth,
                                                 double cutoff, const float (*positions)[2],
                                                 size_t count, float (*results)[4],
                                                 struct turner_gpu_pixel_counts *counts)
{
    /* begins small each time: samples of another call may take a thousand times longer */
    for (size_t done = 0, piece = LIST_FIRST; done < count;) {
        bool whole = count - done >= piece;
        size_t size = whole ? piece : count - done;
        double start = turner_seconds();
        TURNER_TRY(trace_list(renderer, depth, cutoff, positions + done, size, results + done,
                              counts ? counts + done : NULL));
        double seconds = turner_seconds() - start;
        done += size;
        if (seconds > seconds_long(renderer) && piece > LIST_MIN)
            piece /= 2;
        else if (seconds < seconds_short(renderer) && whole && piece < TURNER_LIST_MAX)
            piece *= 2;
    }
    return TURNER_OK;
}

/* The mean of the samples into the picture. */
static void read_back(const struct turner_renderer *renderer, struct turner_image *image,
                      struct tile tile)
{
    const float *from = renderer->pixels.mapped;
    float samples = (float)renderer->settings.spp;
    for (int y = 0; y < tile.height; y++) {
        float *to = image->rgba +
                    4 * ((size_t)(tile.y + y) * (size_t)image->width + (size_t)tile.x);
        for (int i = 0; i < 4 * tile.width; i++)
            *to++ = *from++ / samples;
    }
}

/* The counts of its rays into the layers. */
static void read_back_counts(const struct turner_renderer *renderer, struct turner_layers *layers,
                             struct tile tile)
{
    const struct turner_gpu_pixel_counts *from = renderer->pixel_counts.mapped;
    uint32_t *rays = layers->whole[TURNER_LAYER_RAYS];
    uint32_t *recursion = layers->whole[TURNER_LAYER_RECURSION];
    for (int y = tile.y; y < tile.y + tile.height; y++) {
        for (int x = tile.x; x < tile.x + tile.width; x++, from++) {
            size_t pixel = (size_t)y * (size_t)layers->width + (size_t)x;
            if (rays)
                rays[pixel] = from->rays;
            if (recursion)
                recursion[pixel] = from->recursion;
        }
    }
}

static void add_counters(const struct turner_renderer *renderer,
                         struct turner_statistics *statistics)
{
    const struct turner_gpu_counters *c = renderer->counters.mapped;
    uint64_t counts[TURNER_COUNTS];
    for (int i = 0; i < TURNER_COUNTS; i++)
        counts[i] = c->low[i] | (uint64_t)c->high[i] << 32;
    statistics->camera_rays += counts[TURNER_COUNT_CAMERA];
    statistics->reflected_rays += counts[TURNER_COUNT_REFLECTED];
    statistics->refracted_rays += counts[TURNER_COUNT_REFRACTED];
    statistics->shadow_rays += counts[TURNER_COUNT_SHADOW];
    statistics->tir_rays += counts[TURNER_COUNT_TIR];
    statistics->camera_hits += counts[TURNER_COUNT_CAMERA_HITS];
    statistics->unfinished += counts[TURNER_COUNT_UNFINISHED];
    if ((int)c->largest_depth > statistics->largest_depth)
        statistics->largest_depth = (int)c->largest_depth;
}

enum turner_result turner_report(const struct turner_render_options *options, double share)
{
    if (!options->progress || options->progress(share, options->user))
        return TURNER_OK;
    return turner_fail(TURNER_INTERRUPTED, "interrupted");
}

static enum turner_result draw_regular(struct turner_renderer *renderer, struct turner_image *image,
                                       const struct turner_render_options *options,
                                       struct turner_statistics *statistics)
{
    int edge = renderer->tile ? renderer->tile : renderer->edge ? renderer->edge : TILE_FIRST;
    double pixels = (double)image->width * image->height, done = 0;

    /* rows of tiles; the edge changes between rows only, so that tiles cover the picture */
    for (int y = 0, next_edge = edge; y < image->height; y += edge, edge = next_edge) {
        for (int x = 0; x < image->width; x += edge) {
            struct tile tile = {x, y, edge, edge};
            if (tile.width > image->width - x)
                tile.width = image->width - x;
            if (tile.height > image->height - y)
                tile.height = image->height - y;
            double start = turner_seconds();
            for (int sample = 0; sample < renderer->settings.spp; sample++) {
                double before = turner_seconds();
                TURNER_TRY(trace_sample(renderer, tile, sample));
                double seconds = turner_seconds() - before;
                if (!renderer->tile && seconds > seconds_long(renderer) && edge > TILE_MIN)
                    next_edge = edge / 2;
                else if (!renderer->tile && seconds < seconds_short(renderer) && edge < TURNER_TILE_MAX &&
                         next_edge >= edge)
                    next_edge = edge * 2;
                double share =
                    done + (double)tile.width * tile.height * (sample + 1) / renderer->settings.spp;
                TURNER_TRY(turner_report(options, share / pixels));
            }
            double traced = turner_seconds();
            read_back(renderer, image, tile);
            if (renderer->needs.pixel_counts)
                read_back_counts(renderer, options->layers, tile);
            statistics->seconds_trace += traced - start;
            statistics->seconds_read_back += turner_seconds() - traced;
            done += (double)tile.width * tile.height;
        }
        renderer->edge = next_edge;
    }
    return TURNER_OK;
}

enum turner_result turner_renderer_draw(struct turner_renderer *renderer,
                                        struct turner_image *image,
                                        const struct turner_render_options *options,
                                        struct turner_statistics *statistics)
{
    memset(renderer->counters.mapped, 0, sizeof(struct turner_gpu_counters));
    TURNER_TRY(turner_report(options, 0));
    TURNER_TRY(turner_adaptive_wanted(&renderer->settings)
                   ? turner_adaptive_draw(renderer, image, options, statistics)
                   : draw_regular(renderer, image, options, statistics));
    add_counters(renderer, statistics);
    if (renderer->before_post && renderer->post.wanted)
        memcpy(renderer->before_post->rgba, image->rgba,
               4 * sizeof *image->rgba * (size_t)image->width * (size_t)image->height);
    return turner_post_draw(image, &renderer->post, renderer->gpu);
}
