/* Shader objects in the place of pipelines: what the driver made of a shader comes from the cache,
 * and computes the same; what the driver does not take is made again. Without validation, as layers
 * before 1.3.246 do not know them. */
#include "gpu_test.h"

#include <dirent.h>
#include <unistd.h>

#include "gpu/program.h"

static struct turner_gpu gpu;
static char folder[64], entries[128];
static PFN_vkCreateShadersEXT driver_create;
static int from_spirv, from_binary;
static VkResult binary_answer, spirv_answer; /* 0: the driver's */

static VKAPI_ATTR VkResult VKAPI_CALL count_creations(VkDevice device, uint32_t count,
                                                      const VkShaderCreateInfoEXT *infos,
                                                      const VkAllocationCallbacks *callbacks,
                                                      VkShaderEXT *shaders)
{
    bool binary = infos->codeType == VK_SHADER_CODE_TYPE_BINARY_EXT;
    VkResult answer = binary ? binary_answer : spirv_answer;
    assert_int_equal(count, 1);
    *(binary ? &from_binary : &from_spirv) += 1;
    if (answer)
        *shaders = VK_NULL_HANDLE;
    return answer ? answer : driver_create(device, count, infos, callbacks, shaders);
}

static int entry_count(void)
{
    int count = 0;
    DIR *directory = opendir(entries);
    for (struct dirent *entry; directory && (entry = readdir(directory));)
        count += strncmp(entry->d_name, "driver-", 7) == 0;
    if (directory)
        closedir(directory);
    return count;
}

static void empty_cache(void)
{
    DIR *directory = opendir(entries);
    for (struct dirent *entry; directory && (entry = readdir(directory));)
        if (entry->d_name[0] != '.')
            assert_int_equal(unlinkat(dirfd(directory), entry->d_name, 0), 0);
    if (directory)
        closedir(directory);
    from_spirv = from_binary = 0;
}

/* 64 numbers: those of a shader that adds a constant, by pushing and by a descriptor. */
static enum turner_result add(uint32_t numbers[64], uint32_t added, bool no_cache)
{
    static const char text[] = "#version 460\n"
                               "layout(local_size_x = 64) in;\n"
                               "layout(constant_id = 3) const uint added = 1;\n"
                               "layout(push_constant) uniform block { uint factor; } push;\n"
                               "layout(binding = 2) buffer numbers { uint at[]; };\n"
                               "void main()\n{\n"
                               "    uint i = gl_LocalInvocationIndex;\n"
                               "    at[i] = i * push.factor + added;\n"
                               "}\n";
    const struct turner_constant constant = {3, added};
    struct turner_shader_source source;
    struct turner_spirv spirv;
    struct turner_program program;
    assert_ok(turner_shader_source_from_text(&source, "test.comp", text, NULL, 0));
    assert_ok(turner_compile(&spirv, &source, NULL, 0));
    enum turner_result result = turner_program_create(&program, &gpu, &spirv, &constant, 1,
                                                      no_cache);
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
    if (result != TURNER_OK)
        return result;
    struct turner_buffer buffer;
    VkCommandBuffer commands;
    const uint32_t factor = 7;
    assert_ok(turner_buffer_create(&buffer, &gpu, 256, 0, TURNER_MEMORY_HOST, "numbers"));
    assert_ok(turner_program_bind_buffer(&program, &gpu, 2, &buffer));
    assert_ok(turner_gpu_begin(&gpu, &commands));
    turner_program_dispatch(commands, &program, &factor, 1, 1, 1);
    assert_ok(turner_gpu_submit_wait(&gpu, commands));
    assert_ok(turner_buffer_download(&gpu, &buffer, 0, numbers, 256));
    turner_buffer_destroy(&gpu, &buffer);
    turner_program_destroy(&gpu, &program);
    return TURNER_OK;
}

static void assert_adds(uint32_t added, bool no_cache)
{
    uint32_t numbers[64];
    assert_ok(add(numbers, added, no_cache));
    for (uint32_t i = 0; i < 64; i++)
        assert_int_equal(numbers[i], 7 * i + added);
}

static void comes_from_the_cache(void **state)
{
    (void)state;
    empty_cache();
    assert_adds(10, false);
    assert_int_equal(from_spirv, 1);
    assert_int_equal(from_binary, 0);
    assert_int_equal(entry_count(), 1);
    assert_adds(10, false);
    assert_int_equal(from_spirv, 1);
    assert_int_equal(from_binary, 1);
    assert_adds(11, false); /* another constant is another shader */
    assert_int_equal(from_spirv, 2);
    assert_int_equal(entry_count(), 2);
}

/* As most kernels are, once their constants are folded in. */
static void without_constants(void **state)
{
    (void)state;
    struct turner_shader_source source;
    struct turner_spirv spirv;
    empty_cache();
    assert_ok(turner_shader_source_from_text(&source, "test.comp",
                                             "#version 460\n"
                                             "layout(local_size_x = 8) in;\n"
                                             "void main() {}\n", NULL, 0));
    assert_ok(turner_compile(&spirv, &source, NULL, 0));
    for (int made = 0; made < 2; made++) {
        struct turner_program program;
        assert_ok(turner_program_create(&program, &gpu, &spirv, NULL, 0, false));
        assert_int_equal(program.cached, made);
        turner_program_destroy(&gpu, &program);
    }
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
}

static void without_a_cache(void **state)
{
    (void)state;
    empty_cache();
    assert_adds(10, true);
    assert_adds(10, true);
    assert_int_equal(from_spirv, 2);
    assert_int_equal(from_binary, 0);
    assert_int_equal(entry_count(), 0);
}

static void refused_by_the_driver(void **state)
{
    (void)state;
    empty_cache();
    assert_adds(10, false);
    binary_answer = VK_ERROR_INITIALIZATION_FAILED; /* or VK_INCOMPATIBLE_SHADER_BINARY_EXT */
    assert_adds(10, false);
    assert_int_equal(from_spirv, 2);
    assert_int_equal(from_binary, 1);
    binary_answer = VK_SUCCESS;
    assert_adds(10, false);
    assert_int_equal(from_spirv, 2);
    assert_int_equal(from_binary, 2);
}

/* The version may be the same, and all else. Here it is this program in the driver's place. */
static void another_build_of_the_driver(void **state)
{
    (void)state;
    empty_cache();
    assert_adds(10, false);
    assert_int_equal(entry_count(), 1);
    gpu.create_shaders = driver_create;
    assert_adds(10, false);
    gpu.create_shaders = count_creations;
    assert_int_equal(entry_count(), 2);
    assert_int_equal(from_binary, 0);
}

static void the_driver_fails(void **state)
{
    (void)state;
    uint32_t numbers[64];
    empty_cache();
    spirv_answer = VK_ERROR_OUT_OF_HOST_MEMORY;
    assert_int_equal(add(numbers, 10, false), TURNER_DEVICE);
    assert_message_has("VK_ERROR_OUT_OF_HOST_MEMORY (shader_object.c:");
    spirv_answer = VK_SUCCESS;
    assert_int_equal(entry_count(), 0);
}

static void not_where_it_is_missing(void **state)
{
    (void)state;
    struct turner_gpu with = gpu;
    setenv("TURNER_MASK_EXTENSIONS", VK_EXT_SHADER_OBJECT_EXTENSION_NAME, 1);
    assert_ok(turner_gpu_create(&gpu, NULL, false));
    unsetenv("TURNER_MASK_EXTENSIONS");
    assert_null(gpu.create_shaders);
    empty_cache();
    assert_adds(10, false);
    assert_int_equal(from_spirv + from_binary + entry_count(), 0);
    turner_gpu_destroy(&gpu);
    gpu = with;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(comes_from_the_cache),
        cmocka_unit_test(without_constants),
        cmocka_unit_test(without_a_cache),
        cmocka_unit_test(refused_by_the_driver),
        cmocka_unit_test(another_build_of_the_driver),
        cmocka_unit_test(the_driver_fails),
        cmocka_unit_test(not_where_it_is_missing),
    };
    strcpy(folder, "/tmp/turner-objects-XXXXXX");
    if (!have_device())
        return SKIPPED;
    if (!mkdtemp(folder) || setenv("TURNER_CACHE_DIR", folder, 1) != 0)
        return 1;
    snprintf(entries, sizeof entries, "%s/shaders", folder);
    if (turner_gpu_create(&gpu, NULL, false) != TURNER_OK) {
        fprintf(stderr, "%s\n", turner_message());
        return 1;
    }
    int failures = SKIPPED;
    if (gpu.create_shaders) {
        driver_create = gpu.create_shaders;
        gpu.create_shaders = count_creations;
        failures = cmocka_run_group_tests(tests, NULL, NULL);
    } else {
        fprintf(stderr, "skipped: %s has pipelines only\n", gpu.info.name);
    }
    turner_gpu_destroy(&gpu);
    empty_cache();
    rmdir(entries);
    rmdir(folder);
    return failures;
}
