// The window on a desktop: steps and frames until it is closed.
#include <GLFW/glfw3.h>
#include <fmt/format.h>
#include <imgui.h>
#include <png.h>
#include <time.h>

#include <algorithm>
#include <stdexcept>

#include "desk.h"
#include "ductile/files.h"
#include "ductile/view.h"
#include "open.h"
#include "trace.h"
#include "window.h"

namespace ductile {
namespace viewer {

const char* const platform::shading_language = "#version 150";

void platform::ask_for(double scale, bool visible) {
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 2);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, scale > 0 ? GLFW_FALSE : GLFW_TRUE);
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
}

double platform::scale_of(GLFWwindow* window) {
  float x = 1, y = 1;
  glfwGetWindowContentScale(window, &x, &y);
  int w = 1, framebuffer = 1, unused = 0;
  glfwGetWindowSize(window, &w, &unused);
  glfwGetFramebufferSize(window, &framebuffer, &unused);
  return std::max(0.5, double{x} * w / std::max(1, framebuffer));
}

namespace {

/// CPU time of this thread, ms.
double cpu_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

/// PNG of what the last frame has drawn.
std::string picture_of(GLFWwindow* window) {
  int w = 0, h = 0;
  glfwGetFramebufferSize(window, &w, &h);
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
  if (!counted) desk.keep_recent(Recent::usual_list());
  std::vector<double> cost;
  ViewCost result;
  std::string title;
  double looked = 0;  // at the disk, s of glfwGetTime()
  for (long frame = 0; !counted || frame <= def.frames; ++frame) {
    if (window.closing()) {
      if (bench.may_discard("close the window")) break;
      window.stay();
    }
    window.begin(!counted && !def.trace && !bench.playing && !bench.run().busy());
    if (const double now = glfwGetTime(); !counted && now > looked + 0.5) {
      looked = now;
      bench.read_again_if_written();
    }
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
    if (last && !def.screenshot.empty()) write_text(def.screenshot, picture_of(window.handle()));
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
