/* The whole chain: source, SPIR-V, pipeline, dispatch, result. */
#include "gpu_test.h"

#include <unistd.h>

#include "gpu/memory.h"
#include "gpu/program.h"

static struct turner_gpu gpu;

static enum turner_result build(struct turner_program *program, const char *text,
                                const struct turner_constant *constants, size_t count)
{
    struct turner_shader_source source;
    struct turner_spirv spirv = {0};
    *program = (struct turner_program){0};
    enum turner_result result = turner_shader_source_from_text(&source, "test.comp", text, NULL, 0);
    if (result == TURNER_OK)
        result = turner_compile(&spirv, &source, NULL, 0);
    if (result == TURNER_OK)
        result = turner_program_create(program, &gpu, &spirv, constants, count, false);
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
    return result;
}

static void dispatch(const struct turner_program *program, const void *push, uint32_t x)
{
    VkCommandBuffer commands;
    assert_ok(turner_gpu_begin(&gpu, &commands));
    turner_program_dispatch(commands, program, push, x, 1, 1);
    assert_ok(turner_gpu_submit_wait(&gpu, commands));
}

/* By address: no descriptor at all. */
static const char add_by_address[] =
    "#version 460\n"
    "#extension GL_EXT_buffer_reference : require\n"
    "#extension GL_EXT_scalar_block_layout : require\n"
    "#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require\n"
    "layout(local_size_x_id = 7) in;\n"
    "layout(constant_id = 3) const uint added = 1;\n"
    "layout(constant_id = 4) const float scale = 1;\n"
    "layout(constant_id = 5) const bool negate = false;\n"
    "layout(buffer_reference, scalar) buffer numbers { float at[]; };\n"
    "layout(push_constant, scalar) uniform push_block { uint64_t data; uint count; } push;\n"
    "void main()\n{\n"
    "    uint i = gl_GlobalInvocationID.x;\n"
    "    if (i < push.count)\n"
    "        numbers(push.data).at[i] = (float(i) + float(added)) * scale * (negate ? -1 : 1);\n"
    "}\n";

struct push {
    uint64_t data;
    uint32_t count, pad;
};

static void constants_and_addresses(void **state)
{
    (void)state;
    float half = 0.5f;
    uint32_t half_bits;
    memcpy(&half_bits, &half, sizeof half);
    const struct turner_constant constants[] = {
        {7, 16}, {99, 5}, {3, 10}, {4, half_bits}, {5, 1}}; /* 99 is not in the shader */
    for (size_t given = 1; given <= 5; given++) {
        struct turner_program program;
        assert_ok(build(&program, add_by_address, constants, given));
        assert_int_equal(program.local_size[0], 16);
        assert_int_equal(program.push_size, 12);
        assert_null(program.set_layout);
        assert_null(program.set);
        struct turner_buffer buffer;
        assert_ok(turner_buffer_create(&buffer, &gpu, 100 * sizeof(float), 0, TURNER_MEMORY_DEVICE,
                                       "numbers"));
        float numbers[100];
        memset(numbers, 0, sizeof numbers);
        assert_ok(turner_buffer_upload(&gpu, &buffer, 0, numbers, sizeof numbers));
        struct push push = {.data = buffer.address, .count = 99};
        dispatch(&program, &push, 7);
        assert_ok(turner_buffer_download(&gpu, &buffer, 0, numbers, sizeof numbers));
        for (int i = 0; i < 99; i++) {
            float expected = (float)(i + (given >= 3 ? 10 : 1)) * (given >= 4 ? 0.5f : 1.0f) *
                             (given >= 5 ? -1.0f : 1.0f);
            assert_true(numbers[i] == expected);
        }
        assert_true(numbers[99] == 0);
        turner_buffer_destroy(&gpu, &buffer);
        turner_program_destroy(&gpu, &program);
    }
}

static void bindings(void **state)
{
    (void)state;
    static const char text[] = "#version 460\n"
                               "layout(local_size_x = 64) in;\n"
                               "layout(binding = 0) readonly buffer in_block { uint from[]; };\n"
                               "layout(binding = 4) buffer out_block { uint to[]; };\n"
                               "void main()\n{\n"
                               "    uint i = gl_GlobalInvocationID.x;\n"
                               "    to[i] = from[i] * from[i];\n"
                               "}\n";
    struct turner_program program;
    assert_ok(build(&program, text, NULL, 0));
    assert_int_equal(program.binding_count, 2);
    assert_int_equal(program.push_size, 0);
    struct turner_buffer from, to;
    assert_ok(turner_buffer_create(&from, &gpu, 256, 0, TURNER_MEMORY_DEVICE, "from"));
    assert_ok(turner_buffer_create(&to, &gpu, 256, 0, TURNER_MEMORY_HOST, "to"));
    uint32_t numbers[64];
    for (uint32_t i = 0; i < 64; i++)
        numbers[i] = i + 3;
    assert_ok(turner_buffer_upload(&gpu, &from, 0, numbers, sizeof numbers));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 0, &from));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 4, &to));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 5, &to)); /* not in the shader */
    assert_int_equal(turner_program_bind_acceleration(&program, &gpu, 4, VK_NULL_HANDLE),
                     TURNER_BAD_INPUT);
    assert_message_has("the shader's binding 4 must be an accelerationStructureEXT");
    dispatch(&program, NULL, 1);
    for (uint32_t i = 0; i < 64; i++)
        assert_int_equal(((uint32_t *)to.mapped)[i], (i + 3) * (i + 3));

    uint64_t range = gpu.info.max_storage_range;
    gpu.info.max_storage_range = 255;
    assert_int_equal(turner_program_bind_buffer(&program, &gpu, 4, &to), TURNER_DEVICE);
    assert_message_has("binding 4 has 256 bytes, a descriptor of ");
    gpu.info.max_storage_range = range;
    turner_buffer_destroy(&gpu, &from);
    turner_buffer_destroy(&gpu, &to);
    turner_program_destroy(&gpu, &program);
}

static void barriers_order_dispatches(void **state)
{
    (void)state;
    static const char text[] = "#version 460\n"
                               "layout(local_size_x = 64) in;\n"
                               "layout(binding = 0) buffer block { uint at[]; };\n"
                               "void main()\n{\n"
                               "    uint i = gl_GlobalInvocationID.x;\n"
                               "    at[(i + 1) % 64 + 64] = at[i] + 1;\n"
                               "    barrier();\n"
                               "    memoryBarrierBuffer();\n"
                               "    at[i] = at[i + 64];\n"
                               "}\n";
    struct turner_program program;
    struct turner_buffer buffer;
    assert_ok(build(&program, text, NULL, 0));
    assert_ok(turner_buffer_create(&buffer, &gpu, 512, 0, TURNER_MEMORY_DEVICE, "numbers"));
    uint32_t numbers[128] = {0};
    assert_ok(turner_buffer_upload(&gpu, &buffer, 0, numbers, sizeof numbers));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 0, &buffer));
    VkCommandBuffer commands;
    assert_ok(turner_gpu_begin(&gpu, &commands));
    for (int i = 0; i < 100; i++) {
        turner_program_dispatch(commands, &program, NULL, 1, 1, 1);
        turner_gpu_barrier(commands);
    }
    assert_ok(turner_gpu_submit_wait(&gpu, commands));
    assert_ok(turner_buffer_download(&gpu, &buffer, 0, numbers, sizeof numbers));
    for (int i = 0; i < 64; i++)
        assert_int_equal(numbers[i], 100);
    turner_buffer_destroy(&gpu, &buffer);
    turner_program_destroy(&gpu, &program);
}

static void too_much_is_refused(void **state)
{
    (void)state;
    struct turner_program program;
    const struct turner_constant wide = {7, 1u << 20};
    assert_int_equal(build(&program, add_by_address, &wide, 1), TURNER_DEVICE);
    assert_message_has("a workgroup of 1048576×1×1 does not fit");
    assert_false(turner_program_exists(&program));
    const struct turner_constant none = {7, 0};
    assert_int_equal(build(&program, add_by_address, &none, 1), TURNER_DEVICE);
    assert_message_has("a workgroup of 0×1×1 does not fit");
    assert_int_equal(build(&program,
                           "#version 460\n"
                           "layout(push_constant) uniform block { vec4 a[4096]; uint i; } push;\n"
                           "layout(binding = 0) buffer out_block { vec4 to; };\n"
                           "void main() { to = push.a[push.i]; }\n",
                           NULL, 0),
                     TURNER_DEVICE);
    assert_message_has("65540 bytes of push constants");
}

static size_t resident_kilobytes(void)
{
    FILE *file = fopen("/proc/self/statm", "r");
    size_t pages = 0, resident = 0;
    assert_non_null(file);
    assert_int_equal(fscanf(file, "%zu %zu", &pages, &resident), 2);
    fclose(file);
    return resident * (size_t)sysconf(_SC_PAGESIZE) / 1024;
}

/* A thousand dispatches, each in its own submission with upload and download, and a new pipeline
 * every hundred: memory must not grow once all is warm. */
static void soak(void **state)
{
    (void)state;
    struct turner_buffer buffer;
    assert_ok(turner_buffer_create(&buffer, &gpu, 4096, 0, TURNER_MEMORY_DEVICE, "numbers"));
    uint64_t used = gpu.memory_used;
    size_t warm = 0;
    float numbers[1024];
    for (int round = 0; round < 10; round++) {
        const struct turner_constant constants[] = {{7, 32}, {3, 10}};
        struct turner_program program;
        assert_ok(build(&program, add_by_address, constants, 2));
        for (int i = 0; i < 100; i++) {
            memset(numbers, 0, sizeof numbers);
            assert_ok(turner_buffer_upload(&gpu, &buffer, 0, numbers, sizeof numbers));
            struct push push = {.data = buffer.address, .count = (uint32_t)(1000 - i)};
            dispatch(&program, &push, 32);
            assert_ok(turner_buffer_download(&gpu, &buffer, 0, numbers, sizeof numbers));
            assert_true(numbers[999 - i] == (float)(1009 - i) && numbers[1000 - i] == 0);
        }
        turner_program_destroy(&gpu, &program);
        assert_int_equal(gpu.memory_used, used);
        if (round == 4)
            warm = resident_kilobytes();
    }
    size_t end = resident_kilobytes();
    print_message("resident after 500 dispatches %zu KiB, after 1000 %zu KiB\n", warm, end);
#ifndef __SANITIZE_ADDRESS__ /* it keeps what was freed for a while, and finds leaks itself */
    /* 500 dispatches at one leaked page each would be 2000 KiB */
    if (end > warm + 1024)
        fail_msg("memory grew from %zu to %zu KiB", warm, end);
#endif
    turner_buffer_destroy(&gpu, &buffer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constants_and_addresses),
        cmocka_unit_test(bindings),
        cmocka_unit_test(barriers_order_dispatches),
        cmocka_unit_test(too_much_is_refused),
        cmocka_unit_test(soak),
    };
    open_device(&gpu);
    return close_device(&gpu, cmocka_run_group_tests(tests, NULL, NULL));
}
