/* Vertex normals for meshes that come without. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/readers.h"

struct placed_vertex {
    struct turner_vec3 position;
    uint32_t vertex;
};

static int compare_positions(const void *left, const void *right)
{
    const struct turner_vec3 *a = &((const struct placed_vertex *)left)->position;
    const struct turner_vec3 *b = &((const struct placed_vertex *)right)->position;
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    if (a->y != b->y)
        return a->y < b->y ? -1 : 1;
    return a->z < b->z ? -1 : a->z > b->z;
}

/* For each vertex, one vertex that stands for all at its position. The caller frees it. */
static uint32_t *weld(const struct turner_mesh *mesh)
{
    uint32_t *same = turner_calloc(mesh->vertex_count, sizeof *same);
    struct placed_vertex *sorted = turner_calloc(mesh->vertex_count, sizeof *sorted);
    for (uint32_t i = 0; i < mesh->vertex_count; i++)
        sorted[i] = (struct placed_vertex){mesh->positions[i], i};
    qsort(sorted, mesh->vertex_count, sizeof *sorted, compare_positions);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        bool starts = i == 0 || compare_positions(&sorted[i - 1], &sorted[i]) != 0;
        same[sorted[i].vertex] = starts ? sorted[i].vertex : same[sorted[i - 1].vertex];
    }
    free(sorted);
    return same;
}

static double angle_between(struct turner_vec3 a, struct turner_vec3 b)
{
    /* unlike acos, exact for nearly parallel and nearly opposite vectors */
    return atan2(turner_vec3_length(turner_vec3_cross(a, b)), turner_vec3_dot(a, b));
}

void turner_mesh_smooth(struct turner_mesh *mesh)
{
    uint32_t *same = weld(mesh);
    struct turner_vec3 *sums = turner_calloc(mesh->vertex_count, sizeof *sums);
    struct turner_vec3 *fallback = turner_calloc(mesh->vertex_count, sizeof *fallback);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        struct turner_vec3 edges[3]; /* edge c leads from corner c to the next one */
        const uint32_t *corners = mesh->triangles[i];
        for (int c = 0; c < 3; c++) {
            struct turner_vec3 edge = turner_vec3_sub(mesh->positions[corners[(c + 1) % 3]],
                                                      mesh->positions[corners[c]]);
            edges[c] = turner_vec3_normalize(edge);
        }
        struct turner_vec3 cross = turner_vec3_cross(edges[0], edges[1]);
        if (!(turner_vec3_length(cross) > 0))
            continue;
        struct turner_vec3 normal = turner_vec3_normalize(cross);
        for (int c = 0; c < 3; c++) {
            struct turner_vec3 back = turner_vec3_scale(edges[(c + 2) % 3], -1);
            double angle = angle_between(edges[c], back);
            struct turner_vec3 *sum = &sums[same[corners[c]]];
            *sum = turner_vec3_add(*sum, turner_vec3_scale(normal, angle));
            fallback[same[corners[c]]] = normal;
        }
    }

    free(mesh->normals);
    mesh->normals = turner_calloc(mesh->vertex_count, sizeof *mesh->normals);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        /* faces that cancel, as on a sheet seen from both sides, leave rounding noise */
        struct turner_vec3 normal = sums[same[i]];
        if (turner_vec3_length(normal) < 1e-9)
            normal = fallback[same[i]];
        if (!(turner_vec3_length(normal) > 0))
            normal = turner_vec3_of(0, 1, 0);
        normal = turner_vec3_normalize(normal);
        mesh->normals[i][0] = (float)normal.x;
        mesh->normals[i][1] = (float)normal.y;
        mesh->normals[i][2] = (float)normal.z;
    }
    free(same);
    free(sums);
    free(fallback);
}
