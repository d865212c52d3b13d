#include <math.h>
#include <stdlib.h>

#include "app/explain.h"
#include "base/memory.h"

const char *const turner_ray_quantity_names[TURNER_RAY_QUANTITIES] = {
    "direction", "t", "point", "weight", "contribution"};

int turner_agreeing_bits(const long double *a, const long double *b, int count, long double scale,
                         int most)
{
    long double error = 0;
    for (int i = 0; i < count; i++) {
        if (isfinite(a[i]) && isfinite(b[i])) {
            error = fmaxl(error, fabsl(a[i] - b[i]));
            scale = fmaxl(scale, fabsl(b[i]));
        } else if (!(a[i] == b[i] || (isnan(a[i]) && isnan(b[i])))) {
            return 0;
        }
    }
    if (error == 0)
        return most;
    if (scale == 0)
        return 0;
    long double bits = floorl(log2l(scale / error));
    return bits < 0 ? 0 : bits > most ? most : (int)bits;
}

/* ---- one pair ---- */

static bool same_place(const struct turner_ray_place *a, const struct turner_ray_place *b)
{
    return a->kind == b->kind && a->index == b->index && a->instance == b->instance;
}

bool turner_rays_end_alike(const struct turner_ray_tree *a, uint32_t i,
                           const struct turner_ray_tree *b, uint32_t j)
{
    const struct turner_ray_record *p = &a->rays[i], *q = &b->rays[j];
    if (p->kind == TURNER_RAY_SHADOW &&
        (p->end == TURNER_RAY_GIVEN_UP || q->end == TURNER_RAY_GIVEN_UP))
        return true; /* that is decided by what they bring */
    if (p->end != q->end)
        return false;
    if (p->end == TURNER_RAY_BLOCKED)
        return true;
    if (p->end == TURNER_RAY_SURFACE && !same_place(&p->place, &q->place))
        return false;
    size_t count, other;
    const struct turner_ray_crossing *c = turner_ray_tree_crossings(a, i, &count);
    const struct turner_ray_crossing *d = turner_ray_tree_crossings(b, j, &other);
    if (count != other)
        return false;
    for (size_t k = 0; k < count; k++) {
        if (!same_place(&c[k].place, &d[k].place))
            return false;
    }
    return true;
}

static bool has_way(const struct turner_ray_record *ray)
{
    return ray->end == TURNER_RAY_SURFACE || ray->end == TURNER_RAY_LIGHT ||
           ray->end == TURNER_RAY_BACKGROUND;
}

static bool was_traced(const struct turner_ray_record *ray)
{
    return has_way(ray) || ray->end == TURNER_RAY_BLOCKED || ray->end == TURNER_RAY_GIVEN_UP;
}

/* Contributions count from where their difference shows in the pixel's own last bit. */
static long double contribution_scale(const struct turner_ray_comparison *comparison)
{
    const long double *pixel = comparison->reference->radiance;
    long double scale = fmaxl(fabsl(pixel[0]), fmaxl(fabsl(pixel[1]), fabsl(pixel[2])));
    return isfinite(scale) ? ldexpl(scale, comparison->least_bits - comparison->mantissa) : 0;
}

static void measure(struct turner_ray_pair *pair, const struct turner_ray_comparison *comparison)
{
    const struct turner_ray_record *a = &comparison->device->rays[pair->device];
    const struct turner_ray_record *b = &comparison->reference->rays[pair->reference];
    int most = comparison->mantissa;
    bool surface = a->end == TURNER_RAY_SURFACE && b->end == TURNER_RAY_SURFACE;
    if (a->end == TURNER_RAY_OUT_OF_REACH || b->end == TURNER_RAY_OUT_OF_REACH ||
        a->end == TURNER_RAY_UNFINISHED)
        return;
    /* a point is made of the numbers of its ray's origin, too */
    long double size =
        fmaxl(fabsl(b->origin[0]), fmaxl(fabsl(b->origin[1]), fabsl(b->origin[2])));
    pair->bits[TURNER_RAY_DIRECTION] =
        turner_agreeing_bits(a->direction, b->direction, 3, 0, most);
    pair->bits[TURNER_RAY_WEIGHT] = turner_agreeing_bits(a->weight, b->weight, 3, 0, most);
    if (has_way(a) && has_way(b))
        pair->bits[TURNER_RAY_T] = turner_agreeing_bits(&a->t, &b->t, 1, 0, most);
    if (was_traced(a) && was_traced(b)) {
        pair->bits[TURNER_RAY_CONTRIBUTION] =
            turner_agreeing_bits(a->contribution, b->contribution, 3,
                                 contribution_scale(comparison), most);
    }
    if (surface)
        pair->bits[TURNER_RAY_POINT] = turner_agreeing_bits(a->point, b->point, 3, size, most);
}

/* ---- the trees ---- */

/* Rays of a truncated tree that go on to its end may have lost children. */
static bool may_lack_children(const struct turner_ray_tree *tree, uint32_t ray)
{
    return tree->truncated && turner_ray_tree_end(tree, ray) == tree->count;
}

static void part(struct turner_ray_comparison *comparison, enum turner_ray_parting why)
{
    if (comparison->parts != TURNER_NONE)
        return;
    comparison->parts = (uint32_t)comparison->count - 1;
    comparison->why = why;
}

static struct turner_ray_pair *add(struct turner_ray_comparison *comparison, uint32_t device,
                                   uint32_t reference)
{
    struct turner_ray_pair *pair =
        TURNER_PUSH(comparison->pairs, comparison->count, comparison->capacity);
    *pair = (struct turner_ray_pair){.device = device, .reference = reference};
    for (int q = 0; q < TURNER_RAY_QUANTITIES; q++)
        pair->bits[q] = TURNER_NO_BITS;
    return pair;
}

/* A subtree that only one side has. */
static void add_alone(struct turner_ray_comparison *comparison, bool device, uint32_t ray)
{
    const struct turner_ray_tree *tree = device ? comparison->device : comparison->reference;
    for (uint32_t i = ray, end = turner_ray_tree_end(tree, ray); i < end; i++)
        add(comparison, device ? i : TURNER_NONE, device ? TURNER_NONE : i);
}

static void judge_bits(struct turner_ray_comparison *comparison)
{
    uint32_t last = (uint32_t)comparison->count - 1;
    const struct turner_ray_pair *pair = &comparison->pairs[last];
    for (int q = 0; q < TURNER_RAY_QUANTITIES && comparison->parts == TURNER_NONE; q++) {
        int bits = pair->bits[q];
        if (bits == TURNER_NO_BITS)
            continue;
        if (bits < comparison->least_bits) {
            comparison->quantity = (enum turner_ray_quantity)q;
            part(comparison, TURNER_RAYS_FEW_BITS);
        } else if (comparison->worst == TURNER_NONE ||
                   bits < comparison->pairs[comparison->worst].bits[comparison->worst_quantity]) {
            comparison->worst = last;
            comparison->worst_quantity = (enum turner_ray_quantity)q;
        }
    }
}

static void compare(struct turner_ray_comparison *comparison, uint32_t i, uint32_t j);

/* The order of a ray among its siblings. */
static uint64_t rank(const struct turner_ray_record *ray)
{
    return (uint64_t)ray->kind << 32 | (ray->kind == TURNER_RAY_SHADOW ? ray->light : 0);
}

static void compare_children(struct turner_ray_comparison *comparison, uint32_t i, uint32_t j)
{
    const struct turner_ray_tree *a = comparison->device, *b = comparison->reference;
    uint32_t a_end = turner_ray_tree_end(a, i), b_end = turner_ray_tree_end(b, j);
    bool a_lacks = may_lack_children(a, i), b_lacks = may_lack_children(b, j);
    for (i++, j++; i < a_end || j < b_end;) {
        uint64_t a_rank = i < a_end ? rank(&a->rays[i]) : UINT64_MAX;
        uint64_t b_rank = j < b_end ? rank(&b->rays[j]) : UINT64_MAX;
        uint32_t next_i = i < a_end ? turner_ray_tree_end(a, i) : i;
        uint32_t next_j = j < b_end ? turner_ray_tree_end(b, j) : j;
        if (a_rank == b_rank) {
            compare(comparison, i, j);
        } else {
            bool device = a_rank < b_rank; /* it alone has this one */
            size_t before = comparison->count;
            add_alone(comparison, device, device ? i : j);
            bool lost = device ? b_lacks && j == b_end : a_lacks && i == a_end;
            if (!lost && comparison->parts == TURNER_NONE) {
                comparison->parts = (uint32_t)before;
                comparison->why = TURNER_RAYS_ALONE;
            }
        }
        if (a_rank <= b_rank)
            i = next_i;
        if (b_rank <= a_rank)
            j = next_j;
    }
}

static void compare(struct turner_ray_comparison *comparison, uint32_t i, uint32_t j)
{
    const struct turner_ray_tree *a = comparison->device, *b = comparison->reference;
    measure(add(comparison, i, j), comparison);
    if (turner_rays_end_alike(a, i, b, j)) {
        judge_bits(comparison);
        compare_children(comparison, i, j);
        return;
    }
    part(comparison, TURNER_RAYS_END_DIFFERENTLY);
    for (uint32_t child = i + 1, end = turner_ray_tree_end(a, i); child < end;
         child = turner_ray_tree_end(a, child))
        add_alone(comparison, true, child);
    for (uint32_t child = j + 1, end = turner_ray_tree_end(b, j); child < end;
         child = turner_ray_tree_end(b, child))
        add_alone(comparison, false, child);
}

void turner_rays_compare(struct turner_ray_comparison *comparison,
                         const struct turner_ray_tree *device,
                         const struct turner_ray_tree *reference, int least_bits)
{
    *comparison = (struct turner_ray_comparison){.device = device,
                                                 .reference = reference,
                                                 .mantissa = reference->mantissa,
                                                 .least_bits = least_bits,
                                                 .parts = TURNER_NONE,
                                                 .worst = TURNER_NONE};
    if (!device) {
        add_alone(comparison, false, 0);
        return;
    }
    if (device->mantissa < comparison->mantissa)
        comparison->mantissa = device->mantissa;
    compare(comparison, 0, 0);
}

void turner_rays_destroy(struct turner_ray_comparison *comparison)
{
    free(comparison->pairs);
    *comparison = (struct turner_ray_comparison){0};
}

uint32_t turner_rays_find(const struct turner_ray_comparison *comparison, bool device,
                          uint32_t ray)
{
    uint32_t i = 0;
    while (i < comparison->count && ray != (device ? comparison->pairs[i].device
                                                   : comparison->pairs[i].reference))
        i++;
    return i;
}
