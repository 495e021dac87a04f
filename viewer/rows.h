// Tables of a name and its values.
#pragma once

#include <imgui.h>

#include <initializer_list>
#include <string>

namespace ductile::viewer {

inline constexpr ImGuiTableFlags table_flags =
    ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV | ImGuiTableFlags_SizingStretchProp;

inline void row(const char* name, std::initializer_list<std::string> cells) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(name);
  for (const std::string& cell : cells) {
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(cell.c_str());
  }
}

}  // namespace ductile::viewer
