#define _GNU_SOURCE /* sched_getaffinity */
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "gpu/internal.h"

#define MOST_THREADS 32 /* llvmpipe has no more */

const char *const turner_ray_query_extensions[] = {
    VK_KHR_ACCELERATION_STRUCTURE_EXTENSION_NAME,
    VK_KHR_RAY_QUERY_EXTENSION_NAME,
    VK_KHR_DEFERRED_HOST_OPERATIONS_EXTENSION_NAME,
};
const uint32_t turner_ray_query_extension_count =
    sizeof turner_ray_query_extensions / sizeof *turner_ray_query_extensions;

uint32_t turner_gpu_cpu_threads(void)
{
    const char *wanted = getenv("LP_NUM_THREADS");
    cpu_set_t cores;
    int threads = wanted ? atoi(wanted) : 0;
    if (!wanted && sched_getaffinity(0, sizeof cores, &cores) == 0)
        threads = CPU_COUNT(&cores);
    return threads < 1 ? 1 : threads < MOST_THREADS ? (uint32_t)threads : MOST_THREADS;
}

bool turner_gpu_prefer_soon(void)
{
    return !getenv("GALLIVM_PERF") && setenv("GALLIVM_PERF", "nopt", 1) == 0;
}

void turner_gpu_leave_out_absent(void)
{
    if (access("/dev/dri", F_OK) != 0)
        setenv("VK_LOADER_DRIVERS_DISABLE", "*radeon*,*intel*,*nouveau*,*asahi*,*gfxstream*", 0);
}

/* Whether `name` is an item of a comma separated list. */
static bool listed(const char *list, const char *name)
{
    size_t length = strlen(name);
    while (list && *list) {
        list += strspn(list, ", ");
        size_t item = strcspn(list, ", ");
        if (item == length && strncmp(list, name, length) == 0)
            return true;
        list += item;
    }
    return false;
}

enum turner_result turner_extensions_create(struct turner_extensions *extensions,
                                            VkPhysicalDevice physical)
{
    *extensions = (struct turner_extensions){0};
    uint32_t count = 0;
    VK_TRY(vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL));
    extensions->items = turner_calloc(count, sizeof *extensions->items);
    VK_TRY(vkEnumerateDeviceExtensionProperties(physical, NULL, &count, extensions->items));
    const char *masked = getenv("TURNER_MASK_EXTENSIONS");
    for (uint32_t i = 0; i < count; i++) {
        if (!listed(masked, extensions->items[i].extensionName))
            extensions->items[extensions->count++] = extensions->items[i];
    }
    return TURNER_OK;
}

void turner_extensions_destroy(struct turner_extensions *extensions)
{
    free(extensions->items);
    *extensions = (struct turner_extensions){0};
}

bool turner_extensions_have(const struct turner_extensions *extensions, const char *name)
{
    for (uint32_t i = 0; i < extensions->count; i++) {
        if (strcmp(extensions->items[i].extensionName, name) == 0)
            return true;
    }
    return false;
}

uint32_t turner_queue_family(VkPhysicalDevice physical, uint32_t *timestamp_bits)
{
    uint32_t count = 0, found = UINT32_MAX;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, NULL);
    VkQueueFamilyProperties *families = turner_calloc(count, sizeof *families);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    *timestamp_bits = 0;
    for (uint32_t i = 0; i < count && found == UINT32_MAX; i++) {
        if (families[i].queueCount && (families[i].queueFlags & VK_QUEUE_COMPUTE_BIT)) {
            found = i;
            *timestamp_bits = families[i].timestampValidBits;
        }
    }
    free(families);
    return found;
}

/* Adds `what` to a comma separated list of 256 bytes when `absent`. */
static void note(char list[256], bool absent, const char *what)
{
    size_t used = strlen(list);
    if (absent)
        snprintf(list + used, 256 - used, "%s%s", used ? ", " : "", what);
}

static const char *type_name(VkPhysicalDeviceType type)
{
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
        return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return "CPU";
    default:
        return "other";
    }
}

/* Whether the device has what ray queries need, given that it is usable; else info->missing says
 * what not. */
static void describe_ray_query(struct turner_gpu_info *info, VkPhysicalDevice physical,
                               const struct turner_extensions *extensions, VkDriverId driver)
{
    for (uint32_t i = 0; i < turner_ray_query_extension_count; i++)
        note(info->missing, !turner_extensions_have(extensions, turner_ray_query_extensions[i]),
             turner_ray_query_extensions[i]);
    if (info->missing[0])
        return;

    VkPhysicalDeviceRayQueryFeaturesKHR query = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR};
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        .pNext = &query};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &acceleration};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    note(info->missing, !acceleration.accelerationStructure, "the feature accelerationStructure");
    note(info->missing, !query.rayQuery, "the feature rayQuery");

    VkPhysicalDeviceAccelerationStructurePropertiesKHR limits = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_PROPERTIES_KHR};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &limits};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    info->max_primitives = limits.maxPrimitiveCount;
    info->max_instances = limits.maxInstanceCount;
    info->scratch_alignment = limits.minAccelerationStructureScratchOffsetAlignment;

    /* With 128-bit vectors llvmpipe's own build of the structure never ends. */
    note(info->missing, driver == VK_DRIVER_ID_MESA_LLVMPIPE && info->subgroup_size != 8,
         "subgroups of 8 (llvmpipe with 256-bit vectors)");
}

static void describe_memory(struct turner_gpu_info *info, VkPhysicalDevice physical)
{
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t i = 0; i < memory.memoryHeapCount; i++) {
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) &&
            memory.memoryHeaps[i].size > info->device_memory)
            info->device_memory = memory.memoryHeaps[i].size;
    }
}

enum turner_result turner_gpu_describe(struct turner_gpu_info *info, VkPhysicalDevice physical)
{
    *info = (struct turner_gpu_info){0};
    VkPhysicalDeviceProperties basic;
    vkGetPhysicalDeviceProperties(physical, &basic);
    snprintf(info->name, sizeof info->name, "%s", basic.deviceName);
    info->type = type_name(basic.deviceType);
    info->software = basic.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    info->threads = info->software ? turner_gpu_cpu_threads() : 1;
    memcpy(info->max_workgroup_size, basic.limits.maxComputeWorkGroupSize,
           sizeof info->max_workgroup_size);
    memcpy(info->max_workgroup_count, basic.limits.maxComputeWorkGroupCount,
           sizeof info->max_workgroup_count);
    info->max_workgroup_invocations = basic.limits.maxComputeWorkGroupInvocations;
    info->max_push_constants = basic.limits.maxPushConstantsSize;
    info->max_storage_range = basic.limits.maxStorageBufferRange;
    describe_memory(info, physical);

    uint32_t timestamp_bits;
    note(info->lacking, turner_queue_family(physical, &timestamp_bits) == UINT32_MAX,
         "a queue that computes");
    info->timestamp_period = timestamp_bits ? (double)basic.limits.timestampPeriod : 0;
    if (basic.apiVersion < VK_API_VERSION_1_3) {
        /* The structures below are unknown to it. */
        snprintf(info->driver, sizeof info->driver, "Vulkan %u.%u",
                 VK_API_VERSION_MAJOR(basic.apiVersion), VK_API_VERSION_MINOR(basic.apiVersion));
        note(info->lacking, true, "Vulkan 1.3");
        note(info->missing, true, "Vulkan 1.3");
        return TURNER_OK;
    }

    VkPhysicalDeviceDriverProperties driver = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceSubgroupProperties subgroup = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES, .pNext = &driver};
    VkPhysicalDeviceSubgroupSizeControlProperties sizes = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_SIZE_CONTROL_PROPERTIES,
        .pNext = &subgroup};
    VkPhysicalDeviceMaintenance3Properties allocation = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES, .pNext = &sizes};
    VkPhysicalDeviceMaintenance4Properties buffer = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_4_PROPERTIES, .pNext = &allocation};
    VkPhysicalDeviceProperties2 properties = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &buffer};
    vkGetPhysicalDeviceProperties2(physical, &properties);
    snprintf(info->driver, sizeof info->driver, "%s %s", driver.driverName, driver.driverInfo);
    info->subgroup_size = subgroup.subgroupSize;
    info->max_allocation = allocation.maxMemoryAllocationSize;
    info->max_buffer = buffer.maxBufferSize;

    VkPhysicalDeviceVulkan13Features vulkan13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &vulkan13};
    VkPhysicalDeviceFeatures2 features = {.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
                                          .pNext = &vulkan12};
    vkGetPhysicalDeviceFeatures2(physical, &features);
    const VkSubgroupFeatureFlags handing = VK_SUBGROUP_FEATURE_BASIC_BIT |
                                           VK_SUBGROUP_FEATURE_BALLOT_BIT |
                                           VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
    info->packets = sizes.minSubgroupSize == 8 && sizes.maxSubgroupSize == 8 &&
                    vulkan13.computeFullSubgroups &&
                    (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) &&
                    (subgroup.supportedOperations & handing) == handing;
    info->float64 = features.features.shaderFloat64;
    info->int64 = features.features.shaderInt64;
    info->buffer_device_address = vulkan12.bufferDeviceAddress;
    info->scalar_block_layout = vulkan12.scalarBlockLayout;
    note(info->lacking, !info->int64, "the feature shaderInt64");
    note(info->lacking, !info->buffer_device_address, "the feature bufferDeviceAddress");
    note(info->lacking, !info->scalar_block_layout, "the feature scalarBlockLayout");
    info->usable = !info->lacking[0];

    struct turner_extensions extensions;
    enum turner_result result = turner_extensions_create(&extensions, physical);
    if (result == TURNER_OK)
        describe_ray_query(info, physical, &extensions, driver.driverID);
    turner_extensions_destroy(&extensions);
    info->ray_query = info->usable && !info->missing[0];
    return result;
}
