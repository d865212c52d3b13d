/* Samples of dyadic places of the picture, each traced once however many cells meet there. They lie
 * at those places or near them. */
#ifndef TURNER_RENDER_LATTICE_H
#define TURNER_RENDER_LATTICE_H

#include "render/renderer.h"

struct turner_lattice {
    int shift;             /* places are (x, y) · 2^−shift pixels */
    uint64_t *keys;        /* hash table: place + 1, or 0 where it is empty */
    uint32_t *indices;     /* of the sample there */
    size_t slots;          /* a power of two, or 0 */
    float (*positions)[2]; /* in pixels, `count` */
    float (*values)[4];    /* radiance and pruned weight of the first `traced` */
    struct turner_gpu_pixel_counts *counts; /* what each took; NULL unless `counted` */
    bool counted;
    size_t count, traced, capacity;
};

/* Takes no memory yet; `counted` may be set then; release with turner_lattice_destroy. */
void turner_lattice_create(struct turner_lattice *lattice, int shift);
void turner_lattice_destroy(struct turner_lattice *lattice);
/* Forgets all samples. */
void turner_lattice_clear(struct turner_lattice *lattice);

/* The sample of a place, a new one at that position if there was none; (−1, −1) is none. */
uint32_t turner_lattice_at(struct turner_lattice *lattice, int32_t x, int32_t y,
                           const float position[2]);

/* Whether there is a sample of a place; sets its index. */
bool turner_lattice_find(const struct turner_lattice *lattice, int32_t x, int32_t y,
                         uint32_t *index);

#endif
