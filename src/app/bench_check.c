#include <math.h>

#include "app/bench.h"

/* Wherever tracers disagree the reference is asked, up to so many rays of a stream: with more, one
 * of them is broken, and known to be by then. */
#define MOST_DISPUTES 20000

/* Surfaces are floats apart: by t alone rays that pass an edge are not told from those beside. In
 * units of the numbers that t is made of. */
#define NEAR 2e-5

/* Shares of rays that may be wrong, beside a single one: those that pass a silhouette within
 * rounding (measured: about one in a million), and those that pass so near to the edge between two
 * triangles that the neighbour is named (one in 40,000 for a million triangles in a million
 * pixels). */
#define RIGHT 1e-5
#define RIGHT_NAME 1e-4

static double size_of(const struct turner_gpu_ray *ray, const struct turner_gpu_hit *hit)
{
    double size = fabs((double)hit->t);
    for (int i = 0; i < 3; i++)
        size = fmax(size, fabs((double)ray->origin[i]));
    return size;
}

/* Whether both say the same of how far the ray comes. */
static bool as_far(const struct turner_gpu_ray *ray, const struct turner_gpu_hit *a,
                   const struct turner_gpu_hit *b)
{
    bool met = a->t < INFINITY;
    if (met != (b->t < INFINITY))
        return false;
    if (!met || ray->kind == TURNER_RAY_ANY)
        return true;
    return fabs((double)a->t - (double)b->t) <= NEAR * size_of(ray, a);
}

/* And of what it meets. */
static bool agree(const struct turner_gpu_ray *ray, const struct turner_gpu_hit *a,
                  const struct turner_gpu_hit *b)
{
    if (!as_far(ray, a, b))
        return false;
    return !(a->t < INFINITY) || ray->kind == TURNER_RAY_ANY ||
           (a->id == b->id && a->instance == b->instance);
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

static struct turner_ray widened(const struct turner_gpu_ray *ray)
{
    const float *o = ray->origin, *d = ray->direction;
    return (struct turner_ray){.origin = vector(o[0], o[1], o[2]),
                               .direction = vector(d[0], d[1], d[2])};
}

static struct turner_gpu_hit truth_of(const struct turner_gpu_ray *ray,
                                      const struct turner_world *world)
{
    struct turner_ray wide = widened(ray);
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

/* Whether the primitive that `hit` names is there: of several at one place any will do. */
static bool meets(const struct turner_gpu_ray *ray, const struct turner_gpu_hit *hit,
                  const struct turner_world *world)
{
    const struct turner_scene *scene = world->scene;
    struct turner_ray own = widened(ray);
    struct turner_hit found;
    uint32_t index = hit->id & ((1u << TURNER_KIND_SHIFT) - 1);
    uint32_t kind = hit->id >> TURNER_KIND_SHIFT;
    bool met = false;
    if (hit->instance > scene->instance_count)
        return false;
    if (kind == TURNER_KIND_PLANE) {
        met = index < scene->plane_count &&
              turner_plane_intersect(&found, &scene->planes[index], &own, NULL);
        return met && fabs((double)found.t - (double)hit->t) <= NEAR * size_of(ray, hit);
    }
    const struct turner_group *group = &scene->groups[0];
    if (hit->instance) {
        const struct turner_world_instance *instance = &world->instances[hit->instance - 1];
        group = &scene->groups[instance->group];
        own.origin = map_point(&instance->to_group, own.origin);
        own.direction = map_vector(&instance->to_group, own.direction);
    }
    if (kind == TURNER_KIND_SPHERE && index < group->sphere_count)
        met = turner_sphere_intersect(&found, &group->spheres[index], &own, NULL);
    if (kind == TURNER_KIND_CONE && index < group->cone_count)
        met = turner_cone_intersect(&found, &group->cones[index], &own, NULL);
    if (kind == TURNER_KIND_TRIANGLE) {
        const struct turner_mesh *mesh = group->meshes, *end = mesh + group->mesh_count;
        for (; mesh < end && index >= mesh->triangle_count; mesh++)
            index -= mesh->triangle_count;
        met = mesh < end && turner_triangle_intersect(&found, mesh, index, &own, NULL);
    }
    return met && fabs((double)found.t - (double)hit->t) <= NEAR * size_of(ray, hit);
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
            const struct turner_gpu_hit *hit = &hits[k][i];
            cells[k].checked++;
            if (!as_far(ray, &truth, hit))
                cells[k].wrong++;
            else if (!agree(ray, &truth, hit) && !meets(ray, hit, world))
                cells[k].misnamed++;
        }
    }
}

bool turner_bench_right(const struct turner_bench_cell *cell, size_t rays)
{
    return (double)cell->wrong <= 1 + RIGHT * (double)rays &&
           (double)cell->misnamed <= 1 + RIGHT_NAME * (double)rays;
}
