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
  static constexpr std::string_view steel = "EN 1993-1-1:2005 Table 3.1, t ≤ 40 mm; elongation EN 10025";
  static constexpr std::array list{
      NamedMaterial{"S235", S235, steel},
      NamedMaterial{"S275", S275, steel},
      NamedMaterial{"S355", S355, steel},
      NamedMaterial{"S420", S420, steel},
      NamedMaterial{"S460", S460, steel},
      NamedMaterial{"aluminium", aluminium, "EN AW-6061 T6, EN 1999-1-1:2007 Table 3.2b"},
      NamedMaterial{"cast iron", cast_iron, "EN-GJL-250, EN 1561 Annex A"},
      NamedMaterial{"oak", oak, "D30, EN 338:2016 Table 3"},
      NamedMaterial{"pine", pine, "C24, EN 338:2016 Table 1"},
      NamedMaterial{"concrete", concrete, "C30/37, EN 1992-1-1:2004 Table 3.1"},
      NamedMaterial{"glass", glass, "float glass, EN 572-1"},
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
