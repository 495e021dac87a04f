// Controls that several panels have.
#pragma once

#include <imgui.h>

namespace ductile::viewer {

/// A slider that is fine at both ends of its range, 0 < low < high; ctrl + click types a value.
inline bool slide(const char* label, double& value, double low, double high, const char* format) {
  return ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format,
                             ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
}

/// Pressed in this frame; `repeat`: or held down for longer.
inline bool key(int glfw_key, bool repeat = false) { return ImGui::IsKeyPressed(glfw_key, repeat); }

}  // namespace ductile::viewer
