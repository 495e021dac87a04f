// Controls that several panels have.
#pragma once

#include <imgui.h>

namespace ductile::viewer {

/// Pressed in this frame; `repeat`: or held down for longer.
inline bool key(int glfw_key, bool repeat = false) { return ImGui::IsKeyPressed(glfw_key, repeat); }

}  // namespace ductile::viewer
