// What the keys do, and the list of them.
#include <GLFW/glfw3.h>

#include <array>

#include "controls.h"
#include "crossing.h"
#include "desk.h"
#include "pick.h"

namespace ductile::viewer {

// Tab gives the keys to the next panel: arrows go from control to control there, Enter presses or types.
void Desk::panel_keys() {
  ImGuiIO& io = ImGui::GetIO();
  const bool popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
  const bool ours = !popup && !popup_ && !io.WantTextInput;  // Escape has just closed what was open
  popup_ = popup;
  const auto give = [this](Panel panel) {
    static constexpr std::array windows{"scene view", "details", "time", "scene"};  // in the order of Panel
    panel_ = panel;
    if (panel == Panel::details || panel == Panel::scene) details_ = panel == Panel::details;
    ImGui::SetWindowFocus(windows[static_cast<std::size_t>(panel)]);
  };
  if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) panel_ = Panel::view;
  if (ours && key(GLFW_KEY_ESCAPE)) bench_.message.clear();
  if (ours && key(GLFW_KEY_TAB) && !io.KeyCtrl && !io.KeyAlt) {
    give(static_cast<Panel>((static_cast<int>(panel_) + (io.KeyShift ? 3 : 1)) % 4));
  } else if (ours && panel_ != Panel::view && key(GLFW_KEY_ESCAPE)) {
    give(Panel::view);
  } else if (ours && (panel_ == Panel::view || io.KeyCtrl || io.KeyAlt)) {
    keys();
  }
  io.ConfigFlags = popup || panel_ != Panel::view ? ImGuiConfigFlags_NavEnableKeyboard : 0;
}

// What Box2D's testbed has a key for has the same here.
void Desk::keys() {
  const ImGuiIO& io = ImGui::GetIO();
  if (io.KeyCtrl) {
    if (key(GLFW_KEY_S)) save();
    if (key(GLFW_KEY_Z)) bench_.undo();
    if (key(GLFW_KEY_Y)) bench_.redo();
    if (key(GLFW_KEY_A)) bench_.select(joints_from(bench_.frame(), 0), false);
    if (key(GLFW_KEY_N)) start_new();
    if (bench_.editable()) {
      if (key(GLFW_KEY_C)) copy();
      if (key(GLFW_KEY_X)) cut();
      if (key(GLFW_KEY_V)) take(Maker::Tool::paste);
      if (key(GLFW_KEY_M)) take(Maker::Tool::mirror);
      if (key(GLFW_KEY_T)) take(Maker::Tool::turn);
      if (key(GLFW_KEY_G)) io.KeyShift ? maker_.ungroup(bench_) : group();
    }
    if (key(GLFW_KEY_O)) ask_for_file();
    if (key(GLFW_KEY_I) && bench_.editable()) ask_for_file(true);
    if (key(GLFW_KEY_E)) {
      exporting_ = true;
      details_ = false;
    }
    return;
  }
  if (io.KeyAlt) {  // ctrl + N and T are a browser's own
    if (key(GLFW_KEY_N)) start_new();
    if (bench_.editable() && key(GLFW_KEY_T)) take(Maker::Tool::turn);
    return;
  }
  const bool made = make_keys();
  if (key(GLFW_KEY_R)) bench_.restart();
  if (key(GLFW_KEY_P)) bench_.playing = !bench_.playing;
  if (key(GLFW_KEY_O, true) || key(GLFW_KEY_PERIOD, true)) bench_.step_by(1);
  if (key(GLFW_KEY_COMMA, true)) bench_.step_by(-1);
  if (key(GLFW_KEY_Y)) bench_.seek_first(JointEvent::yield);
  if (key(GLFW_KEY_B)) bench_.seek_first(JointEvent::broke);
  const Point mouse = point(io.MousePos);
  const bool over = camera_.screen.contains(mouse) && !io.WantCaptureMouse;
  const Point target = over ? camera_.to_world(mouse) : camera_.centre;
  if (key(GLFW_KEY_SPACE)) hand_.throw_at(bench_, camera_, target);
  if (key(GLFW_KEY_M)) hand_.put(bench_, target);
  if (key(GLFW_KEY_V)) {
    take(Maker::Tool::none);
    send_across(bench_, hand_.mass, hand_.size, hand_.drive);
  }
  if (key(GLFW_KEY_LEFT_BRACKET)) bench_.open_neighbour(-1);
  if (key(GLFW_KEY_RIGHT_BRACKET)) bench_.open_neighbour(1);
  if (key(GLFW_KEY_Z, true)) camera_.zoom(1 / 1.1, camera_.screen.middle());
  if (key(GLFW_KEY_X, true)) camera_.zoom(1.1, camera_.screen.middle());
  if (const double pan = 40 * ui_; !made) {
    if (key(GLFW_KEY_LEFT, true)) camera_.pan({pan, 0});
    if (key(GLFW_KEY_RIGHT, true)) camera_.pan({-pan, 0});
    if (key(GLFW_KEY_UP, true)) camera_.pan({0, pan});
    if (key(GLFW_KEY_DOWN, true)) camera_.pan({0, -pan});
  }
  if (key(GLFW_KEY_HOME)) camera_.show(extent(bench_.plan()));
  if (key(GLFW_KEY_F)) look_.forces = !look_.forces;
  if (key(GLFW_KEY_T)) look_.moments = !look_.moments;
  if (key(GLFW_KEY_I)) {  // none, N, Q, M, none
    const int next = look_.diagram ? static_cast<int>(*look_.diagram) + 1 : 0;
    look_.diagram = next > static_cast<int>(rotation) ? std::nullopt : std::optional(static_cast<Row>(next));
  }
  if (key(GLFW_KEY_U)) look_.peaks = !look_.peaks;
  if (key(GLFW_KEY_C)) look_.contrast = !look_.contrast;
  if (key(GLFW_KEY_K)) {
    if (bench_.collapse()) {
      bench_.forget_collapse();
      bench_.message.clear();
    } else {
      bench_.find_collapse();
    }
  }
  if (key(GLFW_KEY_N)) look_.numbers = static_cast<Look::Numbers>((static_cast<int>(look_.numbers) + 1) % 3);
  if (key(GLFW_KEY_H) || key(GLFW_KEY_F1)) helping_ = !helping_;
  if (key(GLFW_KEY_ESCAPE) && !made) {
    if (helping_) {
      helping_ = false;
    } else {
      bench_.select({}, false);
    }
  }
  if (!bench_.plan().wheels.empty()) {
    if (key(GLFW_KEY_A)) bench_.act(act::Drive{1});
    if (key(GLFW_KEY_S)) bench_.act(act::Drive{0});
    if (key(GLFW_KEY_D)) bench_.act(act::Drive{-1});
  }
}

void Desk::help() {
  struct Row {
    const char *keys, *what;
  };
  static constexpr std::array rows{
      Row{"P", "play or pause"},
      Row{"O  .", "one step on"},
      Row{",", "one step back"},
      Row{"R", "restart"},
      Row{"Y  B", "back to the first yield, to the first break"},
      Row{"[  ]", "previous, next scene"},
      Row{"Z  X", "zoom out, in (or the wheel)"},
      Row{"arrows", "move the view (or drag with the right button)"},
      Row{"Home", "all of the scene"},
      Row{"space", "throw a bomb at the pointer"},
      Row{"M", "put a mass at the pointer"},
      Row{"V", "a vehicle that is to get across"},
      Row{"A  S  D", "drive on, brake, drive back"},
      Row{"F  T  N", "forces, moments, numbers"},
      Row{"U  K  I", "peaks of the run; how it collapses; N, Q, M diagrams"},
      Row{"C", "high contrast"},
      Row{"1 … 9  0  -", "look; beam, support, load; move; delete; line, weld; choose; block; cut"},
      Row{"arrows  E  Q", "with a tool: the cursor, to the next node, the previous"},
      Row{"Enter", "with a tool: what a press and a release do"},
      Row{"Delete", "delete what is chosen or at the cursor, or the body"},
      Row{"ctrl+C  X  V  M  T", "copy, cut, paste, mirror, turn what is chosen (alt+T too)"},
      Row{"ctrl+G  shift+G", "group what is chosen, ungroup it"},
      Row{"click", "select a joint (shift: one more), or a body"},
      Row{"drag", "drag a body; from empty ground: select in a box"},
      Row{"ctrl+drag", "select in a box anywhere"},
      Row{"shift+drag", "pull a bomb back and let it go"},
      Row{"ctrl+A", "select all joints"},
      Row{"ctrl+click", "type a slider's value: 0.2, 20 cm, 8 in"},
      Row{"Tab", "the next panel: arrows, Enter; Escape: back to the scene"},
      Row{"ctrl+Z  Y", "undo, redo"},
      Row{"ctrl+N  O  S  E", "new scene (alt+N too), open, save, export"},
      Row{"ctrl+I", "import a file beside what is there"},
      Row{"Escape", "give up what is drawn, lay the tool down, select nothing"},
      Row{"H", "this list"},
  };
  const Point middle = camera_.screen.middle();
  ImGui::SetNextWindowPos(px(middle), ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::Begin("Keys", &helping_,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoSavedSettings);
  if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const Row& row : rows) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row.keys);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row.what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace ductile::viewer
