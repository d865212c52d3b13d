#include "render/lattice.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

#define FIRST_SAMPLES 4096

void turner_lattice_create(struct turner_lattice *lattice, int shift)
{
    *lattice = (struct turner_lattice){.shift = shift};
}

void turner_lattice_destroy(struct turner_lattice *lattice)
{
    free(lattice->keys);
    free(lattice->indices);
    free(lattice->positions);
    free(lattice->values);
    free(lattice->counts);
    *lattice = (struct turner_lattice){.shift = lattice->shift};
}

void turner_lattice_clear(struct turner_lattice *lattice)
{
    if (lattice->slots)
        memset(lattice->keys, 0, lattice->slots * sizeof *lattice->keys);
    lattice->count = lattice->traced = 0;
}

static uint64_t key_of(int32_t x, int32_t y)
{
    return ((uint64_t)(uint32_t)y << 32 | (uint32_t)x) + 1;
}

/* The slot of a key, or the empty one where it belongs. */
static size_t slot_of(const struct turner_lattice *lattice, uint64_t key)
{
    uint64_t hash = key * 0x9e3779b97f4a7c15u; /* Knuth's multiplicative hash */
    size_t slot = (size_t)(hash >> 20) & (lattice->slots - 1);
    while (lattice->keys[slot] && lattice->keys[slot] != key)
        slot = (slot + 1) & (lattice->slots - 1);
    return slot;
}

static void grow(struct turner_lattice *lattice)
{
    size_t old_slots = lattice->slots;
    uint64_t *old_keys = lattice->keys;
    uint32_t *old_indices = lattice->indices;
    lattice->capacity = lattice->capacity ? 2 * lattice->capacity : FIRST_SAMPLES;
    lattice->slots = 2 * lattice->capacity;
    lattice->keys = turner_calloc(lattice->slots, sizeof *lattice->keys);
    lattice->indices = turner_calloc(lattice->slots, sizeof *lattice->indices);
    lattice->positions =
        turner_realloc(lattice->positions, lattice->capacity, sizeof *lattice->positions);
    lattice->values = turner_realloc(lattice->values, lattice->capacity, sizeof *lattice->values);
    if (lattice->counted)
        lattice->counts =
            turner_realloc(lattice->counts, lattice->capacity, sizeof *lattice->counts);
    for (size_t i = 0; i < old_slots; i++) {
        if (!old_keys[i])
            continue;
        size_t slot = slot_of(lattice, old_keys[i]);
        lattice->keys[slot] = old_keys[i];
        lattice->indices[slot] = old_indices[i];
    }
    free(old_keys);
    free(old_indices);
}

uint32_t turner_lattice_at(struct turner_lattice *lattice, int32_t x, int32_t y,
                           const float position[2])
{
    if (lattice->count == lattice->capacity)
        grow(lattice);
    uint64_t key = key_of(x, y);
    size_t slot = slot_of(lattice, key);
    if (!lattice->keys[slot]) {
        lattice->keys[slot] = key;
        lattice->indices[slot] = (uint32_t)lattice->count;
        memcpy(lattice->positions[lattice->count], position, sizeof *lattice->positions);
        if (lattice->counted)
            lattice->counts[lattice->count] = (struct turner_gpu_pixel_counts){0};
        lattice->count++;
    }
    return lattice->indices[slot];
}

bool turner_lattice_find(const struct turner_lattice *lattice, int32_t x, int32_t y,
                         uint32_t *index)
{
    uint64_t key = key_of(x, y);
    size_t slot = slot_of(lattice, key);
    *index = lattice->indices[slot];
    return lattice->keys[slot] == key;
}
