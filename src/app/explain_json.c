#include <cjson/cJSON.h>
#include <math.h>

#include "app/explain.h"

/* JSON knows no infinity: such numbers become strings. */
static cJSON *number(long double value)
{
    double v = (double)value;
    return isfinite(v)  ? cJSON_CreateNumber(v)
           : isnan(v)   ? cJSON_CreateString("nan")
           : v > 0      ? cJSON_CreateString("inf")
                        : cJSON_CreateString("-inf");
}

static void add_number(cJSON *object, const char *key, long double value)
{
    cJSON_AddItemToObject(object, key, number(value));
}

static void add_vector(cJSON *object, const char *key, const long double v[3])
{
    cJSON *array = cJSON_AddArrayToObject(object, key);
    for (int i = 0; i < 3; i++)
        cJSON_AddItemToArray(array, number(v[i]));
}

static void add_index(cJSON *object, const char *key, uint32_t index)
{
    if (index == TURNER_NONE)
        cJSON_AddNullToObject(object, key);
    else
        cJSON_AddNumberToObject(object, key, index);
}

static void add_name(cJSON *object, const char *key, const char *name)
{
    if (name)
        cJSON_AddStringToObject(object, key, name);
    else
        cJSON_AddNullToObject(object, key);
}

static cJSON *place_object(const struct turner_scene *scene, const struct turner_ray_place *place)
{
    static const char *const kinds[] = {"plane", "sphere", "cone", "triangle"};
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "kind", kinds[place->kind]);
    cJSON_AddNumberToObject(object, "index", place->index);
    if (place->instance) {
        uint32_t group = scene->instances[place->instance - 1].group;
        cJSON_AddNumberToObject(object, "instance", place->instance - 1);
        add_name(object, "group", scene->groups[group].name);
    }
    cJSON_AddNumberToObject(object, "material_index", place->material);
    add_name(object, "material", scene->materials[place->material].name);
    return object;
}

static void add_media(cJSON *object, const struct turner_scene *scene,
                      const struct turner_ray_record *ray)
{
    cJSON *media = cJSON_AddArrayToObject(object, "media");
    for (uint32_t i = 0; i < ray->media_count; i++) {
        const struct turner_medium *medium = &scene->media[ray->media[i]];
        cJSON *entry = cJSON_CreateObject();
        cJSON_AddNumberToObject(entry, "medium", ray->media[i]);
        add_name(entry, "name", medium->name);
        cJSON_AddNumberToObject(entry, "index", medium->index);
        cJSON_AddItemToArray(media, entry);
    }
}

static void add_surface(cJSON *object, const struct turner_ray_record *ray)
{
    add_vector(object, "point", ray->point);
    add_vector(object, "geometric_normal", ray->ng);
    add_vector(object, "normal", ray->ns);
    add_vector(object, "radiance", ray->radiance);
    if (!ray->secondary)
        return;
    add_number(object, "n_dot_v", ray->cosine);
    add_number(object, "n1", ray->n1);
    add_number(object, "n2", ray->n2);
    cJSON_AddBoolToObject(object, "total_internal_reflection", ray->total);
    if (ray->has_fresnel)
        add_vector(object, "fresnel", ray->fresnel);
}

static void add_light(cJSON *object, const struct turner_ray_record *ray)
{
    cJSON_AddNumberToObject(object, "light", ray->light);
    add_number(object, "n_dot_l", ray->n_l);
    add_number(object, "r_dot_v", ray->r_v);
    add_vector(object, "irradiance", ray->irradiance);
    add_vector(object, "diffuse", ray->diffuse);
    add_vector(object, "specular", ray->specular);
}

static cJSON *ray_object(const struct turner_scene *scene, const struct turner_ray_tree *tree,
                         uint32_t index)
{
    static const char *const kinds[] = {"camera", "shadow", "reflected", "refracted"};
    static const char *const ends[] = {"background", "surface",    "cut",          "light",
                                       "blocked",    "given_up",   "faces_away",   "out_of_reach",
                                       "unfinished"};
    const struct turner_ray_record *ray = &tree->rays[index];
    cJSON *object = cJSON_CreateObject();
    cJSON_AddStringToObject(object, "kind", kinds[ray->kind]);
    add_index(object, "parent", ray->parent);
    cJSON_AddNumberToObject(object, "depth", ray->depth);
    add_media(object, scene, ray);
    add_vector(object, "origin", ray->origin);
    add_vector(object, "direction", ray->direction);
    add_vector(object, "weight", ray->weight);
    cJSON_AddStringToObject(object, "end", ends[ray->end]);
    if (ray->end != TURNER_RAY_CUT && ray->end != TURNER_RAY_UNFINISHED)
        add_number(object, "t", ray->t);
    size_t count;
    const struct turner_ray_crossing *crossings = turner_ray_tree_crossings(tree, index, &count);
    if (count) {
        cJSON *array = cJSON_AddArrayToObject(object, "crosses");
        for (size_t i = 0; i < count; i++) {
            cJSON *crossing = place_object(scene, &crossings[i].place);
            add_number(crossing, "t", crossings[i].t);
            cJSON_AddBoolToObject(crossing, "real", crossings[i].real);
            cJSON_AddItemToArray(array, crossing);
        }
    }
    if (ray->end == TURNER_RAY_SURFACE || ray->end == TURNER_RAY_BLOCKED ||
        ray->end == TURNER_RAY_GIVEN_UP)
        cJSON_AddItemToObject(object, "hit", place_object(scene, &ray->place));
    add_vector(object, "through", ray->through);
    if (ray->end == TURNER_RAY_SURFACE)
        add_surface(object, ray);
    if (ray->end == TURNER_RAY_BACKGROUND)
        add_vector(object, "radiance", ray->radiance);
    if (ray->kind == TURNER_RAY_SHADOW)
        add_light(object, ray);
    add_vector(object, "contribution", ray->contribution);
    return object;
}

static cJSON *tree_object(const struct turner_scene *scene, const struct turner_ray_tree *tree)
{
    cJSON *object = cJSON_CreateObject();
    cJSON_AddNumberToObject(object, "mantissa", tree->mantissa);
    add_vector(object, "radiance", tree->radiance);
    add_number(object, "pruned", tree->pruned);
    cJSON_AddBoolToObject(object, "truncated", tree->truncated);
    const char *quantity;
    uint32_t ray = turner_ray_tree_nonfinite(tree, &quantity);
    if (ray == TURNER_NONE) {
        cJSON_AddNullToObject(object, "nonfinite");
    } else {
        cJSON *nonfinite = cJSON_AddObjectToObject(object, "nonfinite");
        cJSON_AddNumberToObject(nonfinite, "ray", ray);
        cJSON_AddStringToObject(nonfinite, "quantity", quantity);
    }
    cJSON *rays = cJSON_AddArrayToObject(object, "rays");
    for (uint32_t i = 0; i < tree->count; i++)
        cJSON_AddItemToArray(rays, ray_object(scene, tree, i));
    return object;
}

static void add_comparison(cJSON *root, const struct turner_ray_comparison *comparison)
{
    static const char *const reasons[] = {"agree", "ends", "alone", "bits"};
    cJSON *pairs = cJSON_AddArrayToObject(root, "pairs");
    for (size_t i = 0; i < comparison->count; i++) {
        const struct turner_ray_pair *pair = &comparison->pairs[i];
        cJSON *object = cJSON_CreateObject();
        add_index(object, "device", pair->device);
        add_index(object, "reference", pair->reference);
        cJSON *bits = cJSON_AddObjectToObject(object, "bits");
        for (int q = 0; q < TURNER_RAY_QUANTITIES; q++) {
            if (pair->bits[q] != TURNER_NO_BITS)
                cJSON_AddNumberToObject(bits, turner_ray_quantity_names[q], pair->bits[q]);
        }
        cJSON_AddItemToArray(pairs, object);
    }
    cJSON_AddNumberToObject(root, "least_bits", comparison->least_bits);
    if (comparison->parts == TURNER_NONE) {
        cJSON_AddNullToObject(root, "parts");
        return;
    }
    cJSON *parts = cJSON_AddObjectToObject(root, "parts");
    cJSON_AddNumberToObject(parts, "pair", comparison->parts);
    cJSON_AddStringToObject(parts, "why", reasons[comparison->why]);
    if (comparison->why == TURNER_RAYS_FEW_BITS)
        cJSON_AddStringToObject(parts, "quantity",
                                turner_ray_quantity_names[comparison->quantity]);
}

void turner_explain_json(FILE *out, const struct turner_explanation *explanation)
{
    const struct turner_scene *scene = explanation->scene;
    const struct turner_ray_comparison *comparison = &explanation->comparison;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "version", turner_version());
    add_name(root, "scene", scene->path);
    int size[2] = {scene->settings.width, scene->settings.height};
    int pixel[2] = {explanation->x, explanation->y};
    double sample[2] = {explanation->sample_x, explanation->sample_y};
    cJSON_AddItemToObject(root, "size", cJSON_CreateIntArray(size, 2));
    cJSON_AddItemToObject(root, "pixel", cJSON_CreateIntArray(pixel, 2));
    cJSON_AddItemToObject(root, "sample", cJSON_CreateDoubleArray(sample, 2));
    if (comparison->device) {
        cJSON *device = tree_object(scene, comparison->device);
        cJSON_AddStringToObject(device, "name", explanation->device);
        cJSON_AddStringToObject(device, "driver", explanation->driver);
        cJSON_AddStringToObject(device, "traversal", explanation->traversal);
        cJSON_AddStringToObject(device, "precision", explanation->precision);
        cJSON_AddItemToObject(root, "device", device);
    }
    cJSON_AddItemToObject(root, "reference", tree_object(scene, comparison->reference));
    if (comparison->device)
        add_comparison(root, comparison);
    char *text = cJSON_Print(root);
    cJSON_Delete(root);
    fprintf(out, "%s\n", text);
    cJSON_free(text);
}
