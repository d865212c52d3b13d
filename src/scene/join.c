/* Vertices that are the same become one. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/parallel.h"
#include "scene/readers.h"

#define PIECE 65536 /* vertices that one thread hashes at once */
#define AHEAD 8     /* triangles whose slots are fetched before they are needed */

/* Every bit of a vertex, so that equal vertices have equal bytes. */
struct vertex_key {
    double position[3];
    float normal[3], uv[2];
    float unused; /* no padding bytes */
};

static struct vertex_key key_of(const struct turner_mesh *mesh, uint32_t i)
{
    struct vertex_key key = {0};
    key.position[0] = mesh->positions[i].x + 0.0; /* −0 equals 0 */
    key.position[1] = mesh->positions[i].y + 0.0;
    key.position[2] = mesh->positions[i].z + 0.0;
    if (mesh->normals)
        memcpy(key.normal, mesh->normals[i], sizeof key.normal);
    if (mesh->uvs)
        memcpy(key.uv, mesh->uvs[i], sizeof key.uv);
    return key;
}

static uint32_t hash_key(const struct vertex_key *key)
{
    uint64_t words[sizeof *key / sizeof(uint64_t)], hash = 0;
    memcpy(words, key, sizeof words);
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        hash = (hash ^ words[i]) * 0x9e3779b97f4a7c15u;
        hash ^= hash >> 29;
    }
    return (uint32_t)(hash >> 16);
}

/* Vertices by their content: an open hash table of 1 + their new numbers. */
struct table {
    const struct turner_mesh *mesh;
    uint32_t *hashes; /* of each vertex */
    uint32_t *slots;
    size_t mask;
    uint32_t *numbers; /* old -> 1 + new number, 0: not yet */
    uint32_t *kept;    /* new -> old number */
    uint32_t count;    /* kept */
};

static void hash_piece(void *user, uint32_t piece)
{
    struct table *table = user;
    uint32_t end = turner_piece_end(table->mesh->vertex_count, PIECE, piece);
    for (uint32_t i = piece * PIECE; i < end; i++) {
        struct vertex_key key = key_of(table->mesh, i);
        table->hashes[i] = hash_key(&key);
    }
}

/* 1 + the new number of a vertex that had none. */
static uint32_t number_of(struct table *table, uint32_t old)
{
    struct vertex_key key = key_of(table->mesh, old);
    size_t slot = table->hashes[old] & table->mask;
    for (; table->slots[slot]; slot = (slot + 1) & table->mask) {
        uint32_t candidate = table->kept[table->slots[slot] - 1];
        if (table->hashes[candidate] != table->hashes[old])
            continue;
        struct vertex_key other = key_of(table->mesh, candidate);
        if (memcmp(&key, &other, sizeof key) == 0)
            return table->slots[slot];
    }
    table->kept[table->count++] = old;
    return table->slots[slot] = table->count;
}

static void fetch_slots(const struct table *table, const uint32_t triangle[3])
{
    for (int c = 0; c < 3; c++)
        __builtin_prefetch(&table->slots[table->hashes[triangle[c]] & table->mask]);
}

static void number_vertices(struct table *table, struct turner_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        if (mesh->triangle_count - i > AHEAD)
            fetch_slots(table, mesh->triangles[i + AHEAD]);
        for (int c = 0; c < 3; c++) {
            uint32_t *number = &table->numbers[mesh->triangles[i][c]];
            if (!*number)
                *number = number_of(table, mesh->triangles[i][c]);
            mesh->triangles[i][c] = *number - 1;
        }
    }
}

void turner_mesh_join(struct turner_mesh *mesh)
{
    size_t slot_count = 16;
    while (slot_count < 2 * (size_t)mesh->vertex_count)
        slot_count *= 2;
    struct table table = {
        .mesh = mesh,
        .hashes = turner_calloc(mesh->vertex_count, sizeof *table.hashes),
        .slots = turner_calloc(slot_count, sizeof *table.slots),
        .mask = slot_count - 1,
        .numbers = turner_calloc(mesh->vertex_count, sizeof *table.numbers),
        .kept = turner_calloc(mesh->vertex_count, sizeof *table.kept),
    };
    turner_parallel_for(turner_pieces(mesh->vertex_count, PIECE), hash_piece, &table);
    number_vertices(&table, mesh);
    uint32_t count = table.count;
    struct turner_mesh joined = {.triangles = mesh->triangles,
                                 .vertex_count = count,
                                 .triangle_count = mesh->triangle_count};
    joined.positions = turner_calloc(count, sizeof *joined.positions);
    joined.normals = mesh->normals ? turner_calloc(count, sizeof *joined.normals) : NULL;
    joined.uvs = mesh->uvs ? turner_calloc(count, sizeof *joined.uvs) : NULL;
    for (uint32_t i = 0; i < count; i++) {
        joined.positions[i] = mesh->positions[table.kept[i]];
        if (joined.normals)
            memcpy(joined.normals[i], mesh->normals[table.kept[i]], sizeof joined.normals[i]);
        if (joined.uvs)
            memcpy(joined.uvs[i], mesh->uvs[table.kept[i]], sizeof joined.uvs[i]);
    }
    mesh->triangles = NULL;
    turner_mesh_destroy(mesh);
    *mesh = joined;
    free(table.hashes);
    free(table.slots);
    free(table.numbers);
    free(table.kept);
}
