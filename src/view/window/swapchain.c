/* The images the display shows, and how a frame gets into one. */
#include <stdio.h>
#include <string.h>

#include "view/window/internal.h"

static void close_frames(struct turner_window *window)
{
    for (uint32_t i = 0; i < window->frame_count; i++) {
        struct turner_frame *frame = &window->frames[i];
        vkDestroyFramebuffer(window->device, frame->framebuffer, NULL);
        vkDestroyImageView(window->device, frame->view, NULL);
        vkDestroySemaphore(window->device, frame->drawn, NULL);
    }
    memset(window->frames, 0, sizeof window->frames);
    window->frame_count = 0;
}

void turner_window_swapchain_close(struct turner_window *window)
{
    if (!window->device)
        return;
    close_frames(window);
    vkDestroySwapchainKHR(window->device, window->swapchain, NULL);
    window->swapchain = VK_NULL_HANDLE;
}

static uint32_t within(uint32_t value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : value;
}

static bool create_frame(struct turner_window *window, struct turner_frame *frame)
{
    VkImageViewCreateInfo view = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
        .image = frame->image,
        .viewType = VK_IMAGE_VIEW_TYPE_2D,
        .format = window->format,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    TRY_VK(window, vkCreateImageView(window->device, &view, NULL, &frame->view));
    VkFramebufferCreateInfo framebuffer = {
        .sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO,
        .renderPass = window->pass,
        .attachmentCount = 1,
        .pAttachments = &frame->view,
        .width = window->extent.width,
        .height = window->extent.height,
        .layers = 1,
    };
    TRY_VK(window, vkCreateFramebuffer(window->device, &framebuffer, NULL, &frame->framebuffer));
    VkSemaphoreCreateInfo semaphore = {.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    TRY_VK(window, vkCreateSemaphore(window->device, &semaphore, NULL, &frame->drawn));
    return true;
}

/* Leaves no swapchain where the window has no area. */
static VkResult create(struct turner_window *window)
{
    VkSurfaceCapabilitiesKHR can;
    VkResult result =
        vkGetPhysicalDeviceSurfaceCapabilitiesKHR(window->physical, window->surface, &can);
    if (result != VK_SUCCESS)
        return result;
    window->extent = can.currentExtent;
    if (can.currentExtent.width == UINT32_MAX) { /* the window is as large as its pictures */
        int width, height;
        glfwGetFramebufferSize(window->glfw, &width, &height);
        window->extent.width =
            within((uint32_t)width, can.minImageExtent.width, can.maxImageExtent.width);
        window->extent.height =
            within((uint32_t)height, can.minImageExtent.height, can.maxImageExtent.height);
    }
    VkSwapchainKHR old = window->swapchain;
    window->swapchain = VK_NULL_HANDLE;
    if (window->extent.width && window->extent.height) {
        VkSwapchainCreateInfoKHR info = {
            .sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR,
            .surface = window->surface,
            .minImageCount = within(can.minImageCount + 1, can.minImageCount,
                                    can.maxImageCount ? can.maxImageCount : UINT32_MAX),
            .imageFormat = window->format,
            .imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR,
            .imageExtent = window->extent,
            .imageArrayLayers = 1,
            .imageUsage =
                VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
            .imageSharingMode = VK_SHARING_MODE_EXCLUSIVE,
            .preTransform = can.currentTransform,
            .compositeAlpha = can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                  ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                                  : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR,
            .presentMode = VK_PRESENT_MODE_FIFO_KHR,
            .clipped = VK_TRUE,
            .oldSwapchain = old,
        };
        result = vkCreateSwapchainKHR(window->device, &info, NULL, &window->swapchain);
    }
    vkDestroySwapchainKHR(window->device, old, NULL);
    return result;
}

bool turner_window_swapchain(struct turner_window *window)
{
    vkDeviceWaitIdle(window->device);
    close_frames(window);
    VkResult result = create(window);
    if (result == VK_ERROR_SURFACE_LOST_KHR) {
        vkDestroySwapchainKHR(window->device, window->swapchain, NULL);
        window->swapchain = VK_NULL_HANDLE;
        if (!turner_window_surface(window))
            return false;
        result = create(window);
    }
    if (!turner_window_check(window, result, "vkCreateSwapchainKHR"))
        return false;
    if (!window->swapchain)
        return true;
    VkImage images[TURNER_SWAPCHAIN_IMAGES];
    uint32_t count = 0;
    TRY_VK(window, vkGetSwapchainImagesKHR(window->device, window->swapchain, &count, NULL));
    if (count > TURNER_SWAPCHAIN_IMAGES) {
        snprintf(window->reason, sizeof window->reason,
                 "the display wants %u images in turn, and %d are the most", count,
                 TURNER_SWAPCHAIN_IMAGES);
        return false;
    }
    TRY_VK(window, vkGetSwapchainImagesKHR(window->device, window->swapchain, &count, images));
    for (uint32_t i = 0; i < count; i++) {
        window->frames[window->frame_count++].image = images[i];
        if (!create_frame(window, &window->frames[i]))
            return false;
    }
    return true;
}

static bool record(struct turner_window *window, const struct turner_frame *frame)
{
    VkCommandBuffer commands = window->commands;
    VkCommandBufferBeginInfo begin = {.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
    TRY_VK(window, vkBeginCommandBuffer(commands, &begin));
    turner_window_texture_draw(window, frame->image);
    VkRenderPassBeginInfo pass = {.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO,
                                  .renderPass = window->pass,
                                  .framebuffer = frame->framebuffer,
                                  .renderArea = {.extent = window->extent}};
    vkCmdBeginRenderPass(commands, &pass, VK_SUBPASS_CONTENTS_INLINE);
    turner_window_ui_draw(window);
    vkCmdEndRenderPass(commands);
    TRY_VK(window, vkEndCommandBuffer(commands));
    return true;
}

static bool submit(struct turner_window *window, const struct turner_frame *frame)
{
    VkPipelineStageFlags stage = VK_PIPELINE_STAGE_TRANSFER_BIT; /* what comes first */
    VkSubmitInfo info = {
        .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
        .waitSemaphoreCount = 1,
        .pWaitSemaphores = &window->acquired,
        .pWaitDstStageMask = &stage,
        .commandBufferCount = 1,
        .pCommandBuffers = &window->commands,
        .signalSemaphoreCount = 1,
        .pSignalSemaphores = &frame->drawn,
    };
    TRY_VK(window, vkResetFences(window->device, 1, &window->done));
    TRY_VK(window, vkQueueSubmit(window->queue, 1, &info, window->done));
    return true;
}

/* Whether the result means that the swapchain no longer fits the window. */
static bool outdated(VkResult result)
{
    return result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_ERROR_SURFACE_LOST_KHR;
}

/* The next image; made anew, with the swapchain, as often as a window that is being resized may
 * want. False with index UINT32_MAX: there is none at present. */
static bool acquire(struct turner_window *window, uint32_t *index)
{
    *index = UINT32_MAX;
    int width, height;
    glfwGetFramebufferSize(window->glfw, &width, &height);
    bool fits = window->swapchain && (uint32_t)width == window->extent.width &&
                (uint32_t)height == window->extent.height;
    for (int attempt = 0; attempt < 3; attempt++) {
        if (!fits && !turner_window_swapchain(window))
            return false;
        if (!window->swapchain)
            return true;
        VkResult result = vkAcquireNextImageKHR(window->device, window->swapchain, UINT64_MAX,
                                                window->acquired, VK_NULL_HANDLE, index);
        if (!outdated(result))
            return turner_window_check(window, result, "vkAcquireNextImageKHR");
        *index = UINT32_MAX;
        fits = false;
    }
    return true;
}

enum turner_window_result turner_window_present(struct turner_window *window)
{
    uint32_t index;
    if (!turner_window_check(window,
                             vkWaitForFences(window->device, 1, &window->done, VK_TRUE, UINT64_MAX),
                             "vkWaitForFences"))
        return TURNER_WINDOW_FAILED;
    if (!acquire(window, &index))
        return TURNER_WINDOW_FAILED;
    if (index == UINT32_MAX)
        return TURNER_WINDOW_HIDDEN;
    const struct turner_frame *frame = &window->frames[index];
    if (!record(window, frame) || !submit(window, frame))
        return TURNER_WINDOW_FAILED;
    VkPresentInfoKHR info = {.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR,
                             .waitSemaphoreCount = 1,
                             .pWaitSemaphores = &frame->drawn,
                             .swapchainCount = 1,
                             .pSwapchains = &window->swapchain,
                             .pImageIndices = &index};
    VkResult result = vkQueuePresentKHR(window->queue, &info);
    if (outdated(result)) /* the next frame makes it anew */
        return turner_window_swapchain(window) ? TURNER_WINDOW_OK : TURNER_WINDOW_FAILED;
    return turner_window_check(window, result, "vkQueuePresentKHR") ? TURNER_WINDOW_OK
                                                                    : TURNER_WINDOW_FAILED;
}
