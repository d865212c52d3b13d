/* Loaded into the command with LD_PRELOAD: the window's surface is lost again and again, as when a
 * display server starts anew.
 *
 * TURNER_LOSE=acquire|present: in which call, each ninth time. Until the program destroys the surface,
 * every call that concerns it fails. Each loss writes a line "lost". */
#define VK_NO_PROTOTYPES
#include <dlfcn.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <vulkan/vulkan.h>

static VkSurfaceKHR current, lost;

static void *next(const char *name)
{
    return dlsym(RTLD_NEXT, name);
}

static bool loses(const char *call)
{
    static unsigned count;
    const char *wanted = getenv("TURNER_LOSE");
    if (!wanted || strcmp(wanted, call) != 0)
        return false;
    if (lost == VK_NULL_HANDLE && ++count % 9 == 0) {
        lost = current;
        if (write(STDERR_FILENO, "lost\n", 5) != 5)
            abort();
    }
    return lost != VK_NULL_HANDLE;
}

VkResult vkGetPhysicalDeviceSurfaceCapabilitiesKHR(VkPhysicalDevice device, VkSurfaceKHR surface,
                                                   VkSurfaceCapabilitiesKHR *capabilities)
{
    PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR call =
        (PFN_vkGetPhysicalDeviceSurfaceCapabilitiesKHR)next(__func__);
    return surface == lost && lost ? VK_ERROR_SURFACE_LOST_KHR : call(device, surface, capabilities);
}

VkResult vkCreateSwapchainKHR(VkDevice device, const VkSwapchainCreateInfoKHR *info,
                              const VkAllocationCallbacks *allocator, VkSwapchainKHR *swapchain)
{
    PFN_vkCreateSwapchainKHR call = (PFN_vkCreateSwapchainKHR)next(__func__);
    current = info->surface;
    return info->surface == lost && lost ? VK_ERROR_SURFACE_LOST_KHR
                                         : call(device, info, allocator, swapchain);
}

void vkDestroySurfaceKHR(VkInstance instance, VkSurfaceKHR surface,
                         const VkAllocationCallbacks *allocator)
{
    PFN_vkDestroySurfaceKHR call = (PFN_vkDestroySurfaceKHR)next(__func__);
    if (surface == lost)
        lost = VK_NULL_HANDLE;
    call(instance, surface, allocator);
}

VkResult vkAcquireNextImageKHR(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                               VkSemaphore semaphore, VkFence fence, uint32_t *index)
{
    PFN_vkAcquireNextImageKHR call = (PFN_vkAcquireNextImageKHR)next(__func__);
    return loses("acquire") ? VK_ERROR_SURFACE_LOST_KHR
                            : call(device, swapchain, timeout, semaphore, fence, index);
}

VkResult vkQueuePresentKHR(VkQueue queue, const VkPresentInfoKHR *info)
{
    PFN_vkQueuePresentKHR call = (PFN_vkQueuePresentKHR)next(__func__);
    VkResult result = call(queue, info); /* semaphores are waited for all the same */
    return loses("present") ? VK_ERROR_SURFACE_LOST_KHR : result;
}
