// The inverse questions: what strength, thickness or stiffness a body needs for what it shall do.
//
// Each is answered by statics, or the slowest vibration, of the calibrated scene, so it holds for any
// structure, statically determinate or not. All throw InvalidInput where no number does it, with what governs
// instead.
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

/// E, Pa, with which a joint ("wall-beam/0") turns elastically by that angle, rad, under the scene's loads.
Answer youngs_modulus_for_rotation(const SceneDef& scene, const std::string& body, const std::string& joint,
                                   double rotation);

/// E, Pa, with which it has turned by that angle, rad, when it yields: M = k θ.
Answer youngs_modulus_for_rotation_at_yield(const SceneDef& scene, const std::string& body,
                                            const std::string& joint, double rotation);

/// The slowest free vibration of the structure that a body is part of, as long as nothing yields, damped as
/// the joints are: c = 2ζ√(k m_eff) each.
struct Mode {
  double frequency = 0;      ///< Hz, undamped
  double damping_ratio = 0;  ///< of critical, φᵀCφ / 2ω φᵀMφ: small damping does not change the shape φ
};
/// Throws InvalidInput where nothing holds the body, or it may move without strain.
Mode slowest_mode(const Plan& plan, const std::string& body);

/// E, Pa, of a body, with which its structure's slowest vibration has that frequency, Hz.
Answer youngs_modulus_for_frequency(const SceneDef& scene, const std::string& body, double frequency);

/// The material's damping ratio of a body's joints, with which its structure's slowest vibration is damped by
/// that share of critical: joints are stiffer than the structure, so theirs is the larger number.
Answer damping_ratio_for(const SceneDef& scene, const std::string& body, double damping_ratio);

/// The least number of equal pieces of a body with which the displacement at a point under the scene's loads
/// is within that relative error of what it is without pieces (Richardson's extrapolation from 64 and 128).
Answer pieces_for(const SceneDef& scene, const std::string& body, Point at, double error);

}  // namespace ductile
