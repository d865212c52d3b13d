/* Primitives, groups, instances. */
#include <string.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/readers.h"

struct primitive_json {
    struct turner_sphere sphere;
    struct turner_plane plane;
    struct turner_cone cone;
    struct turner_vec3 lo, hi;
};

#define PRIMITIVE(member) offsetof(struct primitive_json, member)

enum { SPHERE, PLANE, CONE, CYLINDER, BOX, MESH };
static const char *const types[] = {"sphere", "plane", "cone", "cylinder", "box", "mesh", NULL};

#define COMMON_KEYS                                                                                \
    JSON_KEY_ANY("type", true), JSON_KEY_ANY("material", true)

static const struct json_key sphere_keys[] = {
    COMMON_KEYS,
    JSON_KEY("center", JSON_POINT, true, PRIMITIVE(sphere.center)),
    JSON_KEY_IN("radius", JSON_NUMBER, true, PRIMITIVE(sphere.radius), JSON_POSITIVE),
};
static const struct json_key plane_keys[] = {
    COMMON_KEYS,
    JSON_KEY("point", JSON_POINT, true, PRIMITIVE(plane.point)),
    JSON_KEY("normal", JSON_DIRECTION, true, PRIMITIVE(plane.normal)),
    JSON_KEY("tangent", JSON_DIRECTION, false, PRIMITIVE(plane.tangent)),
};
static const struct json_key cone_keys[] = {
    COMMON_KEYS,
    JSON_KEY("base", JSON_POINT, true, PRIMITIVE(cone.base)),
    JSON_KEY_IN("base_radius", JSON_NUMBER, true, PRIMITIVE(cone.base_radius), JSON_NOT_NEGATIVE),
    JSON_KEY("apex", JSON_POINT, true, PRIMITIVE(cone.apex)),
    JSON_KEY_IN("apex_radius", JSON_NUMBER, false, PRIMITIVE(cone.apex_radius), JSON_NOT_NEGATIVE),
    JSON_KEY("capped", JSON_BOOLEAN, false, PRIMITIVE(cone.capped)),
};
static const struct json_key cylinder_keys[] = {
    COMMON_KEYS,
    JSON_KEY("base", JSON_POINT, true, PRIMITIVE(cone.base)),
    JSON_KEY("apex", JSON_POINT, true, PRIMITIVE(cone.apex)),
    JSON_KEY_IN("radius", JSON_NUMBER, true, PRIMITIVE(cone.base_radius), JSON_POSITIVE),
    JSON_KEY("capped", JSON_BOOLEAN, false, PRIMITIVE(cone.capped)),
};
static const struct json_key box_keys[] = {
    COMMON_KEYS,
    JSON_KEY("min", JSON_POINT, true, PRIMITIVE(lo)),
    JSON_KEY("max", JSON_POINT, true, PRIMITIVE(hi)),
};
static const struct json_key mesh_keys[] = {
    COMMON_KEYS,
    JSON_KEY_ANY("mesh", false),
    JSON_KEY_ANY("file", false),
    JSON_KEY_ANY("positions", false),
    JSON_KEY_ANY("triangles", false),
    JSON_KEY_ANY("normals", false),
    JSON_KEY_ANY("uvs", false),
    JSON_KEY_ANY("smooth", false),
};
const struct json_table json_tables_primitive[6] = {
    [SPHERE] = JSON_TABLE("a sphere", sphere_keys),
    [PLANE] = JSON_TABLE("a plane", plane_keys),
    [CONE] = JSON_TABLE("a cone", cone_keys),
    [CYLINDER] = JSON_TABLE("a cylinder", cylinder_keys),
    [BOX] = JSON_TABLE("a box", box_keys),
    [MESH] = JSON_TABLE("a mesh primitive", mesh_keys),
};

/* ---- one function a shape ---- */

enum turner_result json_count_primitives(struct json_reader *reader,
                                         const struct json_value *value, size_t more)
{
    reader->primitive_count += more;
    if (reader->primitive_count > TURNER_MAX_PRIMITIVES)
        return json_fail(reader, value, "%zu primitives up to here, but %u are the limit; use "
                         "\"groups\" and \"instances\" for what is there many times",
                         reader->primitive_count, TURNER_MAX_PRIMITIVES);
    return TURNER_OK;
}

static enum turner_result add_plane(struct json_reader *reader, const struct json_object *object,
                                    struct turner_plane plane, uint32_t group)
{
    const struct json_value *tangent = json_member(object, "tangent");
    if (group != 0)
        return json_fail(reader, &object->self, "a group cannot have planes, which have no end; "
                         "put it into the scene's \"primitives\"");
    if (tangent) {
        /* what of it lies in the plane */
        struct turner_vec3 along = turner_vec3_scale(
            plane.normal, turner_vec3_dot(plane.tangent, plane.normal));
        struct turner_vec3 flat = turner_vec3_sub(plane.tangent, along);
        if (turner_vec3_length(flat) < 1e-6)
            return json_fail(reader, tangent, "\"tangent\" lies along \"normal\"; choose another");
        plane.tangent = turner_vec3_normalize(flat);
    } else {
        plane.tangent = turner_vec3_perpendicular(plane.normal);
    }
    struct turner_scene *scene = reader->scene;
    if (scene->plane_count == TURNER_MAX_PLANES)
        return json_fail(reader, &object->self, "one plane too many; %d are the limit",
                         TURNER_MAX_PLANES);
    *TURNER_PUSH(scene->planes, scene->plane_count, scene->plane_capacity) = plane;
    return TURNER_OK;
}

static enum turner_result add_cone(struct json_reader *reader, const struct json_object *object,
                                   struct turner_cone cone, struct turner_group *group)
{
    if (!(turner_vec3_length(turner_vec3_sub(cone.apex, cone.base)) > 0))
        return json_fail(reader, json_member(object, "apex"), "\"apex\" is where \"base\" is");
    if (cone.base_radius == 0 && cone.apex_radius == 0)
        return json_fail(reader, json_member(object, "base_radius"),
                         "one of the radii must be above 0");
    *TURNER_PUSH(group->cones, group->cone_count, group->cone_capacity) = cone;
    return TURNER_OK;
}

static enum turner_result add_mesh(struct json_reader *reader, const struct json_object *object,
                                   uint32_t material, struct turner_group *group)
{
    struct turner_mesh mesh;
    enum turner_result result = json_use_mesh(&mesh, reader, object);
    mesh.material = material;
    turner_group_add_mesh(group, &mesh); /* also a half-built one, for the scene to free */
    return result;
}

static enum turner_result read_primitive(struct json_reader *reader, const struct json_value *value,
                                         uint32_t group_index)
{
    int kind;
    TURNER_TRY(json_read_type(&kind, reader, value, types));
    struct primitive_json p = {.cone.capped = true};
    struct json_object object;
    uint32_t material;
    TURNER_TRY(json_read_object(&object, &p, reader, value, &json_tables_primitive[kind]));
    TURNER_TRY(json_find_name(&material, reader, json_member(&object, "material"),
                              &reader->materials));
    p.sphere.material = p.plane.material = p.cone.material = material;

    struct turner_group *group = &reader->scene->groups[group_index];
    if (kind != PLANE && kind != MESH)
        TURNER_TRY(json_count_primitives(reader, value, kind == BOX ? 12 : 1));
    switch (kind) {
    case SPHERE:
        *TURNER_PUSH(group->spheres, group->sphere_count, group->sphere_capacity) = p.sphere;
        return TURNER_OK;
    case PLANE:
        return add_plane(reader, &object, p.plane, group_index);
    case CYLINDER:
        p.cone.apex_radius = p.cone.base_radius;
        return add_cone(reader, &object, p.cone, group);
    case CONE:
        return add_cone(reader, &object, p.cone, group);
    case BOX:
        if (!(p.lo.x < p.hi.x && p.lo.y < p.hi.y && p.lo.z < p.hi.z))
            return json_fail(reader, json_member(&object, "max"),
                             "\"max\" must be above \"min\" in x, y and z");
        turner_group_add_box(group, p.lo, p.hi, material);
        return TURNER_OK;
    default:
        return add_mesh(reader, &object, material, group);
    }
}

static enum turner_result read_primitives(struct json_reader *reader, uint32_t group,
                                          const struct json_value *value)
{
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_PRIMITIVES));
    for (struct json_value e = json_first(value); e.item; e = json_next(e))
        TURNER_TRY(read_primitive(reader, &e, group));
    return TURNER_OK;
}

enum turner_result json_read_world(struct json_reader *reader, const struct json_value *value)
{
    return read_primitives(reader, 0, value);
}

enum turner_result json_read_groups(struct json_reader *reader, const struct json_value *value)
{
    for (struct json_value m = json_first(value); m.item; m = json_next(m)) {
        uint32_t group = turner_scene_add_group(reader->scene, m.item->string);
        TURNER_TRY(read_primitives(reader, group, &m));
    }
    return TURNER_OK;
}

/* ---- transforms ---- */

struct transform_json {
    struct turner_vec3 translate, axis;
    double angle;
};

#define TRANSFORM(member) offsetof(struct transform_json, member)

static const struct json_key transform_keys[] = {
    JSON_KEY("translate", JSON_POINT, false, TRANSFORM(translate)),
    JSON_KEY_ANY("scale", false),
    JSON_KEY_IN("rotate", JSON_DEGREES, false, TRANSFORM(angle), JSON_UNBOUNDED),
    JSON_KEY("axis", JSON_DIRECTION, false, TRANSFORM(axis)),
    JSON_KEY_ANY("matrix", false),
};
const struct json_table json_table_transform = JSON_TABLE("a transform", transform_keys);

/* Rodrigues' formula; right-handed about the unit axis. */
static struct turner_affine rotation(struct turner_vec3 a, double angle)
{
    double c = cos(angle), s = sin(angle), t = 1 - c;
    return (struct turner_affine){{
        {t * a.x * a.x + c, t * a.x * a.y - s * a.z, t * a.x * a.z + s * a.y, 0},
        {t * a.x * a.y + s * a.z, t * a.y * a.y + c, t * a.y * a.z - s * a.x, 0},
        {t * a.x * a.z - s * a.y, t * a.y * a.z + s * a.x, t * a.z * a.z + c, 0},
    }};
}

static enum turner_result read_scale(struct turner_affine *step, const struct json_reader *reader,
                                     const struct json_value *value)
{
    double s[3];
    if (cJSON_IsNumber(value->item)) {
        TURNER_TRY(json_read_number(&s[0], reader, value, (struct json_range)JSON_UNBOUNDED));
        s[1] = s[2] = s[0];
    } else {
        TURNER_TRY(json_read_numbers(s, 3, reader, value));
    }
    for (int i = 0; i < 3; i++)
        step->m[i][i] = s[i];
    return TURNER_OK;
}

static enum turner_result read_step(struct turner_affine *step, const struct json_reader *reader,
                                    const struct json_value *value)
{
    static const char *const kinds[] = {"translate", "scale", "rotate", "matrix", NULL};
    struct transform_json t = {0};
    struct json_object object;
    int kind;
    TURNER_TRY(json_read_object(&object, &t, reader, value, &json_table_transform));
    TURNER_TRY(json_one_of(&kind, reader, &object, kinds));
    const struct json_value *axis = json_member(&object, "axis");
    const struct json_value *given = json_member(&object, kinds[kind]);
    if (axis && kind != 2)
        return json_fail_key(reader, axis, "\"axis\" goes with \"rotate\"");
    if (!axis && kind == 2)
        return json_fail(reader, value, "missing key \"axis\" of a rotation");
    *step = TURNER_AFFINE_IDENTITY;
    switch (kind) {
    case 0:
        step->m[0][3] = t.translate.x;
        step->m[1][3] = t.translate.y;
        step->m[2][3] = t.translate.z;
        break;
    case 1:
        TURNER_TRY(read_scale(step, reader, given));
        break;
    case 2:
        *step = rotation(t.axis, t.angle);
        break;
    default:
        TURNER_TRY(json_read_numbers(step->m[0], 12, reader, given));
        break;
    }
    if (!turner_affine_usable(step))
        return json_fail(reader, given, "this flattens space (its determinant is 0)");
    return TURNER_OK;
}

static enum turner_result read_transform(struct turner_affine *transform,
                                         const struct json_reader *reader,
                                         const struct json_value *value)
{
    if (cJSON_IsObject(value->item))
        return read_step(transform, reader, value);
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, SIZE_MAX));
    *transform = TURNER_AFFINE_IDENTITY;
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct turner_affine step;
        TURNER_TRY(read_step(&step, reader, &e));
        *transform = turner_affine_multiply(&step, transform);
    }
    if (!turner_affine_usable(transform))
        return json_fail(reader, value, "together these steps flatten space or leave the range of "
                         "numbers");
    return TURNER_OK;
}

/* ---- instances ---- */

static const struct json_key instance_keys[] = {
    JSON_KEY_ANY("group", true),
    JSON_KEY_ANY("transform", false),
    JSON_KEY_ANY("material", false),
};
const struct json_table json_table_instance = JSON_TABLE("an instance", instance_keys);

enum turner_result json_read_instances(struct json_reader *reader, const struct json_value *value)
{
    struct turner_scene *scene = reader->scene;
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_INSTANCES));
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct turner_instance instance = {.material = TURNER_NONE,
                                           .transform = TURNER_AFFINE_IDENTITY};
        struct json_object object;
        TURNER_TRY(json_read_object(&object, NULL, reader, &e, &json_table_instance));
        const struct json_value *transform = json_member(&object, "transform");
        const struct json_value *material = json_member(&object, "material");
        TURNER_TRY(json_find_name(&instance.group, reader, json_member(&object, "group"),
                                  &reader->groups));
        instance.group++; /* group 0 is the world */
        if (transform)
            TURNER_TRY(read_transform(&instance.transform, reader, transform));
        if (material)
            TURNER_TRY(json_find_name(&instance.material, reader, material, &reader->materials));
        *TURNER_PUSH(scene->instances, scene->instance_count, scene->instance_capacity) = instance;
    }
    return TURNER_OK;
}
