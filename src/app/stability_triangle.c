/* Rays between triangles: none may slip through. */
#include "app/stability.h"
#include "base/memory.h"

#include <stdlib.h>

static struct turner_scene *empty_scene(void)
{
    struct turner_scene *scene =
        turner_stage_create(8, turner_vec3_of(0, 0, 10), TURNER_GREY(0), 0.5);
    turner_stage_lamp(scene, 1);
    return scene;
}

/* The share of rays that meet nothing; frees scene and probes. */
static enum turner_result count_lost(double *share, struct turner_stability *s,
                                     struct turner_scene *scene, struct turner_gpu_probe *probes,
                                     size_t count, const char *assign)
{
    bool possible = false;
    turner_stage_round(scene);
    enum turner_result result = turner_stability_assign(scene, assign);
    if (result == TURNER_OK)
        result = turner_stability_probe(probes, count, s, scene, TURNER_PROBE_HITS, &possible);
    size_t lost = 0;
    for (size_t i = 0; i < count; i++)
        lost += isinf(probes[i].t[0]) != 0;
    *share = possible ? (double)lost / (double)count : TURNER_UNMEASURED;
    turner_scene_destroy(scene);
    free(probes);
    return result;
}

/* ---- a closed mesh from inside, at its edges and vertices ---- */

/* A dented ball of about `triangles` triangles: `rows` rings of `rows` quads, two of each quad, the
 * poles pulled to a point by rings that are triangles. */
static void add_dented_ball(struct turner_scene *scene, double triangles)
{
    uint32_t rows = (uint32_t)fmax(4, sqrt(triangles / 2)), columns = rows;
    struct turner_mesh *mesh =
        turner_stage_mesh(scene, (rows - 1) * columns + 2, 2 * (rows - 1) * columns, 0);
    uint64_t random = 11;
    uint32_t south = mesh->vertex_count - 1, count = 0;
    mesh->positions[0] = turner_vec3_of(0, 0, 1);
    mesh->positions[south] = turner_vec3_of(0, 0, -1);
    for (uint32_t i = 1; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            double theta = 3.141592653589793 * i / rows, phi = 6.283185307179586 * j / columns;
            double r = 1 + 0.3 / rows * turner_stage_random(&random);
            mesh->positions[1 + (i - 1) * columns + j] = turner_vec3_of(
                r * sin(theta) * cos(phi), r * sin(theta) * sin(phi), r * cos(theta));
        }
    }
    for (uint32_t i = 0; i < rows; i++) {
        for (uint32_t j = 0; j < columns; j++) {
            uint32_t k = (j + 1) % columns;
            uint32_t above = 1 + (i - 1) * columns, below = 1 + i * columns;
            uint32_t a = i ? above + j : 0, b = i ? above + k : 0;
            uint32_t c = i + 1 < rows ? below + j : south, d = i + 1 < rows ? below + k : south;
            uint32_t pair[2][3] = {{a, c, d}, {a, d, b}};
            for (int half = 0; half < 2; half++) {
                if ((half == 0 && i + 1 == rows) || (half == 1 && i == 0))
                    continue;
                for (int corner = 0; corner < 3; corner++)
                    mesh->triangles[count][corner] = pair[half][corner];
                count++;
            }
        }
    }
}

/* A quarter of the rays at vertices, the rest at points of edges. */
static void aim_at_edges(struct turner_gpu_probe *probes, size_t count,
                         const struct turner_mesh *mesh)
{
    struct turner_vec3 eye = turner_vec3_of(0.125, -0.25, 0.0625);
    uint64_t random = 5;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *triangle =
            mesh->triangles[(size_t)(turner_stage_random(&random) * mesh->triangle_count)];
        uint32_t corner = (uint32_t)(3 * turner_stage_random(&random));
        double along = i % 4 == 0 ? 0 : turner_stage_random(&random);
        struct turner_vec3 a = mesh->positions[triangle[corner]];
        struct turner_vec3 b = mesh->positions[triangle[(corner + 1) % 3]];
        struct turner_vec3 target = turner_vec3_add(
            a, turner_vec3_scale(turner_vec3_sub(b, a), along));
        probes[i] =
            turner_stage_probe(eye, turner_vec3_normalize(turner_vec3_sub(target, eye)));
    }
}

static enum turner_result measure_edges(double *error, struct turner_stability *s,
                                        const struct turner_sweep *sweep, double triangles,
                                        const struct turner_sweep_method *method)
{
    enum { rays = 262144 };
    (void)sweep;
    struct turner_scene *scene = empty_scene();
    struct turner_gpu_probe *probes = turner_calloc(rays, sizeof *probes);
    add_dented_ball(scene, triangles);
    turner_stage_round(scene); /* aim at the vertices as they are */
    aim_at_edges(probes, rays, &scene->groups[0].meshes[0]);
    return count_lost(error, s, scene, probes, rays, method->assign);
}

/* ---- the diagonal of a square ---- */
static enum turner_result measure_diagonal(double *error, struct turner_stability *s,
                                           const struct turner_sweep *sweep, double height,
                                           const struct turner_sweep_method *method)
{
    enum { rays = 16384 };
    static const struct turner_vec3 corners[] = {{-5, -5, 0}, {5, -5, 0}, {5, 5, 0}, {-5, 5, 0}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    (void)sweep;
    struct turner_scene *scene = empty_scene();
    struct turner_gpu_probe *probes = turner_calloc(rays, sizeof *probes);
    struct turner_mesh *mesh = turner_stage_mesh(scene, 4, 2, 0);
    for (int i = 0; i < 4; i++)
        mesh->positions[i] = corners[i];
    for (int i = 0; i < 6; i++)
        mesh->triangles[i / 3][i % 3] = triangles[i / 3][i % 3];
    struct turner_vec3 eye = {0.3, -0.2, height};
    for (int i = 0; i < rays; i++) {
        double at = 4.9 * (2 * (i + 0.5) / rays - 1);
        probes[i] = turner_stage_probe(
            eye, turner_vec3_normalize(turner_vec3_of(at - eye.x, at - eye.y, -height)));
    }
    if (height == 10) /* the published one */
        probes[0] = turner_stage_probe(turner_vec3_of(0, 0, 10),
                                       turner_vec3_of(0.30458447, 0.30458447, -0.9024725));
    return count_lost(error, s, scene, probes, rays, method->assign);
}

/* ---- a fan of 16 needles, at the edges between them ---- */
static enum turner_result measure_needles(double *error, struct turner_stability *s,
                                          const struct turner_sweep *sweep, double aspect,
                                          const struct turner_sweep_method *method)
{
    enum { rays = 16384, needles = 16 };
    (void)sweep;
    struct turner_scene *scene = empty_scene();
    struct turner_gpu_probe *probes = turner_calloc(rays, sizeof *probes);
    struct turner_mesh *mesh = turner_stage_mesh(scene, needles + 2, needles, 0);
    mesh->positions[0] = turner_vec3_of(0.1, 0.2, 0.3);
    for (uint32_t i = 0; i <= needles; i++)
        mesh->positions[1 + i] = turner_vec3_of(1.3, 0.7 + i / aspect, 0.1);
    for (uint32_t i = 0; i < needles; i++) {
        mesh->triangles[i][0] = 0;
        mesh->triangles[i][1] = 1 + i;
        mesh->triangles[i][2] = 2 + i;
    }
    turner_stage_round(scene);
    const struct turner_vec3 *p = mesh->positions;
    struct turner_vec3 eye = {0.25, 0.5, 3};
    uint64_t random = 9;
    for (int i = 0; i < rays; i++) { /* edges inside the fan, away from its own border */
        int edge = 5 + (int)(8 * turner_stage_random(&random));
        double along = 0.5 + 0.49 * turner_stage_random(&random);
        struct turner_vec3 target = turner_vec3_add(
            p[0], turner_vec3_scale(turner_vec3_sub(p[edge], p[0]), along));
        probes[i] =
            turner_stage_probe(eye, turner_vec3_normalize(turner_vec3_sub(target, eye)));
    }
    return count_lost(error, s, scene, probes, rays, method->assign);
}

/* ---- straight down on the vertices of a grid, in the planes of the boxes of any hierarchy ---- */
static enum turner_result measure_grid(double *error, struct turner_stability *s,
                                       const struct turner_sweep *sweep, double size,
                                       const struct turner_sweep_method *method)
{
    (void)sweep;
    uint32_t n = (uint32_t)size;
    struct turner_scene *scene = empty_scene();
    struct turner_gpu_probe *probes = turner_calloc((size_t)n * n, sizeof *probes);
    struct turner_mesh *mesh = turner_stage_mesh(scene, (n + 1) * (n + 1), 2 * n * n, 0);
    for (uint32_t i = 0; i < (n + 1) * (n + 1); i++)
        mesh->positions[i] = turner_vec3_of(i % (n + 1), i / (n + 1), 0);
    for (uint32_t i = 0; i < n * n; i++) {
        uint32_t corner = i / n * (n + 1) + i % n;
        uint32_t pair[2][3] = {{corner, corner + 1, corner + n + 2},
                               {corner, corner + n + 2, corner + n + 1}};
        for (int k = 0; k < 6; k++)
            mesh->triangles[2 * i + (uint32_t)k / 3][k % 3] = pair[k / 3][k % 3];
        probes[i] = turner_stage_probe(turner_vec3_of(i % n, i / n, 2),
                                       turner_vec3_of(0, 0, -1));
    }
    return count_lost(error, s, scene, probes, (size_t)n * n, method->assign);
}

/* ---- boxes in the same place: the first one is seen ---- */
static enum turner_result measure_ties(double *error, struct turner_stability *s,
                                       const struct turner_sweep *sweep, double copies,
                                       const struct turner_sweep_method *method)
{
    enum { rays = 64 };
    static struct turner_gpu_probe probes[rays];
    bool possible = false;
    (void)sweep;
    struct turner_scene *scene = empty_scene();
    for (int i = 0; i < (int)copies; i++)
        turner_group_add_box(&scene->groups[0], TURNER_GREY(-1), TURNER_GREY(1), 0);
    uint64_t random = 2;
    for (int i = 0; i < rays; i++) {
        struct turner_vec3 out = turner_vec3_scale(turner_stage_direction(&random), 4);
        probes[i] = turner_stage_probe(
            out, turner_vec3_normalize(turner_vec3_sub(
                     turner_vec3_scale(turner_stage_direction(&random), 0.5), out)));
    }
    enum turner_result result = turner_stability_assign(scene, method->assign);
    if (result == TURNER_OK)
        result = turner_stability_probe(probes, rays, s, scene, TURNER_PROBE_HITS, &possible);
    int wrong = 0;
    for (int i = 0; i < rays; i++)
        wrong += isinf(probes[i].t[0]) ||
                 probes[i].id[0] - (TURNER_KIND_TRIANGLE << TURNER_KIND_SHIFT) >= 12;
    *error = possible ? (double)wrong / rays : TURNER_UNMEASURED;
    turner_scene_destroy(scene);
    return result;
}

static double bound_none(double value, double limit)
{
    (void)value, (void)limit;
    return 0;
}

#define SECTION "3. Triangles"
#define RAY_QUERY_NOTE                                                                             \
    "the device's own triangle test offers the candidates, and some rays slip past it; use "       \
    "--method traversal=bvh where this matters"

static const struct turner_sweep sweeps[] = {
    {.name = "triangle-edges",
     .section = SECTION,
     .question = "From inside a closed mesh, at its edges and vertices: how many rays get out?",
     .parameter = "triangles",
     .unit_of_error = "share of rays lost",
     .values = {100, 1e3, 1e4, 1e5, NAN},
     .methods = {{"watertight (default)", "traversal=bvh", 0, TURNER_HOLDS, NULL},
                 {"moller_trumbore", "traversal=bvh triangle=moller_trumbore", 0,
                  TURNER_FAILS(1e4), NULL},
                 {"precision=f64", "traversal=bvh precision=f64", 0, TURNER_HOLDS, NULL},
                 {"ray_query", "traversal=ray_query", 0, TURNER_SHOWN, RAY_QUERY_NOTE}},
     .measure = measure_edges,
     .bound = bound_none,
     .bound_words = "not one",
     .published = "Möller and Trumbore's test in floats lost 12 to 14 % at 1e5 triangles; "
                  "lavapipe's ray query 0 at edges and 0.65 % at vertices."},
    {.name = "triangle-diagonal",
     .section = SECTION,
     .question = "A square of two triangles, rays at its diagonal: how many are lost?",
     .parameter = "distance, in tenths of the square's edge",
     .unit_of_error = "share of rays lost",
     .values = {1, 10, 100, 1e3, 1e4, NAN},
     .methods = {{"watertight (default)", "traversal=bvh", 0, TURNER_HOLDS, NULL},
                 {"moller_trumbore", "traversal=bvh triangle=moller_trumbore", 0,
                  TURNER_FAILS(10), NULL},
                 {"ray_query", "traversal=ray_query", 0, TURNER_SHOWN, RAY_QUERY_NOTE}},
     .measure = measure_diagonal,
     .bound = bound_none,
     .bound_words = "not one",
     .published = "The ray (0,0,10) → (.30458447, .30458447, −.9024725) is lost by the float "
                  "test."},
    {.name = "triangle-needles",
     .section = SECTION,
     .question = "A fan of needles, at the edges between them: how many rays are lost?",
     .parameter = "length / width of a needle",
     .unit_of_error = "share of rays lost",
     .values = {10, 100, 1e3, 1e4, 1e5, NAN},
     .methods = {{"watertight (default)", "traversal=bvh", 0, TURNER_HOLDS, NULL},
                 {"moller_trumbore", "traversal=bvh triangle=moller_trumbore", 0, TURNER_SHOWN,
                  NULL},
                 {"ray_query", "traversal=ray_query", 0, TURNER_SHOWN, RAY_QUERY_NOTE}},
     .measure = measure_needles,
     .bound = bound_none,
     .bound_words = "not one"},
    {.name = "triangle-grid",
     .section = SECTION,
     .question = "Rays along an axis, in the planes of boxes, at the vertices of a grid (0 · ∞)",
     .parameter = "squares along an edge",
     .unit_of_error = "share of rays lost",
     .values = {4, 16, 64, 256, NAN},
     .methods = {{"watertight (default)", "traversal=bvh", 0, TURNER_HOLDS, NULL},
                 {"ray_query", "traversal=ray_query", 0, TURNER_SHOWN, RAY_QUERY_NOTE}},
     .measure = measure_grid,
     .bound = bound_none,
     .bound_words = "not one"},
    {.name = "triangle-ties",
     .section = SECTION,
     .question = "Boxes in the same place: how many rays do not see the first one?",
     .parameter = "boxes",
     .unit_of_error = "share of rays wrong",
     .values = {1, 10, 100, 1e3, 1e4, 1e5, NAN},
     .methods = {{"bvh (default)", "traversal=bvh", 0, TURNER_HOLDS, NULL},
                 {"ray_query", "traversal=ray_query", 0, TURNER_HOLDS, NULL}},
     .measure = measure_ties,
     .bound = bound_none,
     .bound_words = "not one"},
    {0}};

const struct turner_sweep *const turner_sweeps_triangle = sweeps;
