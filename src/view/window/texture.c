/* The picture as a texture of the presenting device. */
#include <string.h>

#include "view/window/internal.h"

void turner_window_texture_close(struct turner_window *window)
{
    struct turner_texture *t = &window->texture;
    if (!window->device)
        return;
    vkDestroyImage(window->device, t->image, NULL);
    vkFreeMemory(window->device, t->memory, NULL);
    vkDestroyBuffer(window->device, t->staging, NULL);
    vkFreeMemory(window->device, t->staging_memory, NULL);
    memset(t, 0, sizeof *t);
}

static bool allocate(struct turner_window *window, VkDeviceMemory *memory,
                     const VkMemoryRequirements *needs, VkMemoryPropertyFlags flags)
{
    VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                 .allocationSize = needs->size};
    info.memoryTypeIndex = turner_window_memory(window, needs->memoryTypeBits, flags);
    if (info.memoryTypeIndex == UINT32_MAX)
        return turner_window_check(window, VK_ERROR_OUT_OF_DEVICE_MEMORY, "vkAllocateMemory");
    TRY_VK(window, vkAllocateMemory(window->device, &info, NULL, memory));
    return true;
}

static bool create_image(struct turner_window *window, int width, int height)
{
    struct turner_texture *t = &window->texture;
    VkMemoryRequirements needs;
    VkImageCreateInfo create = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = {(uint32_t)width, (uint32_t)height, 1},
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
    };
    TRY_VK(window, vkCreateImage(window->device, &create, NULL, &t->image));
    vkGetImageMemoryRequirements(window->device, t->image, &needs);
    if (!allocate(window, &t->memory, &needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT))
        return false;
    TRY_VK(window, vkBindImageMemory(window->device, t->image, t->memory, 0));
    return true;
}

static bool create_staging(struct turner_window *window, int width, int height)
{
    struct turner_texture *t = &window->texture;
    VkMemoryRequirements needs;
    VkBufferCreateInfo create = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                 .size = (VkDeviceSize)width * (VkDeviceSize)height * 4,
                                 .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT};
    TRY_VK(window, vkCreateBuffer(window->device, &create, NULL, &t->staging));
    vkGetBufferMemoryRequirements(window->device, t->staging, &needs);
    if (!allocate(window, &t->staging_memory, &needs,
                  VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT))
        return false;
    TRY_VK(window, vkBindBufferMemory(window->device, t->staging, t->staging_memory, 0));
    TRY_VK(window, vkMapMemory(window->device, t->staging_memory, 0, VK_WHOLE_SIZE, 0,
                               &t->mapped));
    return true;
}

enum turner_window_result turner_window_picture(struct turner_window *window, const uint8_t *rgba,
                                                int width, int height)
{
    struct turner_texture *t = &window->texture;
    if (!turner_window_check(window,
                             vkWaitForFences(window->device, 1, &window->done, VK_TRUE, UINT64_MAX),
                             "vkWaitForFences"))
        return TURNER_WINDOW_FAILED;
    if (t->width != width || t->height != height) {
        turner_window_texture_close(window);
        if (!create_image(window, width, height) || !create_staging(window, width, height))
            return TURNER_WINDOW_FAILED;
        t->width = width;
        t->height = height;
    }
    memcpy(t->mapped, rgba, (size_t)width * (size_t)height * 4);
    t->fresh = true;
    return TURNER_WINDOW_OK;
}

static void barrier(const struct turner_window *window, VkImage image, VkImageLayout from,
                    VkImageLayout to)
{
    bool begins = from == VK_IMAGE_LAYOUT_UNDEFINED;
    bool attachment = to == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    VkImageMemoryBarrier change = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = begins ? 0 : VK_ACCESS_TRANSFER_WRITE_BIT,
        .dstAccessMask = attachment ? VK_ACCESS_COLOR_ATTACHMENT_READ_BIT |
                                          VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT
                                    : VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1},
    };
    vkCmdPipelineBarrier(window->commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                         attachment ? VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT
                                    : VK_PIPELINE_STAGE_TRANSFER_BIT,
                         0, 0, NULL, 0, NULL, 1, &change);
}

static void upload(struct turner_window *window)
{
    struct turner_texture *t = &window->texture;
    if (!t->fresh)
        return;
    t->fresh = false;
    barrier(window, t->image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy = {.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                              .imageExtent = {(uint32_t)t->width, (uint32_t)t->height, 1}};
    vkCmdCopyBufferToImage(window->commands, t->staging, t->image,
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    barrier(window, t->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

void turner_window_texture_draw(struct turner_window *window, VkImage image)
{
    const struct turner_texture *t = &window->texture;
    upload(window);
    barrier(window, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    if (t->width) {
        int32_t width = (int32_t)window->extent.width, height = (int32_t)window->extent.height;
        bool same = width == t->width && height == t->height;
        VkImageBlit blit = {.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .srcOffsets = {{0, 0, 0}, {t->width, t->height, 1}},
                            .dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1},
                            .dstOffsets = {{0, 0, 0}, {width, height, 1}}};
        vkCmdBlitImage(window->commands, t->image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit,
                       same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
    } else {
        VkClearColorValue grey = {.float32 = {0.16f, 0.16f, 0.17f, 1}};
        VkImageSubresourceRange all = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        vkCmdClearColorImage(window->commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &grey,
                             1, &all);
    }
    barrier(window, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
}
