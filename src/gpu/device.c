#include "gpu/device.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "gpu/fastest.h"
#include "gpu/internal.h"

#define MOST_DEVICES 64

static enum turner_result fail_no_driver(void)
{
    return turner_fail(TURNER_DEVICE,
                       "no Vulkan driver found; install mesa-vulkan-drivers (it brings a device in "
                       "software) or your graphics card's driver, or use --device reference");
}

static enum turner_result create_instance(VkInstance *instance, bool validation)
{
    *instance = VK_NULL_HANDLE;
    if (validation && !turner_validation_available())
        return turner_fail(TURNER_DEVICE,
                           "validation was asked for, but there is no " TURNER_VALIDATION_LAYER
                           "; install vulkan-validationlayers or unset "
                           "TURNER_VALIDATION");
    static const char *const layers[] = {TURNER_VALIDATION_LAYER};
    static const char *const extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
    VkDebugUtilsMessengerCreateInfoEXT messenger = turner_validation_messenger();
    VkApplicationInfo application = {
        .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
        .pApplicationName = "turner",
        .apiVersion = VK_API_VERSION_1_3,
    };
    VkInstanceCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validation ? &messenger : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validation,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = validation,
        .ppEnabledExtensionNames = extensions,
    };
    VkResult result = vkCreateInstance(&create, NULL, instance);
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return fail_no_driver();
    VK_TRY(result);
    return TURNER_OK;
}

/* All devices and what they can do; both arrays are the caller's to free, also after a failure. */
static enum turner_result list_devices(VkInstance instance, VkPhysicalDevice **devices,
                                       struct turner_gpu_info **infos, uint32_t *count)
{
    *count = MOST_DEVICES; /* more are not looked at; to ask how many there are takes as long again */
    *devices = turner_calloc(*count, sizeof **devices);
    VkResult listed = vkEnumeratePhysicalDevices(instance, count, *devices);
    /* what the loader says when every driver failed to start */
    if (listed == VK_ERROR_INITIALIZATION_FAILED || (listed == VK_SUCCESS && *count == 0))
        return fail_no_driver();
    if (listed != VK_INCOMPLETE)
        VK_TRY(listed);
    *infos = turner_calloc(*count, sizeof **infos);
    for (uint32_t i = 0; i < *count; i++) {
        TURNER_TRY(turner_gpu_describe(&(*infos)[i], (*devices)[i]));
        (*infos)[i].fastest = turner_fastest_load(&(*infos)[i]);
    }
    return TURNER_OK;
}

enum turner_result turner_gpu_list(struct turner_gpu_info **infos, size_t *count)
{
    *infos = NULL;
    *count = 0;
    VkInstance instance;
    VkPhysicalDevice *devices = NULL;
    uint32_t found = 0;
    enum turner_result result = create_instance(&instance, false);
    if (result == TURNER_OK)
        result = list_devices(instance, &devices, infos, &found);
    if (result == TURNER_OK) {
        *count = found;
    } else {
        free(*infos);
        *infos = NULL;
    }
    free(devices);
    vkDestroyInstance(instance, NULL);
    return result;
}

static int rank(const struct turner_gpu_info *info)
{
    static const char *const types[] = {"discrete GPU", "integrated GPU", "virtual GPU", "CPU"};
    int i = 0;
    while (i < 4 && strcmp(info->type, types[i]) != 0)
        i++;
    return i;
}

static bool name_contains(const char *name, const char *part)
{
    for (; *name; name++) {
        size_t i = 0;
        while (part[i] && tolower((unsigned char)name[i]) == tolower((unsigned char)part[i]))
            i++;
        if (!part[i])
            return true;
    }
    return false;
}

static enum turner_result choose(uint32_t *chosen, const struct turner_gpu_info *infos,
                                 uint32_t count, const char *wanted)
{
    uint32_t best = UINT32_MAX, unusable = UINT32_MAX;
    bool by_index = wanted && *wanted && strspn(wanted, "0123456789") == strlen(wanted);
    unsigned long long index = by_index ? strtoull(wanted, NULL, 10) : 0;
    for (uint32_t i = 0; i < count; i++) {
        if (wanted && (by_index ? i != index : !name_contains(infos[i].name, wanted)))
            continue;
        if (!infos[i].usable)
            unusable = unusable == UINT32_MAX ? i : unusable;
        else if (best == UINT32_MAX || rank(&infos[i]) < rank(&infos[best]))
            best = i;
    }
    *chosen = best;
    if (best != UINT32_MAX)
        return TURNER_OK;
    if (unusable != UINT32_MAX)
        return turner_fail(TURNER_DEVICE, "%s lacks %s; take another device or a newer driver",
                           infos[unusable].name, infos[unusable].lacking);
    char names[1024] = "";
    for (uint32_t i = 0; i < count; i++) {
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%u: %s", i ? ", " : "", i, infos[i].name);
    }
    return turner_fail(TURNER_USAGE, "no device \"%s\"; those here are %s", wanted, names);
}

#define LOAD(field, name) gpu->field = (PFN_##name)vkGetDeviceProcAddr(gpu->device, #name)
static void load_ray_query_functions(struct turner_gpu *gpu)
{
    LOAD(create_acceleration, vkCreateAccelerationStructureKHR);
    LOAD(destroy_acceleration, vkDestroyAccelerationStructureKHR);
    LOAD(get_acceleration_sizes, vkGetAccelerationStructureBuildSizesKHR);
    LOAD(get_acceleration_address, vkGetAccelerationStructureDeviceAddressKHR);
    LOAD(cmd_build_accelerations, vkCmdBuildAccelerationStructuresKHR);
}

static void load_shader_object_functions(struct turner_gpu *gpu)
{
    LOAD(create_shaders, vkCreateShadersEXT);
    LOAD(destroy_shader, vkDestroyShaderEXT);
    LOAD(get_shader_binary, vkGetShaderBinaryDataEXT);
    LOAD(cmd_bind_shaders, vkCmdBindShadersEXT);
}
#undef LOAD

static enum turner_result create_device(struct turner_gpu *gpu)
{
    struct turner_extensions extensions;
    enum turner_result result = turner_extensions_create(&extensions, gpu->physical);
    gpu->memory_budget = turner_extensions_have(&extensions, VK_EXT_MEMORY_BUDGET_EXTENSION_NAME);
    /* validation layers before 1.3.246 know no shader objects */
    bool objects = gpu->info.software && !gpu->messenger &&
                   turner_extensions_have(&extensions, VK_EXT_SHADER_OBJECT_EXTENSION_NAME);
    turner_extensions_destroy(&extensions);
    TURNER_TRY(result);

    const char *names[8];
    uint32_t count = 0;
    for (uint32_t i = 0; gpu->info.ray_query && i < turner_ray_query_extension_count; i++)
        names[count++] = turner_ray_query_extensions[i];
    if (gpu->memory_budget)
        names[count++] = VK_EXT_MEMORY_BUDGET_EXTENSION_NAME;
    if (objects)
        names[count++] = VK_EXT_SHADER_OBJECT_EXTENSION_NAME;

    VkPhysicalDeviceRayQueryFeaturesKHR query = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_RAY_QUERY_FEATURES_KHR,
        .rayQuery = VK_TRUE,
    };
    VkPhysicalDeviceAccelerationStructureFeaturesKHR acceleration = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ACCELERATION_STRUCTURE_FEATURES_KHR,
        .pNext = &query,
        .accelerationStructure = VK_TRUE,
    };
    VkPhysicalDeviceShaderObjectFeaturesEXT object = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_OBJECT_FEATURES_EXT,
        .pNext = gpu->info.ray_query ? &acceleration : NULL,
        .shaderObject = VK_TRUE,
    };
    VkPhysicalDeviceVulkan13Features vulkan13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .pNext = objects ? &object : object.pNext,
        .maintenance4 = VK_TRUE, /* local size by specialisation constant */
        .computeFullSubgroups = gpu->info.packets,
    };
    VkPhysicalDeviceVulkan12Features vulkan12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = &vulkan13,
        .bufferDeviceAddress = VK_TRUE,
        .scalarBlockLayout = VK_TRUE,
    };
    VkPhysicalDeviceFeatures2 features = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2,
        .pNext = &vulkan12,
        .features = {.shaderInt64 = VK_TRUE, .shaderFloat64 = gpu->info.float64},
    };
    uint32_t timestamp_bits;
    gpu->queue_family = turner_queue_family(gpu->physical, &timestamp_bits);
    float priority = 1;
    VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = gpu->queue_family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    VkDeviceCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = names,
    };
    VK_TRY(vkCreateDevice(gpu->physical, &create, NULL, &gpu->device));
    vkGetDeviceQueue(gpu->device, gpu->queue_family, 0, &gpu->queue);
    if (gpu->info.ray_query)
        load_ray_query_functions(gpu);
    if (objects)
        load_shader_object_functions(gpu);

    VkCommandPoolCreateInfo pool = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
        .flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT,
        .queueFamilyIndex = gpu->queue_family,
    };
    VK_TRY(vkCreateCommandPool(gpu->device, &pool, NULL, &gpu->pool));
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    VK_TRY(vkCreateFence(gpu->device, &fence, NULL, &gpu->fence));
    return TURNER_OK;
}

static enum turner_result create_messenger(struct turner_gpu *gpu)
{
    VkDebugUtilsMessengerCreateInfoEXT create = turner_validation_messenger();
    PFN_vkCreateDebugUtilsMessengerEXT create_function =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(gpu->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    VK_TRY(create_function(gpu->instance, &create, NULL, &gpu->messenger));
    return TURNER_OK;
}

enum turner_result turner_gpu_create(struct turner_gpu *gpu, const char *wanted, bool validation)
{
    *gpu = (struct turner_gpu){0};
    const char *environment = getenv("TURNER_VALIDATION");
    validation |= environment && strcmp(environment, "1") == 0;

    enum turner_result result;
    VkPhysicalDevice *devices = NULL;
    struct turner_gpu_info *infos = NULL;
    uint32_t count, chosen;
    TURNER_TRY_DONE(create_instance(&gpu->instance, validation));
    if (validation)
        TURNER_TRY_DONE(create_messenger(gpu));
    TURNER_TRY_DONE(list_devices(gpu->instance, &devices, &infos, &count));
    TURNER_TRY_DONE(choose(&chosen, infos, count, wanted));
    gpu->physical = devices[chosen];
    gpu->info = infos[chosen];
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &gpu->memory);
    result = create_device(gpu);
    if (result != TURNER_OK)
        turner_fail_within(result, "%s", gpu->info.name);
done:
    free(devices);
    free(infos);
    if (result != TURNER_OK)
        turner_gpu_destroy(gpu);
    return result;
}

void turner_gpu_destroy(struct turner_gpu *gpu)
{
    if (gpu->hung) /* the driver would wait for ever */
        return;
    if (gpu->device) {
        vkDeviceWaitIdle(gpu->device);
        vkDestroyFence(gpu->device, gpu->fence, NULL);
        vkDestroyCommandPool(gpu->device, gpu->pool, NULL);
        vkDestroyDevice(gpu->device, NULL);
    }
    if (gpu->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                gpu->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(gpu->instance, gpu->messenger, NULL);
    }
    vkDestroyInstance(gpu->instance, NULL);
    *gpu = (struct turner_gpu){0};
}
