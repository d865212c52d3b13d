#include "render/depth.h"

#define ROUNDING 1e-6 /* a weight's relative error per surface, at most */

double turner_least_fresnel(double n1, double n2)
{
    double n = fmax(n1, n2) / fmin(n1, n2);
    double m = 1; /* cosθ_t / cosθ_i, seen from the thin side */
    if (n > 2 + sqrt(3)) {
        double s = (n * n * n * n - 6 * n * n + 1) / (n * n * n + n);
        m = 0.5 * (s + sqrt(s * s - 4));
    }
    double r_s = (n * m - 1) / (n * m + 1), r_p = (m - n) / (m + n);
    return 0.5 * (r_s * r_s + r_p * r_p);
}

/* Of the boundaries between the medium and those below it, the outside among them: the least F at
 * normal incidence and at any angle, and whether all have equal indices on both sides. */
struct boundaries {
    double normal, least;
    bool flat;
};

static struct boundaries boundaries_of(const struct turner_scene *scene,
                                       const struct turner_usage *usage, uint32_t medium)
{
    struct boundaries b = {1, 1, true};
    double inside = scene->media[medium].index;
    for (uint32_t i = 0; i <= medium; i++) {
        if (i < medium && !usage->media[i])
            continue;
        double other = i < medium ? scene->media[i].index : 1;
        double r = (inside - other) / (inside + other);
        b.normal = fmin(b.normal, r * r);
        b.least = fmin(b.least, turner_least_fresnel(inside, other));
        b.flat = b.flat && inside == other;
    }
    /* the naive cosine of the refracted angle makes F wrong by anything */
    if (scene->settings.methods.fresnel_cosine == TURNER_COSINE_NAIVE)
        b.normal = b.least = 0, b.flat = false;
    return b;
}

static struct turner_vec3 limit(struct turner_vec3 k_r)
{
    bool any = k_r.x != 0 || k_r.y != 0 || k_r.z != 0; /* else it is no metal at all */
    return any ? turner_vec3_of(fmax(1, k_r.x), fmax(1, k_r.y), fmax(1, k_r.z)) : k_r;
}

struct turner_weights turner_weights_of(const struct turner_scene *scene,
                                        const struct turner_usage *usage,
                                        const struct turner_material *material)
{
    struct turner_weights w = {material->k_r, material->k_t, false};
    enum turner_fresnel fresnel = turner_material_fresnel(&scene->settings, material);
    if (material->medium == TURNER_NONE) {
        if (fresnel == TURNER_FRESNEL_SCHLICK)
            w.reflected = limit(material->k_r);
        return w; /* a conductor's F reaches 1 at grazing incidence */
    }
    struct boundaries b = boundaries_of(scene, usage, material->medium);
    w.flat = b.flat;
    switch (fresnel) {
    case TURNER_FRESNEL_NONE:
        if (!b.flat) /* total internal reflection */
            w.reflected = turner_vec3_add(material->k_r, material->k_t);
        break;
    case TURNER_FRESNEL_SCHLICK:
        w.transmitted = turner_vec3_scale(material->k_t, 1 - b.normal);
        break;
    case TURNER_FRESNEL_EXACT:
        if (b.flat)
            w.reflected = turner_vec3_of(0, 0, 0);
        w.transmitted = turner_vec3_scale(material->k_t, 1 - b.least);
        break;
    }
    return w;
}

static double largest(struct turner_vec3 v)
{
    return fmax(v.x, fmax(v.y, v.z));
}

struct turner_depth turner_depth_of(const struct turner_scene *scene)
{
    struct turner_depth depth = {.material = TURNER_NONE};
    struct turner_usage usage;
    turner_usage_create(&usage, scene);
    for (uint32_t i = 0; i < scene->material_count; i++) {
        if (!usage.materials[i])
            continue;
        struct turner_weights w = turner_weights_of(scene, &usage, &scene->materials[i]);
        double weight = fmax(largest(w.reflected), largest(w.transmitted));
        if (weight > depth.weight) {
            depth.weight = weight;
            depth.material = i;
        }
    }
    turner_usage_destroy(&usage);

    double step = depth.weight * (1 + ROUNDING), weight = step;
    double cutoff = scene->settings.cutoff * (1 - ROUNDING);
    while (weight > 0 && weight >= cutoff && depth.useful < TURNER_MAX_DEPTH) {
        weight *= step;
        depth.useful++;
    }
    if (depth.useful == TURNER_MAX_DEPTH)
        depth.useful = TURNER_DEPTH_UNBOUNDED;
    return depth;
}
