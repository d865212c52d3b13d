#include "render/follow.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define CUT_SHARE 0.25    /* of the error, that cut rays may take */
#define CUTOFF_STEP 8
#define CUTOFF_LEAST 1e-7

void turner_follow_settings(struct turner_settings *settings, bool branches)
{
    settings->depth = branches ? TURNER_MAX_BRANCH_DEPTH : TURNER_MAX_DEPTH;
    settings->cutoff = fmax(fmin(settings->error, 0.5), CUTOFF_LEAST);
    settings->spp = TURNER_ERROR_SAMPLES;
}

static float most_of(struct turner_vec3 v)
{
    return (float)fmax(v.x, fmax(v.y, v.z));
}

static float most_of_environment(const struct turner_scene *scene)
{
    const struct turner_texture_image *image = &scene->texture_images[scene->background.image];
    size_t count = (size_t)image->width * (size_t)image->height * 3;
    float most = 0;
    for (size_t i = 0; i < count; i++)
        most = fmaxf(most, image->rgb[i]);
    return most * most_of(scene->background.scale);
}

float turner_follow_glow(const struct turner_scene *scene)
{
    const struct turner_background *background = &scene->background;
    float most = most_of(background->color);
    if (background->kind == TURNER_BACKGROUND_GRADIENT)
        most = fmaxf(most, most_of(background->top));
    if (background->kind == TURNER_BACKGROUND_ENVIRONMENT)
        most = most_of_environment(scene);
    for (size_t i = 0; i < scene->material_count; i++)
        most = fmaxf(most, most_of(scene->materials[i].k_e));
    return most;
}

float turner_follow_blend(const struct turner_scene *scene)
{
    const struct turner_background *background = &scene->background;
    if (background->kind != TURNER_BACKGROUND_GRADIENT)
        return 0;
    struct turner_vec3 a = background->color, b = background->top;
    return (float)fmax(fabs(a.x - b.x), fmax(fabs(a.y - b.y), fabs(a.z - b.z)));
}

/* Samples of a lattice that are traced again. */
struct selection {
    size_t *indices, count;
    float (*positions)[2], (*values)[4];
    struct turner_gpu_pixel_counts *counts; /* NULL unless they are wanted */
};

static void select_unfinished(struct selection *selection, const struct turner_lattice *lattice,
                              float limit)
{
    size_t kept = 0;
    for (size_t i = 0; i < selection->count; i++) {
        size_t index = selection->indices[i];
        if (!(lattice->values[index][3] > limit))
            continue;
        selection->indices[kept] = index;
        memcpy(selection->positions[kept++], lattice->positions[index],
               sizeof *selection->positions);
    }
    selection->count = kept;
}

/* What was traced again into the lattice. Keeps those that lost less than before: the others ran out
 * of rays, and a lower cutoff does not help. */
static void take_over(struct selection *selection, struct turner_lattice *lattice)
{
    size_t kept = 0;
    for (size_t i = 0; i < selection->count; i++) {
        size_t index = selection->indices[i];
        bool helped = selection->values[i][3] < lattice->values[index][3];
        memcpy(lattice->values[index], selection->values[i], sizeof *selection->values);
        if (selection->counts)
            lattice->counts[index] = selection->counts[i];
        if (helped)
            selection->indices[kept++] = index;
    }
    selection->count = kept;
}

/* Traces again what lost more than `limit`, with ever lower cutoffs. */
static enum turner_result follow_further(struct turner_lattice *lattice,
                                         struct turner_renderer *renderer, float limit,
                                         double *cutoff_least)
{
    const struct turner_settings *settings = &renderer->settings;
    size_t count = lattice->count - lattice->traced;
    struct selection selection = {
        .indices = turner_calloc(count, sizeof *selection.indices),
        .count = count,
        .positions = turner_calloc(count, sizeof *selection.positions),
        .values = turner_calloc(count, sizeof *selection.values),
        .counts = lattice->counted ? turner_calloc(count, sizeof *selection.counts) : NULL,
    };
    enum turner_result result = TURNER_OK;
    for (size_t i = 0; i < count; i++)
        selection.indices[i] = lattice->traced + i;
    double cutoff = settings->cutoff;
    for (;;) {
        *cutoff_least = fmin(*cutoff_least, cutoff);
        select_unfinished(&selection, lattice, limit);
        if (selection.count == 0 || cutoff <= CUTOFF_LEAST)
            break;
        cutoff = fmax(cutoff / CUTOFF_STEP, CUTOFF_LEAST);
        if (selection.counts)
            memset(selection.counts, 0, selection.count * sizeof *selection.counts);
        TURNER_TRY_DONE(turner_renderer_trace_counted(
            renderer, settings->depth, cutoff, (const float(*)[2])selection.positions,
            selection.count, selection.values, selection.counts));
        take_over(&selection, lattice);
    }
done:
    free(selection.indices);
    free(selection.positions);
    free(selection.values);
    free(selection.counts);
    return result;
}

enum turner_result turner_follow(struct turner_lattice *lattice, struct turner_renderer *renderer,
                                 float bound, double *cutoff_least)
{
    const struct turner_settings *settings = &renderer->settings;
    size_t first = lattice->traced;
    if (first == lattice->count)
        return TURNER_OK;
    TURNER_TRY(turner_renderer_trace_counted(
        renderer, settings->depth, settings->cutoff, (const float(*)[2])lattice->positions + first,
        lattice->count - first, lattice->values + first,
        lattice->counted ? lattice->counts + first : NULL));
    if (settings->error > 0)
        TURNER_TRY(follow_further(lattice, renderer, (float)(CUT_SHARE * settings->error) / bound,
                                  cutoff_least));
    lattice->traced = lattice->count;
    return TURNER_OK;
}
