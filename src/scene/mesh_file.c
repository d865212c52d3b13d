/* Mesh files through assimp. Only the bare import is assimp's: its clean-up steps join vertices
 * and cut faces within tolerances of their own. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "base/memory.h"
#include "base/module.h"
#include "scene/assimp.h"
#include "scene/polygon.h"
#include "scene/readers.h"

/* The mesh while it grows. A normal of zero is one that the file does not give. */
struct reading {
    const char *path;
    struct turner_mesh mesh;
    size_t position_capacity, normal_capacity, uv_capacity, triangle_capacity;
    bool normals, uvs; /* wanted, and a part of the file has them */
    bool vertex_normals; /* what the file gives belongs to vertices, not to facets (STL) */
    int smooth;
    struct turner_polygon polygon;
    size_t dropped; /* faces without area */
};

/* A node that is still to be visited. */
struct visit {
    const struct aiNode *node;
    struct turner_affine transform; /* of its parent */
};

static struct turner_affine affine_of(const struct aiMatrix4x4 *m)
{
    return (struct turner_affine){{{(double)m->a1, (double)m->a2, (double)m->a3, (double)m->a4},
                                   {(double)m->b1, (double)m->b2, (double)m->b3, (double)m->b4},
                                   {(double)m->c1, (double)m->c2, (double)m->c3, (double)m->c4}}};
}

static struct turner_vec3 vec3_of(const struct aiVector3D *v)
{
    return turner_vec3_of((double)v->x, (double)v->y, (double)v->z);
}

/* Normals go by the transpose of the inverse. */
static struct turner_vec3 transform_normal(const struct turner_affine *inverse,
                                           struct turner_vec3 n)
{
    const double(*m)[4] = inverse->m;
    return turner_vec3_normalize(turner_vec3_of(m[0][0] * n.x + m[1][0] * n.y + m[2][0] * n.z,
                                                m[0][1] * n.x + m[1][1] * n.y + m[2][1] * n.z,
                                                m[0][2] * n.x + m[1][2] * n.y + m[2][2] * n.z));
}

static bool has_normals(const struct aiMesh *part)
{
    return part->mNormals != NULL;
}

static bool has_uvs(const struct aiMesh *part)
{
    return part->mTextureCoords[0] && part->mNumUVComponents[0] >= 2;
}

static void add_vertex(struct reading *r, struct turner_vec3 position, struct turner_vec3 normal,
                       const float uv[2])
{
    struct turner_mesh *mesh = &r->mesh;
    uint32_t i = mesh->vertex_count;
    if (r->normals) {
        mesh->normals = turner_grow(mesh->normals, i, &r->normal_capacity, sizeof *mesh->normals);
        mesh->normals[i][0] = (float)normal.x;
        mesh->normals[i][1] = (float)normal.y;
        mesh->normals[i][2] = (float)normal.z;
    }
    if (r->uvs) {
        mesh->uvs = turner_grow(mesh->uvs, i, &r->uv_capacity, sizeof *mesh->uvs);
        memcpy(mesh->uvs[i], uv, sizeof mesh->uvs[i]);
    }
    *TURNER_PUSH(mesh->positions, mesh->vertex_count, r->position_capacity) = position;
}

static enum turner_result add_vertices(struct reading *r, const struct aiMesh *part,
                                       const struct turner_affine *transform)
{
    struct turner_affine inverse;
    bool normals = r->normals && has_normals(part) && turner_affine_invert(&inverse, transform);
    if (part->mNumVertices > UINT32_MAX / 8 - r->mesh.vertex_count)
        return turner_fail(TURNER_BAD_INPUT, "%s: more than %u vertices", r->path, UINT32_MAX / 8);
    for (unsigned i = 0; i < part->mNumVertices; i++) {
        struct turner_vec3 p = turner_affine_point(transform, vec3_of(&part->mVertices[i]));
        struct turner_vec3 n = {0, 0, 0};
        float uv[2] = {0, 0};
        if (normals) {
            n = vec3_of(&part->mNormals[i]);
            if (turner_vec3_finite(n))
                n = transform_normal(&inverse, n);
        }
        if (r->uvs && has_uvs(part)) {
            uv[0] = part->mTextureCoords[0][i].x;
            uv[1] = part->mTextureCoords[0][i].y;
        }
        const char *broken = !turner_vec3_finite(p)                      ? "position"
                             : !turner_vec3_finite(n)                    ? "normal"
                             : !isfinite(uv[0]) || !isfinite(uv[1]) ? "texture coordinate"
                                                                         : NULL;
        if (broken)
            return turner_fail(TURNER_BAD_INPUT,
                               "%s: the %s of vertex %u in mesh \"%s\" is not a finite number; "
                               "repair the file", r->path, broken, i, part->mName.data);
        add_vertex(r, p, n, uv);
    }
    return TURNER_OK;
}

/* Adds a triangle of existing vertices. Where its part lacks what others have it gets vertices of
 * its own: their normals are then its own too, and (u, v) is barycentric, as without any uvs. */
static enum turner_result add_triangle(struct reading *r, const uint32_t corners[3],
                                       bool own_vertices, bool own_uvs)
{
    struct turner_mesh *mesh = &r->mesh;
    struct turner_vec3 p[3];
    for (int c = 0; c < 3; c++)
        p[c] = mesh->positions[corners[c]];
    struct turner_vec3 ng =
        turner_vec3_cross(turner_vec3_sub(p[1], p[0]), turner_vec3_sub(p[2], p[0]));
    /* the length is slower, and right where squares vanish */
    if (!(turner_vec3_dot(ng, ng) > 0 || turner_vec3_length(ng) > 0)) {
        r->dropped++;
        return TURNER_OK;
    }
    if (mesh->triangle_count == TURNER_MAX_PRIMITIVES)
        return turner_fail(TURNER_BAD_INPUT, "%s: more than %u triangles", r->path,
                           TURNER_MAX_PRIMITIVES);
    uint32_t triangle[3];
    for (int c = 0; c < 3; c++) {
        triangle[c] = corners[c];
        if (!own_vertices)
            continue;
        static const float barycentric[3][2] = {{0, 0}, {1, 0}, {0, 1}};
        struct turner_vec3 n = {0, 0, 0};
        float uv[2] = {0, 0};
        if (r->normals)
            n = turner_vec3_of((double)mesh->normals[corners[c]][0],
                               (double)mesh->normals[corners[c]][1],
                               (double)mesh->normals[corners[c]][2]);
        if (r->uvs)
            memcpy(uv, own_uvs ? barycentric[c] : mesh->uvs[corners[c]], sizeof uv);
        triangle[c] = mesh->vertex_count;
        add_vertex(r, p[c], n, uv);
    }
    memcpy(*TURNER_PUSH(mesh->triangles, mesh->triangle_count, r->triangle_capacity), triangle,
           sizeof triangle);
    return TURNER_OK;
}

static enum turner_result add_face(struct reading *r, const struct aiMesh *part,
                                   const struct aiFace *face, uint32_t first, bool mirrored)
{
    bool own_uvs = r->uvs && !has_uvs(part);
    bool own_vertices = own_uvs || (r->normals && !has_normals(part) && r->smooth != 1);
    struct turner_polygon *polygon = &r->polygon;
    if (face->mNumIndices > TURNER_MAX_POLYGON_CORNERS)
        return turner_fail(TURNER_BAD_INPUT, "%s: a face with %u corners, the limit is %d",
                           r->path, face->mNumIndices, TURNER_MAX_POLYGON_CORNERS);
    uint32_t count = face->mNumIndices;
    polygon->corner_count = 0;
    for (uint32_t i = 0; i < count; i++) {
        unsigned index = face->mIndices[i];
        if (index >= part->mNumVertices)
            return turner_fail(TURNER_BAD_INPUT,
                               "%s: a face of mesh \"%s\" uses vertex %u (counted from 0), but "
                               "there are only %u; repair the file", r->path, part->mName.data,
                               index, part->mNumVertices);
        *TURNER_PUSH(polygon->corners, polygon->corner_count, polygon->corner_capacity) =
            r->mesh.positions[first + index];
    }
    if (count < 3) /* a point or a line */
        return TURNER_OK;
    polygon->triangle_count = 0;
    if (count > 3 && turner_polygon_triangulate(polygon) == TURNER_OK && !polygon->triangle_count)
        r->dropped++;
    /* Corners at crossings would need normals and uvs: a face that crosses itself becomes a fan,
     * as what has three corners does. */
    bool fan = count == 3 || polygon->corner_count > count;
    size_t triangle_count = fan ? count - 2 : polygon->triangle_count;
    for (uint32_t i = 0; i < triangle_count; i++) {
        const uint32_t in_fan[3] = {0, i + 1, i + 2};
        const uint32_t *t = fan ? in_fan : polygon->triangles[i];
        uint32_t corners[3];
        for (int c = 0; c < 3; c++)
            corners[c] = first + face->mIndices[t[c]];
        if (mirrored) { /* the winding has turned over with the space */
            uint32_t swap = corners[1];
            corners[1] = corners[2];
            corners[2] = swap;
        }
        TURNER_TRY(add_triangle(r, corners, own_vertices, own_uvs));
    }
    return TURNER_OK;
}

static enum turner_result add_part(struct reading *r, const struct aiMesh *part,
                                   const struct turner_affine *transform)
{
    const double(*m)[4] = transform->m;
    struct turner_vec3 rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] = turner_vec3_of(m[i][0], m[i][1], m[i][2]);
    bool mirrored = turner_vec3_dot(turner_vec3_cross(rows[0], rows[1]), rows[2]) < 0;
    uint32_t first = r->mesh.vertex_count;
    TURNER_TRY(add_vertices(r, part, transform));
    for (unsigned i = 0; i < part->mNumFaces; i++)
        TURNER_TRY(add_face(r, part, &part->mFaces[i], first, mirrored));
    return TURNER_OK;
}

/* All nodes from the root, in the file's order. */
static enum turner_result add_nodes(struct reading *r, const struct aiScene *file)
{
    struct visit *stack = NULL;
    size_t count = 0, capacity = 0;
    enum turner_result result = TURNER_OK;
    *TURNER_PUSH(stack, count, capacity) = (struct visit){file->mRootNode, TURNER_AFFINE_IDENTITY};
    while (count && result == TURNER_OK) {
        struct visit visit = stack[--count];
        struct turner_affine own = affine_of(&visit.node->mTransformation);
        struct turner_affine transform = turner_affine_multiply(&visit.transform, &own);
        for (unsigned i = 0; i < visit.node->mNumMeshes && result == TURNER_OK; i++)
            result = add_part(r, file->mMeshes[visit.node->mMeshes[i]], &transform);
        for (unsigned i = visit.node->mNumChildren; i > 0; i--)
            *TURNER_PUSH(stack, count, capacity) =
                (struct visit){visit.node->mChildren[i - 1], transform};
    }
    free(stack);
    return result;
}

static bool is_zero(const float v[3])
{
    return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

/* Gives every vertex without a normal a smooth one or its (first) triangle's. */
static void complete_normals(struct reading *r)
{
    struct turner_mesh *mesh = &r->mesh;
    bool complete = r->normals;
    for (uint32_t i = 0; complete && i < mesh->vertex_count; i++)
        complete = !is_zero(mesh->normals[i]);
    if (complete)
        return;
    if (r->smooth == 1) {
        float(*given)[3] = mesh->normals;
        mesh->normals = NULL;
        turner_mesh_smooth(mesh);
        for (uint32_t i = 0; given && i < mesh->vertex_count; i++) {
            if (!is_zero(given[i]))
                memcpy(mesh->normals[i], given[i], sizeof given[i]);
        }
        free(given);
        return;
    }
    for (uint32_t i = 0; mesh->normals && i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangles[i];
        for (int c = 0; c < 3; c++) {
            float *normal = mesh->normals[t[c]];
            if (!is_zero(normal))
                continue;
            const struct turner_vec3 *p = mesh->positions;
            struct turner_vec3 ng = turner_vec3_normalize(turner_vec3_cross(
                turner_vec3_sub(p[t[1]], p[t[0]]), turner_vec3_sub(p[t[2]], p[t[0]])));
            normal[0] = (float)ng.x;
            normal[1] = (float)ng.y;
            normal[2] = (float)ng.z;
        }
    }
}

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.'), *slash = strrchr(path, '/');
    return dot && (!slash || dot > slash) ? dot : "";
}

static enum turner_result check_file(const char *path)
{
    static const char *const endings[] = {".obj", ".ply", ".stl", ".gltf", ".glb"};
    bool known = false;
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++)
        known |= strcasecmp(ending_of(path), endings[i]) == 0;
    if (!known)
        return turner_fail(TURNER_BAD_INPUT,
                           "%s: not the name of a mesh file; it must end in .obj, .ply, .stl, "
                           ".gltf or .glb", path);
    struct stat status;
    if (stat(path, &status) != 0)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot open the mesh: %s", path,
                           strerror(errno));
    if (!S_ISREG(status.st_mode))
        return turner_fail(TURNER_BAD_INPUT, "%s: not a file", path);
    if (status.st_size > TURNER_MAX_FILE_BYTES)
        return turner_fail(TURNER_BAD_INPUT, "%s: the file has %lld bytes, the limit is %u", path,
                           (long long)status.st_size, TURNER_MAX_FILE_BYTES);
    return TURNER_OK;
}

static enum turner_result read_scene(struct reading *r, const struct aiScene *file)
{
    for (unsigned i = 0; i < file->mNumMeshes; i++) {
        r->normals |= has_normals(file->mMeshes[i]);
        r->uvs |= has_uvs(file->mMeshes[i]);
    }
    r->normals &= r->smooth != 0 && r->vertex_normals;
    if (file->mRootNode)
        TURNER_TRY(add_nodes(r, file));
    if (!r->mesh.triangle_count)
        return turner_fail(TURNER_BAD_INPUT, "%s: holds no triangles with an area", r->path);
    complete_normals(r);
    turner_mesh_join(&r->mesh);
    if (r->dropped)
        turner_warn("%s: %zu face%s without area left out", r->path, r->dropped,
                    r->dropped == 1 ? "" : "s");
    return TURNER_OK;
}

/* assimp 5.2 never comes back from a PLY file that ends inside its header, whatever its name. */
static enum turner_result check_ply_header(const char *path)
{
    FILE *file = fopen(path, "rb");
    if (!file)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot open the mesh: %s", path,
                           strerror(errno));
    char line[256];
    bool ply = fgets(line, sizeof line, file) && strncasecmp(line, "ply", 3) == 0, ended = false;
    while (ply && !ended && fgets(line, sizeof line, file))
        ended = strncasecmp(line, "end_header", 10) == 0;
    fclose(file);
    if (ply && !ended)
        return turner_fail(TURNER_BAD_INPUT, "%s: the PLY header has no end (end_header); the file "
                                             "may be cut off", path);
    return TURNER_OK;
}

/* What assimp has to say about the shape while it reads; it is never silent about what it mends. */
struct complaints {
    char first[256];
    size_t count;
    bool indices; /* faces with indices out of range, which assimp drops from glTF */
};

/* A line of assimp's log: "Warn,  T0: text\n". */
static void hear(const char *line, char *user)
{
    struct complaints *heard = (struct complaints *)(void *)user;
    const char *text = strstr(line, ": ");
    if (!text || (strncmp(line, "Warn", 4) != 0 && strncmp(line, "Error", 5) != 0))
        return;
    if (strstr(line, "aterial") || strstr(line, "exture")) /* not read anyway */
        return;
    heard->indices |= strstr(line, "out-of-range indices") != NULL;
    if (heard->count++ == 0)
        snprintf(heard->first, sizeof heard->first, "%.*s", (int)strcspn(text + 2, "\n"), text + 2);
}

static const struct turner_assimp *load_assimp(void)
{
#ifdef TURNER_ASSIMP_MODULE
    static struct turner_module module = {TURNER_ASSIMP_MODULE, "turner_assimp_module",
                                          "reads mesh files", NULL};
    return turner_module_load(&module);
#else
    return turner_assimp_module();
#endif
}

static const struct aiScene *import(const char *path, struct complaints *heard,
                                    const struct turner_assimp *assimp)
{
    struct aiLogStream stream = {hear, (char *)(void *)heard};
    assimp->attach_log(&stream);
    const struct aiScene *file = assimp->import(path, 0);
    assimp->detach_log(&stream);
    return file;
}

enum turner_result turner_mesh_read_file(struct turner_mesh *mesh, const char *path, int smooth)
{
    *mesh = (struct turner_mesh){0};
    TURNER_TRY(check_file(path));
    TURNER_TRY(check_ply_header(path));
    const struct turner_assimp *assimp = load_assimp();
    if (!assimp)
        return TURNER_DEVICE;
    struct complaints heard = {0};
    const struct aiScene *file = import(path, &heard, assimp);
    if (!file)
        return turner_fail(TURNER_BAD_INPUT, "%s: cannot be read as a mesh: %s", path,
                           assimp->error());
    struct reading r = {.path = path, .smooth = smooth,
                        .vertex_normals = strcasecmp(ending_of(path), ".stl") != 0};
    enum turner_result result =
        heard.indices ? turner_fail(TURNER_BAD_INPUT, "%s: faces use vertices that the file does "
                                                      "not have; repair the file", path)
                      : read_scene(&r, file);
    assimp->release(file);
    turner_polygon_destroy(&r.polygon);
    if (result != TURNER_OK) {
        turner_mesh_destroy(&r.mesh);
        return result;
    }
    if (heard.count)
        turner_warn("%s: %s%s", path, heard.first, heard.count > 1 ? " (and more)" : "");
    *mesh = r.mesh;
    return TURNER_OK;
}
