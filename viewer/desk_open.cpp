// The list from which a file is opened: what was opened last, and what is in a folder.
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "controls.h"
#include "desk.h"

#include <imgui_stdlib.h>  // after imgui.h

namespace ductile::viewer {
namespace fs = std::filesystem;
namespace {

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// What a folder has that may be opened: folders first, then scenes, levels and drawings, each by name.
std::vector<fs::path> offered(const fs::path& folder) {
  std::vector<fs::path> folders{folder / ".."}, files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    const std::string name = entry.path().filename().string(),
                      ending = lower(entry.path().extension().string());
    if (name.starts_with('.')) continue;
    if (entry.is_directory(none))
      folders.push_back(entry.path());
    else if (ending == ".json" || ending == ".svg" || ending == ".svgz")
      files.push_back(entry.path());
  }
  std::sort(folders.begin() + 1, folders.end());
  std::sort(files.begin(), files.end());
  folders.insert(folders.end(), files.begin(), files.end());
  return folders;
}

}  // namespace

void Desk::ask_for_file(bool beside) {
  bench_.bringing = beside;
  if (when_opening_) return when_opening_();
  std::error_code none;
  folder_ = fs::absolute(bench_.file(), none).parent_path();
  opening_ = true;
}

void Desk::take_brought() {
  if (!bench_.brought) return;
  maker_.carry(*std::exchange(bench_.brought, std::nullopt));
  take(Maker::Tool::paste);
}

// Typing shortens the list, and Enter takes its first.
void Desk::open_list() {
  if (std::exchange(opening_, false)) ImGui::OpenPopup("Open");
  const Point middle = camera_.screen.middle();
  ImGui::SetNextWindowPos(px(middle), ImGuiCond_Appearing, {0.5f, 0.5f});
  const double width = std::min(440 * ui_, camera_.screen.size().x - 20 * ui_);
  ImGui::SetNextWindowSize({f(width), f(std::min(420 * ui_, camera_.screen.size().y - 20 * ui_))});
  if (!ImGui::BeginPopupModal("Open", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoSavedSettings))
    return;
  if (ImGui::IsWindowAppearing() || folder_ != listed_) {
    listed_ = folder_;
    in_folder_ = offered(folder_);
    open_filter_.clear();
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-1);
  bool first = ImGui::InputTextWithHint("##filter", "part of a name, or a whole path", &open_filter_,
                                        ImGuiInputTextFlags_EnterReturnsTrue);
  tip("open filter", "Part of a file's name: Enter takes the first of the list; or a whole path.");
  std::error_code none;
  fs::path chosen;
  if (const fs::path typed = open_filter_;
      first && typed.has_parent_path() && fs::is_regular_file(typed, none)) {
    chosen = typed;
    first = false;
  }
  const auto offer = [&](const fs::path& file, const std::string& label) {
    if (lower(label).find(lower(open_filter_)) == std::string::npos) return;
    if (ImGui::Selectable(label.c_str(), false, ImGuiSelectableFlags_DontClosePopups) || first) chosen = file;
    tip(("open " + label).c_str(), file.string().c_str());
    first = false;
  };
  ImGui::BeginChild("files", {0, -ImGui::GetFrameHeightWithSpacing()}, true, ImGuiWindowFlags_NavFlattened);
  for (const fs::path& file : recent_.files()) offer(file, file.filename().string() + "##recent");
  if (!recent_.files().empty()) ImGui::Separator();
  for (const fs::path& file : in_folder_)
    offer(file, file.filename().string() + (fs::is_directory(file, none) ? "/" : ""));
  ImGui::EndChild();
  if (button("Cancel", "open nothing", "Opens nothing (Escape).") || key(GLFW_KEY_ESCAPE))
    ImGui::CloseCurrentPopup();
  ImGui::SameLine();
  ImGui::TextDisabled("%s", folder_.string().c_str());
  if (fs::is_directory(chosen, none)) {
    folder_ = fs::weakly_canonical(chosen, none);
  } else if (!chosen.empty()) {
    ImGui::CloseCurrentPopup();
    if (bench_.receive(chosen) && !bench_.bringing) take(Maker::Tool::none);
    bench_.bringing = false;
  }
  ImGui::EndPopup();
}

}  // namespace ductile::viewer
