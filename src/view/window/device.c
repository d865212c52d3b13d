/* The Vulkan that presents: a device of its own beside the one that traces, so that what is shown
 * never waits for what is traced. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "view/window/internal.h"

#define LAYER "VK_LAYER_KHRONOS_validation"
#define MOST_DEVICES 16
#define MOST_FAMILIES 16

static const char *name_of(VkResult result)
{
    static const struct {
        VkResult result;
        const char *name;
    } names[] = {
#define NAME(result) {result, #result}
        NAME(VK_ERROR_OUT_OF_HOST_MEMORY),    NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY),
        NAME(VK_ERROR_INITIALIZATION_FAILED), NAME(VK_ERROR_DEVICE_LOST),
        NAME(VK_ERROR_LAYER_NOT_PRESENT),     NAME(VK_ERROR_EXTENSION_NOT_PRESENT),
        NAME(VK_ERROR_FEATURE_NOT_PRESENT),   NAME(VK_ERROR_INCOMPATIBLE_DRIVER),
        NAME(VK_ERROR_SURFACE_LOST_KHR),      NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR),
        NAME(VK_ERROR_OUT_OF_DATE_KHR),       NAME(VK_ERROR_UNKNOWN),
#undef NAME
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (names[i].result == result)
            return names[i].name;
    }
    return "an unknown VkResult";
}

bool turner_window_check(struct turner_window *window, VkResult result, const char *call)
{
    if (result >= VK_SUCCESS)
        return true;
    snprintf(window->reason, sizeof window->reason, "the window: %.*s: %s",
             (int)strcspn(call, "("), call, name_of(result));
    return false;
}

static bool refuse(struct turner_window *window, const char *reason)
{
    snprintf(window->reason, sizeof window->reason, "%s", reason);
    return false;
}

static VKAPI_ATTR VkBool32 VKAPI_CALL print(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                            VkDebugUtilsMessageTypeFlagsEXT types,
                                            const VkDebugUtilsMessengerCallbackDataEXT *data,
                                            void *user)
{
    (void)severity, (void)types, (void)user;
    fprintf(stderr, "turner: validation: %s\n", data->pMessage ? data->pMessage : "");
    return VK_FALSE;
}

static bool create_instance(struct turner_window *window, bool validation)
{
    uint32_t count;
    const char *const *wanted = glfwGetRequiredInstanceExtensions(&count);
    const char *names[8];
    if (!wanted || count > 7)
        return refuse(window, "the display shows nothing by Vulkan");
    memcpy(names, wanted, count * sizeof *names);
    if (validation)
        names[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    static const char *const layers[] = {LAYER};
    VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = print,
    };
    VkApplicationInfo application = {.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                     .pApplicationName = "turner",
                                     .apiVersion = VK_API_VERSION_1_3};
    VkInstanceCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validation ? &messenger : NULL,
        .pApplicationInfo = &application,
        .enabledLayerCount = validation,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = names,
    };
    TRY_VK(window, vkCreateInstance(&create, NULL, &window->instance));
    PFN_vkCreateDebugUtilsMessengerEXT make =
        validation ? (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                         window->instance, "vkCreateDebugUtilsMessengerEXT")
                   : NULL;
    if (make)
        TRY_VK(window, make(window->instance, &messenger, NULL, &window->messenger));
    return true;
}

bool turner_window_surface(struct turner_window *window)
{
    vkDestroySurfaceKHR(window->instance, window->surface, NULL);
    window->surface = VK_NULL_HANDLE;
    TRY_VK(window, glfwCreateWindowSurface(window->instance, window->glfw, NULL, &window->surface));
    return true;
}

static bool has_swapchains(VkPhysicalDevice physical)
{
    uint32_t count = 0;
    bool found = false;
    if (vkEnumerateDeviceExtensionProperties(physical, NULL, &count, NULL) != VK_SUCCESS)
        return false;
    VkExtensionProperties *extensions = calloc(count ? count : 1, sizeof *extensions);
    if (extensions &&
        vkEnumerateDeviceExtensionProperties(physical, NULL, &count, extensions) >= VK_SUCCESS) {
        for (uint32_t i = 0; i < count; i++)
            found |= strcmp(extensions[i].extensionName, VK_KHR_SWAPCHAIN_EXTENSION_NAME) == 0;
    }
    free(extensions);
    return found;
}

/* A queue that draws and presents, or UINT32_MAX. */
static uint32_t presenting_family(const struct turner_window *window, VkPhysicalDevice physical)
{
    VkQueueFamilyProperties families[MOST_FAMILIES];
    uint32_t count = MOST_FAMILIES;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        VkBool32 presents = VK_FALSE;
        vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, window->surface, &presents);
        if (presents && families[i].queueFlags & VK_QUEUE_GRAPHICS_BIT)
            return i;
    }
    return UINT32_MAX;
}

static int rank(const VkPhysicalDeviceProperties *properties, const char *wanted)
{
    bool named = wanted && strstr(properties->deviceName, wanted);
    int best = properties->deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU     ? 4
               : properties->deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU ? 3
               : properties->deviceType == VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU    ? 2
                                                                                  : 1;
    return named ? best + 4 : best;
}

static bool choose(struct turner_window *window, const char *wanted)
{
    VkPhysicalDevice devices[MOST_DEVICES];
    uint32_t count = MOST_DEVICES;
    int best = 0;
    TRY_VK(window, vkEnumeratePhysicalDevices(window->instance, &count, devices));
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties properties;
        uint32_t family = presenting_family(window, devices[i]);
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        if (family == UINT32_MAX || !has_swapchains(devices[i]) ||
            rank(&properties, wanted) <= best)
            continue;
        best = rank(&properties, wanted);
        window->physical = devices[i];
        window->family = family;
        snprintf(window->device_name, sizeof window->device_name, "%s", properties.deviceName);
    }
    if (!best)
        return refuse(window, "no Vulkan device can show pictures on this display; install "
                              "mesa-vulkan-drivers or your graphics card's driver");
    vkGetPhysicalDeviceMemoryProperties(window->physical, &window->memory);
    return true;
}

static bool create_device(struct turner_window *window)
{
    float priority = 1;
    static const char *const names[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    VkDeviceQueueCreateInfo queue = {.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                     .queueFamilyIndex = window->family,
                                     .queueCount = 1,
                                     .pQueuePriorities = &priority};
    VkDeviceCreateInfo create = {.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                 .queueCreateInfoCount = 1,
                                 .pQueueCreateInfos = &queue,
                                 .enabledExtensionCount = 1,
                                 .ppEnabledExtensionNames = names};
    TRY_VK(window, vkCreateDevice(window->physical, &create, NULL, &window->device));
    vkGetDeviceQueue(window->device, window->family, 0, &window->queue);

    VkCommandPoolCreateInfo pool = {.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                    .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                    .queueFamilyIndex = window->family};
    TRY_VK(window, vkCreateCommandPool(window->device, &pool, NULL, &window->pool));
    VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = window->pool,
        .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
        .commandBufferCount = 1};
    TRY_VK(window, vkAllocateCommandBuffers(window->device, &allocate, &window->commands));
    VkFenceCreateInfo fence = {.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO,
                               .flags = VK_FENCE_CREATE_SIGNALED_BIT};
    TRY_VK(window, vkCreateFence(window->device, &fence, NULL, &window->done));
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    TRY_VK(window, vkCreateSemaphore(window->device, &semaphore, NULL, &window->acquired));
    return true;
}

/* Colours go to the screen as the bytes they are: the picture brings its sRGB curve with it. */
static bool choose_format(struct turner_window *window)
{
    VkSurfaceFormatKHR formats[64];
    uint32_t count = 64;
    TRY_VK(window, vkGetPhysicalDeviceSurfaceFormatsKHR(window->physical, window->surface, &count,
                                                        formats));
    for (uint32_t i = 0; i < count; i++) {
        if (formats[i].format == VK_FORMAT_B8G8R8A8_UNORM ||
            formats[i].format == VK_FORMAT_R8G8B8A8_UNORM) {
            window->format = formats[i].format;
            return true;
        }
    }
    return refuse(window, "the display takes no pictures of 8 bits a channel");
}

static bool create_pass(struct turner_window *window)
{
    VkAttachmentDescription attachment = {
        .format = window->format,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .loadOp = VK_ATTACHMENT_LOAD_OP_LOAD, /* the picture is there */
        .storeOp = VK_ATTACHMENT_STORE_OP_STORE,
        .stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE,
        .stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
        .initialLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
        .finalLayout = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR,
    };
    VkAttachmentReference color = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS,
                                    .colorAttachmentCount = 1,
                                    .pColorAttachments = &color};
    VkRenderPassCreateInfo create = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO,
                                     .attachmentCount = 1,
                                     .pAttachments = &attachment,
                                     .subpassCount = 1,
                                     .pSubpasses = &subpass};
    TRY_VK(window, vkCreateRenderPass(window->device, &create, NULL, &window->pass));
    return true;
}

static bool create_descriptors(struct turner_window *window)
{
    VkDescriptorPoolSize size = {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8};
    VkDescriptorPoolCreateInfo create = {.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                         .maxSets = 8,
                                         .poolSizeCount = 1,
                                         .pPoolSizes = &size};
    create.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    TRY_VK(window, vkCreateDescriptorPool(window->device, &create, NULL, &window->descriptors));
    return true;
}

bool turner_window_device(struct turner_window *window,
                          const struct turner_window_options *options)
{
    return create_instance(window, options->validation) && turner_window_surface(window) &&
           choose(window, options->device) && create_device(window) && choose_format(window) &&
           create_pass(window) && create_descriptors(window);
}

void turner_window_device_close(struct turner_window *window)
{
    if (window->device) {
        vkDestroyDescriptorPool(window->device, window->descriptors, NULL);
        vkDestroyRenderPass(window->device, window->pass, NULL);
        vkDestroySemaphore(window->device, window->acquired, NULL);
        vkDestroyFence(window->device, window->done, NULL);
        vkDestroyCommandPool(window->device, window->pool, NULL);
        vkDestroyDevice(window->device, NULL);
    }
    if (!window->instance)
        return;
    vkDestroySurfaceKHR(window->instance, window->surface, NULL);
    if (window->messenger) {
        PFN_vkDestroyDebugUtilsMessengerEXT destroy =
            (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                window->instance, "vkDestroyDebugUtilsMessengerEXT");
        destroy(window->instance, window->messenger, NULL);
    }
    vkDestroyInstance(window->instance, NULL);
}

uint32_t turner_window_memory(const struct turner_window *window, uint32_t bits,
                              VkMemoryPropertyFlags flags)
{
    for (uint32_t i = 0; i < window->memory.memoryTypeCount; i++) {
        if (bits >> i & 1 && (window->memory.memoryTypes[i].propertyFlags & flags) == flags)
            return i;
    }
    return UINT32_MAX;
}
