/* Meshes: named ones, and those that stand where they are used. */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/json.h"
#include "scene/readers.h"

struct mesh_json {
    const char *file;
    bool smooth;
};

static const struct json_key mesh_keys[] = {
    JSON_KEY("file", JSON_STRING, false, offsetof(struct mesh_json, file)),
    JSON_KEY_ANY("positions", false),
    JSON_KEY_ANY("triangles", false),
    JSON_KEY_ANY("normals", false),
    JSON_KEY_ANY("uvs", false),
    JSON_KEY("smooth", JSON_BOOLEAN, false, offsetof(struct mesh_json, smooth)),
};
const struct json_table json_table_mesh = JSON_TABLE("a mesh", mesh_keys);

enum turner_result json_read_file_name(char **path, const struct json_reader *reader,
                                       const struct json_value *value)
{
    const char *name;
    TURNER_TRY(json_read_string(&name, reader, value));
    if (!*name)
        return json_fail(reader, value, "expected the name of a file, but this is empty");
    *path = turner_path_beside(reader->path, name);
    return TURNER_OK;
}

static enum turner_result read_positions(struct turner_mesh *mesh, const struct json_reader *reader,
                                         const struct json_value *value)
{
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_PRIMITIVES));
    mesh->positions = turner_calloc(count ? count : 1, sizeof *mesh->positions);
    mesh->vertex_count = (uint32_t)count;
    for (struct json_value e = json_first(value); e.item; e = json_next(e))
        TURNER_TRY(json_read_point(&mesh->positions[e.index], reader, &e));
    return TURNER_OK;
}

static enum turner_result read_triangles(struct turner_mesh *mesh, const struct json_reader *reader,
                                         const struct json_value *value)
{
    size_t count, corners;
    TURNER_TRY(json_expect_list(&count, reader, value, TURNER_MAX_PRIMITIVES));
    if (count == 0)
        return json_fail(reader, value, "a mesh needs at least one triangle");
    mesh->triangles = turner_calloc(count, sizeof *mesh->triangles);
    mesh->triangle_count = (uint32_t)count;
    if (mesh->vertex_count == 0)
        return json_fail(reader, value, "these triangles have no \"positions\" to use");
    const struct json_range range = JSON_FROM_TO(0, (double)mesh->vertex_count - 1);
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        TURNER_TRY(json_expect_list(&corners, reader, &e, SIZE_MAX));
        if (corners != 3)
            return json_fail(reader, &e, "a triangle has 3 corners, but here are %zu", corners);
        for (struct json_value c = json_first(&e); c.item; c = json_next(c)) {
            int corner;
            TURNER_TRY(json_read_integer(&corner, reader, &c, range));
            mesh->triangles[e.index][c.index] = (uint32_t)corner;
        }
    }
    return TURNER_OK;
}

static enum turner_result expect_one_each(const struct json_reader *reader,
                                          const struct json_value *value, uint32_t vertex_count)
{
    size_t count;
    TURNER_TRY(json_expect_list(&count, reader, value, SIZE_MAX));
    if (count != vertex_count)
        return json_fail(reader, value, "expected one for each of the %u positions, but here are "
                         "%zu", vertex_count, count);
    return TURNER_OK;
}

static enum turner_result read_normals(struct turner_mesh *mesh, const struct json_reader *reader,
                                       const struct json_value *value)
{
    TURNER_TRY(expect_one_each(reader, value, mesh->vertex_count));
    mesh->normals = turner_calloc(mesh->vertex_count, sizeof *mesh->normals);
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        struct turner_vec3 normal;
        TURNER_TRY(json_read_direction(&normal, reader, &e));
        mesh->normals[e.index][0] = (float)normal.x;
        mesh->normals[e.index][1] = (float)normal.y;
        mesh->normals[e.index][2] = (float)normal.z;
    }
    return TURNER_OK;
}

static enum turner_result read_uvs(struct turner_mesh *mesh, const struct json_reader *reader,
                                   const struct json_value *value)
{
    TURNER_TRY(expect_one_each(reader, value, mesh->vertex_count));
    mesh->uvs = turner_calloc(mesh->vertex_count, sizeof *mesh->uvs);
    for (struct json_value e = json_first(value); e.item; e = json_next(e)) {
        double uv[2];
        TURNER_TRY(json_read_numbers(uv, 2, reader, &e));
        mesh->uvs[e.index][0] = (float)uv[0];
        mesh->uvs[e.index][1] = (float)uv[1];
    }
    return TURNER_OK;
}

static enum turner_result read_inline(struct turner_mesh *mesh, const struct json_reader *reader,
                                      const struct json_object *object, bool smooth)
{
    const struct json_value *triangles = json_member(object, "triangles");
    const struct json_value *normals = json_member(object, "normals");
    const struct json_value *uvs = json_member(object, "uvs");
    if (!triangles)
        return json_fail(reader, &object->self, "missing key: \"positions\" need \"triangles\"");
    TURNER_TRY(read_positions(mesh, reader, json_member(object, "positions")));
    TURNER_TRY(read_triangles(mesh, reader, triangles));
    if (normals)
        TURNER_TRY(read_normals(mesh, reader, normals));
    if (uvs)
        TURNER_TRY(read_uvs(mesh, reader, uvs));
    if (smooth && !normals)
        turner_mesh_smooth(mesh);
    if (!smooth && json_member(object, "smooth")) {
        free(mesh->normals);
        mesh->normals = NULL;
    }
    return TURNER_OK;
}

/* What stands beside "mesh" or "file" would have no effect. */
static enum turner_result refuse_inline_keys(const struct json_reader *reader,
                                             const struct json_object *object, const char *source)
{
    static const char *const keys[] = {"triangles", "normals", "uvs"};
    for (size_t i = 0; i < 3; i++) {
        const struct json_value *member = json_member(object, keys[i]);
        if (member)
            return json_fail_key(reader, member, "\"%s\" goes with \"positions\", not with \"%s\"",
                                 keys[i], source);
    }
    return TURNER_OK;
}

static enum turner_result read_mesh(struct turner_mesh *mesh, struct json_reader *reader,
                                  const struct json_object *object)
{
    *mesh = (struct turner_mesh){0};
    const struct json_value *file = json_member(object, "file");
    const struct json_value *smooth = json_member(object, "smooth");
    bool make_smooth = false;
    if (smooth)
        TURNER_TRY(json_read_boolean(&make_smooth, reader, smooth));
    enum turner_result result;
    if (!file) {
        result = read_inline(mesh, reader, object, make_smooth);
    } else {
        TURNER_TRY(refuse_inline_keys(reader, object, "file"));
        char *path = NULL;
        TURNER_TRY(json_read_file_name(&path, reader, file));
        result = turner_mesh_read_file(mesh, path, smooth ? make_smooth : -1);
        free(path);
        if (result != TURNER_OK)
            result = json_fail_file(reader, file, result);
    }
    if (result != TURNER_OK)
        turner_mesh_destroy(mesh);
    return result;
}

enum turner_result json_read_meshes(struct json_reader *reader, const struct json_value *value)
{
    static const char *const sources[] = {"file", "positions", NULL};
    reader->mesh_templates =
        turner_calloc(reader->meshes.count + 1, sizeof *reader->mesh_templates);
    for (struct json_value m = json_first(value); m.item; m = json_next(m)) {
        struct mesh_json unused;
        struct json_object object;
        int source;
        TURNER_TRY(json_read_object(&object, &unused, reader, &m, &json_table_mesh));
        TURNER_TRY(json_one_of(&source, reader, &object, sources));
        TURNER_TRY(read_mesh(&reader->mesh_templates[m.index], reader, &object));
    }
    return TURNER_OK;
}

/* ---- a mesh where it is used ---- */

static void *copy(const void *items, size_t count, size_t size)
{
    if (!items)
        return NULL;
    return memcpy(turner_calloc(count, size), items, count * size);
}

static enum turner_result copy_named(struct turner_mesh *mesh, struct json_reader *reader,
                                     const struct json_object *object)
{
    uint32_t index;
    const struct json_value *smooth = json_member(object, "smooth");
    TURNER_TRY(refuse_inline_keys(reader, object, "mesh"));
    if (smooth)
        return json_fail_key(reader, smooth, "\"smooth\" belongs to the mesh in \"meshes\"");
    TURNER_TRY(json_find_name(&index, reader, json_member(object, "mesh"), &reader->meshes));
    const struct turner_mesh *t = &reader->mesh_templates[index];
    TURNER_TRY(json_count_primitives(reader, &object->self, t->triangle_count));
    mesh->positions = copy(t->positions, t->vertex_count, sizeof *t->positions);
    mesh->normals = copy(t->normals, t->vertex_count, sizeof *t->normals);
    mesh->uvs = copy(t->uvs, t->vertex_count, sizeof *t->uvs);
    mesh->triangles = copy(t->triangles, t->triangle_count, sizeof *t->triangles);
    mesh->vertex_count = t->vertex_count;
    mesh->triangle_count = t->triangle_count;
    return TURNER_OK;
}

enum turner_result json_use_mesh(struct turner_mesh *mesh, struct json_reader *reader,
                                 const struct json_object *object)
{
    static const char *const sources[] = {"mesh", "file", "positions", NULL};
    int source;
    *mesh = (struct turner_mesh){0};
    TURNER_TRY(json_one_of(&source, reader, object, sources));
    if (source == 0)
        return copy_named(mesh, reader, object);
    TURNER_TRY(read_mesh(mesh, reader, object));
    return json_count_primitives(reader, &object->self, mesh->triangle_count);
}
