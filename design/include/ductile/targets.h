// The inverse questions: what strength, thickness or stiffness a body needs for what it shall do.
//
// Each is answered by static_check() of the calibrated scene, so it holds for any structure, statically
// determinate or not. All throw InvalidInput where no number does it, with what governs instead.
#pragma once

#include <string>

#include "ductile/design.h"

namespace ductile {

/// A number that a target asks for.
struct Answer {
  double value = 0;
  std::string governed_by;  ///< the joint and row that decide it: "M of wall-beam/0"
};

/// f_y, Pa, of a body's material, with f_c, τ_y and f_u in the same ratios, at which the scene reaches the
/// reserve (StaticCheck::reserve: 1.5 carries 1.5 times all loads before anything yields).
Answer yield_stress_for(const SceneDef& scene, const std::string& body, double reserve);

/// Out-of-plane depth, m, at which the scene reaches the reserve; a deeper body weighs more.
Answer depth_for(const SceneDef& scene, const std::string& body, double reserve);

/// E, Pa, with which the piece of the body that is under `at` moves by that distance, m, under the scene's
/// loads.
Answer youngs_modulus_for(const SceneDef& scene, const std::string& body, Point at, double displacement);

}  // namespace ductile
