/* Between the files of src/view/window/ only. */
#ifndef TURNER_VIEW_WINDOW_INTERNAL_H
#define TURNER_VIEW_WINDOW_INTERNAL_H

#include <vulkan/vulkan.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "view/window.h"

#ifdef __cplusplus
extern "C" {
#endif

#define TURNER_EVENTS 256
#define TURNER_SWAPCHAIN_IMAGES 8

/* One image of the swapchain. */
struct turner_frame {
    VkImage image;
    VkImageView view;
    VkFramebuffer framebuffer;
    VkSemaphore drawn; /* signalled when it may be presented */
};

/* The picture as a texture, and the buffer it comes by. */
struct turner_texture {
    VkImage image;
    VkDeviceMemory memory;
    VkBuffer staging;
    VkDeviceMemory staging_memory;
    void *mapped;
    int width, height;
    bool fresh; /* `mapped` is newer than `image` */
};

struct turner_window {
    GLFWwindow *glfw;
    char reason[TURNER_WINDOW_REASON];
    struct turner_window_event events[TURNER_EVENTS];
    unsigned first, count; /* of events */
    void (*gone)(void);
    bool ui, began;     /* Dear ImGui runs; a frame of it is begun */

    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkSurfaceKHR surface;
    VkPhysicalDevice physical;
    VkPhysicalDeviceMemoryProperties memory;
    char device_name[256];
    uint32_t family;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    VkCommandBuffer commands;
    VkFence done; /* of the last frame */
    VkSemaphore acquired;
    VkRenderPass pass;
    VkDescriptorPool descriptors;
    VkFormat format;
    VkSwapchainKHR swapchain;
    VkExtent2D extent;
    struct turner_frame frames[TURNER_SWAPCHAIN_IMAGES];
    uint32_t frame_count;
    struct turner_texture texture;
};

/* device.c: instance, surface, device and what lives as long as they do. */
bool turner_window_device(struct turner_window *window,
                          const struct turner_window_options *options);
void turner_window_device_close(struct turner_window *window);
/* Makes a lost surface anew. */
bool turner_window_surface(struct turner_window *window);
/* A memory type among `bits` with the flags, or UINT32_MAX. */
uint32_t turner_window_memory(const struct turner_window *window, uint32_t bits,
                              VkMemoryPropertyFlags flags);
/* False with the reason when `result` is a failure. */
bool turner_window_check(struct turner_window *window, VkResult result, const char *call);
/* "VK_ERROR_…", for messages. */
#define TRY_VK(window, call)                              \
    do {                                                  \
        if (!turner_window_check((window), (call), #call)) \
            return false;                                 \
    } while (0)

/* swapchain.c */
bool turner_window_swapchain(struct turner_window *window); /* at the size the window has */
void turner_window_swapchain_close(struct turner_window *window);
enum turner_window_result turner_window_present(struct turner_window *window);

/* texture.c */
enum turner_window_result turner_window_picture(struct turner_window *window, const uint8_t *rgba,
                                                int width, int height);
/* Records how the picture fills `image`, and leaves that as a colour attachment. */
void turner_window_texture_draw(struct turner_window *window, VkImage image);
void turner_window_texture_close(struct turner_window *window);

/* ui.cpp */
bool turner_window_ui(struct turner_window *window);
void turner_window_ui_close(struct turner_window *window);
/* Ends the panel's frame and records it. */
void turner_window_ui_draw(struct turner_window *window);
void turner_window_ui_end(struct turner_window *window); /* ends it without drawing */
bool turner_window_ui_wants_mouse(void);
bool turner_window_ui_wants_keys(void);
void turner_window_ui_key(GLFWwindow *glfw, int key, int scancode, int action, int mods);
void turner_window_ui_char(GLFWwindow *glfw, unsigned c);
void turner_window_ui_button(GLFWwindow *glfw, int button, int action, int mods);
void turner_window_ui_move(GLFWwindow *glfw, double x, double y);
void turner_window_ui_scroll(GLFWwindow *glfw, double x, double y);
void turner_window_ui_focus(GLFWwindow *glfw, int focused);
void turner_window_ui_enter(GLFWwindow *glfw, int entered);
extern const struct turner_ui turner_window_ui_functions;

#ifdef __cplusplus
}
#endif
#endif
