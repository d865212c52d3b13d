#include "explain.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "reference/trace.h"

#define PROBES 128

const char *const cause_names[CAUSES] = {"edge", "shadow or pattern edge", "highlight",
                                         "amplified by mirrors or glass", "NOT EXPLAINED"};

struct probe {
    double rgb[3];
    uint32_t hit[2]; /* what the camera ray met */
};

bool is_off(const float *pixel, const float *truth, struct tolerance tolerance)
{
    for (int c = 0; c < 3; c++) {
        double difference = fabs((double)pixel[c] - (double)truth[c]);
        if (!(difference <= tolerance.absolute ||
              difference <= tolerance.relative * fabs((double)truth[c])))
            return true;
    }
    return false;
}

/* docs/model.md "Camera" */
struct turner_vec3 explain_direction(const struct turner_scene *scene, double x, double y)
{
    const struct turner_camera *camera = &scene->camera;
    double height = scene->settings.height;
    struct turner_vec3 w = turner_vec3_normalize(turner_vec3_sub(camera->from, camera->at));
    struct turner_vec3 u = turner_vec3_normalize(turner_vec3_cross(camera->up, w));
    struct turner_vec3 v = turner_vec3_cross(w, u);
    double s = 2 * tan(camera->vfov / 2) / (scene->settings.spd_grid ? height - 2 : height);
    double right = (x - scene->settings.width / 2.0) * s, up = (height / 2.0 - y) * s;
    struct turner_vec3 direction = turner_vec3_scale(w, -1);
    direction = turner_vec3_add(direction, turner_vec3_scale(u, right));
    return turner_vec3_normalize(turner_vec3_add(direction, turner_vec3_scale(v, up)));
}

static struct probe probe_at(const struct turner_scene *scene, const struct turner_world *world,
                             double x, double y)
{
    struct turner_vec3 d = explain_direction(scene, x, y);
    turner_vector origin = {scene->camera.from.x, scene->camera.from.y, scene->camera.from.z};
    turner_vector direction = {d.x, d.y, d.z};
    struct turner_tracer tracer = {.world = world};
    turner_vector radiance = turner_trace_camera(&tracer, origin, direction);
    struct probe probe = {.rgb = {(double)radiance.x, (double)radiance.y, (double)radiance.z}};
    struct turner_ray ray = {.origin = origin, .direction = direction};
    struct turner_hit hit;
    if (turner_world_intersect(&hit, world, &ray, INFINITY)) {
        probe.hit[0] = hit.place.instance + 1;
        probe.hit[1] = hit.place.primitive;
    }
    return probe;
}

/* Probe i of PROBES in a disc about the pixel's centre: a sunflower, so that every direction and
 * distance has some. The first is the centre. */
static struct probe probe_around(const struct turner_scene *scene,
                                 const struct turner_world *world, int x, int y, int i)
{
    double r = EXPLAIN_RADIUS * sqrt((double)i / PROBES), angle = 2.399963229728653 * i;
    return probe_at(scene, world, x + 0.5 + r * cos(angle), y + 0.5 + r * sin(angle));
}

/* Whether the probes, with `scene` as it stands now, differ by more than the tolerance. */
static bool varies(const struct turner_scene *scene, const struct turner_world *world, int x,
                   int y, struct tolerance tolerance)
{
    struct probe center = probe_around(scene, world, x, y, 0);
    float truth[3] = {(float)center.rgb[0], (float)center.rgb[1], (float)center.rgb[2]};
    for (int i = 1; i < PROBES; i++) {
        struct probe probe = probe_around(scene, world, x, y, i);
        float value[3] = {(float)probe.rgb[0], (float)probe.rgb[1], (float)probe.rgb[2]};
        if (is_off(value, truth, tolerance))
            return true;
    }
    return false;
}

static enum cause name_cause(struct turner_scene *scene, const struct turner_world *world, int x,
                             int y, struct tolerance tolerance)
{
    struct turner_settings settings = scene->settings;
    scene->settings.depth = 0;
    bool local = varies(scene, world, x, y, tolerance);
    bool diffuse = false;
    if (local) {
        struct turner_vec3 *k_s = turner_calloc(scene->material_count, sizeof *k_s);
        for (size_t i = 0; i < scene->material_count; i++) {
            k_s[i] = scene->materials[i].k_s;
            scene->materials[i].k_s = (struct turner_vec3){0};
        }
        diffuse = varies(scene, world, x, y, tolerance);
        for (size_t i = 0; i < scene->material_count; i++)
            scene->materials[i].k_s = k_s[i];
        free(k_s);
    }
    scene->settings = settings;
    return diffuse ? CAUSE_SHADOW : local ? CAUSE_HIGHLIGHT : CAUSE_AMPLIFIED;
}

enum cause explain(struct turner_scene *scene, const struct turner_world *world, int x, int y,
                   const float *pixel, struct tolerance tolerance)
{
    double lo[3], hi[3];
    bool edge = false;
    struct probe center = {0};
    for (int i = 0; i < PROBES; i++) {
        struct probe probe = probe_around(scene, world, x, y, i);
        if (i == 0)
            center = probe;
        edge = edge || memcmp(probe.hit, center.hit, sizeof center.hit) != 0;
        for (int c = 0; c < 3; c++) {
            lo[c] = i == 0 ? probe.rgb[c] : fmin(lo[c], probe.rgb[c]);
            hi[c] = i == 0 ? probe.rgb[c] : fmax(hi[c], probe.rgb[c]);
        }
    }
    for (int c = 0; c < 3; c++) {
        double value = (double)pixel[c];
        double slack = fmax(tolerance.absolute, tolerance.relative * fabs(value));
        if (!(value >= lo[c] - slack && value <= hi[c] + slack))
            return CAUSE_NONE;
    }
    return edge ? CAUSE_EDGE : name_cause(scene, world, x, y, tolerance);
}
