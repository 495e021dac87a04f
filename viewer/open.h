// Files that a user opens or drops on the window: told apart by what is in them, not by their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile::viewer {

struct Opened {
  SceneDef scene;
  std::filesystem::path file;  ///< where saving goes: the scene file itself, or a new one beside a drawing
  std::string note;            ///< what a user should know of how it was read
  std::optional<Plan> level;   ///< of a R.U.B.E. level, which has no scene to edit
  std::string text;            ///< of the scene file; empty for others
  /// Where it was read from: the file itself, and the drawings and sections beside it that a scene names.
  std::vector<std::filesystem::path> sources;
};

/// A scene file, a R.U.B.E. level, or a drawing, whose shapes become steel bodies above a floor. Throws
/// InvalidInput and std::system_error. `metres_per_unit` of a drawing; 0: as it says itself, else 10 m large.
Opened open_file(const std::filesystem::path& file, double metres_per_unit = 0);

/// What a file has, as a part to be put beside what is there (part.h): of a drawing its shapes without a
/// floor and what holds them there; of a level its bodies of known material, whose joints are pins with the
/// limits that they have in it. Throws as open_file() does.
SceneDef part_of_file(const std::filesystem::path& file);

/// Files of scenes in a folder, by name. None where there is no such folder.
std::vector<std::filesystem::path> scenes_in(const std::filesystem::path& folder);

}  // namespace ductile::viewer
