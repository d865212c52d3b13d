/* Finding devices. Some of it needs another environment, so the program starts itself again:
 * test_gpu_device list|open [NAME] prints what happened. */
#include "gpu_test.h"

#include <sys/wait.h>
#include <unistd.h>

static const char *program;

/* What the child does; its exit status is the result. */
static int child(int count, char **arguments)
{
    if (strcmp(arguments[1], "list") == 0) {
        struct turner_gpu_info *infos;
        size_t devices;
        enum turner_result result = turner_gpu_list(&infos, &devices);
        for (size_t i = 0; i < devices; i++)
            printf("%zu: %s, usable %d, lacking <%s>, ray_query %d, missing <%s>\n", i,
                   infos[i].name, infos[i].usable, infos[i].lacking, infos[i].ray_query,
                   infos[i].missing);
        if (result != TURNER_OK)
            printf("%s\n", turner_message());
        free(infos);
        return result;
    }
    struct turner_gpu gpu;
    enum turner_result result = turner_gpu_create(&gpu, count > 2 ? arguments[2] : NULL, false);
    if (result == TURNER_OK)
        printf("opened %s, ray_query %d, functions %d\n", gpu.info.name, gpu.info.ray_query,
               gpu.create_acceleration != NULL);
    else
        printf("%s\n", turner_message());
    turner_gpu_destroy(&gpu);
    return result;
}

/* Runs this program with an environment variable; its output in a static buffer. */
static const char *run(int *status, const char *variable, const char *value, const char *command,
                       const char *argument)
{
    static char output[4096];
    int ends[2];
    assert_int_equal(pipe(ends), 0);
    fflush(NULL);
    pid_t pid = fork(); /* no device is open in this process */
    assert_true(pid >= 0);
    if (pid == 0) {
        if (variable)
            setenv(variable, value, 1);
        dup2(ends[1], STDOUT_FILENO);
        close(ends[0]);
        close(ends[1]);
        execl(program, program, command, argument, (char *)NULL);
        _exit(127);
    }
    close(ends[1]);
    size_t length = 0;
    for (ssize_t got; (got = read(ends[0], output + length, sizeof output - 1 - length)) > 0;)
        length += (size_t)got;
    output[length] = 0;
    close(ends[0]);
    assert_int_equal(waitpid(pid, status, 0), pid);
    if (!WIFEXITED(*status))
        fail_msg("the child was killed by signal %d", WTERMSIG(*status));
    *status = WEXITSTATUS(*status);
    return output;
}

#define assert_output(output, part)                         \
    do {                                                    \
        if (!strstr(output, part))                          \
            fail_msg("\"%s\" is not in: %s", part, output); \
    } while (0)

static void no_driver(void **state)
{
    (void)state;
    int status;
    const char *const none[] = {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"};
    for (int i = 0; i < 2; i++) {
        const char *output = run(&status, none[i], "/nonexistent", "list", NULL);
        assert_int_equal(status, TURNER_DEVICE);
        assert_output(output, "no Vulkan driver found; install mesa-vulkan-drivers");
        output = run(&status, none[i], "/nonexistent", "open", NULL);
        assert_int_equal(status, TURNER_DEVICE);
        assert_output(output, "no Vulkan driver found; install mesa-vulkan-drivers");
    }
}

static void no_layer(void **state)
{
    (void)state;
    if (!have_device())
        skip();
    int status;
    setenv("TURNER_VALIDATION", "1", 1);
    const char *output = run(&status, "VK_LAYER_PATH", "/nonexistent", "open", NULL);
    unsetenv("TURNER_VALIDATION");
    assert_int_equal(status, TURNER_DEVICE);
    assert_output(output, "VK_LAYER_KHRONOS_validation; install vulkan-validationlayers");
}

static void lists_and_chooses(void **state)
{
    (void)state;
    if (!have_device())
        skip();
    struct turner_gpu_info *infos;
    size_t count;
    assert_ok(turner_gpu_list(&infos, &count));
    assert_true(count > 0);
    for (size_t i = 0; i < count; i++) {
        const struct turner_gpu_info *info = &infos[i];
        assert_true(info->name[0] && info->driver[0] && info->type);
        assert_true(info->usable == !info->lacking[0]);
        assert_true(info->ray_query == (info->usable && !info->missing[0]));
        if (!info->usable)
            continue;
        assert_true(info->int64 && info->buffer_device_address && info->scalar_block_layout);
        assert_true(info->subgroup_size > 0 && info->max_allocation > 0);
        assert_true(info->max_buffer > 0 && info->device_memory > 0);
        assert_true(info->max_workgroup_invocations >= 128 && info->max_push_constants >= 128);
        if (info->ray_query)
            assert_true(info->max_primitives > 0 && info->max_instances > 0 &&
                        info->scratch_alignment > 0);
        /* by index, and by a part of the name in capitals */
        char index[32], name[9] = "";
        int status;
        snprintf(index, sizeof index, "%zu", i);
        const char *output = run(&status, NULL, NULL, "open", index);
        assert_int_equal(status, TURNER_OK);
        assert_output(output, info->name);
        for (int c = 0; c < 8 && info->name[c]; c++)
            name[c] = info->name[c] >= 'a' && info->name[c] <= 'z' ? info->name[c] - 'a' + 'A'
                                                                   : info->name[c];
        run(&status, NULL, NULL, "open", name);
        assert_int_equal(status, TURNER_OK);
    }
    int status;
    const char *output = run(&status, NULL, NULL, "open", "no such device");
    assert_int_equal(status, TURNER_USAGE);
    assert_output(output, "no device \"no such device\"; those here are 0: ");
    assert_output(output, infos[0].name);
    output = run(&status, NULL, NULL, "open", "18446744073709551616");
    assert_int_equal(status, TURNER_USAGE);
    free(infos);
}

static void masked_extensions_are_missing(void **state)
{
    (void)state;
    if (!have_device())
        skip();
    struct turner_gpu_info *infos;
    size_t count;
    assert_ok(turner_gpu_list(&infos, &count));
    bool ray_query = infos[0].ray_query;
    free(infos);
    if (!ray_query)
        skip();
    int status;
    const char *output = run(&status, "TURNER_MASK_EXTENSIONS", "VK_KHR_ray_query", "list", NULL);
    assert_int_equal(status, TURNER_OK);
    assert_output(output, "ray_query 0, missing <VK_KHR_ray_query>");
    output = run(&status, "TURNER_MASK_EXTENSIONS", "VK_KHR_ray_query", "open", NULL);
    assert_int_equal(status, TURNER_OK);
    assert_output(output, "ray_query 0, functions 0");
    output = run(&status, "TURNER_MASK_EXTENSIONS",
                 "VK_KHR_acceleration_structure, VK_KHR_ray_query,VK_KHR_deferred_host_operations",
                 "list", NULL);
    assert_output(output, "missing <VK_KHR_acceleration_structure, VK_KHR_ray_query, "
                          "VK_KHR_deferred_host_operations>");
    output = run(&status, "TURNER_MASK_EXTENSIONS", "VK_KHR_ray", "open", NULL);
    assert_output(output, "ray_query 1, functions 1");
}

/* llvmpipe with vectors of four would hang in the first build. */
static void narrow_vectors_trace_without_ray_queries(void **state)
{
    (void)state;
    int status;
    const char *output = run(&status, "LP_NATIVE_VECTOR_WIDTH", "128", "list", NULL);
    if (!strstr(output, "llvmpipe"))
        skip();
    assert_int_equal(status, TURNER_OK);
    assert_output(output, "usable 1, lacking <>, ray_query 0, missing <subgroups of 8");
}

static void messages_are_counted(void **state)
{
    (void)state;
    if (!have_device())
        skip();
    struct turner_gpu gpu;
    assert_ok(turner_gpu_create(&gpu, NULL, true));
    assert_int_equal(turner_gpu_validation_count(), 0);
    VkBufferCreateInfo wrong = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT};
    VkBuffer buffer; /* size 0 is not allowed */
    if (vkCreateBuffer(gpu.device, &wrong, NULL, &buffer) == VK_SUCCESS)
        vkDestroyBuffer(gpu.device, buffer, NULL);
    assert_true(turner_gpu_validation_count() > 0);
    turner_gpu_destroy(&gpu);
    assert_null(gpu.instance);
    turner_gpu_destroy(&gpu); /* a zeroed one */
}

static enum turner_result failing_call(VkResult result)
{
    VK_TRY(result);
    return TURNER_OK;
}

static enum turner_result failing_call_done(VkResult result_of_call, bool *cleaned)
{
    enum turner_result result = TURNER_OK;
    VK_TRY_DONE(result_of_call);
done:
    *cleaned = true;
    return result;
}

static void results_have_names(void **state)
{
    (void)state;
    assert_string_equal(turner_vk_result_name(VK_ERROR_DEVICE_LOST), "VK_ERROR_DEVICE_LOST");
    assert_string_equal(turner_vk_result_name((VkResult)-123456), "an unknown VkResult");
    assert_int_equal(failing_call(VK_SUCCESS), TURNER_OK);
    assert_int_equal(failing_call(VK_ERROR_OUT_OF_DEVICE_MEMORY), TURNER_DEVICE);
    assert_message_has("result: VK_ERROR_OUT_OF_DEVICE_MEMORY (test_gpu_device.c:");
    bool cleaned = false;
    assert_int_equal(failing_call_done(VK_ERROR_DEVICE_LOST, &cleaned), TURNER_DEVICE);
    assert_true(cleaned);
    assert_message_has("VK_ERROR_DEVICE_LOST (test_gpu_device.c:");
    assert_message_has("the device is lost: try again");
}

int main(int count, char **arguments)
{
    program = arguments[0];
    if (count > 1)
        return child(count, arguments);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(results_have_names),
        cmocka_unit_test(no_driver),
        cmocka_unit_test(no_layer),
        cmocka_unit_test(lists_and_chooses),
        cmocka_unit_test(masked_extensions_are_missing),
        cmocka_unit_test(narrow_vectors_trace_without_ray_queries),
        cmocka_unit_test(messages_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
