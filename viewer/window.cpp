#include "window.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace ductile::viewer {
namespace {

constexpr int width = 1280, height = 720;  // at scale 1

std::string last_error;  // of GLFW

std::runtime_error glfw_error(const std::string& what) {
  return std::runtime_error(what + (last_error.empty() ? "" : ": " + last_error));
}

}  // namespace

Window::Library::Library() {
  glfwSetErrorCallback([](int, const char* why) { last_error = why; });
  if (glfwInit() == GLFW_FALSE) throw glfw_error("there is no display");
}

Window::Library::~Library() { glfwTerminate(); }

Window::Window(Workbench& bench, double scale, bool visible) {
  platform::ask_for(scale, visible);
  const auto pixels = [scale](int size) { return static_cast<int>(size * (scale > 0 ? scale : 1)); };
  window_ = glfwCreateWindow(pixels(width), pixels(height), "ductile", nullptr, nullptr);
  if (!window_) throw glfw_error("there is no window with OpenGL 3.2");
  glfwMakeContextCurrent(window_);
  glfwSwapInterval(1);
  glfwSetWindowUserPointer(window_, &bench);
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
    std::vector<std::string> dropped(files, files + count);
    // A scene after the drawings that were dropped with it.
    std::stable_partition(dropped.begin(), dropped.end(),
                          [](const std::string& file) { return !file.ends_with(".scene.json"); });
    auto& to = *static_cast<Workbench*>(glfwGetWindowUserPointer(window));
    for (const std::string& file : dropped) to.receive(file);
    to.bringing = false;
  });
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui_ImplGlfw_InitForOpenGL(window_, true);
  ImGui::GetIO().KeyMap[ImGuiKey_Space] = GLFW_KEY_ENTER;  // presses what has the keys: the space bar throws
  ImGui_ImplOpenGL3_Init(platform::shading_language);
  scale_ = scale > 0 ? scale : platform::scale_of(window_);
  dress();
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
}

bool Window::closing() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }

void Window::stay() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

void Window::title(const std::string& text) { glfwSetWindowTitle(window_, text.c_str()); }

void Window::begin(bool idle) {
  if (idle) {
    glfwWaitEventsTimeout(0.05);
  } else {
    glfwPollEvents();
  }
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
}

void Window::end() {
  int w = 0, h = 0;
  glfwGetFramebufferSize(window_, &w, &h);
  glViewport(0, 0, w, h);
  glClearColor(1, 1, 1, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Window::swap() { glfwSwapBuffers(window_); }

// Font and colours.
void Window::dress() const {
  ImGuiIO& io = ImGui::GetIO();
  static constexpr ImWchar glyphs[] = {0x20, 0xff, 0x2013, 0x2013, 0x2026, 0x2026, 0};  // Latin-1, –, …
  static constexpr const char* font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  const auto size = static_cast<float>(std::round(13 * scale_));
  std::error_code none;
  if (!std::filesystem::exists(font, none) || !io.Fonts->AddFontFromFileTTF(font, size, nullptr, glyphs)) {
    ImFontConfig config;
    config.SizePixels = size;
    io.Fonts->AddFontDefault(&config);
  }
  ImGui::StyleColorsLight();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0;
  style.FrameRounding = style.GrabRounding = 3;
  style.FrameBorderSize = 1;
  style.WindowPadding = {8, 6};
  style.ItemSpacing = {6, 4};
  style.CellPadding = {4, 1};
  style.Colors[ImGuiCol_WindowBg] = ImColor(0xf2, 0xf4, 0xf7);
  style.Colors[ImGuiCol_Text] = ImColor(0x1b, 0x20, 0x27);
  style.Colors[ImGuiCol_TextDisabled] = ImColor(0x5c, 0x66, 0x72);
  style.Colors[ImGuiCol_FrameBg] = ImColor(0xff, 0xff, 0xff);
  style.Colors[ImGuiCol_Border] = ImColor(0xcc, 0xd2, 0xda);
  style.Colors[ImGuiCol_SliderGrab] = ImColor(0xb4, 0xd2, 0xee);
  style.Colors[ImGuiCol_SliderGrabActive] = ImColor(0x7f, 0xae, 0xd8);
  style.Colors[ImGuiCol_PlotHistogram] = ImColor(0xed, 0x7d, 0x14);
  style.ScaleAllSizes(static_cast<float>(scale_));
}

}  // namespace ductile::viewer
