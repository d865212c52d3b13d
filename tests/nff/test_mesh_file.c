/* Mesh files: what comes in, in which shape, and what is refused. */
#include <errno.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "nff_reading.h"

#define FOLDER TURNER_BINARY_DIR "/mesh_file_test"
#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char quad_obj[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n"
    "f 1/1/1 2/2/1 3/3/1 4/4/1\n";

/* The same quad, two triangles; glTF has v = 0 at the top. NODES, then INDEX, the last index. */
#define QUAD_GLTF(nodes, tail)                                                                     \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["         \
    nodes                                                                                          \
    "],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,"                 \
    "\"TEXCOORD_0\":2},\"indices\":3}]}],\"accessors\":["                                          \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","                      \
    "\"min\":[0,0,0],\"max\":[1,1,0]},"                                                            \
    "{\"bufferView\":0,\"byteOffset\":48,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"},"   \
    "{\"bufferView\":0,\"byteOffset\":96,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"   \
    "{\"bufferView\":0,\"byteOffset\":128,\"componentType\":5123,\"count\":6,"                     \
    "\"type\":\"SCALAR\"}],"                                                                       \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":140}],\"buffers\":[{\"byteLength\":140,"        \
    "\"uri\":\"data:application/octet-stream;base64,"                                              \
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAACAPwAAgD8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/"             \
    "AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/AAAAAAAAAAAAAIA/"                                             \
    "AAAAAAAAgD8AAIA/AACAPwAAgD8AAAAAAAAAAAAAAAAAAAEAAgAAAAIA" tail "\"}]}"

static const char cube_obj[] = /* no normals, six quads */
    "v -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\nv -1 1 1\nv 1 1 1\n"
    "f 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4\nf 1 3 4 2\nf 5 6 8 7\n";

static const char octahedron_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
    "property float z\nelement face 8\nproperty list uchar int vertex_indices\nend_header\n"
    "1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n"
    "3 0 2 4\n3 2 1 4\n3 1 3 4\n3 3 0 4\n3 2 0 5\n3 1 2 5\n3 3 1 5\n3 0 3 5\n";

static const char with_normals_ply[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
    "property float s\nproperty float t\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 0 0 2 0 0\n1 0 0 0 3 4 1 0.25\n0 1 0 0 0 0 0 1\n3 0 1 2\n";

#define FACET(a, b, c)                                                                             \
    "facet normal 0 0 0\nouter loop\nvertex " a "\nvertex " b "\nvertex " c "\nendloop\nendfacet\n"
static const char tetrahedron_stl[] =
    "solid t\n" FACET("0 0 0", "0 1 0", "1 0 0") FACET("0 0 0", "1 0 0", "0 0 1")
        FACET("0 0 0", "0 0 1", "0 1 0") FACET("1 0 0", "0 1 0", "0 0 1") "endsolid t\n";

static const char *write_file(const char *name, const char *content, size_t length)
{
    static char path[1024];
    mkdir(FOLDER, 0777);
    snprintf(path, sizeof path, FOLDER "/%s", name);
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(content, 1, length, file) != length || fclose(file) != 0)
        fail_msg("cannot write %s", path);
    return path;
}

/* The mesh of a file with that content; nothing may come on stderr. */
static struct turner_mesh mesh_of(const char *name, const char *content, int smooth)
{
    struct turner_mesh mesh;
    struct caught caught = caught_begin();
    enum turner_result result =
        turner_mesh_read_file(&mesh, write_file(name, content, strlen(content)), smooth);
    char *output = caught_end(&caught);
    if (result != TURNER_OK)
        fail_msg("%s", turner_message());
    assert_string_equal(output, "");
    free(output);
    for (uint32_t i = 0; i < mesh.triangle_count; i++) {
        for (int c = 0; c < 3; c++)
            assert_true(mesh.triangles[i][c] < mesh.vertex_count);
    }
    for (uint32_t i = 0; mesh.normals && i < mesh.vertex_count; i++) {
        const float *n = mesh.normals[i];
        assert_true(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-6f);
    }
    assert_int_equal(mesh.material, 0);
    return mesh;
}

static struct turner_vec3 ng_of(const struct turner_mesh *mesh, uint32_t triangle)
{
    const uint32_t *t = mesh->triangles[triangle];
    struct turner_vec3 a = mesh->positions[t[0]];
    return turner_vec3_cross(turner_vec3_sub(mesh->positions[t[1]], a),
                             turner_vec3_sub(mesh->positions[t[2]], a));
}

static double area_of(const struct turner_mesh *mesh)
{
    double area = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        area += turner_vec3_length(ng_of(mesh, i)) / 2;
    return area;
}

/* Volume by the divergence theorem: right only if every triangle is wound outward. */
static double volume_of(const struct turner_mesh *mesh)
{
    double volume = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++)
        volume += turner_vec3_dot(ng_of(mesh, i), mesh->positions[mesh->triangles[i][0]]) / 6;
    return volume;
}

static void coordinates_have_v_upwards(void **state)
{
    (void)state;
    for (int gltf = 0; gltf < 2; gltf++) {
        struct turner_mesh mesh =
            gltf ? mesh_of("quad.gltf", QUAD_GLTF("{\"mesh\":0}", "AwA="), -1)
                 : mesh_of("quad.obj", quad_obj, -1);
        assert_true(mesh.vertex_count == 4 && mesh.triangle_count == 2);
        assert_non_null(mesh.uvs);
        for (uint32_t i = 0; i < 4; i++) {
            assert_true((double)mesh.uvs[i][0] == mesh.positions[i].x);
            assert_true((double)mesh.uvs[i][1] == mesh.positions[i].y);
            assert_true(mesh.normals[i][2] == 1);
        }
        assert_true(area_of(&mesh) == 1);
        turner_mesh_destroy(&mesh);
    }
}

static void nodes_move_turn_and_mirror(void **state)
{
    (void)state;
    /* the root moves; below it one plain, one mirrored in x and stretched, one turned about y */
    struct turner_mesh mesh = mesh_of(
        "nodes.gltf",
        QUAD_GLTF("{\"translation\":[10,0,0],\"children\":[1,2,3]},{\"mesh\":0},"
                  "{\"mesh\":0,\"scale\":[-2,1,1]},"
                  "{\"mesh\":0,\"rotation\":[0,0.70710678118,0,0.70710678118]}", "AwA="), -1);
    assert_int_equal(mesh.triangle_count, 6);
    assert_true(fabs(area_of(&mesh) - (1 + 2 + 1)) < 1e-6);
    for (uint32_t i = 0; i < 6; i++) {
        const float *n = mesh.normals[mesh.triangles[i][0]];
        struct turner_vec3 ng = turner_vec3_normalize(ng_of(&mesh, i));
        struct turner_vec3 p = mesh.positions[mesh.triangles[i][1]];
        assert_true(fabs(ng.x * (double)n[0] + ng.y * (double)n[1] + ng.z * (double)n[2] - 1) <
                    1e-6); /* still on the same side */
        if (i < 2)
            assert_true(p.x == 11 && ng.z == 1);
        else if (i < 4)
            assert_true(mesh.positions[mesh.triangles[i][0]].x == 10 && ng.z == 1);
        else
            assert_true(fabs(ng.x - 1) < 1e-6 && fabs(p.x - 10) < 1e-6);
    }
    assert_true(mesh.positions[mesh.triangles[2][2]].x == 8); /* the winding was turned back */
    turner_mesh_destroy(&mesh);
}

static void smooth_and_flat(void **state)
{
    (void)state;
    struct turner_mesh flat = mesh_of("cube.obj", cube_obj, -1);
    assert_true(!flat.normals && !flat.uvs);
    assert_true(flat.vertex_count == 8 && flat.triangle_count == 12);
    assert_true(fabs(volume_of(&flat) - 8) < 1e-12);
    turner_mesh_destroy(&flat);

    struct turner_mesh smooth = mesh_of("cube.obj", cube_obj, 1);
    assert_int_equal(smooth.vertex_count, 8);
    for (uint32_t i = 0; i < 8; i++) {
        const struct turner_vec3 p = smooth.positions[i];
        const float *n = smooth.normals[i], third = (float)(1 / sqrt(3));
        assert_true(fabsf(n[0] - third * (float)p.x) < 1e-6f);
        assert_true(fabsf(n[1] - third * (float)p.y) < 1e-6f);
        assert_true(fabsf(n[2] - third * (float)p.z) < 1e-6f);
    }
    turner_mesh_destroy(&smooth);

    struct turner_mesh dropped = mesh_of("quad.obj", quad_obj, 0);
    assert_true(!dropped.normals && dropped.uvs && dropped.vertex_count == 4);
    turner_mesh_destroy(&dropped);
}

static void ply(void **state)
{
    (void)state;
    struct turner_mesh mesh = mesh_of("octahedron.ply", octahedron_ply, -1);
    assert_true(!mesh.normals && mesh.vertex_count == 6 && mesh.triangle_count == 8);
    assert_true(fabs(volume_of(&mesh) - 4.0 / 3) < 1e-12);
    turner_mesh_destroy(&mesh);

    mesh = mesh_of("normals.ply", with_normals_ply, -1);
    static const float normals[3][3] = {{0, 0, 1}, {0, .6f, .8f}, {0, 0, 1}};
    for (uint32_t i = 0; i < 3; i++) { /* made unit; the zero one became Ng */
        for (int c = 0; c < 3; c++)
            assert_true(fabsf(mesh.normals[i][c] - normals[i][c]) < 1e-7f);
    }
    assert_true(mesh.uvs[1][0] == 1 && mesh.uvs[1][1] == .25f);
    turner_mesh_destroy(&mesh);
}

static void stl(void **state)
{
    (void)state;
    struct turner_mesh flat = mesh_of("tetrahedron.stl", tetrahedron_stl, -1);
    assert_true(!flat.normals && flat.vertex_count == 4 && flat.triangle_count == 4);
    assert_true(fabs(volume_of(&flat) - 1.0 / 6) < 1e-7);
    turner_mesh_destroy(&flat);
    struct turner_mesh smooth = mesh_of("tetrahedron.stl", tetrahedron_stl, 1);
    assert_true(smooth.normals && smooth.vertex_count == 4);
    turner_mesh_destroy(&smooth);

    unsigned char binary[84 + 50] = "binary";
    static const float corners[9] = {0, 0, 0, 2, 0, 0, 0, 2, 0};
    binary[80] = 1;
    memcpy(binary + 84 + 12, corners, sizeof corners);
    struct turner_mesh one;
    const char *path = write_file("binary.stl", (const char *)binary, sizeof binary);
    assert_int_equal(turner_mesh_read_file(&one, path, -1), TURNER_OK);
    assert_true(one.triangle_count == 1 && area_of(&one) == 2 && !one.normals);
    turner_mesh_destroy(&one);
}

/* A flat part and one with normals in the same file. */
static void parts_that_differ(void **state)
{
    (void)state;
    static const char obj[] = "o first\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n"
                              "vn 0 .6 .8\nf 1/1/1 2/2/1 3/3/1\n"
                              "o second\nv 0 0 5\nv 0 1 5\nv 1 0 5\nv 1 1 5\n"
                              "f 4 5 6\nf 6 5 7\n";
    for (int smooth = -1; smooth <= 1; smooth++) {
        struct turner_mesh mesh = mesh_of("parts.obj", obj, smooth);
        assert_int_equal(mesh.triangle_count, 3);
        assert_non_null(mesh.uvs);
        assert_true((mesh.normals == NULL) == (smooth == 0));
        for (uint32_t i = 0; i < 3; i++) {
            for (int c = 0; c < 3; c++) {
                uint32_t v = mesh.triangles[i][c];
                assert_true(mesh.uvs[v][0] == (c == 1) && mesh.uvs[v][1] == (c == 2));
                if (mesh.normals)
                    assert_true(fabsf(mesh.normals[v][2] - (i == 0 ? .8f : -1)) < 1e-6f);
            }
        }
        turner_mesh_destroy(&mesh);
    }
}

static void concave_faces(void **state)
{
    (void)state;
    struct turner_mesh mesh =
        mesh_of("arrow.obj", "v 0 0 0\nv 2 -1 0\nv 0.5 0 0\nv 2 1 0\nf 2 3 4 1\n", -1);
    assert_true(mesh.triangle_count == 2 && fabs(area_of(&mesh) - .5) < 1e-7);
    assert_true(ng_of(&mesh, 0).z > 0 && ng_of(&mesh, 1).z > 0);
    turner_mesh_destroy(&mesh);
    mesh = mesh_of("bow_tie.obj", "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 1.5 0\nf 1 2 3 4\n", -1);
    assert_true(mesh.triangle_count == 2 && mesh.vertex_count == 4); /* a fan, no new corners */
    turner_mesh_destroy(&mesh);
}

static void vertices_join_only_when_equal_in_everything(void **state)
{
    (void)state;
    struct turner_mesh mesh =
        mesh_of("seam.obj",
                "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 1 0.000000000\nv 9 9 9\nvt 0 0\nvt 1 1\n"
                "f 1/1 2/1 3/1\nf 1/1 5/1 4/1\nf 1/1 2/2 3/1\n", -1);
    assert_int_equal(mesh.vertex_count, 5); /* 3 and 5 are one, 2 is two, 6 is of no use */
    turner_mesh_destroy(&mesh);
}

static void faces_without_area_are_left_out_with_one_warning(void **state)
{
    (void)state;
    static const char obj[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nv 0.5 0 0\nf 1 2 3\nf 1 2 2\n"
                              "f 1 2 4\nf 1 2 4 5\nl 1 2\n";
    struct turner_mesh mesh;
    struct caught caught = caught_begin();
    enum turner_result result =
        turner_mesh_read_file(&mesh, write_file("flat.obj", obj, strlen(obj)), -1);
    char *output = caught_end(&caught);
    assert_int_equal(result, TURNER_OK);
    assert_string_equal(output, "turner: warning: " FOLDER
                                "/flat.obj: 3 faces without area left out\n");
    free(output);
    assert_true(mesh.triangle_count == 1 && mesh.vertex_count == 3);
    turner_mesh_destroy(&mesh);
}

struct fault {
    const char *name, *content, *message;
};

#define PLY(vertices, faces)                                                                       \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"                \
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"       \
    vertices faces
#define THREE_VERTICES "v 0 0 0\nv 1 0 0\nv 0 1 0\n"

static const struct fault faults[] = {
    {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n", "the position of vertex 1 in mesh"},
    {"inf.ply", PLY("0 0 0\n1 0 0\n0 inf 0\n", "3 0 1 2\n"), "the position of vertex 2 in mesh"},
    {"nan.stl", "solid t\n" FACET("0 0 0", "0 nan 0", "1 0 0") "endsolid t\n",
     "the position of vertex 1 in mesh"},
    {"nan_normal.obj", THREE_VERTICES "vn 0 0 nan\nf 1//1 2//1 3//1\n", "the normal of vertex 0"},
    {"nan_uv.ply",
     "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
     "property float z\nproperty float s\nproperty float t\nelement face 1\n"
     "property list uchar int vertex_indices\nend_header\n"
     "0 0 0 0 0\n1 0 0 0 nan\n0 1 0 0 0\n3 0 1 2\n", "the texture coordinate of vertex 1"},
    {"index.obj", THREE_VERTICES "f 1 2 4\n", "cannot be read as a mesh: "},
    {"index.ply", PLY("0 0 0\n1 0 0\n0 1 0\n", "3 0 1 3\n"), "uses vertex 3 (counted from 0), but "
                                                             "there are only 3; repair the file"},
    {"index.gltf", QUAD_GLTF("{\"mesh\":0}", "CQA="),
     "faces use vertices that the file does not have"},
    {"no_nodes.gltf", "{\"asset\":{\"version\":\"2.0\"}}", "cannot be read as a mesh: "},
    {"no_buffer.gltf",
     "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
     "\"nodes\":[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],"
     "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
     "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
     "\"buffers\":[{\"byteLength\":36,\"uri\":\"gone.bin\"}]}",
     "gone.bin"},
    {"broken.gltf", "{\"asset\":", "cannot be read as a mesh: "},
    {"points.obj", "v 0 0 0\nv 1 0 0\np 1\np 2\n", "holds no triangles with an area"},
    {"lines.obj", THREE_VERTICES "l 1 2\nl 2 3\n", "holds no triangles with an area"},
    {"flat.ply", PLY("0 0 0\n1 0 0\n2 0 0\n", "3 0 1 2\n"), "holds no triangles with an area"},
    {"empty.obj", "", "cannot be read as a mesh: "},
    {"empty.ply", "", "cannot be read as a mesh: "},
    {"empty.stl", "", "cannot be read as a mesh: "},
    {"empty.glb", "", "cannot be read as a mesh: "},
    {"noise.stl", "\x7f\x45\x4c\x46 no mesh at all", "cannot be read as a mesh: "},
    {"cut.glb", "glTF\2", "cannot be read as a mesh: "},
    {"cut.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n",
     "the PLY header has no end (end_header)"},
    {"cut_ply.stl", "ply\nformat ascii 1.0\n", "the PLY header has no end (end_header)"},
    {"mesh.xyz", "0 0 0", "not the name of a mesh file; it must end in .obj, .ply, .stl, .gltf or "
                          ".glb"},
    {"obj", "0 0 0", "not the name of a mesh file"},
};

static void refused(const char *path, const char *message)
{
    struct turner_mesh mesh;
    struct caught caught = caught_begin();
    enum turner_result result = turner_mesh_read_file(&mesh, path, -1);
    char *output = caught_end(&caught);
    if (result == TURNER_OK)
        fail_msg("%s is read without complaint", path);
    assert_int_equal(result, TURNER_BAD_INPUT);
    assert_string_equal(output, "");
    free(output);
    print_message("%s\n", turner_message());
    assert_ptr_equal(strstr(turner_message(), path), turner_message());
    if (!strstr(turner_message(), message))
        fail_msg("%s\ndoes not say: %s", turner_message(), message);
    assert_true(!mesh.positions && !mesh.triangles && !mesh.vertex_count && !mesh.triangle_count);
}

static void messages(void **state)
{
    (void)state;
    for (size_t i = 0; i < COUNT(faults); i++)
        refused(write_file(faults[i].name, faults[i].content, strlen(faults[i].content)),
                faults[i].message);
    refused(FOLDER "/missing.obj", "cannot open the mesh: No such file or directory");
    assert_true(mkdir(FOLDER "/folder.ply", 0777) == 0 || errno == EEXIST);
    refused(FOLDER "/folder.ply", "not a file");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coordinates_have_v_upwards),
        cmocka_unit_test(nodes_move_turn_and_mirror),
        cmocka_unit_test(smooth_and_flat),
        cmocka_unit_test(ply),
        cmocka_unit_test(stl),
        cmocka_unit_test(parts_that_differ),
        cmocka_unit_test(concave_faces),
        cmocka_unit_test(vertices_join_only_when_equal_in_everything),
        cmocka_unit_test(faces_without_area_are_left_out_with_one_warning),
        cmocka_unit_test(messages),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
