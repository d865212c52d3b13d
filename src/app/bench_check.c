#include <math.h>

#include "app/bench.h"

/* Wherever tracers disagree the reference is asked, up to so many rays of a stream: with more, one
 * of them is broken, and known to be by then. */
#define MOST_DISPUTES 20000

/* Surfaces are floats apart: by t alone rays that pass an edge are not told from those beside. In
 * units of the numbers that t is made of. */
#define NEAR 2e-5

/* Share of rays that may be wrong, beside a single one: those that pass a silhouette within
 * rounding. Measured: about one in a million. */
#define RIGHT 1e-5

static bool agree(const struct turner_gpu_ray *ray, const struct turner_gpu_hit *a,
                  const struct turner_gpu_hit *b)
{
    bool met = a->t < INFINITY;
    if (met != (b->t < INFINITY))
        return false;
    if (!met || ray->kind == TURNER_RAY_ANY)
        return true;
    double size = fabs((double)a->t);
    for (int i = 0; i < 3; i++)
        size = fmax(size, fabs((double)ray->origin[i]));
    return fabs((double)a->t - (double)b->t) <= NEAR * size;
}

static uint32_t id_of(const struct turner_place *place, const struct turner_scene *scene)
{
    if (place->instance == TURNER_INSTANCE_PLANES)
        return TURNER_KIND_PLANE << TURNER_KIND_SHIFT | place->primitive;
    const struct turner_group *group =
        &scene->groups[place->instance ? scene->instances[place->instance - 1].group : 0];
    size_t index = place->primitive;
    if (index < group->sphere_count)
        return TURNER_KIND_SPHERE << TURNER_KIND_SHIFT | (uint32_t)index;
    index -= group->sphere_count;
    if (index < group->cone_count)
        return TURNER_KIND_CONE << TURNER_KIND_SHIFT | (uint32_t)index;
    return TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT | (uint32_t)(index - group->cone_count);
}

static struct turner_gpu_hit truth_of(const struct turner_gpu_ray *ray,
                                      const struct turner_world *world)
{
    const float *o = ray->origin, *d = ray->direction;
    struct turner_ray wide = {.origin = vector(o[0], o[1], o[2]),
                              .direction = vector(d[0], d[1], d[2])};
    struct turner_hit hit;
    if (ray->kind == TURNER_RAY_ANY)
        return (struct turner_gpu_hit){
            .t = turner_world_occluded(world, &wide, ray->t_max) ? 0 : INFINITY};
    if (!turner_world_intersect(&hit, world, &wide, ray->t_max))
        return (struct turner_gpu_hit){.t = INFINITY};
    return (struct turner_gpu_hit){
        (float)hit.t, id_of(&hit.place, world->scene),
        hit.place.instance > 0 ? (uint32_t)hit.place.instance : 0};
}

static bool disputed(const struct turner_gpu_ray *ray, struct turner_gpu_hit *const *hits, size_t n,
                     size_t i)
{
    const struct turner_gpu_hit *first = NULL;
    for (size_t k = 0; k < n; k++) {
        if (!hits[k])
            continue;
        first = first ? first : &hits[k][i];
        if (!agree(ray, first, &hits[k][i]))
            return true;
    }
    return false;
}

void turner_bench_check(struct turner_bench_cell *cells, struct turner_gpu_hit *const *hits,
                        size_t n, const struct turner_bench_stream *stream,
                        const struct turner_world *world, size_t check)
{
    size_t disputes = 0, sample = 0;
    for (size_t i = 0; i < stream->count; i++) {
        const struct turner_gpu_ray *ray = &stream->rays[i];
        bool due = sample * stream->count <= i * check; /* evenly */
        sample += due;
        bool dispute = disputes < MOST_DISPUTES && disputed(ray, hits, n, i);
        disputes += dispute;
        if (!due && !dispute)
            continue;
        struct turner_gpu_hit truth = truth_of(ray, world);
        for (size_t k = 0; k < n; k++) {
            if (!hits[k])
                continue;
            cells[k].checked++;
            cells[k].wrong += !agree(ray, &truth, &hits[k][i]);
        }
    }
}

bool turner_bench_right(const struct turner_bench_cell *cell, size_t rays)
{
    return (double)cell->wrong <= 1 + RIGHT * (double)rays;
}
