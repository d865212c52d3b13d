#include "render/layers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/ids.h"
#include "scene/nearest.h"

/* Channel names are letters, one a channel: what other programs make of "normal.X" or "depth.Z" is
 * a layer of that name. */
static const struct {
    const char *name, *channels;
    bool whole;
} kinds[TURNER_LAYERS] = {
    [TURNER_LAYER_ERROR] = {"error", "X", false},
    [TURNER_LAYER_PRUNED] = {"pruned", "X", false},
    [TURNER_LAYER_SAMPLES] = {"samples", "X", true},
    [TURNER_LAYER_RAYS] = {"rays", "X", true},
    [TURNER_LAYER_RECURSION] = {"recursion", "X", true},
    [TURNER_LAYER_NONFINITE] = {"nonfinite", "X", true},
    [TURNER_LAYER_DEPTH] = {"depth", "Z", false},
    [TURNER_LAYER_NORMAL] = {"normal", "XYZ", false},
    [TURNER_LAYER_ALBEDO] = {"albedo", "RGB", false},
    [TURNER_LAYER_POSITION] = {"position", "XYZ", false},
    [TURNER_LAYER_ID] = {"id", "X", true},
};

const char *turner_layer_name(enum turner_layer layer)
{
    return kinds[layer].name;
}

static const char *word(const void *user, size_t i)
{
    (void)user;
    return i < TURNER_LAYERS ? kinds[i].name : "all";
}

static enum turner_result parse_name(uint32_t *wanted, const char *name)
{
    for (size_t i = 0; i < TURNER_LAYERS; i++) {
        if (strcmp(name, kinds[i].name) == 0) {
            *wanted |= 1u << i;
            return TURNER_OK;
        }
    }
    if (strcmp(name, "all") == 0) {
        *wanted |= (1u << TURNER_LAYERS) - 1;
        return TURNER_OK;
    }
    const char *nearest = turner_nearest(name, TURNER_LAYERS + 1, word, NULL);
    if (nearest)
        return turner_fail(TURNER_USAGE, "there is no layer \"%s\"; did you mean \"%s\"?", name,
                           nearest);
    return turner_fail(TURNER_USAGE, "there is no layer \"%s\"; turner render --help lists them",
                       name);
}

enum turner_result turner_layers_parse(uint32_t *wanted, const char *list)
{
    char *copy = turner_strdup(list);
    enum turner_result result = TURNER_OK;
    for (char *name = copy, *next = copy; next && result == TURNER_OK; name = next) {
        next = strchr(name, ',');
        if (next)
            *next++ = 0;
        result = parse_name(wanted, name);
    }
    free(copy);
    return result;
}

static enum turner_result check_memory(const struct turner_layers *layers)
{
    size_t pixels = (size_t)layers->width * (size_t)layers->height;
    size_t words = 4; /* the picture itself */
    for (int i = 0; i < TURNER_LAYERS; i++)
        words += layers->wanted >> i & 1 ? strlen(kinds[i].channels) : 0;
    uint64_t bytes = (uint64_t)pixels * words * sizeof(float);
    uint64_t available = turner_memory_available();
    if (bytes <= available)
        return TURNER_OK;
    return turner_fail(TURNER_DEVICE,
                       "a picture of %d×%d pixels takes %.1f MiB with its layers, but only %.1f MiB "
                       "of memory are free; choose a smaller size or fewer layers",
                       layers->width, layers->height, (double)bytes / 1048576,
                       (double)available / 1048576);
}

enum turner_result turner_layers_create(struct turner_layers *layers,
                                        const struct turner_scene *scene)
{
    const struct turner_settings *settings = &scene->settings;
    *layers = (struct turner_layers){.wanted = layers->wanted & ((1u << TURNER_LAYERS) - 1),
                                     .width = settings->width,
                                     .height = settings->height};
    enum turner_result result = TURNER_OK;
    TURNER_TRY_DONE(check_memory(layers));
    if (turner_layers_want(layers, 1u << TURNER_LAYER_ID)) {
        struct turner_ids ids;
        TURNER_TRY_DONE(turner_ids_create(&ids, scene));
        turner_ids_destroy(&ids);
    }
    size_t pixels = (size_t)layers->width * (size_t)layers->height;
    for (int i = 0; i < TURNER_LAYERS; i++) {
        if (!(layers->wanted >> i & 1))
            continue;
        if (kinds[i].whole)
            layers->whole[i] = turner_calloc(pixels, sizeof *layers->whole[i]);
        else
            layers->real[i] =
                turner_calloc(pixels * strlen(kinds[i].channels), sizeof *layers->real[i]);
    }
    uint32_t *samples = layers->whole[TURNER_LAYER_SAMPLES];
    for (size_t i = 0; samples && i < pixels; i++)
        samples[i] = (uint32_t)settings->spp;
done:
    if (result != TURNER_OK)
        turner_layers_destroy(layers);
    return result;
}

void turner_layers_destroy(struct turner_layers *layers)
{
    for (int i = 0; i < TURNER_LAYERS; i++) {
        free(layers->real[i]);
        free(layers->whole[i]);
    }
    *layers = (struct turner_layers){.wanted = layers->wanted};
}

void turner_layers_inspect(struct turner_layers *layers, const struct turner_image *image)
{
    float *pruned = layers->real[TURNER_LAYER_PRUNED];
    uint32_t *nonfinite = layers->whole[TURNER_LAYER_NONFINITE];
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels && (pruned || nonfinite); i++) {
        const float *p = image->rgba + 4 * i;
        if (pruned)
            pruned[i] = p[3];
        if (nonfinite)
            nonfinite[i] = !(isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]) && isfinite(p[3]));
    }
}

size_t turner_layers_channels(struct turner_image_channel channels[TURNER_LAYER_CHANNELS],
                              const struct turner_layers *layers)
{
    size_t count = 0;
    for (int i = 0; i < TURNER_LAYERS; i++) {
        size_t stride = strlen(kinds[i].channels);
        for (size_t c = 0; c < stride && (layers->wanted >> i & 1); c++) {
            struct turner_image_channel *channel = &channels[count++];
            *channel = (struct turner_image_channel){.stride = stride, .whole = kinds[i].whole};
            snprintf(channel->name, sizeof channel->name, "%s.%c", kinds[i].name,
                     kinds[i].channels[c]);
            channel->values = kinds[i].whole ? (const void *)(layers->whole[i] + c)
                                             : (const void *)(layers->real[i] + c);
        }
    }
    return count;
}
