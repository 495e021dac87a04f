// The window: a scene that runs, is looked at, played with and edited (GLFW, Dear ImGui, OpenGL 3).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace ductile {

struct ViewDef {
  std::filesystem::path scene;       ///< a scene file or a drawing
  std::vector<std::string> select;   ///< names of joints that are selected at first
  std::string tab = "joint";         ///< which is open at first: joint, joints, edit, events, ledger,
                                     ///< make
  bool forces = false;               ///< forces and moments are drawn at first
  long frames = -1;                  ///< so many steps, then the end; negative: until it is closed
  double metres_per_unit = 0;        ///< of a drawing; 0: as it says itself, else it is 10 m large
  double scale = 0;                  ///< pixels per pixel of 1280 × 720; 0: as the display asks for
  std::filesystem::path screenshot;  ///< PNG of the last frame; empty: none
  bool trace = false;                ///< each frame's state as a line of JSON on stdout, for tests
};

/// What it cost to draw, of the frames after the first (which loads fonts): CPU time of this thread from the
/// state of the scene to lists of triangles, ms.
struct ViewCost {
  long frames = 0;
  double median_ms = 0, most_ms = 0;
};

/// Opens the window and returns when it is closed. Throws InvalidInput on a scene that cannot be used, and
/// std::runtime_error where there is no display or no OpenGL 3.2, or where the window was not
/// built (CMake: DUCTILE_VIEWER).
ViewCost view(const ViewDef& def);

}  // namespace ductile
