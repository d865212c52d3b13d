#include "gpu_test.h"

#include "gpu/memory.h"

static struct turner_gpu gpu;

static void there_and_back(enum turner_memory memory, size_t size, bool unmapped)
{
    struct turner_buffer buffer;
    assert_ok(turner_buffer_create(&buffer, &gpu, size, 0, memory, "test"));
    assert_true(buffer.size >= 16 && buffer.address != 0 && buffer.address % 16 == 0);
    assert_true(gpu.memory_used >= size);
    if (memory == TURNER_MEMORY_HOST)
        assert_non_null(buffer.mapped);
    struct turner_buffer view = buffer;
    if (unmapped)
        view.mapped = NULL; /* takes the way of a device with memory of its own */
    uint32_t *data = malloc(size + 4), *back = calloc(1, size + 4);
    for (size_t i = 0; i < size / 4; i++)
        data[i] = (uint32_t)(i * 2654435761u);
    back[size / 4] = 1234;
    assert_ok(turner_buffer_upload(&gpu, &view, 0, data, size));
    assert_ok(turner_buffer_download(&gpu, &view, 0, back, size));
    assert_memory_equal(data, back, size);
    assert_int_equal(back[size / 4], 1234);
    if (size >= 64) { /* in the middle */
        assert_ok(turner_buffer_upload(&gpu, &view, 32, data, 16));
        assert_ok(turner_buffer_download(&gpu, &view, 16, back, 32));
        assert_memory_equal(back, data + 4, 16);
        assert_memory_equal(back + 4, data, 16);
    }
    free(data);
    free(back);
    turner_buffer_destroy(&gpu, &buffer);
    assert_null(buffer.buffer);
}

static void uploads_and_downloads(void **state)
{
    (void)state;
    for (int unmapped = 0; unmapped < 2; unmapped++) {
        there_and_back(TURNER_MEMORY_DEVICE, 0, unmapped);
        there_and_back(TURNER_MEMORY_DEVICE, 4, unmapped);
        there_and_back(TURNER_MEMORY_DEVICE, 4096, unmapped);
        there_and_back(TURNER_MEMORY_HOST, 4096, unmapped);
        there_and_back(TURNER_MEMORY_DEVICE, ((size_t)130 << 20) + 12, unmapped); /* three pieces */
    }
    assert_int_equal(gpu.memory_used, 0);
    assert_true(gpu.memory_peak >= (uint64_t)130 << 20);
}

static void too_large_is_refused(void **state)
{
    (void)state;
    struct turner_buffer buffer;
    uint64_t peak = gpu.memory_peak;
    assert_int_equal(turner_buffer_create(&buffer, &gpu, gpu.info.max_buffer + 1, 0,
                                          TURNER_MEMORY_DEVICE, "the picture"),
                     TURNER_DEVICE);
    assert_message_has("the picture: ");
    assert_message_has("one buffer may have");
    assert_null(buffer.buffer);

    /* allocations one by one until no memory is left would thrash: pretend there is less */
    VkDeviceSize heap = gpu.memory.memoryHeaps[0].size;
    bool budget = gpu.memory_budget;
    gpu.memory_budget = false;
    for (uint32_t i = 0; i < gpu.memory.memoryHeapCount; i++)
        gpu.memory.memoryHeaps[i].size = 1000;
    assert_int_equal(turner_gpu_memory_available(&gpu, TURNER_MEMORY_DEVICE), 1000);
    assert_int_equal(
        turner_buffer_create(&buffer, &gpu, 1 << 20, 0, TURNER_MEMORY_DEVICE, "triangles"),
        TURNER_DEVICE);
    assert_message_has("triangles: 1048576 bytes");
    assert_message_has("there are 1000 bytes");
    gpu.memory_budget = budget;
    for (uint32_t i = 0; i < gpu.memory.memoryHeapCount; i++)
        gpu.memory.memoryHeaps[i].size = heap;

    uint64_t most = gpu.info.max_allocation;
    gpu.info.max_allocation = 1 << 16;
    assert_int_equal(
        turner_buffer_create(&buffer, &gpu, 1 << 20, 0, TURNER_MEMORY_DEVICE, "triangles"),
        TURNER_DEVICE);
    assert_message_has("one allocation may have 65536 bytes");
    gpu.info.max_allocation = most;
    assert_int_equal(gpu.memory_used, 0);
    assert_int_equal(gpu.memory_peak, peak);
}

static void many_buffers(void **state)
{
    (void)state;
    struct turner_buffer buffers[300];
    for (int i = 0; i < 300; i++)
        assert_ok(turner_buffer_create(&buffers[i], &gpu, 1000, 0, i % 2, "many"));
    for (int i = 0; i < 300; i++)
        turner_buffer_destroy(&gpu, &buffers[i]);
    assert_int_equal(gpu.memory_used, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uploads_and_downloads),
        cmocka_unit_test(too_large_is_refused),
        cmocka_unit_test(many_buffers),
    };
    open_device(&gpu);
    return close_device(&gpu, cmocka_run_group_tests(tests, NULL, NULL));
}
