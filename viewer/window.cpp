// GLFW and OpenGL around the desk.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <png.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "desk.h"
#include "ductile/files.h"
#include "ductile/view.h"
#include "open.h"

namespace ductile {
namespace viewer {
namespace {

constexpr int width = 1280, height = 720;  // at scale 1

/// CPU time of this thread, ms.
double cpu_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

std::runtime_error glfw_error(const std::string& what) {
  const char* why = nullptr;
  glfwGetError(&why);
  return std::runtime_error(what + (why ? std::string(": ") + why : ""));
}

/// A window with Dear ImGui in it.
class Window {
 public:
  Window(Workbench& bench, double scale, bool visible) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale > 0 ? GLFW_FALSE : GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
    const auto pixels = [scale](int size) { return static_cast<int>(size * (scale > 0 ? scale : 1)); };
    window_ = glfwCreateWindow(pixels(width), pixels(height), "ductile", nullptr, nullptr);
    if (!window_) throw glfw_error("there is no window with OpenGL 3.2");
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    glfwSetWindowUserPointer(window_, &bench);
    glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** files) {
      for (int i = 0; i < count; ++i) {
        static_cast<Workbench*>(glfwGetWindowUserPointer(window))->try_open(files[i]);
      }
    });
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL3_Init("#version 150");
    scale_ = scale > 0 ? scale : scale_of_display();
    dress();
  }
  ~Window() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
  }
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  double scale() const { return scale_; }
  bool closing() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }
  void stay() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }
  void title(const std::string& text) { glfwSetWindowTitle(window_, text.c_str()); }
  void begin(bool idle) {
    if (idle) {
      glfwWaitEventsTimeout(0.05);
    } else {
      glfwPollEvents();
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
  }
  /// Puts what was drawn on the screen.
  void end() {
    int w = 0, h = 0;
    glfwGetFramebufferSize(window_, &w, &h);
    glViewport(0, 0, w, h);
    glClearColor(1, 1, 1, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  }
  void swap() { glfwSwapBuffers(window_); }
  /// PNG of what end() has drawn.
  std::string picture() const {
    int w = 0, h = 0;
    glfwGetFramebufferSize(window_, &w, &h);
    const int line = 3 * w;
    std::string pixels(static_cast<std::size_t>(line) * static_cast<std::size_t>(h), '\0');
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, w, h, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = static_cast<png_uint_32>(w);
    image.height = static_cast<png_uint_32>(h);
    image.format = PNG_FORMAT_RGB;
    std::string png(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
    png_alloc_size_t size = png.size();
    // OpenGL's first line is the lowest one.
    if (!png_image_write_to_memory(&image, png.data(), &size, 0, pixels.data(), -line, nullptr)) {
      throw std::runtime_error(std::string("no picture: ") + image.message);
    }
    png.resize(size);
    return png;
  }

 private:
  /// Of the units that GLFW and Dear ImGui count in.
  double scale_of_display() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    int w = 1, framebuffer = 1, unused = 0;
    glfwGetWindowSize(window_, &w, &unused);
    glfwGetFramebufferSize(window_, &framebuffer, &unused);
    return std::max(0.5, double{x} * w / std::max(1, framebuffer));
  }
  /// Font and colours.
  void dress() const {
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

  struct Library {
    Library() {
      if (glfwInit() == GLFW_FALSE) throw glfw_error("there is no display");
    }
    ~Library() { glfwTerminate(); }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;
  } library_;
  GLFWwindow* window_ = nullptr;
  double scale_ = 1;
};

/// What a test wants to know of a frame: the state, and where everything is.
std::string trace_of(Workbench& bench, const Desk& desk) {
  using Json = nlohmann::ordered_json;
  const auto pixels = [&](Point world) {
    const Point p = desk.camera().to_screen(world);
    return Json{p.x, p.y};
  };
  Json controls = Json::object(), joints = Json::object(), pieces = Json::object(), selected = Json::array();
  for (const auto& [name, box] : desk.controls()) {
    controls[name] = {box.low.x, box.low.y, box.high.x, box.high.y};
  }
  for (std::size_t i = 0; i < bench.plan().joints.size(); ++i) {
    joints[bench.plan().joints[i].name] = pixels(place(bench.plan(), i, bench.frame()).anchor);
  }
  for (std::size_t i = 0; i < bench.plan().pieces.size(); ++i) {
    pieces[bench.plan().pieces[i].name] = pixels(bench.frame().pieces[i].position);
  }
  for (const std::size_t i : bench.selected) selected.push_back(bench.plan().joints[i].name);
  const Box& view = desk.camera().screen;
  const Json state{{"file", bench.file().string()},
                   {"step", bench.run().cursor()},
                   {"last", bench.run().last()},
                   {"time", bench.frame().time},
                   {"busy", bench.run().busy()},
                   {"playing", bench.playing},
                   {"pace", bench.pace},
                   {"solver", static_cast<int>(bench.solver())},
                   {"dt", bench.run().stepping().dt},
                   {"events", bench.run().events().size()},
                   {"thrown", bench.frame().thrown.size()},
                   {"selected", selected},
                   {"changed", bench.changed()},
                   {"message", bench.message},
                   {"scale", desk.camera().scale},
                   {"view", {view.low.x, view.low.y, view.high.x, view.high.y}},
                   {"joints", joints},
                   {"pieces", pieces},
                   {"controls", controls}};
  return state.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::vector<std::size_t> find_joints(const Plan& plan, const ViewDef& def) {
  std::vector<std::size_t> found;
  for (const std::string& name : def.select) {
    const auto joint = std::find_if(plan.joints.begin(), plan.joints.end(),
                                    [&](const PlannedJoint& j) { return j.name == name; });
    if (joint == plan.joints.end()) {
      throw InvalidInput({{"command line:--select", def.scene.string() + " has no joint '" + name + "'",
                           "ductile calibrate lists their names"}});
    }
    found.push_back(static_cast<std::size_t>(joint - plan.joints.begin()));
  }
  return found;
}

}  // namespace
}  // namespace viewer

ViewCost view(const ViewDef& def) {
  using namespace viewer;
  const std::filesystem::path folder = def.scene.has_parent_path() ? def.scene.parent_path() : ".";
  Workbench bench(scenes_in(folder));
  bench.open(def.scene, def.metres_per_unit);
  bench.select(find_joints(bench.plan(), def), false);
  const bool counted = def.frames >= 0;
  Window window(bench, def.scale, !counted);
  Desk desk(bench, def.forces, def.tab);
  std::vector<double> cost;
  ViewCost result;
  std::string title;
  for (long frame = 0; !counted || frame <= def.frames; ++frame) {
    if (window.closing()) {
      if (bench.may_discard("close the window")) break;
      window.stay();
    }
    window.begin(!counted && !def.trace && !bench.playing && !bench.run().busy());
    const ImGuiIO& io = ImGui::GetIO();
    if (counted) {
      if (frame > 0) bench.tick(bench.run().stepping().dt, 1e9);  // one step a frame
    } else {
      constexpr double budget = 0.012;  // s of a frame, for simulating
      bench.tick(std::min(io.DeltaTime, 0.1f), budget);
    }
    const double start = cpu_ms();
    ImGui::NewFrame();
    desk.draw({io.DisplaySize.x, io.DisplaySize.y}, window.scale());
    ImGui::Render();
    if (frame > 0) cost.push_back(cpu_ms() - start);
    if (def.trace) {
      const std::string line = trace_of(bench, desk);
      std::fwrite(line.data(), 1, line.size(), stdout);
      std::fflush(stdout);
    }
    const bool last = counted && frame == def.frames;
    if (counted && !last) continue;  // nobody sees those between
    window.end();
    if (last && !def.screenshot.empty()) write_text(def.screenshot, window.picture());
    window.swap();
    const std::string now = bench.file().filename().string() + (bench.changed() ? "*" : "") + " - ductile";
    if (now != title) window.title(title = now);
  }
  if (!cost.empty()) {
    const auto middle = cost.begin() + static_cast<std::ptrdiff_t>(cost.size() / 2);
    std::nth_element(cost.begin(), middle, cost.end());
    result = {static_cast<long>(cost.size()), *middle, *std::max_element(cost.begin(), cost.end())};
  }
  return result;
}

}  // namespace ductile
