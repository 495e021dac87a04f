// What a body is made of. SI units: Pa, kg/m³.
#pragma once

#include <span>
#include <string_view>

namespace ductile {

/// Shear yield stress from the tensile one: Tresca f/2, von Mises f/√3.
enum class Criterion { tresca, von_mises };

struct Material {
  double yield_stress = 0;              ///< f_t, Pa; required, > 0
  double yield_stress_compression = 0;  ///< f_c, Pa, as a positive number; 0: equal to yield_stress
  double shear_yield_stress = 0;        ///< τ_y, Pa; 0: from the criterion and the smaller of f_t and f_c
  double youngs_modulus = 0;            ///< E, Pa; 0: not known (no elastic values)
  Criterion criterion = Criterion::tresca;  ///< as in the paper
  double density = 0;                       ///< kg/m³; needed by calibrate/, not by section/
  double ultimate_stress = 0;               ///< f_u, Pa; 0: equal to yield_stress (no hardening)
  double fracture_strain = 0.2;             ///< ε_f, engineering strain at rupture
  double damping_ratio = 0.05;              ///< ζ of the elastic joints made of it
  double friction = 0.5;                    ///< of its fixtures, as b2FixtureDef
  double restitution = 0;                   ///< of its fixtures, as b2FixtureDef

  /// f_c with its default applied, Pa.
  constexpr double compression() const {
    return yield_stress_compression > 0 ? yield_stress_compression : yield_stress;
  }
  /// τ_y with its default applied, Pa.
  double shear() const;

  friend bool operator==(const Material&, const Material&) = default;
};

/// A material with the name that scene and section files use for it.
struct NamedMaterial {
  std::string_view name;  ///< "S355"
  Material material;
  std::string_view source;  ///< where its numbers come from
};

namespace materials {
/// All built-in materials.
std::span<const NamedMaterial> all();
/// The material of that name, or nullptr.
const Material* find(std::string_view name);

namespace detail {
constexpr Material structural_steel(double fy, double fu) {
  return {.yield_stress = fy,
          .youngs_modulus = 210e9,
          .criterion = Criterion::von_mises,
          .density = 7850,
          .ultimate_stress = fu};
}
}  // namespace detail

/// Structural steels, EN 1993-1-1:2005 Table 3.1, t ≤ 40 mm; E clause 3.2.6, density EN 1991-1-1 Table A.4.
inline constexpr Material S235 = detail::structural_steel(235e6, 360e6);
inline constexpr Material S275 = detail::structural_steel(275e6, 430e6);
inline constexpr Material S355 = detail::structural_steel(355e6, 490e6);
}  // namespace materials

}  // namespace ductile
