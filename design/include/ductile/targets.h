// The inverse questions: what strength, thickness or stiffness a body needs for what it shall do.
//
// Each is answered by statics, or the slowest vibration, of the calibrated scene, so it holds for any
// structure, statically determinate or not. All throw InvalidInput where no number does it, with what governs
// instead.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

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
/// the elastic rows of its joints are: c = ζk/(πf), N s/m or N m s, each with its own ζ and k and with f the
/// joint's PlannedJoint::damping_frequency. Where that is the structure's own and all joints have the same ζ,
/// so has the vibration.
struct Mode {
  double frequency = 0;      ///< Hz, undamped
  double damping_ratio = 0;  ///< of critical, φᵀCφ / 2ω φᵀMφ: small damping does not change the shape φ
};
/// Throws InvalidInput where nothing holds the body, or it may move without strain.
Mode slowest_mode(const Plan& plan, const std::string& body);
/// The slowest of all structures of the plan that are held.
Mode slowest_mode(const Plan& plan);

/// E, Pa, of a body, with which its structure's slowest vibration has that frequency, Hz.
Answer youngs_modulus_for_frequency(const SceneDef& scene, const std::string& body, double frequency);

/// The material's damping ratio with which the slowest vibration of a body's structure is damped by that
/// share of critical: the share itself where all that is elastic in the structure is of that body, a larger
/// number where other bodies' joints store energy and are damped less.
Answer damping_ratio_for(const SceneDef& scene, const std::string& body, double damping_ratio);

/// The largest number of pieces that questions of how many try.
inline constexpr int most_pieces_tried = 128;

/// The least number of equal pieces of a body with which the displacement at a point under the scene's loads
/// is within that relative error of what it is without pieces (Richardson's extrapolation from half and all
/// of `most_pieces_tried`).
Answer pieces_for(const SceneDef& scene, const std::string& body, Point at, double error);

/// What a scene as a whole shows, of first order, or where that makes a difference of second.
enum class Measure {
  reserve,       ///< StaticCheck::reserve
  collapse,      ///< LimitAnalysis::load_factor; of second order Pushover::load_factor
  displacement,  ///< m, the largest of any corner of a piece, under the scene's loads, elastic
  rotation,      ///< rad, the largest elastic rotation of a joint, |M|/k
  frequency,     ///< Hz, Mode::frequency of the slowest of all structures
  damping,       ///< Mode::damping_ratio of the same
  mass,          ///< kg, of all that moves
};
double measured(const Plan& plan, Measure measure, Order order = Order::first);
/// Whether it depends on the order: reserve, collapse, displacement and rotation do.
bool has_order(Measure measure);

/// A scene that reaches a target.
struct Reach {
  double value = 0;    ///< of the first body, or the index of the candidate
  double reached = 0;  ///< the measure
  SceneDef scene;
};

/// A number of a body that may change; of a material, in its profile as well.
enum class Property {
  depth,         ///< m; of bodies without profile
  yield_stress,  ///< Pa; with f_c, τ_y and f_u in the same ratios
  youngs_modulus,
  damping_ratio,
};

/// The scene in which that property of these bodies (indices, at least one), of each in proportion to what it
/// is, brings the measure to the target, within 1e-9. Throws InvalidInput where no factor does.
Reach reach(const SceneDef& scene, const std::vector<std::size_t>& bodies, Property property, Measure measure,
            double target, Order order = Order::first);

/// The first of the scenes with at least that reserve, collapse load, frequency or damping; at most that
/// displacement, rotation or mass; those that calibrate() refuses, and those of which nothing ever
/// yields, are passed over. Throws InvalidInput where
/// none is, and what is wrong with the last one where all are refused.
Reach first_to_reach(const std::vector<SceneDef>& candidates, Measure measure, double target,
                     Order order = Order::first);
/// The lightest of them; of equally light ones the first.
Reach lightest(const std::vector<SceneDef>& candidates, Measure measure, double target,
               Order order = Order::first);

/// Bodies of the depths with which a scene weighs least.
struct LeastMass {
  double mass = 0;      ///< kg, of all that moves
  double collapse = 0;  ///< LimitAnalysis::load_factor
  SceneDef scene;
};

/// The scene of least mass that collapses at no less than that factor on loads and gravity, over the depths
/// of groups of bodies (indices), those of a group in proportion to what they are: by linear programming
/// over all depths and all forces in equilibrium (Foulkes, Q. Appl. Math. 10 (1953) 347), rigid-plastic and
/// in the geometry as drawn, of every load case at once. No depth becomes less than a thousandth of what is
/// drawn. Throws InvalidInput where no depths bear it, where Plan::interaction is set, and as
/// limit_analysis() does.
LeastMass least_mass(const SceneDef& scene, const std::vector<std::vector<std::size_t>>& groups,
                     double collapse);

/// Draws a body that is one straight strip with another profile: its outline, cuts, and the supports and
/// loads on it are stretched across the strip, about its middle line, to the profile's height. What touches
/// it on its sides, a column under a girder, does so no more where the height changes: join such bodies at
/// points.
void set_profile(SceneDef& scene, std::size_t body, std::vector<Region> profile,
                 const std::string& name = "");

}  // namespace ductile
