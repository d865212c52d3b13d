#include "reference/record.h"

static void keep(long double out[3], turner_vector v)
{
    out[0] = v.x;
    out[1] = v.y;
    out[2] = v.z;
}

static turner_vector kept(const long double v[3])
{
    return vector(v[0], v[1], v[2]);
}

static struct turner_ray_record *record_of(const struct turner_tracer *tracer, uint32_t ray)
{
    return ray == TURNER_NONE ? NULL : &tracer->tree->rays[ray];
}

/* The reference numbers the primitives of a group through; a record says which of its kind. */
static struct turner_ray_place place_of(const struct turner_tracer *tracer,
                                        const struct turner_surface *surface)
{
    const struct turner_scene *scene = tracer->world->scene;
    struct turner_ray_place place = {.kind = TURNER_PRIMITIVE_PLANE,
                                     .index = surface->place.primitive,
                                     .material = surface->material};
    if (surface->place.instance == TURNER_INSTANCE_PLANES)
        return place;
    place.instance = (uint32_t)surface->place.instance;
    uint32_t group_index = place.instance ? scene->instances[place.instance - 1].group : 0;
    const struct turner_group *group = &scene->groups[group_index];
    uint32_t spheres = (uint32_t)group->sphere_count, cones = (uint32_t)group->cone_count;
    if (place.index < spheres) {
        place.kind = TURNER_PRIMITIVE_SPHERE;
    } else if (place.index < spheres + cones) {
        place.kind = TURNER_PRIMITIVE_CONE;
        place.index -= spheres;
    } else {
        place.kind = TURNER_PRIMITIVE_TRIANGLE;
        place.index -= spheres + cones;
    }
    return place;
}

static void keep_start(struct turner_ray_record *record, const struct turner_ray *ray,
                       const struct turner_media *media)
{
    keep(record->origin, ray->origin);
    keep(record->direction, ray->direction);
    record->media_count = media->count;
    for (uint32_t i = 0; i < media->count; i++)
        record->media[i] = media->inside[media->count - 1 - i];
}

uint32_t turner_record_ray(struct turner_tracer *tracer, enum turner_ray_kind kind, int depth,
                           const struct turner_ray *ray, const struct turner_media *media,
                           turner_vector weight)
{
    if (!tracer->tree)
        return TURNER_NONE;
    uint32_t index = turner_ray_tree_add(tracer->tree, kind, (uint32_t)depth);
    struct turner_ray_record *record = record_of(tracer, index);
    if (record) {
        keep_start(record, ray, media);
        keep(record->weight, weight);
        keep(record->through, grey(1));
        record->end = TURNER_RAY_CUT;
    }
    return index;
}

void turner_record_crossing(struct turner_tracer *tracer, uint32_t ray,
                            const struct turner_surface *surface, turner_real way, bool real)
{
    if (ray != TURNER_NONE)
        turner_ray_tree_cross(tracer->tree, ray, place_of(tracer, surface), way, real);
}

void turner_record_background(struct turner_tracer *tracer, uint32_t ray, turner_vector through,
                              turner_vector radiance)
{
    struct turner_ray_record *record = record_of(tracer, ray);
    if (!record)
        return;
    record->end = TURNER_RAY_BACKGROUND;
    record->t = INFINITY;
    keep(record->through, through);
    turner_record_radiance(tracer, ray, radiance);
}

void turner_record_surface(struct turner_tracer *tracer, uint32_t ray,
                           const struct turner_surface *surface, turner_vector v, turner_vector ng,
                           turner_vector ns, turner_real way, turner_vector through)
{
    struct turner_ray_record *record = record_of(tracer, ray);
    if (!record)
        return;
    record->end = TURNER_RAY_SURFACE;
    record->t = way;
    record->place = place_of(tracer, surface);
    record->cosine = dot(ns, v);
    keep(record->through, through);
    keep(record->point, surface->p);
    keep(record->ng, ng);
    keep(record->ns, ns);
}

void turner_record_radiance(struct turner_tracer *tracer, uint32_t ray, turner_vector radiance)
{
    struct turner_ray_record *record = record_of(tracer, ray);
    if (!record)
        return;
    keep(record->radiance, radiance);
    keep(record->contribution, mul(mul(kept(record->weight), kept(record->through)), radiance));
}

void turner_record_secondary(struct turner_tracer *tracer, uint32_t ray,
                             const struct turner_material *material, turner_real n1,
                             turner_real n2, const struct turner_secondary *weights)
{
    struct turner_ray_record *record = record_of(tracer, ray);
    if (!record || (largest(widen(material->k_r)) == 0 && largest(widen(material->k_t)) == 0))
        return;
    record->secondary = true;
    record->n1 = n1;
    record->n2 = n2;
    record->total = weights->total;
    record->has_fresnel = weights->has_fresnel;
    keep(record->fresnel, weights->fresnel);
}

uint32_t turner_record_light(struct turner_tracer *tracer, uint32_t ray, uint32_t light,
                             const struct turner_illumination *arriving, turner_vector n,
                             turner_vector v)
{
    struct turner_ray_record *hit = record_of(tracer, ray);
    if (!hit)
        return TURNER_NONE;
    turner_vector weight = mul(kept(hit->weight), kept(hit->through));
    uint32_t index = turner_ray_tree_add(tracer->tree, TURNER_RAY_SHADOW, hit->depth + 1);
    struct turner_ray_record *record = record_of(tracer, index);
    if (!record)
        return index;
    turner_vector l = arriving->direction, r = sub(scale(n, 2 * dot(n, l)), l);
    bool reaches = largest(arriving->irradiance) > 0;
    record->end = reaches ? TURNER_RAY_FACES_AWAY : TURNER_RAY_OUT_OF_REACH;
    record->light = light;
    record->t = arriving->distance;
    record->n_l = dot(n, l);
    record->r_v = dot(r, v);
    keep(record->weight, weight);
    keep(record->direction, l);
    keep(record->irradiance, arriving->irradiance);
    return index;
}

void turner_record_shadow(struct turner_tracer *tracer, uint32_t shadow,
                          const struct turner_ray *ray, const struct turner_media *media)
{
    struct turner_ray_record *record = record_of(tracer, shadow);
    if (record)
        keep_start(record, ray, media);
}

void turner_record_blocked(struct turner_tracer *tracer, uint32_t shadow,
                           enum turner_ray_end end, const struct turner_surface *surface,
                           turner_real way)
{
    struct turner_ray_record *record = record_of(tracer, shadow);
    if (!record)
        return;
    record->end = end;
    record->place = place_of(tracer, surface);
    record->t = way;
}

void turner_record_lit(struct turner_tracer *tracer, uint32_t shadow, turner_vector s,
                       const struct turner_illumination *arriving,
                       const struct turner_material *material, turner_vector color,
                       turner_vector n, turner_vector v)
{
    struct turner_ray_record *record = record_of(tracer, shadow);
    if (!record)
        return;
    enum turner_shading shading = tracer->world->scene->settings.shading;
    struct turner_material dull = *material, black = *material;
    dull.k_s = black.k_d = (struct turner_vec3){0};
    turner_vector l = arriving->direction;
    turner_vector f = turner_phong(material, shading, color, n, v, l);
    if (record->end != TURNER_RAY_BLOCKED && record->end != TURNER_RAY_GIVEN_UP)
        record->end = TURNER_RAY_LIGHT;
    keep(record->through, s);
    keep(record->diffuse, turner_phong(&dull, shading, color, n, v, l));
    keep(record->specular, turner_phong(&black, shading, color, n, v, l));
    keep(record->contribution, mul(kept(record->weight), mul(mul(s, arriving->irradiance), f)));
}
