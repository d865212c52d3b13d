/* Acceleration structures, seen by a ray query in a small shader. */
#include "gpu_test.h"

#include <math.h>

#include "gpu/accel.h"
#include "gpu/program.h"

static struct turner_gpu gpu;

/* One ray a lane: the nearest hit, confirmed by the shader itself. Boxes hold spheres of radius ½
 * around (2·primitive, 0, 0). */
static const char shader[] =
    "#version 460\n"
    "#extension GL_EXT_ray_query : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "struct ray { vec3 origin; vec3 direction; };\n"
    "struct hit { float t; int instance; int primitive; };\n"
    "layout(local_size_x = 64) in;\n"
    "layout(binding = 0) uniform accelerationStructureEXT top;\n"
    "layout(binding = 1, scalar) readonly buffer ray_block { ray rays[]; };\n"
    "layout(binding = 2, scalar) buffer hit_block { hit hits[]; };\n"
    "layout(push_constant) uniform push_block { uint count; } push;\n"
    "float sphere(vec3 o, vec3 d, vec3 centre)\n{\n"
    "    float b = dot(centre - o, d) / dot(d, d);\n"
    "    vec3 nearest = o + b * d - centre;\n"
    "    float h = 0.25 - dot(nearest, nearest);\n"
    "    return h < 0 ? -1 : b - sqrt(h / dot(d, d));\n"
    "}\n"
    "void main()\n{\n"
    "    uint i = gl_GlobalInvocationID.x;\n"
    "    if (i >= push.count)\n"
    "        return;\n"
    "    rayQueryEXT query;\n"
    "    rayQueryInitializeEXT(query, top, 0, 255, rays[i].origin, 0, rays[i].direction, 1e30);\n"
    "    while (rayQueryProceedEXT(query)) {\n"
    "        if (rayQueryGetIntersectionTypeEXT(query, false) ==\n"
    "            gl_RayQueryCandidateIntersectionTriangleEXT) {\n"
    "            rayQueryConfirmIntersectionEXT(query);\n"
    "            continue;\n"
    "        }\n"
    "        float t = sphere(rayQueryGetIntersectionObjectRayOriginEXT(query, false),\n"
    "                         rayQueryGetIntersectionObjectRayDirectionEXT(query, false),\n"
    "                         vec3(2 * rayQueryGetIntersectionPrimitiveIndexEXT(query, false), 0, "
    "0));\n"
    "        bool nearer = rayQueryGetIntersectionTypeEXT(query, true) ==\n"
    "                      gl_RayQueryCommittedIntersectionNoneEXT ||\n"
    "                      t < rayQueryGetIntersectionTEXT(query, true);\n"
    "        if (t > 0 && nearer)\n"
    "            rayQueryGenerateIntersectionEXT(query, t);\n"
    "    }\n"
    "    hits[i] = hit(-1, -1, -1);\n"
    "    if (rayQueryGetIntersectionTypeEXT(query, true) != "
    "gl_RayQueryCommittedIntersectionNoneEXT)\n"
    "        hits[i] = hit(rayQueryGetIntersectionTEXT(query, true),\n"
    "                      rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),\n"
    "                      rayQueryGetIntersectionPrimitiveIndexEXT(query, true));\n"
    "}\n";

struct ray {
    float origin[3], direction[3];
};

struct hit {
    float t;
    int32_t instance, primitive;
};

static void build_program(struct turner_program *program)
{
    struct turner_shader_source source;
    struct turner_spirv spirv;
    assert_ok(turner_shader_source_from_text(&source, "ray.comp", shader, NULL, 0));
    assert_ok(turner_compile(&spirv, &source, NULL, 0));
    assert_ok(turner_program_create(program, &gpu, &spirv, NULL, 0, false));
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
}

static void trace(const struct turner_accel *top, const struct ray *rays, struct hit *hits,
                  uint32_t count)
{
    struct turner_program program;
    struct turner_buffer in, out;
    build_program(&program);
    assert_ok(
        turner_buffer_create(&in, &gpu, count * sizeof *rays, 0, TURNER_MEMORY_DEVICE, "rays"));
    assert_ok(
        turner_buffer_create(&out, &gpu, count * sizeof *hits, 0, TURNER_MEMORY_HOST, "hits"));
    assert_ok(turner_buffer_upload(&gpu, &in, 0, rays, count * sizeof *rays));
    assert_ok(turner_program_bind_acceleration(&program, &gpu, 0, top->handle));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 1, &in));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 2, &out));
    VkCommandBuffer commands;
    assert_ok(turner_gpu_begin(&gpu, &commands));
    turner_program_dispatch(commands, &program, &count, (count + 63) / 64, 1, 1);
    assert_ok(turner_gpu_submit_wait(&gpu, commands));
    assert_ok(turner_buffer_download(&gpu, &out, 0, hits, count * sizeof *hits));
    turner_buffer_destroy(&gpu, &in);
    turner_buffer_destroy(&gpu, &out);
    turner_program_destroy(&gpu, &program);
}

static void input(struct turner_buffer *buffer, const void *data, size_t size)
{
    assert_ok(turner_buffer_create(buffer, &gpu, size, TURNER_ACCEL_INPUT, TURNER_MEMORY_DEVICE,
                                   "geometry"));
    assert_ok(turner_buffer_upload(&gpu, buffer, 0, data, size));
}

static VkAccelerationStructureInstanceKHR instance(const struct turner_accel *accel, uint32_t index,
                                                   float x, float scale)
{
    return (VkAccelerationStructureInstanceKHR){
        .transform = {{{scale, 0, 0, x}, {0, scale, 0, 0}, {0, 0, scale, 0}}},
        .instanceCustomIndex = index,
        .mask = 255,
        .accelerationStructureReference = accel->address,
    };
}

/* A square of two triangles at x = −20 and again, twice as large, at x = −10; three spheres from
 * x = 0 on. All seen from z = 5 along −z. */
static void nearest_hits(void **state)
{
    (void)state;
    static const float corners[4][4] = {
        {-.5f, -.5f, 0, 7}, {.5f, -.5f, 0, 7}, {.5f, .5f, 0, 7}, {-.5f, .5f, 0, 7}};
    static const uint32_t indices[6] = {0, 1, 2, 0, 2, 3};
    VkAabbPositionsKHR boxes[3];
    for (int i = 0; i < 3; i++)
        boxes[i] = (VkAabbPositionsKHR){2 * (float)i - .51f, -.51f, -.51f,
                                        2 * (float)i + .51f, .51f,  .51f};
    struct turner_buffer vertex_buffer, index_buffer, box_buffer;
    input(&vertex_buffer, corners, sizeof corners);
    input(&index_buffer, indices, sizeof indices);
    input(&box_buffer, boxes, sizeof boxes);
    struct turner_accel triangles, spheres, top;
    assert_ok(turner_accel_build_triangles(&triangles, &gpu, vertex_buffer.address, 16, 4,
                                           index_buffer.address, 2,
                                           VK_GEOMETRY_NO_DUPLICATE_ANY_HIT_INVOCATION_BIT_KHR));
    assert_ok(turner_accel_build_boxes(&spheres, &gpu, box_buffer.address, 3, 0));
    turner_buffer_destroy(&gpu, &vertex_buffer);
    turner_buffer_destroy(&gpu, &index_buffer);
    turner_buffer_destroy(&gpu, &box_buffer);
    const VkAccelerationStructureInstanceKHR instances[3] = {instance(&triangles, 100, -20, 1),
                                                             instance(&triangles, 200, -10, 2),
                                                             instance(&spheres, 300, 0, 1)};
    assert_ok(turner_accel_build_instances(&top, &gpu, instances, 3));

    enum { WIDTH = 300, HEIGHT = 31, COUNT = WIDTH * HEIGHT };
    struct ray *rays = calloc(COUNT, sizeof *rays);
    struct hit *hits = calloc(COUNT, sizeof *hits);
    int seen[3] = {0};
    for (int i = 0; i < COUNT; i++) {
        struct ray *ray = &rays[i];
        ray->origin[0] = -21.987f + (float)(i % WIDTH) * .1f; /* on no edge */
        ray->origin[1] = -1.513f + (float)(i / WIDTH) * .1f;
        ray->origin[2] = 5;
        ray->direction[2] = -2; /* t is half the distance */
    }
    trace(&top, rays, hits, COUNT);
    for (int i = 0; i < COUNT; i++) {
        float x = rays[i].origin[0], y = rays[i].origin[1], t = -1;
        int which = -1, primitive = -1;
        for (int square = 0; square < 2; square++) {
            float half = square ? 1 : .5f, from = x - (square ? -10 : -20);
            if (fabsf(from) < half && fabsf(y) < half) {
                t = 2.5f;
                which = 100 + 100 * square;
                primitive = y > from;
            }
        }
        for (int s = 0; s < 3; s++) {
            float dx = x - 2 * (float)s, square = dx * dx + y * y;
            if (square < .25f) {
                t = (5 - sqrtf(.25f - square)) / 2;
                which = 300;
                primitive = s;
            }
        }
        assert_int_equal(hits[i].instance, which);
        assert_int_equal(hits[i].primitive, primitive);
        assert_true(fabsf(hits[i].t - t) < 1e-5f);
        if (which > 0)
            seen[which / 100 - 1]++;
    }
    for (int i = 0; i < 3; i++)
        assert_true(seen[i] > 90);
    free(rays);
    free(hits);
    turner_accel_destroy(&gpu, &top);
    turner_accel_destroy(&gpu, &spheres);
    turner_accel_destroy(&gpu, &triangles);
    assert_null(top.handle);
}

static void nothing_is_never_hit(void **state)
{
    (void)state;
    struct turner_buffer buffer;
    float zero[16] = {0};
    input(&buffer, zero, sizeof zero);
    struct turner_accel triangles, boxes, top;
    assert_ok(turner_accel_build_triangles(&triangles, &gpu, buffer.address, 12, 0, 0, 0, 0));
    assert_ok(turner_accel_build_boxes(&boxes, &gpu, buffer.address, 0, 0));
    const VkAccelerationStructureInstanceKHR instances[2] = {instance(&triangles, 1, 0, 1),
                                                             instance(&boxes, 2, 0, 1)};
    const struct ray rays[2] = {{{0, 0, 1}, {0, 0, -1}}, {{0, 0, 0}, {1, 0, 0}}};
    for (uint32_t count = 0; count <= 2; count += 2) {
        struct hit hits[2];
        assert_ok(turner_accel_build_instances(&top, &gpu, instances, count));
        trace(&top, rays, hits, 2);
        assert_int_equal(hits[0].instance, -1);
        assert_int_equal(hits[1].instance, -1);
        turner_accel_destroy(&gpu, &top);
    }
    turner_accel_destroy(&gpu, &triangles);
    turner_accel_destroy(&gpu, &boxes);
    turner_buffer_destroy(&gpu, &buffer);
}

static void too_many_are_refused(void **state)
{
    (void)state;
    struct turner_accel accel;
    char figure[64];
    if (gpu.info.max_primitives < UINT32_MAX) {
        uint32_t many = (uint32_t)gpu.info.max_primitives + 1;
        snprintf(figure, sizeof figure, "takes at most %llu",
                 (unsigned long long)gpu.info.max_primitives);
        assert_int_equal(turner_accel_build_boxes(&accel, &gpu, 0, many, 0), TURNER_DEVICE);
        assert_message_has(figure);
        assert_null(accel.handle);
        assert_int_equal(turner_accel_build_triangles(&accel, &gpu, 0, 12, 3, 0, many, 0),
                         TURNER_DEVICE);
        assert_message_has(figure);
    }
    if (gpu.info.max_instances < UINT32_MAX) {
        uint32_t many = (uint32_t)gpu.info.max_instances + 1;
        assert_int_equal(turner_accel_build_instances(&accel, &gpu, NULL, many), TURNER_DEVICE);
        assert_message_has("instances, an acceleration structure of ");
    }
}

/* Many thousand triangles, so that the structure is deep and scratch memory is not trivial. */
static void a_large_mesh(void **state)
{
    (void)state;
    enum { COUNT = 20000 };
    float(*corners)[3] = calloc(3 * COUNT, sizeof *corners);
    struct ray *rays = calloc(COUNT, sizeof *rays);
    struct hit *hits = calloc(COUNT, sizeof *hits);
    for (int i = 0; i < COUNT; i++) {
        float x = (float)(i % 200), y = (float)(i / 200);
        const float triangle[3][3] = {{x, y, 0}, {x + .9f, y, 0}, {x, y + .9f, 0}};
        memcpy(corners[3 * i], triangle, sizeof triangle);
        rays[i] = (struct ray){{x + .3f, y + .3f, 1}, {0, 0, -1}};
    }
    struct turner_buffer buffer;
    input(&buffer, corners, 3 * COUNT * sizeof *corners);
    struct turner_accel mesh, top;
    assert_ok(
        turner_accel_build_triangles(&mesh, &gpu, buffer.address, 12, 3 * COUNT, 0, COUNT, 0));
    turner_buffer_destroy(&gpu, &buffer);
    VkAccelerationStructureInstanceKHR one = instance(&mesh, 1, 0, 1);
    assert_ok(turner_accel_build_instances(&top, &gpu, &one, 1));
    trace(&top, rays, hits, COUNT);
    for (int i = 0; i < COUNT; i++)
        assert_int_equal(hits[i].primitive, i);
    turner_accel_destroy(&gpu, &top);
    turner_accel_destroy(&gpu, &mesh);
    free(corners);
    free(rays);
    free(hits);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nearest_hits),
        cmocka_unit_test(nothing_is_never_hit),
        cmocka_unit_test(too_many_are_refused),
        cmocka_unit_test(a_large_mesh),
    };
    open_device(&gpu);
    if (!gpu.info.ray_query) {
        fprintf(stderr, "skipped: %s lacks %s\n", gpu.info.name, gpu.info.missing);
        turner_gpu_destroy(&gpu);
        return SKIPPED;
    }
    return close_device(&gpu, cmocka_run_group_tests(tests, NULL, NULL));
}
