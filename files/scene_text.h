// How scene files write materials and sections, for other files that have them too.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "ductile/section.h"

namespace ductile {

nlohmann::ordered_json material_json(const Material& material);
/// {"regions": […]}
nlohmann::ordered_json section_json(const std::vector<Region>& regions);

}  // namespace ductile
