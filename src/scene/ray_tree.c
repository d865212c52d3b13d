#include "scene/ray_tree.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"

void turner_ray_tree_destroy(struct turner_ray_tree *tree)
{
    free(tree->rays);
    free(tree->crossings);
    *tree = (struct turner_ray_tree){0};
}

uint32_t turner_ray_tree_add(struct turner_ray_tree *tree, enum turner_ray_kind kind,
                             uint32_t depth)
{
    if (tree->count == TURNER_RAY_TREE_MAX) {
        tree->truncated = true;
        return TURNER_NONE;
    }
    uint32_t index = (uint32_t)tree->count;
    *TURNER_PUSH(tree->rays, tree->count, tree->capacity) = (struct turner_ray_record){
        .kind = kind, .parent = depth > 0 ? tree->path[depth - 1] : TURNER_NONE, .depth = depth};
    if (kind != TURNER_RAY_SHADOW)
        tree->path[depth] = index;
    return index;
}

void turner_ray_tree_cross(struct turner_ray_tree *tree, uint32_t ray,
                           struct turner_ray_place place, long double t, bool real)
{
    if (ray == TURNER_NONE)
        return;
    *TURNER_PUSH(tree->crossings, tree->crossing_count, tree->crossing_capacity) =
        (struct turner_ray_crossing){.ray = ray, .t = t, .place = place, .real = real};
}

uint32_t turner_ray_tree_end(const struct turner_ray_tree *tree, uint32_t index)
{
    uint32_t end = index + 1;
    while (end < tree->count && tree->rays[end].depth > tree->rays[index].depth)
        end++;
    return end;
}

const struct turner_ray_crossing *turner_ray_tree_crossings(const struct turner_ray_tree *tree,
                                                            uint32_t index, size_t *count)
{
    size_t low = 0, high = tree->crossing_count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (tree->crossings[middle].ray < index)
            low = middle + 1;
        else
            high = middle;
    }
    *count = 0;
    while (low + *count < tree->crossing_count && tree->crossings[low + *count].ray == index)
        ++*count;
    return *count ? tree->crossings + low : NULL;
}

void turner_ray_tree_sum(long double sum[3], const struct turner_ray_tree *tree, uint32_t index)
{
    sum[0] = sum[1] = sum[2] = 0;
    for (uint32_t i = index, end = turner_ray_tree_end(tree, index); i < end; i++) {
        for (int channel = 0; channel < 3; channel++)
            sum[channel] += tree->rays[i].contribution[channel];
    }
}

/* ---- what is not finite ---- */

static bool finite3(const long double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

/* A way may be infinite where the ray left the scene, or its light is that far. */
static bool good_way(const struct turner_ray_record *ray)
{
    bool ends = ray->end == TURNER_RAY_SURFACE || ray->end == TURNER_RAY_BLOCKED ||
                ray->end == TURNER_RAY_GIVEN_UP;
    return isfinite(ray->t) || (!ends && ray->t > 0);
}

/* Pictures are floats, whatever the tracer calculates with. */
static bool in_picture(long double radiance)
{
    return fabsl(radiance) <= (long double)FLT_MAX;
}

static const char *nonfinite_quantity(const struct turner_ray_record *ray)
{
    const struct {
        const char *name;
        bool finite;
    } quantities[] = {
        {"weight", finite3(ray->weight)},
        {"direction", finite3(ray->direction)},
        {"irradiance", finite3(ray->irradiance)},
        {"N·L", isfinite(ray->n_l)},
        {"R·V", isfinite(ray->r_v)},
        {"diffuse term", finite3(ray->diffuse)},
        {"specular term", finite3(ray->specular)},
        {"origin", finite3(ray->origin)},
        {"t", good_way(ray)},
        {"share let through", finite3(ray->through)},
        {"point", finite3(ray->point)},
        {"geometric normal", finite3(ray->ng)},
        {"normal", finite3(ray->ns)},
        {"N·V", isfinite(ray->cosine)},
        {"refractive index", isfinite(ray->n1) && isfinite(ray->n2)},
        {"Fresnel value", finite3(ray->fresnel)},
        {"radiance", finite3(ray->radiance)},
        {"contribution", finite3(ray->contribution)},
    };
    for (size_t i = 0; i < sizeof quantities / sizeof *quantities; i++) {
        if (!quantities[i].finite)
            return quantities[i].name;
    }
    return NULL;
}

uint32_t turner_ray_tree_nonfinite(const struct turner_ray_tree *tree, const char **quantity)
{
    long double sum[3] = {0, 0, 0};
    uint32_t overflow = TURNER_NONE;
    for (uint32_t i = 0; i < tree->count; i++) {
        *quantity = nonfinite_quantity(&tree->rays[i]);
        if (*quantity)
            return i;
        for (int channel = 0; channel < 3; channel++) {
            sum[channel] += tree->rays[i].contribution[channel];
            if (!in_picture(sum[channel]) && overflow == TURNER_NONE)
                overflow = i;
        }
    }
    const long double *radiance = tree->radiance;
    if (in_picture(radiance[0]) && in_picture(radiance[1]) && in_picture(radiance[2]))
        return TURNER_NONE;
    *quantity = "sum of the contributions so far";
    return overflow != TURNER_NONE ? overflow : tree->count ? (uint32_t)tree->count - 1 : 0;
}
