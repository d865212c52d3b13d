#include "scene/polygon.h"

#include <assert.h>
#include <float.h>
#include <stdlib.h>

#include "base/memory.h"

/* Lines times edges of an outline that is cut into trapezoids. */
#define MAX_TRAPEZOID_WORK (1u << 20)
#define NO_CORNER UINT32_MAX

struct point {
    double x, y;
};

/* The outline in the plane: corners that follow their twin are left out. */
struct outline {
    struct point *points;
    uint32_t *corners; /* of each point, index into the polygon's corners */
    size_t count;
};

static void add_triangle(struct turner_polygon *polygon, uint32_t a, uint32_t b, uint32_t c)
{
    uint32_t *triangle = *TURNER_PUSH(polygon->triangles, polygon->triangle_count,
                                      polygon->triangle_capacity);
    triangle[0] = a;
    triangle[1] = b;
    triangle[2] = c;
}

/* fmin and fmax without their care for NaN, which costs a call */
static double least(double a, double b)
{
    return a < b ? a : b;
}

static double most(double a, double b)
{
    return a > b ? a : b;
}

/* Twice the signed area of abc, positive when counter-clockwise; 0 when rounding decides. */
static double orient(struct point a, struct point b, struct point c)
{
    double left = (b.x - a.x) * (c.y - a.y), right = (b.y - a.y) * (c.x - a.x);
    double area = left - right;
    return fabs(area) > 4 * DBL_EPSILON * (fabs(left) + fabs(right)) ? area : 0;
}

/* Newell's normal, taken about corner 0 so that a far polygon loses no digits. False when the
 * area is nothing but rounding. */
static bool newell(struct turner_polygon *polygon)
{
    struct turner_vec3 sum = {0, 0, 0};
    double extent = 0; /* squared */
    for (size_t i = 1; i + 1 < polygon->corner_count; i++) {
        struct turner_vec3 a = turner_vec3_sub(polygon->corners[i], polygon->corners[0]);
        struct turner_vec3 b = turner_vec3_sub(polygon->corners[i + 1], polygon->corners[0]);
        sum = turner_vec3_add(sum, turner_vec3_cross(a, b));
        extent = most(extent, most(turner_vec3_dot(a, a), turner_vec3_dot(b, b)));
    }
    polygon->normal = sum;
    return turner_vec3_length(sum) > 8 * DBL_EPSILON * extent;
}

/* Drops the coordinate along which the normal is longest; seen from the normal's side the outline
 * then has a positive area. */
static void project(struct outline *outline, const struct turner_polygon *polygon)
{
    struct turner_vec3 n = polygon->normal;
    double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    for (size_t i = 0; i < polygon->corner_count; i++) {
        struct turner_vec3 c = turner_vec3_sub(polygon->corners[i], polygon->corners[0]);
        struct point p;
        bool swap;
        if (x >= y && x >= z) {
            p = (struct point){c.y, c.z};
            swap = n.x < 0;
        } else if (y >= z) {
            p = (struct point){c.z, c.x};
            swap = n.y < 0;
        } else {
            p = (struct point){c.x, c.y};
            swap = n.z < 0;
        }
        if (swap)
            p = (struct point){p.y, p.x};
        if (outline->count && p.x == outline->points[outline->count - 1].x &&
            p.y == outline->points[outline->count - 1].y)
            continue;
        outline->points[outline->count] = p;
        outline->corners[outline->count++] = (uint32_t)i;
    }
    while (outline->count > 1 &&
           outline->points[0].x == outline->points[outline->count - 1].x &&
           outline->points[0].y == outline->points[outline->count - 1].y)
        outline->count--;
}

/* The outline turns back on itself at b. */
static bool folds(struct point a, struct point b, struct point c)
{
    return orient(a, b, c) == 0 && (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y) < 0;
}

/* Turns left everywhere and goes round once: edges change between rightward and leftward twice. */
static bool is_convex(const struct outline *o)
{
    size_t changes = 0;
    for (size_t i = 0; i < o->count; i++) {
        struct point a = o->points[i], b = o->points[(i + 1) % o->count],
                     c = o->points[(i + 2) % o->count];
        if (orient(a, b, c) < 0 || folds(a, b, c))
            return false;
        bool right = b.x > a.x || (b.x == a.x && b.y > a.y);
        bool right_next = c.x > b.x || (c.x == b.x && c.y > b.y);
        changes += right != right_next;
    }
    return changes == 2;
}

/* Whether segments ab and cd have a point in common. */
static bool segments_meet(struct point a, struct point b, struct point c, struct point d)
{
    if (most(a.x, b.x) < least(c.x, d.x) || most(c.x, d.x) < least(a.x, b.x) ||
        most(a.y, b.y) < least(c.y, d.y) || most(c.y, d.y) < least(a.y, b.y))
        return false;
    double abc = orient(a, b, c), abd = orient(a, b, d);
    if ((abc > 0 && abd > 0) || (abc < 0 && abd < 0))
        return false;
    double cda = orient(c, d, a), cdb = orient(c, d, b);
    return !((cda > 0 && cdb > 0) || (cda < 0 && cdb < 0));
}

/* No two edges have a point in common but the corner between neighbours. */
static bool is_simple(const struct outline *o)
{
    const struct point *p = o->points;
    size_t n = o->count;
    for (size_t i = 0; i < n; i++) {
        if (folds(p[i], p[(i + 1) % n], p[(i + 2) % n]))
            return false;
        for (size_t j = i + 2; j < n; j++) {
            if ((j + 1) % n != i && segments_meet(p[i], p[i + 1], p[j], p[(j + 1) % n]))
                return false;
        }
    }
    return true;
}

/* ---- ears ---- */

struct ring {
    uint32_t *next, *previous;
    bool *ear;
    uint32_t *blunt; /* the corners left at which the outline does not turn left */
    size_t blunt_count;
};

static bool is_blunt(const struct outline *o, const struct ring *ring, uint32_t i)
{
    return orient(o->points[ring->previous[i]], o->points[i], o->points[ring->next[i]]) <= 0;
}

/* A triangle that holds any part of a simple outline holds one of its blunt corners. */
static bool is_ear(const struct outline *o, const struct ring *ring, uint32_t tip)
{
    uint32_t first = ring->previous[tip], last = ring->next[tip];
    struct point a = o->points[first], b = o->points[tip], c = o->points[last];
    if (orient(a, b, c) <= 0)
        return false;
    double low_x = least(a.x, least(b.x, c.x)), high_x = most(a.x, most(b.x, c.x));
    double low_y = least(a.y, least(b.y, c.y)), high_y = most(a.y, most(b.y, c.y));
    for (size_t k = 0; k < ring->blunt_count; k++) {
        uint32_t i = ring->blunt[k];
        struct point p = o->points[i];
        if (p.x >= low_x && p.x <= high_x && p.y >= low_y && p.y <= high_y && i != first &&
            i != last && orient(a, b, p) >= 0 && orient(b, c, p) >= 0 && orient(c, a, p) >= 0)
            return false;
    }
    return true;
}

/* After an ear beside corner i was cut: a blunt corner may have become a sharp one, never the
 * other way round. */
static void update_blunt(const struct outline *o, struct ring *ring, uint32_t i)
{
    for (size_t k = 0; k < ring->blunt_count; k++) {
        if (ring->blunt[k] == i) {
            if (!is_blunt(o, ring, i))
                ring->blunt[k] = ring->blunt[--ring->blunt_count];
            return;
        }
    }
}

/* A simple outline always has an ear; cutting one changes only whether its two neighbours are
 * ears. False if rounding left none. */
static bool cut_ears(struct turner_polygon *polygon, const struct outline *o)
{
    size_t left = o->count;
    struct ring ring = {turner_calloc(left, sizeof *ring.next),
                        turner_calloc(left, sizeof *ring.previous),
                        turner_calloc(left, sizeof *ring.ear),
                        turner_calloc(left, sizeof *ring.blunt), 0};
    for (uint32_t i = 0; i < left; i++) {
        ring.next[i] = i + 1 < left ? i + 1 : 0;
        ring.previous[i] = i ? i - 1 : (uint32_t)left - 1;
    }
    for (uint32_t i = 0; i < left; i++) {
        if (is_blunt(o, &ring, i))
            ring.blunt[ring.blunt_count++] = i;
    }
    for (uint32_t i = 0; i < left; i++)
        ring.ear[i] = is_ear(o, &ring, i);

    uint32_t i = 0;
    size_t misses = 0;
    while (left > 3 && misses <= left) {
        uint32_t before = ring.previous[i], after = ring.next[i];
        if (!ring.ear[i]) {
            misses++;
            i = after;
            continue;
        }
        misses = 0;
        add_triangle(polygon, o->corners[before], o->corners[i], o->corners[after]);
        ring.next[before] = after;
        ring.previous[after] = before;
        left--;
        update_blunt(o, &ring, before);
        update_blunt(o, &ring, after);
        ring.ear[before] = is_ear(o, &ring, before);
        ring.ear[after] = is_ear(o, &ring, after);
        i = ring.next[after]; /* not after itself: that would make a fan of slivers */
    }
    bool done = left == 3 && ring.ear[i];
    if (done)
        add_triangle(polygon, o->corners[ring.previous[i]], o->corners[i],
                     o->corners[ring.next[i]]);
    free(ring.next);
    free(ring.previous);
    free(ring.ear);
    free(ring.blunt);
    return done;
}

/* ---- trapezoids ---- */

/* Where the outline meets a horizontal line. */
struct meeting {
    double x;
    uint32_t edge;
    uint32_t corner; /* NO_CORNER where the edge only passes */
};

struct line {
    struct meeting *meetings; /* from left to right */
    size_t count, capacity;
};

struct edge {
    size_t low, high; /* lines on which its ends lie, low < high */
    uint32_t a, b;    /* its ends, points of the outline; a is the lower one */
};

/* An edge within the slab between two lines. */
struct side {
    double x; /* half way up */
    uint32_t edge;
};

struct slabs {
    struct turner_polygon *polygon;
    const struct outline *outline;
    double *heights; /* of the lines, ascending */
    size_t line_count, line_capacity;
    struct edge *edges;
    size_t edge_count;
    double tolerance; /* heights and x closer than this are the same */
};

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static int compare_meetings(const void *a, const void *b)
{
    const struct meeting *x = a, *y = b;
    if (x->x != y->x)
        return x->x < y->x ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

static int compare_sides(const void *a, const void *b)
{
    const struct side *x = a, *y = b;
    if (x->x != y->x)
        return x->x < y->x ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

/* The line nearest to y. */
static size_t line_at(const struct slabs *s, double y)
{
    size_t low = 0, high = s->line_count - 1;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (s->heights[middle] < y)
            low = middle + 1;
        else
            high = middle;
    }
    return low && y - s->heights[low - 1] < s->heights[low] - y ? low - 1 : low;
}

/* How far along the edge its point on the line is, 0 at a and 1 at b. */
static double edge_parameter(const struct slabs *s, const struct edge *e, size_t line)
{
    if (line == e->low || line == e->high)
        return line == e->high;
    struct point a = s->outline->points[e->a], b = s->outline->points[e->b];
    return least(most((s->heights[line] - a.y) / (b.y - a.y), 0), 1);
}

static double edge_x(const struct slabs *s, const struct edge *e, size_t line)
{
    struct point a = s->outline->points[e->a], b = s->outline->points[e->b];
    double t = edge_parameter(s, e, line);
    return t == 1 ? b.x : a.x + t * (b.x - a.x);
}

/* Heights of all corners and of all crossings of two edges, without repeats. False when the work
 * would be beyond the limit. */
static bool find_lines(struct slabs *s)
{
    const struct point *p = s->outline->points;
    size_t n = s->outline->count;
    for (size_t i = 0; i < n; i++) {
        *TURNER_PUSH(s->heights, s->line_count, s->line_capacity) = p[i].y;
        struct point a = p[i], b = p[(i + 1) % n];
        for (size_t j = i + 2; j < n; j++) {
            struct point c = p[j], d = p[(j + 1) % n];
            if (!segments_meet(a, b, c, d))
                continue;
            double of_c = orient(a, b, c), of_d = orient(a, b, d);
            if (of_c == of_d) /* along one another: only ends matter */
                continue;
            *TURNER_PUSH(s->heights, s->line_count, s->line_capacity) =
                c.y + of_c / (of_c - of_d) * (d.y - c.y);
            if (s->line_count * n > MAX_TRAPEZOID_WORK)
                return false;
        }
    }
    if (s->line_count * n > MAX_TRAPEZOID_WORK)
        return false;
    qsort(s->heights, s->line_count, sizeof *s->heights, compare_doubles);
    size_t kept = 1;
    for (size_t i = 1; i < s->line_count; i++) {
        if (s->heights[i] - s->heights[kept - 1] > s->tolerance)
            s->heights[kept++] = s->heights[i];
    }
    s->line_count = kept;
    return true;
}

static void find_edges(struct slabs *s)
{
    size_t n = s->outline->count;
    s->edges = turner_calloc(n, sizeof *s->edges);
    for (uint32_t i = 0; i < n; i++) {
        struct edge e = {.a = i, .b = i + 1 < n ? i + 1 : 0};
        e.low = line_at(s, s->outline->points[e.a].y);
        e.high = line_at(s, s->outline->points[e.b].y);
        if (e.low > e.high)
            e = (struct edge){e.high, e.low, e.b, e.a};
        if (e.low != e.high) /* level edges bound nothing */
            s->edges[s->edge_count++] = e;
    }
}

/* All points of the outline on the line; where edges only pass a corner is made, so that the
 * trapezoids above and below share it. */
static void meet(struct slabs *s, struct line *line, size_t index)
{
    struct turner_polygon *polygon = s->polygon;
    line->count = 0;
    for (uint32_t i = 0; i < s->edge_count; i++) {
        const struct edge *e = &s->edges[i];
        if (index < e->low || index > e->high)
            continue;
        struct meeting m = {edge_x(s, e, index), i, NO_CORNER};
        if (index == e->low || index == e->high)
            m.corner = s->outline->corners[index == e->low ? e->a : e->b];
        *TURNER_PUSH(line->meetings, line->count, line->capacity) = m;
    }
    if (!line->count) /* qsort wants an array */
        return;
    qsort(line->meetings, line->count, sizeof *line->meetings, compare_meetings);
    size_t kept = 0;
    for (size_t i = 1; i < line->count; i++) {
        struct meeting *last = &line->meetings[kept], *m = &line->meetings[i];
        if (m->x - last->x > s->tolerance)
            line->meetings[++kept] = *m;
        else if (last->corner == NO_CORNER)
            last->corner = m->corner;
    }
    line->count = kept + 1;
    for (size_t i = 0; i < line->count; i++) {
        struct meeting *m = &line->meetings[i];
        if (m->corner != NO_CORNER)
            continue;
        const struct edge *e = &s->edges[m->edge];
        struct turner_vec3 from = polygon->corners[s->outline->corners[e->a]];
        struct turner_vec3 way =
            turner_vec3_sub(polygon->corners[s->outline->corners[e->b]], from);
        m->corner = (uint32_t)polygon->corner_count;
        *TURNER_PUSH(polygon->corners, polygon->corner_count, polygon->corner_capacity) =
            turner_vec3_add(from, turner_vec3_scale(way, edge_parameter(s, e, index)));
    }
}

/* The meeting nearest to x. */
static size_t nearest(const struct line *line, double x)
{
    size_t low = 0, high = line->count - 1;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (line->meetings[middle].x < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low && x - line->meetings[low - 1].x < line->meetings[low].x - x ? low - 1 : low;
}

/* The trapezoid between two edges: a strip between the points of its lower and its upper line. */
static void add_trapezoid(struct slabs *s, const struct line *lower, size_t i, size_t i_end,
                          const struct line *upper, size_t j, size_t j_end)
{
    while (i < i_end || j < j_end) {
        bool along_lower =
            j >= j_end || (i < i_end && lower->meetings[i + 1].x <= upper->meetings[j + 1].x);
        uint32_t a = lower->meetings[i].corner, c = upper->meetings[j].corner;
        if (along_lower)
            add_triangle(s->polygon, a, lower->meetings[++i].corner, c);
        else
            add_triangle(s->polygon, a, upper->meetings[++j].corner, c);
    }
}

static bool cut_trapezoids(struct turner_polygon *polygon, const struct outline *outline)
{
    struct slabs s = {.polygon = polygon, .outline = outline};
    double extent = 0;
    for (size_t i = 0; i < outline->count; i++)
        extent = most(extent, most(fabs(outline->points[i].x), fabs(outline->points[i].y)));
    s.tolerance = 64 * DBL_EPSILON * extent;
    bool done = find_lines(&s);
    if (done) {
        find_edges(&s);
        struct line lower = {0}, upper = {0};
        struct side *sides = turner_calloc(s.edge_count, sizeof *sides);
        meet(&s, &lower, 0);
        for (size_t k = 0; k + 1 < s.line_count; k++) {
            meet(&s, &upper, k + 1);
            size_t count = 0;
            for (uint32_t i = 0; i < s.edge_count; i++) {
                const struct edge *e = &s.edges[i];
                if (e->low <= k && e->high > k)
                    sides[count++] = (struct side){edge_x(&s, e, k) + edge_x(&s, e, k + 1), i};
            }
            if (count)
                qsort(sides, count, sizeof *sides, compare_sides);
            for (size_t i = 0; i + 1 < count; i += 2) { /* even-odd: inside from each to the next */
                const struct edge *e = &s.edges[sides[i].edge], *f = &s.edges[sides[i + 1].edge];
                add_trapezoid(&s, &lower, nearest(&lower, edge_x(&s, e, k)),
                              nearest(&lower, edge_x(&s, f, k)), &upper,
                              nearest(&upper, edge_x(&s, e, k + 1)),
                              nearest(&upper, edge_x(&s, f, k + 1)));
            }
            struct line swap = lower;
            lower = upper;
            upper = swap;
        }
        free(sides);
        free(lower.meetings);
        free(upper.meetings);
    }
    free(s.heights);
    free(s.edges);
    return done;
}

enum turner_result turner_polygon_triangulate(struct turner_polygon *polygon)
{
    assert(polygon->corner_count <= TURNER_MAX_POLYGON_CORNERS);
    polygon->triangle_count = 0;
    if (!newell(polygon))
        return TURNER_OK;
    struct outline outline = {turner_calloc(polygon->corner_count, sizeof *outline.points),
                              turner_calloc(polygon->corner_count, sizeof *outline.corners), 0};
    project(&outline, polygon);
    bool done = true;
    if (is_convex(&outline)) {
        for (size_t i = 1; i + 1 < outline.count; i++) {
            if (orient(outline.points[0], outline.points[i], outline.points[i + 1]) > 0)
                add_triangle(polygon, outline.corners[0], outline.corners[i],
                             outline.corners[i + 1]);
        }
    } else if (!is_simple(&outline) || !cut_ears(polygon, &outline)) {
        polygon->triangle_count = 0;
        done = cut_trapezoids(polygon, &outline);
    }
    free(outline.points);
    free(outline.corners);
    if (!done)
        return turner_fail(TURNER_BAD_INPUT,
                           "the outline of a polygon with %zu corners crosses itself too often; "
                           "split the polygon", polygon->corner_count);
    return TURNER_OK;
}

void turner_polygon_destroy(struct turner_polygon *polygon)
{
    free(polygon->corners);
    free(polygon->triangles);
    *polygon = (struct turner_polygon){0};
}
