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
  /// Cracks where its first fibre yields: calibrate/ takes the yield moment for the plastic one.
  bool brittle = false;
  /// ζ of the lowest vibration of what is made of it. The default and those of timber and concrete are the
  /// least that N. M. Newmark and W. J. Hall recommend for stresses at or just below yield (Earthquake
  /// Spectra and Design, EERI 1982; as A. K. Chopra tabulates them, Dynamics of Structures, Table 11.2.1):
  /// welded steel 5 to 7 %, reinforced concrete 7 to 10 %, bolted timber 10 to 15 %.
  double damping_ratio = 0.05;
  /// D, 1/s, and q of Cowper and Symonds: at a strain rate r its yield stress is 1 + (r/D)^(1/q) times as
  /// large. 0: the same at any rate. Mild steel 40 and 5, aluminium alloys 6500 and 4, stainless steel 100
  /// and 10 (as N. Jones tabulates them, Structural Impact; quoted, not read).
  double rate_D = 0, rate_q = 5;
  double friction = 0.5;   ///< of its fixtures, as b2FixtureDef
  double restitution = 0;  ///< of its fixtures, as b2FixtureDef

  /// f_c with its default applied, Pa.
  constexpr double compression() const {
    return yield_stress_compression > 0 ? yield_stress_compression : yield_stress;
  }
  /// τ_y with its default applied, Pa.
  double shear() const;

  friend bool operator==(const Material&, const Material&) = default;
};

/// f_t, f_c, τ_y and f_u in proportion.
constexpr void scale_strength(Material& material, double factor) {
  material.yield_stress *= factor;
  material.yield_stress_compression *= factor;
  material.shear_yield_stress *= factor;
  material.ultimate_stress *= factor;
}

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

// Nominal or characteristic values; each source is in all() and beside its constant. Brittle ones break where
// they cease to be elastic: ε_f = f_t/E.

namespace detail {
constexpr Material structural_steel(double fy, double fu, double elongation) {
  return {.yield_stress = fy,
          .youngs_modulus = 210e9,
          .criterion = Criterion::von_mises,
          .density = 7850,
          .ultimate_stress = fu,
          .fracture_strain = elongation};
}
}  // namespace detail

/// Structural steels: f_y, f_u EN 1993-1-1:2005 Table 3.1 (t ≤ 40 mm), E clause 3.2.6, density EN 1991-1-1
/// Table A.4, ε_f the least elongation of EN 10025-2 Table 7 (S235 … S355) and EN 10025-3 Table 4 (S420N,
/// S460N).
inline constexpr Material S235 = detail::structural_steel(235e6, 360e6, 0.26);
inline constexpr Material S275 = detail::structural_steel(275e6, 430e6, 0.23);
inline constexpr Material S355 = detail::structural_steel(355e6, 490e6, 0.22);
inline constexpr Material S420 = detail::structural_steel(420e6, 520e6, 0.19);
inline constexpr Material S460 = detail::structural_steel(460e6, 540e6, 0.17);

/// EN AW-6061 T6, extruded: EN 1999-1-1:2007 Table 3.2b and clause 3.2.5.
inline constexpr Material aluminium{.yield_stress = 240e6,
                                    .youngs_modulus = 70e9,
                                    .criterion = Criterion::von_mises,
                                    .density = 2700,
                                    .ultimate_stress = 260e6,
                                    .fracture_strain = 0.08};

/// Grey iron EN-GJL-250: EN 1561 Annex A, the lower ends of the ranges; 0.1 % proof stresses.
inline constexpr Material cast_iron{.yield_stress = 165e6,
                                    .yield_stress_compression = 325e6,
                                    .youngs_modulus = 103e9,
                                    .density = 7200,
                                    .ultimate_stress = 250e6,
                                    .fracture_strain = 0.003,
                                    .brittle = true};

/// Oak of strength class D30: EN 338:2016 Table 3, along the grain; shear f_v.
inline constexpr Material oak{.yield_stress = 18e6,
                              .yield_stress_compression = 24e6,
                              .shear_yield_stress = 3.9e6,
                              .youngs_modulus = 11e9,
                              .density = 640,
                              .fracture_strain = 18e6 / 11e9,
                              .damping_ratio = 0.1};

/// Pine or spruce of strength class C24: EN 338:2016 Table 1, along the grain; shear f_v.
inline constexpr Material pine{.yield_stress = 14.5e6,
                               .yield_stress_compression = 21e6,
                               .shear_yield_stress = 4e6,
                               .youngs_modulus = 11e9,
                               .density = 420,
                               .fracture_strain = 14.5e6 / 11e9,
                               .damping_ratio = 0.1};

/// Plain concrete C30/37: f_ctm, f_ck, E_cm of EN 1992-1-1:2004 Table 3.1; density EN 1991-1-1 Table A.1.
inline constexpr Material concrete{.yield_stress = 2.9e6,
                                   .yield_stress_compression = 30e6,
                                   .youngs_modulus = 33e9,
                                   .density = 2400,
                                   .fracture_strain = 2.9e6 / 33e9,
                                   .brittle = true,
                                   .damping_ratio = 0.07};

/// Float glass: bending strength, E and density of EN 572-1; its far greater strength in compression is not
/// used.
inline constexpr Material glass{.yield_stress = 45e6,
                                .youngs_modulus = 70e9,
                                .density = 2500,
                                .fracture_strain = 45e6 / 70e9,
                                .brittle = true};

}  // namespace materials

}  // namespace ductile
