// Dear ImGui behind functions that C can call: the panel's widgets.
#include <cmath>
#include <cstdio>
#include <cstring>

#include <imgui.h>

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>

#include "view/window/internal.h"

namespace
{
bool wraps = true;       // text in the box that is open
float divided = 0;       // where the divider is
float stacked = 0;       // height of the boxes at the bottom, so far in this frame
bool stacks = false;     // the box that is open is one of them
ImFont *columns = nullptr;
float column = 0;        // where the texts of rows begin
const float margin = 10; // between the window's edge and a box, of a screen that is not scaled

// The first of the files that is there, or Dear ImGui's own, which is made of few pixels.
ImFont *load_font(const char *const *files, int count, float size)
{
    static const ImWchar ranges[] = {0x20,   0xff,   0x391,  0x3c9,  0x2013, 0x2026, 0x2190,
                                     0x2193, 0x2212, 0x2265, 0x2500, 0x257f, 0};
    ImFontAtlas *fonts = ImGui::GetIO().Fonts;
    ImFontConfig config;
    for (int i = 0; i < count; i++) {
        std::FILE *there = std::fopen(files[i], "rb");
        if (!there)
            continue;
        std::fclose(there);
        config.OversampleH = 2;
        config.PixelSnapH = true;
        ImFont *font = fonts->AddFontFromFileTTF(files[i], std::floor(size), &config, ranges);
        if (font)
            return font;
    }
    config.SizePixels = std::floor(size);
    return fonts->AddFontDefault(&config);
}

// Fonts that people can read, where the system has them; the second for what stands in columns.
void choose_fonts(float scale)
{
    static const char *const plain[] = {
        "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
        "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
        "/usr/share/fonts/TTF/DejaVuSans.ttf",
    };
    static const char *const even[] = {
        "/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf",
        "/usr/share/fonts/truetype/noto/NotoSansMono-Regular.ttf",
        "/usr/share/fonts/truetype/liberation/LiberationMono-Regular.ttf",
        "/usr/share/fonts/TTF/DejaVuSansMono.ttf",
    };
    load_font(plain, 4, 14 * scale);
    columns = load_font(even, 4, 12 * scale);
}

void choose_style(float scale)
{
    ImGui::StyleColorsDark();
    ImGuiStyle &style = ImGui::GetStyle();
    style.WindowRounding = 6;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.WindowPadding = ImVec2(12, 10);
    style.ItemSpacing = ImVec2(8, 5);
    style.FramePadding = ImVec2(6, 3);
    style.ScrollbarSize = 12;
    ImVec4 *colors = style.Colors;
    colors[ImGuiCol_WindowBg] = ImVec4(0.09f, 0.09f, 0.10f, 0.88f);
    colors[ImGuiCol_TitleBg] = ImVec4(0.13f, 0.13f, 0.15f, 0.95f);
    colors[ImGuiCol_TitleBgActive] = ImVec4(0.19f, 0.19f, 0.22f, 0.98f);
    colors[ImGuiCol_TitleBgCollapsed] = ImVec4(0.13f, 0.13f, 0.15f, 0.80f);
    colors[ImGuiCol_FrameBg] = ImVec4(0.22f, 0.22f, 0.25f, 0.90f);
    colors[ImGuiCol_FrameBgHovered] = ImVec4(0.29f, 0.29f, 0.33f, 0.95f);
    colors[ImGuiCol_FrameBgActive] = ImVec4(0.33f, 0.33f, 0.38f, 1);
    colors[ImGuiCol_Header] = ImVec4(0.22f, 0.22f, 0.25f, 0.9f);
    colors[ImGuiCol_HeaderHovered] = ImVec4(0.30f, 0.30f, 0.34f, 1);
    colors[ImGuiCol_HeaderActive] = ImVec4(0.34f, 0.34f, 0.38f, 1);
    colors[ImGuiCol_Button] = ImVec4(0.27f, 0.27f, 0.31f, 1);
    colors[ImGuiCol_ButtonHovered] = ImVec4(0.36f, 0.36f, 0.41f, 1);
    colors[ImGuiCol_ButtonActive] = ImVec4(0.45f, 0.37f, 0.22f, 1);
    colors[ImGuiCol_SliderGrab] = ImVec4(0.85f, 0.66f, 0.30f, 1);
    colors[ImGuiCol_SliderGrabActive] = ImVec4(0.95f, 0.76f, 0.40f, 1);
    colors[ImGuiCol_CheckMark] = ImVec4(0.90f, 0.70f, 0.33f, 1);
    colors[ImGuiCol_PlotHistogram] = ImVec4(0.85f, 0.66f, 0.30f, 1);
    style.ScaleAllSizes(scale);
}

float scale_of(GLFWwindow *glfw)
{
    float x = 1, y = 1;
    glfwGetWindowContentScale(glfw, &x, &y);
    return x >= 1 && x <= 8 ? x : 1;
}

bool upload_fonts(struct turner_window *window)
{
#if IMGUI_VERSION_NUM >= 19000 // it has commands of its own
    TRY_VK(window, ImGui_ImplVulkan_CreateFontsTexture() ? VK_SUCCESS : VK_ERROR_UNKNOWN);
    return true;
#else
    VkCommandBufferBeginInfo begin = {};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    TRY_VK(window, vkBeginCommandBuffer(window->commands, &begin));
    ImGui_ImplVulkan_CreateFontsTexture(window->commands);
    TRY_VK(window, vkEndCommandBuffer(window->commands));
    VkSubmitInfo submit = {};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &window->commands;
    TRY_VK(window, vkQueueSubmit(window->queue, 1, &submit, VK_NULL_HANDLE));
    TRY_VK(window, vkDeviceWaitIdle(window->device));
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return true;
#endif
}
} // namespace

bool turner_window_ui(struct turner_window *window)
{
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    window->ui = true;
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr; // leaves no file behind
    io.LogFilename = nullptr;
    float scale = scale_of(window->glfw);
    choose_fonts(scale);
    choose_style(scale);
    ImGui_ImplGlfw_InitForVulkan(window->glfw, false);
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = window->instance;
    info.PhysicalDevice = window->physical;
    info.Device = window->device;
    info.QueueFamily = window->family;
    info.Queue = window->queue;
    info.DescriptorPool = window->descriptors;
    info.MinImageCount = 2;
    info.ImageCount = 2;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    ImGui_ImplVulkan_Init(&info, window->pass);
    return upload_fonts(window);
}

void turner_window_ui_close(struct turner_window *window)
{
    if (!window->ui)
        return;
    turner_window_ui_end(window);
    if (ImGui::GetIO().BackendRendererUserData)
        ImGui_ImplVulkan_Shutdown();
    if (ImGui::GetIO().BackendPlatformUserData)
        ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    window->ui = false;
}

static void begin(struct turner_window *window)
{
    if (window->began)
        return;
    ImGui_ImplVulkan_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    window->began = true;
    stacked = 0;
}

void turner_window_ui_draw(struct turner_window *window)
{
    begin(window);
    ImGui::Render();
    window->began = false;
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), window->commands);
}

void turner_window_ui_end(struct turner_window *window)
{
    if (window->began)
        ImGui::EndFrame();
    window->began = false;
}

bool turner_window_ui_wants_mouse(void)
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantCaptureMouse;
}

bool turner_window_ui_wants_keys(void)
{
    return ImGui::GetCurrentContext() && ImGui::GetIO().WantTextInput;
}

void turner_window_ui_key(GLFWwindow *glfw, int key, int scancode, int action, int mods)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_KeyCallback(glfw, key, scancode, action, mods);
}

void turner_window_ui_char(GLFWwindow *glfw, unsigned c)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_CharCallback(glfw, c);
}

void turner_window_ui_button(GLFWwindow *glfw, int button, int action, int mods)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_MouseButtonCallback(glfw, button, action, mods);
}

void turner_window_ui_move(GLFWwindow *glfw, double x, double y)
{
#if IMGUI_VERSION_NUM >= 18700 // before, it asked for the place by itself
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_CursorPosCallback(glfw, x, y);
#else
    (void)glfw, (void)x, (void)y;
#endif
}

void turner_window_ui_scroll(GLFWwindow *glfw, double x, double y)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_ScrollCallback(glfw, x, y);
}

void turner_window_ui_focus(GLFWwindow *glfw, int focused)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_WindowFocusCallback(glfw, focused);
}

void turner_window_ui_enter(GLFWwindow *glfw, int entered)
{
    if (ImGui::GetCurrentContext())
        ImGui_ImplGlfw_CursorEnterCallback(glfw, entered);
}

// ---- widgets ----

// Where a box of that width keeps clear of the divider as long as the screen has room for it.
static ImVec2 beside_divider(bool left, float across, float wide, float gap)
{
    float x = left ? divided - gap : divided + gap, least = gap + wide, most = across - gap - wide;
    return ImVec2(left ? (x < least ? least : x) : (x > most ? most : x), gap);
}

static void divider(float x)
{
    ImVec2 size = ImGui::GetIO().DisplaySize, mouse = ImGui::GetIO().MousePos;
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    float grip = ImGui::GetFontSize(), middle = 0.5f * size.y;
    bool near = mouse.x >= x - 6 && mouse.x <= x + 6 && !ImGui::GetIO().WantCaptureMouse;
    ImU32 light = near ? IM_COL32(255, 204, 110, 255) : IM_COL32(235, 235, 235, 220);
    divided = x;
    list->AddRectFilled(ImVec2(x - 2, 0), ImVec2(x + 2, size.y), IM_COL32(0, 0, 0, 110));
    list->AddRectFilled(ImVec2(x - 1, 0), ImVec2(x + 1, size.y), light);
    list->AddRectFilled(ImVec2(x - 4, middle - grip), ImVec2(x + 4, middle + grip), light, 4);
    if (near)
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
}

static bool open_box(const char *title, int place, float width, bool plain)
{
    static const float across[] = {0, 1, 0, 0.5f, 1, 0.5f, 1, 0, 1};
    static const float down[] = {0, 0, 1, 0.5f, 0, 1, 0, 0, 1};
    ImVec2 size = ImGui::GetIO().DisplaySize;
    float gap = margin * ImGui::GetFontSize() / 14;
    ImVec2 at(gap + across[place] * (size.x - 2 * gap), gap + down[place] * (size.y - 2 * gap));
    float wide = width * ImGui::GetFontSize();
    stacks = down[place] == 1;
    if (stacks)
        at.y -= stacked;
    if (place == 6 || place == 7)
        at = beside_divider(place == 6, size.x, wide, gap);
    float most = size.x - 2 * gap > 60 ? size.x - 2 * gap : 60;
    bool moves = !plain && place < 2;
    ImGui::SetNextWindowPos(at, moves ? ImGuiCond_FirstUseEver : ImGuiCond_Always,
                            ImVec2(across[place], down[place]));
    wide = wide > most ? most : wide;
    ImGui::SetNextWindowSizeConstraints(
        ImVec2(wide, 0), ImVec2(wide > 0 ? wide : most, size.y > 2 * gap + 40 ? size.y - 2 * gap : 40));
    ImGuiWindowFlags flags = ImGuiWindowFlags_HorizontalScrollbar |
                             ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                             ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;
    if (plain)
        flags |= ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs;
    else if (!moves)
        flags |= ImGuiWindowFlags_NoMove;
    wraps = width > 0;
    column = 0.42f * wide;
    bool shown = ImGui::Begin(title, nullptr, flags);
    ImGui::PushItemWidth(width > 0 ? -0.42f * wide : 0);
    return shown;
}

static void close_box(void)
{
    if (stacks)
        stacked += ImGui::GetWindowHeight() + 0.5f * margin;
    stacks = false;
    ImGui::PopItemWidth();
    ImGui::End();
}

static void text(const char *string)
{
    ImGui::PushTextWrapPos(wraps ? 0.0f : -1.0f);
    ImGui::TextUnformatted(string);
    ImGui::PopTextWrapPos();
}

static void colored(const char *string, const ImVec4 &color)
{
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    text(string);
    ImGui::PopStyleColor();
}

static void note(const char *string)
{
    colored(string, ImVec4(0.66f, 0.66f, 0.68f, 1));
}

static void alert(const char *string)
{
    colored(string, ImVec4(1, 0.50f, 0.42f, 1));
}

static void code(const char *string)
{
    ImGui::PushFont(columns);
    ImGui::TextUnformatted(string);
    ImGui::PopFont();
}

static void row(const char *name, const char *string)
{
    ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.66f, 0.66f, 0.68f, 1));
    ImGui::PushTextWrapPos(column > 0 ? column - 4 : -1.0f);
    ImGui::TextUnformatted(name);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
    ImGui::SameLine(column);
    text(string);
}

static bool section(const char *title, bool open)
{
    return ImGui::CollapsingHeader(title, open ? ImGuiTreeNodeFlags_DefaultOpen : 0);
}

static bool slide(const char *name, float *value, float least, float most, bool logarithmic)
{
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    return ImGui::SliderFloat(name, value, least, most, "%.4g",
                              flags | (logarithmic ? ImGuiSliderFlags_Logarithmic : 0));
}

static bool slide_whole(const char *name, int *value, int least, int most)
{
    return ImGui::SliderInt(name, value, least, most, "%d", ImGuiSliderFlags_AlwaysClamp);
}

static bool number(const char *name, float *value, float speed)
{
    return ImGui::DragFloat(name, value, speed, 0, 0, "%.5g");
}

static bool numbers(const char *name, float value[3], float speed)
{
    return ImGui::DragFloat3(name, value, speed, 0, 0, "%.4g");
}

static bool color(const char *name, float rgb[3])
{
    return ImGui::ColorEdit3(name, rgb, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_HDR);
}

static bool check(const char *name, bool *value)
{
    return ImGui::Checkbox(name, value);
}

static bool choose(const char *name, int *value, const char *const *choices, int count)
{
    return ImGui::Combo(name, value, choices, count);
}

static bool button(const char *name)
{
    return ImGui::Button(name);
}

static void beside(void)
{
    ImGui::SameLine();
}

static void push(int id)
{
    ImGui::PushID(id);
}

static void pop(void)
{
    ImGui::PopID();
}

static void bar(float share, const char *string)
{
    ImGui::ProgressBar(share, ImVec2(-1, 0), string);
}

const struct turner_ui turner_window_ui_functions = {
    begin,       open_box, close_box, text,  code,  note,   alert,  row,    section, slide,
    slide_whole, number,   numbers,   color, check, choose, button, beside, push,
    pop,         bar,      divider,
};
