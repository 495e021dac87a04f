// What scene files share with section files.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "json.h"

namespace ductile {

/// The keys of a material that a section needs: fy (required), fyc, tau, E, criterion.
void read_strength(Object& object, Material& material);

/// A built-in material by its name; nothing after complaining. `also` are other names that would be right.
std::optional<Material> built_in_material(const Value& name, const std::vector<std::string_view>& also = {});

/// A whole section, {"regions": […]}.
std::vector<Region> read_regions(const Value& value);

}  // namespace ductile
