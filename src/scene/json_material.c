/* Media, materials and their patterns. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/readers.h"

/* ---- media ---- */

#define MEDIUM(member) offsetof(struct turner_medium, member)

static const struct json_key medium_keys[] = {
    JSON_KEY_IN("index", JSON_NUMBER, true, MEDIUM(index), JSON_POSITIVE),
    JSON_KEY("absorption", JSON_COLOR, false, MEDIUM(absorption)),
    JSON_KEY_IN("priority", JSON_INTEGER, false, MEDIUM(priority), JSON_UNBOUNDED),
};
const struct json_table json_table_medium = JSON_TABLE("a medium", medium_keys);

static void add_medium(struct turner_scene *scene, struct turner_medium medium)
{
    *TURNER_PUSH(scene->media, scene->media_count, scene->media_capacity) = medium;
}

enum turner_result json_read_media(struct json_reader *reader, const struct json_value *value)
{
    for (struct json_value m = json_first(value); m.item; m = json_next(m)) {
        struct turner_medium medium = {0};
        struct json_object object;
        TURNER_TRY(json_read_object(&object, &medium, reader, &m, &json_table_medium));
        medium.name = turner_strdup(m.item->string);
        add_medium(reader->scene, medium);
    }
    return TURNER_OK;
}

/* The medium of a material that gives its index itself. */
static enum turner_result own_medium(uint32_t *medium, struct json_reader *reader,
                                     const struct json_value *index, struct turner_medium wanted)
{
    struct turner_scene *scene = reader->scene;
    for (size_t i = 0; i < scene->media_count; i++) {
        const struct turner_medium *m = &scene->media[i];
        if (!m->name && m->index == wanted.index && m->priority == wanted.priority &&
            m->absorption.x == wanted.absorption.x && m->absorption.y == wanted.absorption.y &&
            m->absorption.z == wanted.absorption.z) {
            *medium = (uint32_t)i;
            return TURNER_OK;
        }
    }
    if (scene->media_count == TURNER_MAX_MEDIA)
        return json_fail(reader, index, "one medium too many; %d are the limit, those of "
                         "materials with an \"index\" included", TURNER_MAX_MEDIA);
    add_medium(scene, wanted);
    *medium = (uint32_t)(scene->media_count - 1);
    return TURNER_OK;
}

/* ---- patterns ---- */

struct pattern_json {
    const char *file;
};

static const char *const pattern_types[] = {"checker", "image", NULL};
static const struct json_key checker_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY_ANY("colors", true),
    JSON_KEY_ANY("scale", false),
};
static const struct json_key image_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("file", JSON_STRING, true, offsetof(struct pattern_json, file)),
    JSON_KEY_ANY("scale", false),
};
const struct json_table json_tables_pattern[2] = {
    JSON_TABLE("a checker pattern", checker_keys),
    JSON_TABLE("an image pattern", image_keys),
};

static enum turner_result read_pattern_scale(double scale[2], const struct json_reader *reader,
                                             const struct json_value *value)
{
    if (cJSON_IsNumber(value->item)) {
        TURNER_TRY(json_read_number(&scale[0], reader, value,
                                    (struct json_range)JSON_UNBOUNDED));
        scale[1] = scale[0];
    } else {
        TURNER_TRY(json_read_numbers(scale, 2, reader, value));
    }
    if (scale[0] == 0 || scale[1] == 0)
        return json_fail(reader, value, "a pattern cannot be scaled by 0");
    return TURNER_OK;
}

static enum turner_result read_pattern(struct turner_material *material,
                                       struct json_reader *reader, const struct json_value *value)
{
    int kind;
    TURNER_TRY(json_read_type(&kind, reader, value, pattern_types));
    struct pattern_json p = {0};
    struct json_object object;
    TURNER_TRY(json_read_object(&object, &p, reader, value, &json_tables_pattern[kind]));
    const struct json_value *scale = json_member(&object, "scale");
    if (scale)
        TURNER_TRY(read_pattern_scale(material->uv_scale, reader, scale));
    if (p.file) {
        material->pattern = TURNER_PATTERN_IMAGE;
        return json_read_texture(&material->image, reader, json_member(&object, "file"));
    }
    const struct json_value *colors = json_member(&object, "colors");
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, colors, SIZE_MAX));
    if (count != 2)
        return json_fail(reader, colors, "a checker has 2 colours, but here are %zu", count);
    for (struct json_value e = json_first(colors); e.item; e = json_next(e))
        TURNER_TRY(json_read_color(&material->checker[e.index], reader, &e));
    material->pattern = TURNER_PATTERN_CHECKER;
    return TURNER_OK;
}

enum turner_result json_read_texture(uint32_t *image, struct json_reader *reader,
                                     const struct json_value *value)
{
    char *path;
    TURNER_TRY(json_read_file_name(&path, reader, value));
    enum turner_result result = turner_scene_texture(image, reader->scene, path);
    free(path);
    return result == TURNER_OK ? result : json_fail_file(reader, value, result);
}

/* ---- materials ---- */

struct material_json {
    struct turner_material material;
    struct turner_medium medium; /* of its own */
    int metal;
};

#define MATERIAL(member) offsetof(struct material_json, member)

static const char *const fresnels[] = {"none", "schlick", "exact", NULL};
static const char *const metals[] = {"gold", "silver", "copper", NULL};
static const struct json_key material_keys[] = {
    JSON_KEY("k_e", JSON_COLOR, false, MATERIAL(material.k_e)),
    JSON_KEY("k_a", JSON_COLOR, false, MATERIAL(material.k_a)),
    JSON_KEY("k_d", JSON_COLOR, false, MATERIAL(material.k_d)),
    JSON_KEY("k_s", JSON_COLOR, false, MATERIAL(material.k_s)),
    JSON_KEY("k_r", JSON_COLOR, false, MATERIAL(material.k_r)),
    JSON_KEY("k_t", JSON_COLOR, false, MATERIAL(material.k_t)),
    JSON_KEY_IN("exponent", JSON_NUMBER, false, MATERIAL(material.exponent), JSON_NOT_NEGATIVE),
    JSON_KEY_CHOICE("fresnel", false, MATERIAL(material.fresnel), fresnels),
    JSON_KEY_ANY("medium", false),
    JSON_KEY_IN("index", JSON_NUMBER, false, MATERIAL(medium.index), JSON_POSITIVE),
    JSON_KEY("absorption", JSON_COLOR, false, MATERIAL(medium.absorption)),
    JSON_KEY_IN("priority", JSON_INTEGER, false, MATERIAL(medium.priority), JSON_UNBOUNDED),
    JSON_KEY("eta", JSON_COLOR, false, MATERIAL(material.eta)),
    JSON_KEY("k", JSON_COLOR, false, MATERIAL(material.k)),
    JSON_KEY_CHOICE("metal", false, MATERIAL(metal), metals),
    JSON_KEY_ANY("pattern", false),
};
const struct json_table json_table_material = JSON_TABLE("a material", material_keys);

/* Complex indices of measured metals, integrated to linear sRGB as the Mitsuba renderer does
 * (data of its "Au", "Ag" and "Cu"); tests compare their reflectance at 0°. */
static const struct {
    struct turner_vec3 eta, k;
} metal_indices[] = {
    {{0.143119, 0.374957, 1.442479}, {3.983160, 2.385721, 1.603215}},
    {{0.155264, 0.116723, 0.138381}, {4.828364, 3.122497, 2.147037}},
    {{0.200438, 0.924033, 1.102212}, {3.912949, 2.452848, 2.142188}},
};

static bool is_black(struct turner_vec3 color)
{
    return color.x == 0 && color.y == 0 && color.z == 0;
}

/* Opaque materials: is this a metal, and which Fresnel curve does it have? */
static enum turner_result complete_metal(struct material_json *m, const struct json_reader *reader,
                                         const struct json_object *object)
{
    const struct json_value *eta = json_member(object, "eta"), *k = json_member(object, "k");
    const struct json_value *metal = json_member(object, "metal");
    const struct json_value *fresnel = json_member(object, "fresnel");
    if (metal && (eta || k))
        return json_fail_key(reader, eta ? eta : k, "\"metal\" says this already; leave one out");
    if (metal) {
        m->material.eta = metal_indices[m->metal].eta;
        m->material.k = metal_indices[m->metal].k;
    } else if (eta || k) {
        if (!k)
            return json_fail_key(reader, eta, "\"eta\" needs \"k\": a metal has a complex index; "
                                 "for glass use \"index\"");
        if (!eta)
            return json_fail_key(reader, k, "\"k\" needs \"eta\": a metal has a complex index");
    }
    m->material.conductor = metal || eta;
    if (m->material.conductor && !is_black(m->material.k_t))
        return json_fail(reader, json_member(object, "k_t"),
                         "a metal lets no light through; leave out \"k_t\" or \"%s\"",
                         metal ? "metal" : "eta");
    if (m->material.conductor && fresnel && m->material.fresnel != TURNER_FRESNEL_EXACT)
        return json_fail(reader, fresnel, "a metal with a complex index wants \"exact\"; for "
                         "\"schlick\" give \"k_r\" alone");
    if (!fresnel)
        m->material.fresnel = m->material.conductor || !is_black(m->material.k_t)
                                  ? TURNER_FRESNEL_EXACT
                                  : TURNER_FRESNEL_NONE;
    if (m->material.fresnel == TURNER_FRESNEL_EXACT && !m->material.conductor &&
        is_black(m->material.k_t) && !is_black(m->material.k_r))
        return json_fail(reader, fresnel, "\"exact\" needs to know the mirror's index: add "
                         "\"metal\", or \"eta\" and \"k\", or use \"schlick\"");
    if (m->material.conductor && is_black(m->material.k_r)) {
        char quoted[JSON_QUOTE];
        json_quote(quoted, object->self.item->string);
        turner_warn("%s: the metal \"%s\" reflects nothing; add \"k_r\": 1", reader->path,
                    quoted);
    }
    return TURNER_OK;
}

/* What is behind the surface. */
static enum turner_result complete_medium(struct material_json *m, struct json_reader *reader,
                                          const struct json_object *object)
{
    const struct json_value *medium = json_member(object, "medium");
    const struct json_value *index = json_member(object, "index");
    const struct json_value *absorption = json_member(object, "absorption");
    const struct json_value *priority = json_member(object, "priority");
    const struct json_value *extra = absorption ? absorption : priority;
    if (medium && index)
        return json_fail_key(reader, index, "\"medium\" says this already; leave one out");
    if (extra && !index)
        return json_fail_key(reader, extra, "\"%s\" goes with \"index\"%s", extra->item->string,
                             medium ? "; a medium has its own" : "");
    m->material.medium = TURNER_NONE;
    uint32_t found = TURNER_NONE;
    if (medium)
        TURNER_TRY(json_find_name(&found, reader, medium, &reader->media));
    if (is_black(m->material.k_t))
        return TURNER_OK;
    if (!medium && !index)
        return json_fail(reader, json_member(object, "k_t"), "light goes through, but into what? "
                         "Add \"index\" (1.5 is glass) or \"medium\"");
    if (index)
        TURNER_TRY(own_medium(&found, reader, index, m->medium));
    m->material.medium = found;
    return TURNER_OK;
}

enum turner_result json_read_materials(struct json_reader *reader, const struct json_value *value)
{
    struct turner_scene *scene = reader->scene;
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct material_json m = {.material = {.exponent = 1, .uv_scale = {1, 1}}};
        m.material.image = TURNER_NONE;
        struct json_object object;
        TURNER_TRY(json_read_object(&object, &m, reader, &e, &json_table_material));
        TURNER_TRY(complete_metal(&m, reader, &object));
        TURNER_TRY(complete_medium(&m, reader, &object));
        const struct json_value *pattern = json_member(&object, "pattern");
        if (pattern)
            TURNER_TRY(read_pattern(&m.material, reader, pattern));
        m.material.name = turner_strdup(e.item->string);
        *TURNER_PUSH(scene->materials, scene->material_count, scene->material_capacity) =
            m.material;
    }
    return TURNER_OK;
}
