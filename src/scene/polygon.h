/* Flat polygons into triangles. */
#ifndef TURNER_SCENE_POLYGON_H
#define TURNER_SCENE_POLYGON_H

#include <stddef.h>
#include <stdint.h>

#include "base/result.h"
#include "base/vec.h"

#define TURNER_MAX_POLYGON_CORNERS 16384

/* Zero it before the first use, then fill corners (with TURNER_PUSH) and triangulate, as often as
 * wanted; the arrays are kept from one polygon to the next. */
struct turner_polygon {
    struct turner_vec3 *corners;
    size_t corner_count, corner_capacity;
    uint32_t (*triangles)[3]; /* indices into corners */
    size_t triangle_count, triangle_capacity;
    struct turner_vec3 normal; /* Newell's; its length is twice the signed area */
};

/* Fills `triangles` and `normal` from `corners` (any number up to TURNER_MAX_POLYGON_CORNERS; more
 * than that is our own mistake). The polygon may be concave, touch itself (a hole on a keyhole
 * edge) or cross itself: it is filled by the even-odd rule. Every triangle is wound as Newell's
 * normal has it, also where the corners do not quite lie in a plane. A polygon without area has no
 * triangles; that is no failure. Where the outline crosses itself new corners are appended.
 *
 * Convex outlines become a fan about corner 0; other simple ones are cut by ears (Meisters 1975);
 * all others are cut into trapezoids between the heights of their corners and crossings.
 * TURNER_BAD_INPUT for an outline with so many crossings that the trapezoids would be too many. */
enum turner_result turner_polygon_triangulate(struct turner_polygon *polygon);

/* Frees the arrays and zeroes the polygon. */
void turner_polygon_destroy(struct turner_polygon *polygon);

#endif
