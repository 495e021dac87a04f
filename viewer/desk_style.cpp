// What a beam is made of: its material, and its section, a rectangle or a profile by its name.
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "controls.h"
#include "desk.h"
#include "ductile/rolled.h"
#include "prices.h"

#include <imgui_stdlib.h>  // after imgui.h

namespace ductile::viewer {
namespace {

/// Whether a name holds what is typed, blanks and case aside.
bool holds(const std::string& name, const std::string& typed) {
  const auto plain = [](const std::string& text) {
    std::string out;
    for (const char c : text) {
      if (c != ' ') out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return out;
  };
  return plain(name).find(plain(typed)) != std::string::npos;
}

}  // namespace

bool Desk::choose_material(Material& material) {
  const auto& all = materials::all();
  const auto is = [&](const NamedMaterial& known) { return known.material == material; };
  const auto now = std::find_if(all.begin(), all.end(), is);
  bool changed = false;
  if (!ImGui::BeginCombo("material", now == all.end() ? "its own" : std::string(now->name).c_str()))
    return false;
  for (const NamedMaterial& known : all) {
    if (!ImGui::Selectable(std::string(known.name).c_str(), is(known))) continue;
    material = known.material;
    changed = true;
  }
  ImGui::EndCombo();
  return changed;
}

// Typing shortens the list, and Enter takes its first.
bool Desk::choose_profile(std::string& profile) {
  static const std::vector<Rolled> all = rolled_profiles();
  if (!ImGui::BeginCombo("section", profile.empty() ? "rectangle" : profile.c_str(),
                         ImGuiComboFlags_HeightLarge))
    return false;
  if (ImGui::IsWindowAppearing()) {
    profile_filter_.clear();
    ImGui::SetKeyboardFocusHere();
  }
  std::string chosen = profile;
  ImGui::SetNextItemWidth(-1);
  bool first = ImGui::InputTextWithHint("##filter", "IPE 200, HEB …", &profile_filter_,
                                        ImGuiInputTextFlags_EnterReturnsTrue);
  tip("section name", "The profile's name, or part of it: Enter takes the first of the list.");
  const auto offer = [&](const std::string& name, const std::string& label) {
    if (!holds(label, profile_filter_)) return;
    if (ImGui::Selectable(label.c_str(), name == profile) || first) {
      chosen = name;
      ImGui::CloseCurrentPopup();
    }
    tip(("section " + label).c_str(), "A rectangle of that height and depth, or a rolled profile.");
    first = false;
  };
  offer("", "rectangle");
  for (const Rolled& each : all) offer(each.name, each.name);
  ImGui::EndCombo();
  const bool changed = chosen != profile;
  profile = std::move(chosen);
  return changed;
}

bool Desk::section_style(BeamStyle& style) {
  bool changed = ImGui::Checkbox("solid", &style.solid);
  tip("beam solid",
      "Things run on it and hit it. Where it is not, all passes it, as it passes a truss beside a road.");
  changed |= choose_profile(style.profile);
  tip("beam section", "A rectangle, or a profile by its name.");
  if (!style.profile.empty()) return changed;
  changed |= slide("height", style.height, 0.01, 10, "%.3g m");
  tip("beam height", "Of the beam, in the plane.");
  changed |= slide("depth", style.depth, 0.001, 10, "%.3g m");
  tip("beam depth", "Of the beam, out of the plane.");
  return changed;
}

void Desk::beam_style(BeamStyle& style) {
  if (choose_material(style.material)) style.price = price_of(bench_.scene(), style.material);
  tip("beam material", "Of the next beam.");
  section_style(style);
  ImGui::SliderInt("pieces", &style.pieces, 1, 60, "%d", ImGuiSliderFlags_AlwaysClamp);
  tip("beam pieces", "Into how many the next beam is split.");
}

}  // namespace ductile::viewer
