/* The window and its events (GLFW), and the module's table of functions. */
#include "view/window/internal.h"

#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct turner_window *only; /* for X's handler, which is told nothing of ours */

static void push(struct turner_window *window, struct turner_window_event event)
{
    struct turner_window_event *last =
        window->count ? &window->events[(window->first + window->count - 1) % TURNER_EVENTS] : NULL;
    if (last && last->kind == TURNER_WINDOW_MOVE && event.kind == TURNER_WINDOW_MOVE) {
        *last = event; /* only where the mouse is by now matters */
        return;
    }
    if (window->count == TURNER_EVENTS)
        return;
    window->events[(window->first + window->count++) % TURNER_EVENTS] = event;
}

/* Screen coordinates to pixels: they differ where the screen is scaled. */
static void to_pixels(const struct turner_window *window, double *x, double *y)
{
    int width, height, pixels_x, pixels_y;
    glfwGetWindowSize(window->glfw, &width, &height);
    glfwGetFramebufferSize(window->glfw, &pixels_x, &pixels_y);
    if (width > 0 && height > 0) {
        *x *= (double)pixels_x / width;
        *y *= (double)pixels_y / height;
    }
}

/* The panel has taken something for itself, and looks different now. */
static void uncover(struct turner_window *window)
{
    push(window, (struct turner_window_event){.kind = TURNER_WINDOW_UNCOVER});
}

static void on_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    struct turner_window *window = glfwGetWindowUserPointer(glfw);
    turner_window_ui_key(glfw, key, scancode, action, mods);
    if (action == GLFW_RELEASE)
        push(window, (struct turner_window_event){
                         .kind = TURNER_WINDOW_RELEASE, .key = key, .mods = mods});
    else if (!turner_window_ui_wants_keys())
        push(window, (struct turner_window_event){.kind = TURNER_WINDOW_KEY,
                                                  .key = key,
                                                  .mods = mods,
                                                  .again = action == GLFW_REPEAT});
    else
        uncover(window);
}

static void on_char(GLFWwindow *glfw, unsigned c)
{
    turner_window_ui_char(glfw, c);
    uncover(glfwGetWindowUserPointer(glfw));
}

static void on_button(GLFWwindow *glfw, int button, int action, int mods)
{
    struct turner_window *window = glfwGetWindowUserPointer(glfw);
    turner_window_ui_button(glfw, button, action, mods);
    if (action == GLFW_PRESS && turner_window_ui_wants_mouse()) {
        uncover(window);
        return;
    }
    struct turner_window_event event = {
        .kind = action == GLFW_PRESS ? TURNER_WINDOW_PRESS : TURNER_WINDOW_LIFT,
        .button = button,
        .mods = mods};
    glfwGetCursorPos(glfw, &event.x, &event.y);
    to_pixels(window, &event.x, &event.y);
    push(window, event);
}

static void on_move(GLFWwindow *glfw, double x, double y)
{
    struct turner_window *window = glfwGetWindowUserPointer(glfw);
    turner_window_ui_move(glfw, x, y);
    to_pixels(window, &x, &y);
    push(window, (struct turner_window_event){.kind = TURNER_WINDOW_MOVE, .x = x, .y = y});
}

static void on_scroll(GLFWwindow *glfw, double x, double y)
{
    struct turner_window *window = glfwGetWindowUserPointer(glfw);
    turner_window_ui_scroll(glfw, x, y);
    if (turner_window_ui_wants_mouse())
        uncover(window);
    else
        push(window, (struct turner_window_event){.kind = TURNER_WINDOW_WHEEL, .y = y});
}

static void on_focus(GLFWwindow *glfw, int focused)
{
    turner_window_ui_focus(glfw, focused);
}

static void on_enter(GLFWwindow *glfw, int entered)
{
    turner_window_ui_enter(glfw, entered);
}

static void on_close(GLFWwindow *glfw)
{
    push(glfwGetWindowUserPointer(glfw),
         (struct turner_window_event){.kind = TURNER_WINDOW_CLOSE});
}

static void on_refresh(GLFWwindow *glfw)
{
    uncover(glfwGetWindowUserPointer(glfw));
}

/* What GLFW last said of a failure. */
static void glfw_reason(struct turner_window *window, const char *what)
{
    const char *text = NULL;
    glfwGetError(&text);
    snprintf(window->reason, sizeof window->reason, "%s: %s", what, text ? text : "no reason given");
}

/* Xlib ends the process when the display goes away; this way it says so first. Called by Xlib, must
 * not return. */
static int display_gone(void *display)
{
    (void)display;
    if (only && only->gone)
        only->gone();
    _Exit(4);
}

static void watch_display(void)
{
    void *x11 = dlopen("libX11.so.6", RTLD_LAZY | RTLD_NOLOAD);
    void *symbol = x11 ? dlsym(x11, "XSetIOErrorHandler") : NULL;
    void *(*set)(int (*handler)(void *display));
    if (symbol) {
        memcpy(&set, &symbol, sizeof set); /* POSIX's way past ISO C */
        set(display_gone);
    }
    if (x11)
        dlclose(x11); /* GLFW holds it */
}

/* No larger than the screen has room for. */
static void fit(int *width, int *height)
{
    int x, y, most_x, most_y;
    GLFWmonitor *monitor = glfwGetPrimaryMonitor();
    if (!monitor)
        return;
    glfwGetMonitorWorkarea(monitor, &x, &y, &most_x, &most_y);
    double shrink = 1;
    if (*width > most_x)
        shrink = (double)most_x / *width;
    if (*height * shrink > most_y)
        shrink = (double)most_y / *height;
    *width = (int)(*width * shrink + 0.5);
    *height = (int)(*height * shrink + 0.5);
}

/* GLFW tries Wayland first, whose library complains where there is none. */
static void choose_platform(void)
{
#ifdef GLFW_PLATFORM
    const char *wayland = getenv("WAYLAND_DISPLAY"), *x11 = getenv("DISPLAY");
    if ((!wayland || !*wayland) && x11 && *x11 && glfwPlatformSupported(GLFW_PLATFORM_X11))
        glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
}

static bool open_window(struct turner_window *window, const struct turner_window_options *options)
{
    choose_platform();
    if (!glfwInit()) {
        glfw_reason(window, "no window can be opened");
        return false;
    }
    watch_display();
    if (!glfwVulkanSupported()) {
        glfw_reason(window, "the display shows nothing by Vulkan");
        return false;
    }
    int width = options->width, height = options->height;
    fit(&width, &height);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    window->glfw = glfwCreateWindow(width, height, options->title, NULL, NULL);
    if (!window->glfw) {
        glfw_reason(window, "no window can be opened");
        return false;
    }
    glfwSetWindowUserPointer(window->glfw, window);
    glfwSetKeyCallback(window->glfw, on_key);
    glfwSetCharCallback(window->glfw, on_char);
    glfwSetMouseButtonCallback(window->glfw, on_button);
    glfwSetCursorPosCallback(window->glfw, on_move);
    glfwSetScrollCallback(window->glfw, on_scroll);
    glfwSetWindowFocusCallback(window->glfw, on_focus);
    glfwSetCursorEnterCallback(window->glfw, on_enter);
    glfwSetWindowCloseCallback(window->glfw, on_close);
    glfwSetWindowRefreshCallback(window->glfw, on_refresh);
    return turner_window_device(window, options) && turner_window_swapchain(window) &&
           turner_window_ui(window);
}

static void close_window(struct turner_window *window)
{
    if (window->device)
        vkDeviceWaitIdle(window->device);
    turner_window_ui_close(window);
    turner_window_texture_close(window);
    turner_window_swapchain_close(window);
    turner_window_device_close(window);
    if (window->glfw)
        glfwDestroyWindow(window->glfw);
    glfwTerminate();
    only = NULL;
    free(window);
}

static struct turner_window *open_or_say(const struct turner_window_options *options,
                                         char reason[TURNER_WINDOW_REASON])
{
    struct turner_window *window = calloc(1, sizeof *window);
    if (!window) {
        snprintf(reason, TURNER_WINDOW_REASON, "no memory for a window");
        return NULL;
    }
    window->gone = options->gone;
    only = window;
    if (open_window(window, options))
        return window;
    snprintf(reason, TURNER_WINDOW_REASON, "%s", window->reason);
    close_window(window);
    return NULL;
}

static void wait_for(struct turner_window *window, double seconds)
{
    if (window->count) /* they are there already */
        seconds = 0;
    if (seconds < 0)
        glfwWaitEvents();
    else if (seconds == 0)
        glfwPollEvents();
    else
        glfwWaitEventsTimeout(seconds);
}

static void wake(struct turner_window *window)
{
    (void)window;
    glfwPostEmptyEvent();
}

static bool next(struct turner_window *window, struct turner_window_event *event)
{
    if (!window->count)
        return false;
    *event = window->events[window->first];
    window->first = (window->first + 1) % TURNER_EVENTS;
    window->count--;
    return true;
}

static void get_state(const struct turner_window *window, struct turner_window_state *state)
{
    memset(state, 0, sizeof *state);
    if (!glfwGetWindowAttrib(window->glfw, GLFW_ICONIFIED))
        glfwGetFramebufferSize(window->glfw, &state->width, &state->height);
    if (!state->width || !state->height)
        state->width = state->height = 0;
    state->closing = glfwWindowShouldClose(window->glfw);
    glfwGetCursorPos(window->glfw, &state->mouse_x, &state->mouse_y);
    to_pixels(window, &state->mouse_x, &state->mouse_y);
    snprintf(state->device, sizeof state->device, "%s", window->device_name);
}

static enum turner_window_result show(struct turner_window *window)
{
    struct turner_window_state state;
    get_state(window, &state);
    if (!window->began)
        window->reason[0] = 0;
    enum turner_window_result result =
        state.width ? turner_window_present(window) : TURNER_WINDOW_HIDDEN;
    turner_window_ui_end(window);
    return result;
}

static const char *get_reason(const struct turner_window *window)
{
    return window->reason;
}

static void set_title(struct turner_window *window, const char *title)
{
    glfwSetWindowTitle(window->glfw, title);
}

static void set_clipboard(struct turner_window *window, const char *text)
{
    glfwSetClipboardString(window->glfw, text);
}

__attribute__((visibility("default"))) const struct turner_window_functions *
turner_window_module(void)
{
    static struct turner_window_functions functions = {
        .version = TURNER_VERSION,
        .open = open_or_say,
        .close = close_window,
        .wait = wait_for,
        .wake = wake,
        .next = next,
        .state = get_state,
        .picture = turner_window_picture,
        .show = show,
        .reason = get_reason,
        .title = set_title,
        .clipboard = set_clipboard,
    };
    functions.ui = turner_window_ui_functions;
    return &functions;
}
