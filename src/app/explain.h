/* The parts of `turner explain`: two trees of rays laid beside each other, as text and as JSON. */
#ifndef TURNER_APP_EXPLAIN_H
#define TURNER_APP_EXPLAIN_H

#include <stdio.h>

#include "scene/ray_tree.h"

/* What decides whether two rays agree. */
enum turner_ray_quantity {
    TURNER_RAY_DIRECTION,
    TURNER_RAY_T,
    TURNER_RAY_POINT,
    TURNER_RAY_WEIGHT,
    TURNER_RAY_CONTRIBUTION,
    TURNER_RAY_QUANTITIES
};
extern const char *const turner_ray_quantity_names[TURNER_RAY_QUANTITIES];

#define TURNER_NO_BITS (-1) /* one of the rays has no such quantity */

/* A ray of the device and the reference's; one may be TURNER_NONE. */
struct turner_ray_pair {
    uint32_t device, reference;
    /* Of the mantissa that agree (turner_agreeing_bits), or TURNER_NO_BITS. The scale of a point is
     * its ray's origin, that of a contribution the pixel times 2^(least_bits − mantissa): of one
     * that counts less, no difference shows in the pixel's last bit. */
    int bits[TURNER_RAY_QUANTITIES];
};

enum turner_ray_parting {
    TURNER_RAYS_AGREE,
    TURNER_RAYS_END_DIFFERENTLY, /* meet different things, or one meets nothing, or is cut */
    TURNER_RAYS_ALONE,           /* one side has no such ray */
    TURNER_RAYS_FEW_BITS
};

struct turner_ray_comparison {
    const struct turner_ray_tree *device, *reference; /* device NULL: the reference alone */
    struct turner_ray_pair *pairs;                    /* depth first */
    size_t count, capacity;
    int mantissa;               /* bits that could agree */
    int least_bits;             /* asked for */
    uint32_t parts;             /* the first pair that does not agree, or TURNER_NONE, and why */
    enum turner_ray_parting why;
    enum turner_ray_quantity quantity; /* FEW_BITS */
    /* of the pairs before that, the quantity that agrees in the fewest bits; TURNER_NONE: no pair */
    uint32_t worst;
    enum turner_ray_quantity worst_quantity;
};

/* Bits of the mantissa in which the `count` numbers a and b agree: −log2 of the largest difference
 * relative to the largest of |b| and `scale`, from 0 to `most`. Numbers that are not finite agree
 * only with the same. */
int turner_agreeing_bits(const long double *a, const long double *b, int count, long double scale,
                         int most);

/* Pairs camera ray with camera ray, then children of the same kind (and light) of pairs that met
 * the same. What one side lacks because its tree is truncated is no parting. Destroy with
 * turner_rays_destroy. */
void turner_rays_compare(struct turner_ray_comparison *comparison,
                         const struct turner_ray_tree *device,
                         const struct turner_ray_tree *reference, int least_bits);
void turner_rays_destroy(struct turner_ray_comparison *comparison);

/* Of a shadow ray that was blocked the occluder may differ: any will do. */
bool turner_rays_end_alike(const struct turner_ray_tree *a, uint32_t i,
                           const struct turner_ray_tree *b, uint32_t j);

/* The pair of a ray of one side. */
uint32_t turner_rays_find(const struct turner_ray_comparison *comparison, bool device,
                          uint32_t ray);

/* What is explained, and by whom. */
struct turner_explanation {
    const struct turner_scene *scene;
    int x, y;
    double sample_x, sample_y;          /* in the pixel */
    const char *device, *driver, *traversal, *precision; /* NULL without a device */
    struct turner_ray_comparison comparison;
};

/* For a terminal of 100 columns. */
void turner_explain_text(FILE *out, const struct turner_explanation *explanation);

/* One JSON object (docs/explain.md); numbers that are not finite are strings. */
void turner_explain_json(FILE *out, const struct turner_explanation *explanation);

#endif
