/* What is known of pixels, as colours for the screen. */
#include <math.h>
#include <stdio.h>

#include "render/layers.h"
#include "view/painter.h"

static const struct {
    const char *name;
    int layer; /* turner_layer, or −1 */
} kinds[TURNER_SEEN_KINDS] = {
    [TURNER_SEEN_PICTURE] = {"picture", -1},
    [TURNER_SEEN_NORMAL] = {"normal", TURNER_LAYER_NORMAL},
    [TURNER_SEEN_DEPTH] = {"depth", TURNER_LAYER_DEPTH},
    [TURNER_SEEN_ID] = {"id", TURNER_LAYER_ID},
    [TURNER_SEEN_RAYS] = {"rays", TURNER_LAYER_RAYS},
    [TURNER_SEEN_RECURSION] = {"recursion", TURNER_LAYER_RECURSION},
    [TURNER_SEEN_PRUNED] = {"pruned", TURNER_LAYER_PRUNED},
    [TURNER_SEEN_ERROR] = {"error", TURNER_LAYER_ERROR},
    [TURNER_SEEN_NONFINITE] = {"nonfinite", TURNER_LAYER_NONFINITE},
    [TURNER_SEEN_DIFFERENCE] = {"difference", -1},
    [TURNER_SEEN_AGAINST] = {"against", -1},
};

const char *turner_seen_name(enum turner_seen seen)
{
    return kinds[seen].name;
}

uint32_t turner_seen_layers(enum turner_seen seen)
{
    return kinds[seen].layer < 0 ? 0 : 1u << kinds[seen].layer;
}

static void set(float *rgba, double r, double g, double b)
{
    rgba[0] = (float)r;
    rgba[1] = (float)g;
    rgba[2] = (float)b;
    rgba[3] = 0;
}

static double clamped(double v)
{
    return v > 0 ? v < 1 ? v : 1 : 0; /* NaN is 0 */
}

/* Black, red, yellow, white: as turner compare --heatmap. */
static void heat(float *rgba, double share)
{
    double s = 3 * clamped(share);
    set(rgba, clamped(s), clamped(s - 1), clamped(s - 2));
}

static void color_normals(struct turner_image *colors, const float *normals, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++, normals += 3) {
        bool none = normals[0] == 0 && normals[1] == 0 && normals[2] == 0;
        double half = none ? 0 : 0.5;
        set(colors->rgba + 4 * i, half + 0.5 * (double)normals[0], half + 0.5 * (double)normals[1],
            half + 0.5 * (double)normals[2]);
    }
}

static void color_depth(struct turner_image *colors, char legend[160], const float *depth,
                        size_t pixels)
{
    double least = HUGE_VAL, most = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (isfinite(depth[i])) {
            least = fmin(least, (double)depth[i]);
            most = fmax(most, (double)depth[i]);
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        double share = most > least ? ((double)depth[i] - least) / (most - least) : 0;
        double grey = isfinite(depth[i]) ? 1 - 0.9 * share : 0;
        set(colors->rgba + 4 * i, grey, grey, grey);
    }
    if (most > 0)
        snprintf(legend, 160, "white %.4g m, dark %.4g m", least, most);
}

/* Neighbours in number are no neighbours in colour. */
static void color_ids(struct turner_image *colors, const uint32_t *ids, size_t pixels)
{
    for (size_t i = 0; i < pixels; i++) {
        uint32_t h = ids[i] * 2654435761u;
        h = (h ^ h >> 15) * 2246822519u;
        h ^= h >> 13;
        double scale = ids[i] ? 1.0 / 300 : 0;
        set(colors->rgba + 4 * i, scale * (45 + (h & 255)), scale * (45 + (h >> 8 & 255)),
            scale * (45 + (h >> 16 & 255)));
    }
}

static double value_of(const struct turner_layers *layers, int layer, size_t i)
{
    return layers->real[layer] ? (double)layers->real[layer][i] : layers->whole[layer][i];
}

static void color_heat(struct turner_image *colors, char legend[160], enum turner_seen seen,
                       const struct turner_layers *layers, size_t pixels)
{
    double most = 0, sum = 0;
    int layer = kinds[seen].layer;
    for (size_t i = 0; i < pixels; i++) {
        double value = value_of(layers, layer, i);
        if (isfinite(value)) {
            most = fmax(most, value);
            sum += value;
        }
    }
    for (size_t i = 0; i < pixels; i++) {
        double value = value_of(layers, layer, i);
        if (isfinite(value))
            heat(colors->rgba + 4 * i, most > 0 ? value / most : 0);
        else
            set(colors->rgba + 4 * i, 1, 0, 1);
    }
    snprintf(legend, 160, "black 0, white %.4g; mean %.4g", most, sum / (double)pixels);
}

static void color_nonfinite(struct turner_image *colors, char legend[160], const uint32_t *flags,
                            const struct turner_image *image, size_t pixels)
{
    size_t count = 0;
    for (size_t i = 0; i < pixels; i++) {
        const float *p = image->rgba + 4 * i;
        double grey = clamped(((double)p[0] + (double)p[1] + (double)p[2]) / 12);
        count += flags[i];
        if (flags[i])
            set(colors->rgba + 4 * i, 1, 0, 1);
        else
            set(colors->rgba + 4 * i, grey, grey, grey);
    }
    snprintf(legend, 160, "%zu of %zu pixels are not finite (magenta)", count, pixels);
}

void turner_false_color(struct turner_image *colors, char legend[160], enum turner_seen seen,
                        const struct turner_layers *layers, const struct turner_image *image)
{
    size_t pixels = (size_t)colors->width * (size_t)colors->height;
    legend[0] = 0;
    switch (seen) {
    case TURNER_SEEN_NORMAL:
        color_normals(colors, layers->real[TURNER_LAYER_NORMAL], pixels);
        break;
    case TURNER_SEEN_DEPTH:
        color_depth(colors, legend, layers->real[TURNER_LAYER_DEPTH], pixels);
        break;
    case TURNER_SEEN_ID: color_ids(colors, layers->whole[TURNER_LAYER_ID], pixels); break;
    case TURNER_SEEN_NONFINITE:
        color_nonfinite(colors, legend, layers->whole[TURNER_LAYER_NONFINITE], image, pixels);
        break;
    case TURNER_SEEN_RAYS:
    case TURNER_SEEN_RECURSION:
    case TURNER_SEEN_PRUNED:
    case TURNER_SEEN_ERROR: color_heat(colors, legend, seen, layers, pixels); break;
    case TURNER_SEEN_PICTURE:
    case TURNER_SEEN_DIFFERENCE:
    case TURNER_SEEN_AGAINST:
    case TURNER_SEEN_KINDS:
        for (size_t i = 0; i < 4 * pixels; i++)
            colors->rgba[i] = (float)clamped((double)image->rgba[i]) / 4;
        break;
    }
}
