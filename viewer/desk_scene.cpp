// The left side of the desk: which scene, how it is run, what is drawn of it, what is thrown at it.
#include <GLFW/glfw3.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>

#include "controls.h"
#include "crossing.h"
#include "desk.h"
#include "ductile/files.h"
#include "exporting.h"

#include <imgui_stdlib.h>  // after imgui.h

namespace ductile::viewer {

void Desk::scene(const Bounds& box) {
  ImGui::SetNextWindowPos(px(box.low));
  ImGui::SetNextWindowSize(px(box.size()));
  ImGui::Begin("scene", nullptr,
               ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus);
  ImGui::TextUnformatted("Scene");
  const auto rows = static_cast<float>(std::min<std::size_t>(5, bench_.scenes().size() + 1));
  ImGui::BeginChild("scenes", {0, rows * ImGui::GetTextLineHeightWithSpacing()}, true,
                    ImGuiWindowFlags_NavFlattened);
  for (const std::filesystem::path& file : bench_.scenes()) {
    const bool here = file == bench_.file();
    if (ImGui::Selectable(scene_name(file).c_str(), here) && !here) bench_.try_open(file);
    tip(("scene " + scene_name(file)).c_str(), "Opens this scene. [ and ] go through the list.");
    if (here && file_ != file) ImGui::SetScrollHereY();
    if (here) file_ = file;
  }
  if (bench_.scenes().empty()) ImGui::TextWrapped("Drop a file here.");
  ImGui::EndChild();
  ImGui::SetNextItemWidth(-1);
  ImGui::PushAllowKeyboardFocus(false);  // Tab goes on to the next panel
  ImGui::InputText("##save as", &save_as_);
  ImGui::PopAllowKeyboardFocus();
  tip("save as", "Where the scene is saved. Files dropped on the window are opened: scenes, drawings.");
  if (button("Save", "save", "Saves the scene as it was edited to the file above (ctrl+S).")) save();
  ImGui::SameLine();
  ImGui::BeginDisabled(!bench_.can_undo());
  if (button("Undo", "undo", "Takes the last edit back (ctrl+Z).")) bench_.undo();
  ImGui::EndDisabled();
  ImGui::SameLine();
  ImGui::BeginDisabled(!bench_.can_redo());
  if (button("Redo", "redo", "Does it again (ctrl+Y).")) bench_.redo();
  ImGui::EndDisabled();
  ImGui::SameLine();
  exports();
  ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
  run();
  show();
  throwing();
  ImGui::PopItemWidth();
  ImGui::End();
}

// Into files beside the scene, of its name and the format's ending.
void Desk::exports() {
  if (button("Export", "export",
             "For other programs: definitions, C++, a level, a picture, a replay (ctrl+E, and a number)."))
    exporting_ = true;
  if (std::exchange(exporting_, false)) ImGui::OpenPopup("formats");
  ImGui::SetNextWindowPos({ImGui::GetItemRectMin().x, ImGui::GetItemRectMax().y});
  if (!ImGui::BeginPopup("formats")) return;
  int number = 0;
  for (const ExportFormat& format : export_formats()) {
    const bool typed = key(GLFW_KEY_1 + number++);
    const bool wanted = ImGui::Selectable(fmt::format("{} {}", number, format.name).c_str()) || typed;
    tip((std::string("export ") + format.name).c_str(), format.what);
    if (!wanted) continue;
    ImGui::CloseCurrentPopup();
    const std::filesystem::path scene = save_as_;
    const std::filesystem::path file = scene.parent_path() / (scene_name(scene) + format.ending);
    attempt(bench_, [&] {
      write_text(file, format.text(bench_));
      tell("Exported to " + file.string());
      if (when_saved_) when_saved_(file);
    });
  }
  if (when_linking_) {
    const bool typed = key(GLFW_KEY_1 + number++),
               wanted = ImGui::Selectable(fmt::format("{} link", number).c_str());
    tip("export link", "An address of this page that opens the scene as it is now.");
    if (typed || wanted) {
      ImGui::CloseCurrentPopup();
      attempt(bench_, [&] {
        when_linking_(scene_name(save_as_), link_text(bench_));
        tell("The address of this page now opens this scene. It has been copied, too.");
      });
    }
  }
  ImGui::EndPopup();
}

void Desk::run() {
  if (!ImGui::CollapsingHeader("Run", ImGuiTreeNodeFlags_DefaultOpen)) return;
  int solver = static_cast<int>(bench_.solver());
  if (choose(
          "solver",
          "What finds the joints' forces: all together, exactly; one by one as in the paper; or Box2D's own "
          "welds, which never yield. The same run is done again up to this step.",
          solver, {"direct", "iterative", "stock"})) {
    bench_.set_solver(static_cast<JointSolver>(solver));
  }
  Stepping stepping = bench_.run().stepping();
  double hz = 1 / stepping.dt;
  bool changed = slide("steps/s", hz, 10, 2000, "%.0f");
  tip("steps/s", fmt::format("Steps per second from here on; now dt = {:.4g} s.", stepping.dt).c_str());
  stepping.dt = changed ? 1 / std::round(hz) : stepping.dt;
  changed |= ImGui::SliderInt("velocity it.", &stepping.velocity_iterations, 1, 100, "%d",
                              ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  tip("velocity iterations", "Box2D's velocity iterations from here on (8).");
  changed |= ImGui::SliderInt("position it.", &stepping.position_iterations, 0, 100, "%d",
                              ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  tip("position iterations", "Box2D's position iterations from here on (3).");
  if (changed) bench_.set_stepping(stepping);
  beside();
}

void Desk::beside() {
  std::optional<Workbench::Beside> how = bench_.how_beside();
  int solver = how ? 1 + static_cast<int>(how->solver) : 0;
  bool changed = choose(
      "beside", "Another run of the same beside this one, with this solver or another, drawn as outlines.",
      solver, {"nothing", "direct", "iterative", "stock"});
  if (changed && solver == 0) how.reset();
  if (changed && solver > 0)
    how = {.solver = static_cast<JointSolver>(solver - 1), .dt = how.value_or(Workbench::Beside{}).dt};
  if (how) {
    double hz = 1 / (how->dt > 0 ? how->dt : bench_.run().stepping().dt);
    const bool slid = slide("its steps/s", hz, 10, 2000, "%.0f");
    tip("steps/s beside", "Steps per second of the run beside this one, from the start on.");
    if (slid) how->dt = 1 / std::round(hz);
    changed |= slid;
  }
  if (changed) bench_.run_beside(how);
}

void Desk::show() {
  if (!ImGui::CollapsingHeader("Show", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const auto checkbox = [](const char* label, bool& on, ImU32 colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::Checkbox(label, &on);
    ImGui::PopStyleColor();
  };
  checkbox("forces", look_.forces, ink::force);
  tip("forces", "Draws the force on each joint's second body (F).");
  ImGui::SameLine();
  slide("##force scale", look_.force_scale, 0.05, 20, "%.2f x");
  tip("force scale", "Length of the forces: at 1 what is usual in this scene is 50 pixels long.");
  checkbox("moments", look_.moments, ink::moment);
  tip("moments", "Draws each joint's moment as an arc that turns the second body (T).");
  ImGui::SameLine();
  slide("##moment scale", look_.moment_scale, 0.05, 20, "%.2f x");
  tip("moment scale", "Size of the moments: at 1 what is usual in this scene is 22 pixels in radius.");
  checkbox("loads", look_.loads, ink::load);
  tip("loads", "Draws the scene's loads as they are now.");
  ImGui::SameLine();
  ImGui::Checkbox("names", &look_.names);
  tip("names", "Writes the joints' names beside them.");
  ImGui::Checkbox("peaks", &look_.peaks);
  tip("peaks", "Colours tell how far each joint has ever been in this run, not where it is now (U).");
  ImGui::SameLine();
  ImGui::Checkbox("contrast", &look_.contrast);
  tip("contrast", "Few colours, far apart, and strong outlines, for weak sight and bright light (C).");
  int diagram = look_.diagram ? 1 + static_cast<int>(*look_.diagram) : 0;
  if (choose("diagram", "What the pieces carry between their joints, loads at their full size (I).", diagram,
             {"none", "axial force N", "shear force Q", "moment M"}))
    look_.diagram = diagram == 0 ? std::nullopt : std::optional(static_cast<Row>(diagram - 1));
  int numbers = static_cast<int>(look_.numbers), as = static_cast<int>(look_.as);
  if (choose("numbers", "Writes N, Q and M beside the joints (N). What would cover another is left out.",
             numbers, {"none", "selected", "all"})) {
    look_.numbers = static_cast<Look::Numbers>(numbers);
  }
  if (choose("as", "Numbers as they are, or as a share of what the joint can carry.", as,
             {"N, N m", "% of cap"})) {
    look_.as = static_cast<Look::As>(as);
  }
}

void Desk::throwing() {
  if (!ImGui::CollapsingHeader("Throw", ImGuiTreeNodeFlags_DefaultOpen)) return;
  slide("mass", hand_.mass, 1e-3, 1e9, "%.6g kg");
  tip("mass", "Of the next bomb or mass.");
  slide("size", hand_.size, 1e-2, 100, "%.3g m");
  tip("size", "Diameter of a bomb, side of a mass.");
  slide("speed", hand_.speed, 0.1, 1000, "%.3g m/s");
  tip("speed",
      "Of a bomb that is thrown with the space bar; one that is pulled back goes as far as it was pulled in "
      "a quarter of a second.");
  if (button("Bomb", "bomb",
             "Throws a bomb at the middle of the view; the space bar throws it at the pointer.")) {
    hand_.throw_at(bench_, camera_, camera_.centre);
  }
  ImGui::SameLine();
  if (button("Add mass", "add mass", "Then click where it is put (M: at the pointer).")) {
    placing_ = true;
  }
  if (button("Vehicle", "vehicle",
             "The run starts again with a vehicle of that mass and size (from wheel to wheel) on the left "
             "end of what "
             "moves; it is to get to the right end (V).")) {
    take(Maker::Tool::none);
    send_across(bench_, hand_.mass, hand_.size, hand_.drive);
  }
  ImGui::SameLine();
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
  slide("drive", hand_.drive, 0.1, 50, "%.3g m/s");
  tip("drive", "How fast the vehicle gets across.");
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.5f);
  slide("grip", hand_.strength, 1, 1e5, "%.0f m/s²");
  tip("grip", "Greatest pull of the pointer on a body that is dragged, over its mass.");
}

}  // namespace ductile::viewer
