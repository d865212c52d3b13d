#include "reference/trace.h"

#include "reference/fresnel.h"
#include "reference/light.h"
#include "reference/record.h"
#include "reference/texture.h"

/* A hit as shading sees it: normals on the viewer's side. */
struct shading_point {
    struct turner_surface surface;
    const struct turner_material *material;
    turner_vector v, ng, ns;
    bool outside;                /* the viewer is on the side that the geometric normal points to */
    struct turner_media media;   /* on the viewer's side */
    struct turner_media beyond;  /* on the other side, where the material transmits */
    uint32_t record;             /* of the ray that met it (record.h) */
};

enum secondary_kind { REFLECTED, REFLECTED_TOTALLY, REFRACTED };

static turner_vector trace(struct turner_tracer *tracer, struct turner_ray ray,
                           struct turner_media media, int depth, turner_vector weight,
                           uint32_t record);

static bool transmits(const struct turner_material *material)
{
    return material->k_t.x > 0 || material->k_t.y > 0 || material->k_t.z > 0;
}

/* Whether light that falls on the surface leaves it by Phong's terms; otherwise none is asked.
 * `color` is the pattern's. */
static bool reflects_light(const struct turner_material *material, turner_vector color)
{
    return largest(mul(widen(material->k_d), color)) > 0 || largest(widen(material->k_s)) > 0;
}

/* Fills `point` for a hit of a ray that travels in `media`. */
static void meet(struct shading_point *point, const struct turner_world *world,
                 const struct turner_ray *ray, const struct turner_hit *hit,
                 const struct turner_media *media)
{
    struct turner_surface *surface = &point->surface;
    turner_world_surface(surface, world, ray, hit);
    point->material = &world->scene->materials[surface->material];
    point->v = negate(ray->direction);
    point->outside = dot(surface->ng, point->v) >= 0;
    point->ng = point->outside ? surface->ng : negate(surface->ng);
    point->ns = dot(surface->ns, point->ng) >= 0 ? surface->ns : negate(surface->ns);
    point->media = point->beyond = *media;
    if (transmits(point->material)) {
        turner_media_cross(&point->beyond, &point->media, point->material->medium,
                           point->outside);
    }
}

/* A surface with the same medium on both sides is none. */
static bool is_none(const struct shading_point *point)
{
    return transmits(point->material) &&
           turner_media_current(&point->media) == turner_media_current(&point->beyond);
}

/* ---- local illumination ---- */

/* Notes what is in the way of an opaque shadow, for whoever wants to know. */
static void record_occluder(struct turner_tracer *tracer, const struct turner_ray *ray,
                            turner_real distance, uint32_t record)
{
    struct turner_hit hit;
    struct turner_surface surface;
    if (record != TURNER_NONE && turner_world_intersect(&hit, tracer->world, ray, distance)) {
        turner_world_surface(&surface, tracer->world, ray, &hit);
        turner_record_blocked(tracer, record, TURNER_RAY_BLOCKED, &surface, hit.t);
    }
}

/* S: what reaches the point from `distance` away along `l`. */
static turner_vector shadow(struct turner_tracer *tracer, const struct shading_point *from,
                            turner_vector l, turner_real distance, uint32_t record)
{
    const struct turner_scene *scene = tracer->world->scene;
    bool viewer_side = dot(l, from->ng) >= 0;
    struct turner_ray ray =
        turner_surface_leave(&from->surface, l, viewer_side == from->outside);
    tracer->statistics.shadow_rays++;
    turner_record_shadow(tracer, record, &ray, &from->media);
    if (scene->settings.shadows == TURNER_SHADOWS_OPAQUE) {
        record_occluder(tracer, &ray, distance, record);
        return grey(turner_world_occluded(tracer->world, &ray, distance) ? 0 : 1);
    }

    turner_real way = 0;
    turner_vector through = grey(1);
    struct turner_media media = from->media;
    struct turner_hit hit;
    while (turner_world_intersect(&hit, tracer->world, &ray, distance)) {
        struct shading_point point;
        meet(&point, tracer->world, &ray, &hit, &media);
        way += hit.t;
        through = mul(through, turner_media_transmittance(&point.media, scene, hit.t));
        if (!is_none(&point))
            through = mul(through, widen(point.material->k_t));
        if (!transmits(point.material) || largest(through) == 0) {
            turner_record_blocked(tracer, record,
                                  transmits(point.material) ? TURNER_RAY_GIVEN_UP
                                                            : TURNER_RAY_BLOCKED,
                                  &point.surface, way);
            return grey(0);
        }
        turner_record_crossing(tracer, record, &point.surface, way, !is_none(&point));
        ray = turner_surface_leave(&point.surface, l, !point.outside);
        media = point.beyond;
        distance -= hit.t;
    }
    return mul(through, turner_media_transmittance(&media, scene, distance));
}

static turner_vector local_illumination(struct turner_tracer *tracer,
                                        const struct shading_point *point)
{
    const struct turner_scene *scene = tracer->world->scene;
    const struct turner_material *material = point->material;
    turner_vector color =
        turner_pattern_color(scene, material, point->surface.u, point->surface.v);
    turner_vector radiance =
        add(widen(material->k_e), mul(mul(widen(material->k_a), color), widen(scene->ambient)));

    turner_record_radiance(tracer, point->record, radiance);
    if (!reflects_light(material, color))
        return radiance;
    for (size_t j = 0; j < scene->light_count; j++) {
        struct turner_illumination light =
            turner_light_arrive(&scene->lights[j], point->surface.p);
        uint32_t record = turner_record_light(tracer, point->record, (uint32_t)j, &light,
                                              point->ns, point->v);
        if (largest(light.irradiance) <= 0 || dot(point->ns, light.direction) <= 0)
            continue;
        turner_vector s = shadow(tracer, point, light.direction, light.distance, record);
        turner_vector f = turner_phong(material, scene->settings.shading, color, point->ns,
                                       point->v, light.direction);
        radiance = add(radiance, mul(mul(s, light.irradiance), f));
        turner_record_lit(tracer, record, s, &light, material, color, point->ns, point->v);
    }
    return radiance;
}

/* ---- secondary rays ---- */

/* Where the mirror direction of V goes; never below the geometric surface. */
static turner_vector mirror_direction(const struct shading_point *point)
{
    turner_vector r = sub(scale(point->ns, 2 * dot(point->ns, point->v)), point->v);
    turner_real above = dot(r, point->ng);
    return normalize(above < 0 ? sub(r, scale(point->ng, 2 * above)) : r);
}

/* Snell's law; never above the geometric surface. */
static turner_vector refracted_direction(const struct shading_point *point, turner_real n1,
                                         turner_real n2)
{
    turner_real eta = n1 / n2, c = dot(point->ns, point->v);
    turner_real ct = sqrtl(fmaxl(0, turner_cosine2_refracted(n1, n2, c)));
    turner_vector t = add(scale(point->v, -eta), scale(point->ns, eta * c - ct));
    turner_real above = dot(t, point->ng);
    return normalize(above > 0 ? sub(t, scale(point->ng, 2 * above)) : t);
}

/* The radiance of a secondary ray, or 0 and a note in `pruned` where the recursion stops. */
static turner_vector follow(struct turner_tracer *tracer, const struct shading_point *point,
                            enum secondary_kind kind, turner_vector direction, int depth,
                            turner_vector weight)
{
    const struct turner_settings *settings = &tracer->world->scene->settings;
    struct turner_reference_statistics *statistics = &tracer->statistics;
    bool outward = kind == REFRACTED ? !point->outside : point->outside;
    struct turner_ray ray = turner_surface_leave(&point->surface, direction, outward);
    struct turner_media media = kind == REFRACTED ? point->beyond : point->media;
    uint32_t record = turner_record_ray(
        tracer, kind == REFRACTED ? TURNER_RAY_REFRACTED : TURNER_RAY_REFLECTED, depth, &ray,
        &media, weight);
    if (depth > settings->depth || largest(weight) < settings->cutoff) {
        tracer->pruned += largest(weight);
        return grey(0);
    }
    if (kind == REFRACTED)
        statistics->refracted_rays++;
    else
        statistics->reflected_rays++;
    if (kind == REFLECTED_TOTALLY)
        statistics->tir_rays++;
    return trace(tracer, ray, media, depth, weight, record);
}

static turner_vector secondary_radiance(struct turner_tracer *tracer,
                                        const struct shading_point *point, int depth,
                                        turner_vector weight)
{
    const struct turner_scene *scene = tracer->world->scene;
    turner_real n1 = turner_media_index(&point->media, scene);
    turner_real n2 = turner_media_index(&point->beyond, scene);
    struct turner_secondary w =
        turner_secondary_weights(point->material,
                                 turner_material_fresnel(&scene->settings, point->material), n1,
                                 n2, dot(point->ns, point->v));
    turner_vector w_r = mul(weight, w.reflected), w_t = mul(weight, w.refracted);
    turner_record_secondary(tracer, point->record, point->material, n1, n2, &w);

    /* The SPD's counts take every glass for a mirror too, and know no weight. */
    bool spd = scene->settings.spd_rays;
    bool reflect = spd ? largest(w.reflected) > 0 || transmits(point->material)
                       : largest(w_r) > 0;
    bool refract = spd ? largest(w.refracted) > 0 : largest(w_t) > 0;

    turner_vector radiance = grey(0);
    if (reflect) {
        turner_vector incoming = follow(tracer, point, w.total ? REFLECTED_TOTALLY : REFLECTED,
                                        mirror_direction(point), depth + 1, w_r);
        radiance = add(radiance, mul(w.reflected, incoming));
    }
    if (refract) {
        turner_vector incoming = follow(tracer, point, REFRACTED,
                                        refracted_direction(point, n1, n2), depth + 1, w_t);
        radiance = add(radiance, mul(w.refracted, incoming));
    }
    return radiance;
}

/* ---- the recursion ---- */

/* Radiance along a ray that travels in `media` and whose share of the pixel is `weight`. */
static turner_vector trace(struct turner_tracer *tracer, struct turner_ray ray,
                           struct turner_media media, int depth, turner_vector weight,
                           uint32_t record)
{
    const struct turner_scene *scene = tracer->world->scene;
    turner_real way = 0;
    turner_vector through = grey(1); /* what absorption leaves on the way to the point */
    struct shading_point point;
    struct turner_hit hit;
    if (depth > tracer->statistics.largest_depth)
        tracer->statistics.largest_depth = depth;

    for (bool none = true; none;) {
        if (!turner_world_intersect(&hit, tracer->world, &ray, INFINITY)) {
            through = mul(through, turner_media_transmittance(&media, scene, INFINITY));
            turner_vector background = turner_background_radiance(scene, ray.direction);
            turner_record_background(tracer, record, through, background);
            return mul(through, background);
        }
        meet(&point, tracer->world, &ray, &hit, &media);
        way += hit.t;
        through = mul(through, turner_media_transmittance(&point.media, scene, hit.t));
        none = is_none(&point);
        if (none) {
            turner_record_crossing(tracer, record, &point.surface, way, false);
            ray = turner_surface_leave(&point.surface, ray.direction, !point.outside);
            media = point.beyond;
        }
    }
    if (depth == 0)
        tracer->statistics.camera_hits++;
    point.record = record;
    turner_record_surface(tracer, record, &point.surface, point.v, point.ng, point.ns, way,
                          through);
    turner_vector local = local_illumination(tracer, &point);
    turner_vector secondary = secondary_radiance(tracer, &point, depth, mul(weight, through));
    return mul(through, add(local, secondary));
}

turner_vector turner_trace_camera(struct turner_tracer *tracer, turner_vector origin,
                                  turner_vector direction)
{
    const struct turner_scene *scene = tracer->world->scene;
    struct turner_ray ray = {.origin = origin, .direction = direction};
    struct turner_media media = turner_media_of_camera(&scene->camera);
    uint32_t record = turner_record_ray(tracer, TURNER_RAY_CAMERA, 0, &ray, &media, grey(1));
    if (scene->settings.cutoff > 1) { /* the camera ray's own weight is 1 */
        tracer->pruned += 1;
        return grey(0);
    }
    tracer->statistics.camera_rays++;
    return trace(tracer, ray, media, 0, grey(1), record);
}

bool turner_trace_first_hit(struct turner_first_hit *first, const struct turner_world *world,
                            turner_vector origin, turner_vector direction)
{
    struct turner_ray ray = {.origin = origin, .direction = direction};
    struct turner_media media = turner_media_of_camera(&world->scene->camera);
    struct turner_hit hit;
    *first = (struct turner_first_hit){0};
    while (turner_world_intersect(&hit, world, &ray, INFINITY)) {
        struct shading_point point;
        meet(&point, world, &ray, &hit, &media);
        first->depth += hit.t;
        if (!is_none(&point)) {
            first->position = point.surface.p;
            first->normal = point.ns;
            first->albedo = mul(widen(point.material->k_d),
                                turner_pattern_color(world->scene, point.material,
                                                     point.surface.u, point.surface.v));
            first->place = hit.place;
            return true;
        }
        ray = turner_surface_leave(&point.surface, direction, !point.outside);
        media = point.beyond;
    }
    return false;
}
