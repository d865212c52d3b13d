#include "base/memory.h"
#include "scene/json.h"
#include "scene/readers.h"

struct light_json {
    struct turner_light light;
    struct turner_vec3 flux, at;
    double inner, outer; /* radians */
};

#define LIGHT(member) offsetof(struct light_json, member)

static const char *const types[] = {"point", "directional", "spot", NULL};
static const char *const falloffs[] = {"inverse_square", "none", NULL};

static const struct json_key point_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("position", JSON_POINT, true, LIGHT(light.position)),
    JSON_KEY("intensity", JSON_COLOR, false, LIGHT(light.power)),
    JSON_KEY("flux", JSON_COLOR, false, LIGHT(flux)),
    JSON_KEY_CHOICE("falloff", false, LIGHT(light.falloff), falloffs),
};
static const struct json_key directional_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("direction", JSON_DIRECTION, true, LIGHT(light.direction)),
    JSON_KEY("irradiance", JSON_COLOR, true, LIGHT(light.power)),
};
static const struct json_key spot_keys[] = {
    JSON_KEY_ANY("type", true),
    JSON_KEY("position", JSON_POINT, true, LIGHT(light.position)),
    JSON_KEY("direction", JSON_DIRECTION, false, LIGHT(light.direction)),
    JSON_KEY("at", JSON_POINT, false, LIGHT(at)),
    JSON_KEY_IN("inner", JSON_DEGREES, true, LIGHT(inner), JSON_FROM_TO(0, 180)),
    JSON_KEY_IN("outer", JSON_DEGREES, true, LIGHT(outer), JSON_ABOVE_TO(0, 180)),
    JSON_KEY("intensity", JSON_COLOR, false, LIGHT(light.power)),
    JSON_KEY("flux", JSON_COLOR, false, LIGHT(flux)),
    JSON_KEY_CHOICE("falloff", false, LIGHT(light.falloff), falloffs),
};
const struct json_table json_tables_light[3] = {
    JSON_TABLE("a point light", point_keys),
    JSON_TABLE("a directional light", directional_keys),
    JSON_TABLE("a spot light", spot_keys),
};

static enum turner_result aim_spot(struct light_json *l, const struct json_reader *reader,
                                   const struct json_object *object)
{
    static const char *const aims[] = {"direction", "at", NULL};
    int aim;
    TURNER_TRY(json_one_of(&aim, reader, object, aims));
    if (aim == 1) {
        struct turner_vec3 way = turner_vec3_sub(l->at, l->light.position);
        if (!(turner_vec3_length(way) > 0))
            return json_fail(reader, json_member(object, "at"),
                             "\"at\" is where \"position\" is; the light has no direction");
        l->light.direction = turner_vec3_normalize(way);
    }
    if (l->inner > l->outer)
        return json_fail(reader, json_member(object, "inner"),
                         "\"inner\" must not be larger than \"outer\"");
    l->light.cos_inner = cos(l->inner);
    l->light.cos_outer = cos(l->outer);
    return TURNER_OK;
}

static enum turner_result read_light(struct json_reader *reader, const struct json_value *value)
{
    static const enum turner_light_kind kinds[] = {TURNER_LIGHT_POINT, TURNER_LIGHT_DIRECTIONAL,
                                                   TURNER_LIGHT_SPOT};
    static const char *const powers[] = {"intensity", "flux", NULL};
    int kind, power = 0;
    TURNER_TRY(json_read_type(&kind, reader, value, types));
    struct light_json l = {.light.kind = kinds[kind]};
    struct json_object object;
    TURNER_TRY(json_read_object(&object, &l, reader, value, &json_tables_light[kind]));
    if (l.light.kind == TURNER_LIGHT_SPOT)
        TURNER_TRY(aim_spot(&l, reader, &object));
    if (l.light.kind != TURNER_LIGHT_DIRECTIONAL)
        TURNER_TRY(json_one_of(&power, reader, &object, powers));
    if (power == 1) {
        /* the solid angle it goes into; a spot's smooth edge counts half */
        double whole = 4 * acos(-1);
        double angle = l.light.kind == TURNER_LIGHT_POINT
                           ? whole
                           : whole / 2 * (1 - (l.light.cos_inner + l.light.cos_outer) / 2);
        l.light.power = turner_vec3_scale(l.flux, 1 / angle);
        if (!turner_color_usable(l.light.power))
            return json_fail(reader, json_member(&object, "outer"),
                             "the flux in so narrow a spot is too large a number");
    }
    struct turner_scene *scene = reader->scene;
    *TURNER_PUSH(scene->lights, scene->light_count, scene->light_capacity) = l.light;
    return TURNER_OK;
}

enum turner_result json_read_lights(struct json_reader *reader, const struct json_value *value)
{
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_LIGHTS));
    for (struct json_value e = json_first(value); e.item; e = json_next(e))
        TURNER_TRY(read_light(reader, &e));
    return TURNER_OK;
}
