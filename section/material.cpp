#include "ductile/material.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace ductile {

double Material::shear() const {
  if (shear_yield_stress > 0) return shear_yield_stress;
  const double f = std::min(yield_stress, compression());
  return criterion == Criterion::tresca ? f / 2 : f / std::numbers::sqrt3;
}

namespace materials {
std::span<const NamedMaterial> all() {
  static const std::array list{
      NamedMaterial{"S235", S235, "EN 1993-1-1:2005 Table 3.1, t ≤ 40 mm"},
      NamedMaterial{"S275", S275, "EN 1993-1-1:2005 Table 3.1, t ≤ 40 mm"},
      NamedMaterial{"S355", S355, "EN 1993-1-1:2005 Table 3.1, t ≤ 40 mm"},
  };
  return list;
}

const Material* find(std::string_view name) {
  const auto list = all();
  const auto found =
      std::find_if(list.begin(), list.end(), [&](const NamedMaterial& m) { return m.name == name; });
  return found == list.end() ? nullptr : &found->material;
}
}  // namespace materials

}  // namespace ductile
