#include "bvh/wide.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/parallel.h"

enum { WIDTH = 4, STEPS = 255, PIECE = 4096 };

struct child {
    float lo[3], hi[3];
    uint32_t child, count; /* as in turner_gpu_node */
};

/* Half the surface. */
static double area(const struct child *child)
{
    double x = (double)child->hi[0] - (double)child->lo[0];
    double y = (double)child->hi[1] - (double)child->lo[1];
    double z = (double)child->hi[2] - (double)child->lo[2];
    return x * y + y * z + z * x;
}

/* Appends the children of a binary node, without those that are none. */
static int take_children(struct child children[WIDTH], int count,
                         const struct turner_gpu_node *node)
{
    for (int side = 0; side < 2; side++) {
        if (node->child[side] == 0 && node->count[side] == 0)
            continue;
        struct child *child = &children[count++];
        memcpy(child->lo, side ? node->lo1 : node->lo0, sizeof child->lo);
        memcpy(child->hi, side ? node->hi1 : node->hi0, sizeof child->hi);
        child->child = node->child[side];
        child->count = node->count[side];
    }
    return count;
}

/* The children of a wide node: those of a binary one, of which the largest gives way to its own
 * children as long as there is room. */
static int gather_children(struct child children[WIDTH], const struct turner_gpu_node *nodes,
                           uint32_t root)
{
    int count = take_children(children, 0, &nodes[root]);
    while (count < WIDTH) {
        int largest = -1;
        for (int i = 0; i < count; i++) {
            if (children[i].count == 0 &&
                (largest < 0 || area(&children[i]) > area(&children[largest])))
                largest = i;
        }
        if (largest < 0)
            break;
        uint32_t opened = children[largest].child;
        memmove(&children[largest], &children[largest + 1],
                (size_t)(count - largest - 1) * sizeof *children);
        count = take_children(children, count - 1, &nodes[opened]);
    }
    return count;
}

/* A place on the grid, as the shaders compute it: the product is exact, the sum rounded once. */
static float plane_at(float origin, float spacing, int step)
{
    return origin + (float)step * spacing;
}

/* The least power of two, and a normal number, whose grid reaches from lo to hi. */
static float spacing_of(float lo, float hi)
{
    int exponent;
    frexp(((double)hi - (double)lo) / STEPS, &exponent); /* below 2^exponent */
    float spacing = ldexpf(1, exponent < -125 ? -125 : exponent);
    while (spacing > FLT_MIN && plane_at(lo, spacing / 2, STEPS) >= hi)
        spacing /= 2;
    return spacing;
}

/* The last place on the grid not above x, which is not below the origin. */
static int step_below(float origin, float spacing, float x)
{
    double steps = floor(((double)x - (double)origin) / (double)spacing);
    int step = (int)fmin(steps, STEPS);
    while (step > 0 && plane_at(origin, spacing, step) > x)
        step--;
    return step;
}

/* The first not below x. */
static int step_above(float origin, float spacing, float x)
{
    double steps = ceil(((double)x - (double)origin) / (double)spacing);
    int step = (int)fmin(steps, STEPS);
    while (step < STEPS && plane_at(origin, spacing, step) < x)
        step++;
    return step;
}

static void set_boxes(struct turner_gpu_wide_node *node, const struct child *children, int count)
{
    for (int axis = 0; axis < 3; axis++) {
        struct turner_gpu_face *lower = &node->face[2 * axis], *upper = lower + 1;
        float lo = count ? children[0].lo[axis] : 0, hi = count ? children[0].hi[axis] : 0;
        for (int i = 1; i < count; i++) {
            lo = fminf(lo, children[i].lo[axis]);
            hi = fmaxf(hi, children[i].hi[axis]);
        }
        lower->grid = lo;
        upper->grid = spacing_of(lo, hi);
        for (int i = 0; i < count; i++) {
            int below = step_below(lo, upper->grid, children[i].lo[axis]);
            int above = step_above(lo, upper->grid, children[i].hi[axis]);
            lower->planes |= (uint32_t)below << (8 * i);
            upper->planes |= (uint32_t)above << (8 * i);
        }
    }
}

uint32_t turner_bvh_widen(struct turner_gpu_wide_node *wide, size_t *count,
                          const struct turner_gpu_node *nodes, uint32_t root)
{
    struct child children[WIDTH];
    int child_count = gather_children(children, nodes, root);
    size_t index = (*count)++;
    wide[index] = (struct turner_gpu_wide_node){0};
    wide[index].face[0].planes = root; /* until turner_bvh_wide_boxes */
    uint32_t below = 1;
    for (int i = 0; i < child_count; i++) {
        const struct child *child = &children[i];
        if (child->count) {
            assert(child->count <= 8 && child->child <= TURNER_WIDE_FIRST);
            wide[index].child[i] = TURNER_WIDE_LEAF |
                                   (child->count - 1) << TURNER_WIDE_COUNT_SHIFT | child->child;
            continue;
        }
        wide[index].child[i] = (uint32_t)*count;
        uint32_t entries = turner_bvh_widen(wide, count, nodes, child->child);
        below = entries > below ? entries : below;
    }
    return child_count ? (uint32_t)child_count - 1 + below : 0;
}

struct boxing {
    struct turner_gpu_wide_node *wide;
    const struct turner_gpu_node *nodes;
    uint32_t count;
};

static void box_piece(void *user, uint32_t piece)
{
    const struct boxing *b = user;
    for (uint32_t i = piece * PIECE; i < turner_piece_end(b->count, PIECE, piece); i++) {
        struct child children[WIDTH];
        int count = gather_children(children, b->nodes, b->wide[i].face[0].planes);
        b->wide[i].face[0].planes = 0;
        set_boxes(&b->wide[i], children, count);
    }
}

void turner_bvh_wide_boxes(struct turner_gpu_wide_node *wide, size_t count,
                           const struct turner_gpu_node *nodes)
{
    struct boxing boxing = {wide, nodes, (uint32_t)count};
    turner_parallel_for(turner_pieces(boxing.count, PIECE), box_piece, &boxing);
}

float turner_bvh_wide_plane(const struct turner_gpu_wide_node *node, int child, int axis, int side)
{
    const struct turner_gpu_face *face = &node->face[2 * axis];
    return plane_at(face[0].grid, face[1].grid, (int)(face[side].planes >> (8 * child) & 0xff));
}
