// How scene files write materials and sections, for other files that have them too.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ductile/calibrate.h"

namespace ductile {

/// None where it is not built in.
std::optional<std::string> built_in_name(const Material& material);

nlohmann::ordered_json scene_json(const SceneDef& scene);
nlohmann::ordered_json material_json(const Material& material);
nlohmann::ordered_json load_json(const LoadDef& load);
/// {"regions": […]}
nlohmann::ordered_json section_json(const std::vector<Region>& regions);

}  // namespace ductile
