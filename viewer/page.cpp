// The window in a page of a browser: a frame at a time, as the browser asks for them.
#include <GLFW/glfw3.h>
#include <emscripten.h>
#include <imgui.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "desk.h"
#include "ductile/files.h"
#include "open.h"
#include "trace.h"
#include "window.h"

// clang-format off
EM_JS(double, pixel_ratio, (), { return window.devicePixelRatio || 1; });
EM_JS(int, inner_width, (), { return window.innerWidth; });
EM_JS(int, inner_height, (), { return window.innerHeight; });
EM_JS(void, frame_is_drawn, (double own), {
  window.firstFrame = window.firstFrame || performance.now();
  window.ownWork = own;
});
EM_JS(void, ask_for_files, (), { askForFiles(); });
EM_JS(void, hand_over, (const char* name, const char* text, int size), {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(new Blob([HEAPU8.slice(text, text + size)], {type: 'application/octet-stream'}));
  link.download = UTF8ToString(name);
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1e4);
});
EM_JS(void, carry_in_link, (const char* name, const char* text), { carryInLink(UTF8ToString(name), UTF8ToString(text)); });
// clang-format on

namespace ductile::viewer {

const char* const platform::shading_language = "#version 300 es";

void platform::ask_for(double, bool) {}

double platform::scale_of(GLFWwindow*) { return pixel_ratio(); }

namespace {

class Page {
 public:
  explicit Page(const std::filesystem::path& scene)
      : bench_(scenes_in("/scenes")), window_(bench_, 0, true), desk_(bench_) {
    if (scene.empty() || !bench_.try_open(scene)) {
      const std::string why = bench_.message;
      bench_.open("/scenes/harbour_crane.scene.json");
      if (!why.empty()) bench_.message = why;
    }
    desk_.when_opening([] { ask_for_files(); });
    desk_.when_saved([](const std::filesystem::path& file) {
      const std::string text = read_text(file);
      hand_over(file.filename().c_str(), text.data(), static_cast<int>(text.size()));
    });
    desk_.when_linking(
        [](const std::string& name, const std::string& text) { carry_in_link(name.c_str(), text.c_str()); });
  }

  void frame() {
    fit();
    window_.begin(false);
    const double start = emscripten_get_now();
    constexpr double budget = 0.008;  // s of a frame, for simulating; a step more may be under way
    bench_.tick(std::min(ImGui::GetIO().DeltaTime, 0.1f), budget);
    ImGui::NewFrame();
    const ImVec2 size = ImGui::GetIO().DisplaySize;
    desk_.draw({size.x, size.y}, window_.scale());
    ImGui::Render();
    const double own = emscripten_get_now() - start;  // ms, without what WebGL makes of it
    window_.end();
    frame_is_drawn(own);
  }
  std::string state() { return trace_of(bench_, desk_); }
  /// [[x, y, angle], …] of all pieces after so many steps.
  std::string poses(long step) {
    bench_.playing = false;
    bench_.run().seek(step);
    while (!bench_.run().work(1)) {
    }
    nlohmann::json all = nlohmann::json::array();
    for (const PieceReading& piece : bench_.frame().pieces) {
      all.push_back({piece.position.x, piece.position.y, piece.angle});
    }
    return all.dump();
  }

 private:
  /// The canvas has a pixel for each of the screen's.
  void fit() {
    const int w = static_cast<int>(inner_width() * pixel_ratio()),
              h = static_cast<int>(inner_height() * pixel_ratio());
    if (w == width_ && h == height_) return;
    glfwSetWindowSize(window_.handle(), width_ = w, height_ = h);
  }

  Workbench bench_;
  Window window_;
  Desk desk_;
  int width_ = 0, height_ = 0;
};

}  // namespace
}  // namespace ductile::viewer

static std::optional<ductile::viewer::Page> page;

int main(int argc, char** argv) {
  page.emplace(argc > 1 ? argv[1] : "");
  emscripten_set_main_loop([] { page->frame(); }, 0, false);
}

// For tests.
extern "C" {
const char* page_state() {
  static std::string state;
  state = page->state();
  return state.c_str();
}
const char* page_poses(int step) {
  static std::string poses;
  poses = page->poses(step);
  return poses.c_str();
}
}
