#include "render/measure.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/fastest.h"
#include "render/renderer.h"
#include "scene/readers.h"

#define SPHERES 1000
#define CELLS 100        /* of the mesh, along an edge */
#define EDGE 5.0         /* of the mesh, metres */
#define PICTURES_LEAST 3
#define PICTURES_MOST 50
#define SECONDS_LEAST 0.05 /* spent on pictures of a traversal */

static const char head[] =
    "{\"version\": 1, \"background\": 0.5, \"camera\": {\"from\": [0, 2, 5], \"at\": [0, 0, 0]},"
    " \"settings\": {\"size\": [512, 512], \"depth\": 2, \"cutoff\": 0},"
    " \"materials\": {\"m\": {\"k_d\": 0.5, \"k_r\": 0.5}},"
    " \"lights\": [{\"type\": \"point\", \"position\": [2, 5, 3], \"intensity\": 30}]}";

/* In [0,1): the additive recurrence of the plastic number's powers (Roberts, 2018). */
static struct turner_vec3 point(int i)
{
    static const double steps[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703};
    return turner_vec3_of(fmod(i * steps[0], 1), fmod(i * steps[1], 1), fmod(i * steps[2], 1));
}

static void add_spheres(struct turner_group *group)
{
    for (int i = 0; i < SPHERES; i++) {
        struct turner_vec3 p = point(i);
        struct turner_sphere sphere = {
            .center = turner_vec3_of(3 * p.x - 1.5, 2 * p.y - 0.5, 3 * p.z - 1.5), .radius = 0.05};
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) = sphere;
    }
}

/* Waves below the spheres. */
static void add_mesh(struct turner_group *group)
{
    const uint32_t row = CELLS + 1;
    struct turner_mesh mesh = {.vertex_count = row * row, .triangle_count = 2 * CELLS * CELLS};
    mesh.positions = turner_calloc(mesh.vertex_count, sizeof *mesh.positions);
    mesh.triangles = turner_calloc(mesh.triangle_count, sizeof *mesh.triangles);
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        double x = EDGE * (i % row) / CELLS - EDGE / 2, z = EDGE * (i / row) / CELLS - EDGE / 2;
        mesh.positions[i] = turner_vec3_of(x, 0.1 * sin(9 * x) * sin(7 * z) - 1, z);
    }
    uint32_t(*triangle)[3] = mesh.triangles;
    for (uint32_t i = 0; i < CELLS * CELLS; i++) {
        uint32_t a = i / CELLS * row + i % CELLS;
        const uint32_t two[2][3] = {{a, a + row, a + 1}, {a + 1, a + row, a + row + 1}};
        memcpy(triangle, two, sizeof two);
        triangle += 2;
    }
    *TURNER_PUSH(group->meshes, group->mesh_count, group->mesh_capacity) = mesh;
}

static enum turner_result time_pictures(double *rays_per_second, struct turner_renderer *renderer,
                                        const struct turner_render_options *options)
{
    struct turner_image image;
    enum turner_result result = TURNER_OK;
    double best = INFINITY, spent = 0, rays = 0;
    TURNER_TRY(turner_image_create(&image, renderer->settings.width, renderer->settings.height));
    for (int i = 0; i < PICTURES_MOST && (i < PICTURES_LEAST || spent < SECONDS_LEAST); i++) {
        struct turner_statistics counts = {0};
        TURNER_TRY_DONE(turner_renderer_draw(renderer, &image, options, &counts));
        best = fmin(best, counts.seconds_trace);
        spent += counts.seconds_trace;
        rays = (double)(counts.camera_rays + counts.reflected_rays + counts.shadow_rays);
    }
    *rays_per_second = rays / best;
done:
    turner_image_destroy(&image);
    return result;
}

static enum turner_result measure(struct turner_traversal_rate *rate, struct turner_gpu *gpu,
                                  const struct turner_scene *scene, bool no_cache)
{
    const struct turner_render_options options = {.no_cache = no_cache};
    struct turner_statistics unused = {0};
    struct turner_renderer renderer = {0};
    struct turner_kernel kernel = {0};
    unsigned kind;
    enum turner_result result;
    TURNER_TRY_DONE(
        turner_choose_kernel(&kind, &gpu->info, &scene->settings.methods, rate->traversal));
    TURNER_TRY_DONE(turner_kernel_create(&kernel, kind, &options));
    TURNER_TRY_DONE(turner_renderer_create(&renderer, gpu, &kernel, scene, &options, &unused));
    TURNER_TRY_DONE(turner_renderer_warm(&renderer));
    result = time_pictures(&rate->rays_per_second, &renderer, &options);
done:
    turner_renderer_destroy(&renderer);
    turner_kernel_destroy(&kernel);
    return result;
}

static int compare_rates(const void *a, const void *b)
{
    double x = ((const struct turner_traversal_rate *)a)->rays_per_second;
    double y = ((const struct turner_traversal_rate *)b)->rays_per_second;
    return x > y ? -1 : x < y;
}

enum turner_result turner_measure_traversals(
    struct turner_traversal_rate rates[TURNER_TRAVERSALS_MEASURED], size_t *count,
    struct turner_gpu *gpu, const struct turner_render_options *options)
{
    struct turner_scene *scene;
    enum turner_result result;
    *count = 0;
    rates[(*count)++].traversal = TURNER_TRAVERSAL_BVH_LANE;
    if (gpu->info.packets)
        rates[(*count)++].traversal = TURNER_TRAVERSAL_BVH_PACKET;
    if (gpu->info.ray_query)
        rates[(*count)++].traversal = TURNER_TRAVERSAL_RAY_QUERY;
    TURNER_TRY(turner_scene_parse(&scene, head, strlen(head), "measured.json"));
    add_spheres(&scene->groups[0]);
    add_mesh(&scene->groups[0]);
    for (size_t i = 0; i < *count; i++)
        TURNER_TRY_DONE(measure(&rates[i], gpu, scene, options->no_cache));
    qsort(rates, *count, sizeof *rates, compare_rates);
    gpu->info.fastest = rates[0].traversal;
    if (!options->no_cache)
        turner_fastest_store(&gpu->info, gpu->info.fastest);
done:
    turner_scene_destroy(scene);
    return result;
}
