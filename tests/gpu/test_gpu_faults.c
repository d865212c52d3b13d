/* Drivers that fail: calls are intercepted (the linker's --wrap) and answer with an error. */
#include "gpu_test.h"

#include "gpu/accel.h"
#include "gpu/program.h"

static struct turner_gpu gpu;
static VkResult wait_answer, allocate_answer, submit_answer, pipeline_answer; /* 0: the driver's */
static int waits;

VkResult __real_vkWaitForFences(VkDevice device, uint32_t count, const VkFence *fences,
                                VkBool32 all, uint64_t timeout);
VkResult __wrap_vkWaitForFences(VkDevice device, uint32_t count, const VkFence *fences,
                                VkBool32 all, uint64_t timeout);
VkResult __wrap_vkWaitForFences(VkDevice device, uint32_t count, const VkFence *fences,
                                VkBool32 all, uint64_t timeout)
{
    waits++;
    VkResult result = __real_vkWaitForFences(device, count, fences, all, timeout);
    return wait_answer ? wait_answer : result;
}

VkResult __real_vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                 const VkAllocationCallbacks *callbacks, VkDeviceMemory *memory);
VkResult __wrap_vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                 const VkAllocationCallbacks *callbacks, VkDeviceMemory *memory);
VkResult __wrap_vkAllocateMemory(VkDevice device, const VkMemoryAllocateInfo *info,
                                 const VkAllocationCallbacks *callbacks, VkDeviceMemory *memory)
{
    return allocate_answer ? allocate_answer
                           : __real_vkAllocateMemory(device, info, callbacks, memory);
}

VkResult __real_vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *submits,
                              VkFence fence);
VkResult __wrap_vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *submits,
                              VkFence fence);
VkResult __wrap_vkQueueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo *submits,
                              VkFence fence)
{
    return submit_answer ? submit_answer : __real_vkQueueSubmit(queue, count, submits, fence);
}

VkResult __real_vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                         const VkComputePipelineCreateInfo *infos,
                                         const VkAllocationCallbacks *callbacks,
                                         VkPipeline *pipelines);
VkResult __wrap_vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                         const VkComputePipelineCreateInfo *infos,
                                         const VkAllocationCallbacks *callbacks,
                                         VkPipeline *pipelines);
VkResult __wrap_vkCreateComputePipelines(VkDevice device, VkPipelineCache cache, uint32_t count,
                                         const VkComputePipelineCreateInfo *infos,
                                         const VkAllocationCallbacks *callbacks,
                                         VkPipeline *pipelines)
{
    return pipeline_answer
               ? pipeline_answer
               : __real_vkCreateComputePipelines(device, cache, count, infos, callbacks, pipelines);
}

/* One copy through a staging buffer: allocation, submission and wait. */
static enum turner_result staged_upload(uint32_t value)
{
    struct turner_buffer buffer;
    TURNER_TRY(turner_buffer_create(&buffer, &gpu, 64, 0, TURNER_MEMORY_DEVICE, "numbers"));
    struct turner_buffer view = buffer;
    view.mapped = NULL;
    uint32_t back = 0;
    enum turner_result result = turner_buffer_upload(&gpu, &view, 4, &value, sizeof value);
    if (result == TURNER_OK)
        result = turner_buffer_download(&gpu, &view, 4, &back, sizeof back);
    turner_buffer_destroy(&gpu, &buffer);
    if (result == TURNER_OK)
        assert_int_equal(back, value);
    return result;
}

static void lost_device(void **state)
{
    (void)state;
    wait_answer = VK_ERROR_DEVICE_LOST;
    assert_int_equal(staged_upload(1), TURNER_DEVICE);
    wait_answer = VK_SUCCESS;
    assert_message_has("vkWaitForFences: VK_ERROR_DEVICE_LOST (commands.c:");
    assert_message_has("try again, with smaller tiles");
    submit_answer = VK_ERROR_DEVICE_LOST;
    assert_int_equal(staged_upload(2), TURNER_DEVICE);
    submit_answer = VK_SUCCESS;
    assert_message_has("vkQueueSubmit: VK_ERROR_DEVICE_LOST (commands.c:");
    assert_int_equal(gpu.memory_used, 0);
    assert_ok(staged_upload(3));
}

static void no_memory(void **state)
{
    (void)state;
    const VkResult answers[] = {VK_ERROR_OUT_OF_DEVICE_MEMORY, VK_ERROR_OUT_OF_HOST_MEMORY};
    for (int i = 0; i < 2; i++) {
        allocate_answer = answers[i];
        assert_int_equal(staged_upload(1), TURNER_DEVICE);
        assert_message_has("numbers: 64 bytes (0.00 GiB) wanted, but the driver gave none of its");
    }
    allocate_answer = VK_ERROR_TOO_MANY_OBJECTS;
    assert_int_equal(staged_upload(1), TURNER_DEVICE);
    assert_message_has("VK_ERROR_TOO_MANY_OBJECTS (memory.c:");
    if (gpu.info.ray_query) {
        struct turner_accel accel;
        allocate_answer = VK_ERROR_OUT_OF_DEVICE_MEMORY;
        assert_int_equal(turner_accel_build_boxes(&accel, &gpu, 0, 10, 0), TURNER_DEVICE);
        assert_message_has("acceleration structure: ");
        assert_null(accel.handle);
    }
    allocate_answer = VK_SUCCESS;
    assert_int_equal(gpu.memory_used, 0);
    assert_ok(staged_upload(4));
}

static void no_pipeline(void **state)
{
    (void)state;
    struct turner_shader_source source;
    struct turner_spirv spirv;
    struct turner_program program;
    assert_ok(turner_shader_source_from_text(
        &source, "test.comp",
        "#version 460\nlayout(binding = 0) buffer b { int a; };\nvoid main() { a = 1; }\n", NULL,
        0));
    assert_ok(turner_compile(&spirv, &source, NULL, 0));
    pipeline_answer = VK_ERROR_OUT_OF_HOST_MEMORY;
    assert_int_equal(turner_program_create(&program, &gpu, &spirv, NULL, 0, false),
                     TURNER_DEVICE);
    pipeline_answer = VK_SUCCESS;
    assert_message_has("vkCreateComputePipelines: VK_ERROR_OUT_OF_HOST_MEMORY (program.c:");
    assert_null(program.module);
    assert_null(program.set_layout);
    assert_ok(turner_program_create(&program, &gpu, &spirv, NULL, 0, false));
    turner_program_destroy(&gpu, &program);
    turner_spirv_destroy(&spirv);
    turner_shader_source_destroy(&source);
}

/* Ten minutes of waiting, in no time. Last, because the device cannot be used after it. */
static void hung_device(void **state)
{
    (void)state;
    wait_answer = VK_TIMEOUT;
    waits = 0;
    VkCommandBuffer commands;
    assert_ok(turner_gpu_begin(&gpu, &commands));
    assert_int_equal(turner_gpu_submit_wait(&gpu, commands), TURNER_DEVICE);
    assert_message_has("has not finished in 600 seconds");
    assert_int_equal(waits, 600);
    assert_true(gpu.hung);
    struct turner_gpu copy = gpu;
    turner_gpu_destroy(&copy); /* must not touch what a driver may still use, nor wait */
    assert_non_null(copy.device);
    gpu.hung = false; /* it was not, so that the rest can be destroyed */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lost_device),
        cmocka_unit_test(no_memory),
        cmocka_unit_test(no_pipeline),
        cmocka_unit_test(hung_device),
    };
    open_device(&gpu);
    return close_device(&gpu, cmocka_run_group_tests(tests, NULL, NULL));
}
