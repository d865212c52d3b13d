/* Primitives and groups. */
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
