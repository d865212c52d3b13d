/* The Vulkan instance, device and queue; what a device can do; one-time commands.
 *
 * A turner_gpu is used from one thread, but for programs, which any may make. Needs Vulkan 1.3 with
 * bufferDeviceAddress, shaderInt64 and scalarBlockLayout; ray queries are used where present. */
#ifndef TURNER_GPU_DEVICE_H
#define TURNER_GPU_DEVICE_H

#include "base/result.h"
#include "gpu/vulkan.h"

struct turner_gpu_info {
    char name[256];
    char driver[512];  /* driver's name and version, as the driver words it */
    const char *type;  /* "discrete GPU", "integrated GPU", "virtual GPU", "CPU", "other" */
    bool software;     /* a CPU pretending */
    uint32_t threads;  /* of software; 1 of others */
    bool usable;       /* has everything turner requires */
    char lacking[256]; /* what it lacks of that, comma separated; "" when usable */
    bool ray_query;    /* can trace with VK_KHR_ray_query */
    char missing[256]; /* what it lacks for that, comma separated; "" when ray_query */
    bool float64, int64, buffer_device_address, scalar_block_layout;
    uint32_t subgroup_size;
    bool packets; /* subgroups of 8 lanes, never other, that a program may insist on being full, and
                     whose lanes can hand each other numbers */
    enum turner_traversal fastest; /* as measured (gpu/fastest.h), or AUTO */
    uint32_t max_workgroup_size[3], max_workgroup_invocations, max_workgroup_count[3];
    uint32_t max_push_constants; /* bytes */
    uint64_t max_storage_range;  /* bytes one descriptor reaches; addresses have no such limit */
    uint64_t max_allocation;     /* bytes of one allocation */
    uint64_t max_buffer;         /* bytes of one buffer */
    uint64_t device_memory;      /* bytes of the largest device-local heap */
    double timestamp_period;     /* nanoseconds per tick; 0 when the queue has no timestamps */
    uint64_t max_primitives;     /* of one bottom-level acceleration structure; 0 without */
    uint64_t max_instances;      /* of a top-level one */
    uint32_t scratch_alignment;  /* bytes */
};

struct turner_gpu {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t queue_family;
    VkCommandPool pool;
    VkFence fence; /* of turner_gpu_submit_wait */
    struct turner_gpu_info info;
    VkPhysicalDeviceMemoryProperties memory;
    bool memory_budget; /* VK_EXT_memory_budget is on */
    bool hung;          /* a submission never ended: nothing of the device can be destroyed */
    uint64_t memory_used, memory_peak; /* bytes of turner_buffers */
    /* NULL unless info.ray_query */
    PFN_vkCreateAccelerationStructureKHR create_acceleration;
    PFN_vkDestroyAccelerationStructureKHR destroy_acceleration;
    PFN_vkGetAccelerationStructureBuildSizesKHR get_acceleration_sizes;
    PFN_vkGetAccelerationStructureDeviceAddressKHR get_acceleration_address;
    PFN_vkCmdBuildAccelerationStructuresKHR cmd_build_accelerations;
    /* NULL where pipelines are used */
    PFN_vkCreateShadersEXT create_shaders;
    PFN_vkDestroyShaderEXT destroy_shader;
    PFN_vkGetShaderBinaryDataEXT get_shader_binary;
    PFN_vkCmdBindShadersEXT cmd_bind_shaders;
};

/* Opens a device. `wanted` NULL takes the best usable one (discrete, integrated, virtual, CPU, in
 * the driver's order among equals); digits are an index into turner_gpu_list; anything else is a
 * part of the name, upper or lower case.
 * Environment: TURNER_VALIDATION=1 is the same as `validation`; TURNER_MASK_EXTENSIONS, a comma
 * separated list of device extensions, pretends the device has none of them (for tests).
 * With validation each warning or error of VK_LAYER_KHRONOS_validation goes to stderr as
 * "turner: validation: …" and is counted.
 * TURNER_DEVICE without a driver, a fitting device or the layer; TURNER_USAGE for an index or name
 * that no device has. */
enum turner_result turner_gpu_create(struct turner_gpu *gpu, const char *wanted, bool validation);
void turner_gpu_destroy(struct turner_gpu *gpu);

/* Has Mesa's CPU device not optimise what it makes of shaders, which takes less than half of the time
 * to make and thrice to run; others take no notice. Before the process opens a device or begins a
 * thread. False, and nothing done, where GALLIVM_PERF is set. */
bool turner_gpu_prefer_soon(void);

/* Has the Vulkan loader leave out Mesa's drivers of hardware that they find in /dev/dri where there is
 * no such folder: to open them for nothing takes a tenth of a short run. Before the process begins a
 * thread. Does nothing where VK_LOADER_DRIVERS_DISABLE is set. */
void turner_gpu_leave_out_absent(void);

/* Threads that Mesa's CPU device has: one per core this process may use, or LP_NUM_THREADS. */
uint32_t turner_gpu_cpu_threads(void);

/* Every device with a Vulkan driver, usable or not, in the order of its index. The caller frees
 * *infos. Not while a turner_gpu exists. TURNER_DEVICE without a driver or a device. */
enum turner_result turner_gpu_list(struct turner_gpu_info **infos, size_t *count);

/* Validation messages so far in this process. Thread-safe. */
unsigned turner_gpu_validation_count(void);

/* A command buffer that records one submission. */
enum turner_result turner_gpu_begin(struct turner_gpu *gpu, VkCommandBuffer *commands);

/* Ends, submits and frees `commands` (also on failure) and waits until the device is done; what
 * shaders wrote to mapped memory can then be read. TURNER_DEVICE when the device is lost or does
 * not answer for ten minutes. */
enum turner_result turner_gpu_submit_wait(struct turner_gpu *gpu, VkCommandBuffer commands);

/* Makes everything that shaders and copies of this command buffer wrote so far visible to shaders,
 * acceleration structure builds and copies recorded after it. */
void turner_gpu_barrier(VkCommandBuffer commands);

/* "VK_ERROR_DEVICE_LOST" and so on; "an unknown VkResult" for others. Never NULL. */
const char *turner_vk_result_name(VkResult result);

/* turner_fail for a Vulkan call that failed: "vkCreateX: VK_ERROR_… (file.c:12)", what to do. */
enum turner_result turner_vk_fail(VkResult result, const char *call, const char *file, int line);

#define VK_TRY(call)                                                         \
    do {                                                                     \
        VkResult vk_try_result = (call);                                     \
        if (vk_try_result != VK_SUCCESS)                                     \
            return turner_vk_fail(vk_try_result, #call, __FILE__, __LINE__); \
    } while (0)

/* The same for functions with one cleanup tail: sets `result` and goes to `done`. */
#define VK_TRY_DONE(call)                                                      \
    do {                                                                       \
        VkResult vk_try_result = (call);                                       \
        if (vk_try_result != VK_SUCCESS) {                                     \
            result = turner_vk_fail(vk_try_result, #call, __FILE__, __LINE__); \
            goto done;                                                         \
        }                                                                      \
    } while (0)

#endif
