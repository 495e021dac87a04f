#include "ductile/targets.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "buckling.h"
#include "ductile/plane.h"
#include "equilibrium.h"
#include "seek.h"

namespace ductile {
namespace {

BodyDef& body_of(SceneDef& scene, const std::string& name) {
  for (BodyDef& body : scene.bodies)
    if (body.name == name) return body;
  throw InvalidInput({{"target", "there is no body '" + name + "'", "name one of the scene's bodies"}});
}

Material& material_of(SceneDef& scene, const std::string& name) {
  BodyDef& body = body_of(scene, name);
  if (!body.material) throw InvalidInput({{"body '" + name + "'", "has no material", "give it one"}});
  return *body.material;
}

Answer for_reserve(const SceneDef& scene, double reserve,
                   const std::function<void(SceneDef&, double)>& scaled) {
  if (!(reserve > 0 && reserve < unlimited))
    throw InvalidInput({{"target", "the reserve is " + to_string(reserve), "give one above 0"}});
  Answer answer;
  answer.value = factor_for(
      reserve,
      [&](double factor) {
        SceneDef changed = scene;
        scaled(changed, factor);
        const Plan plan = calibrate(changed);
        const StaticCheck check = static_check(plan);
        answer.governed_by = governing(plan, check);
        return check.reserve;
      },
      [&] { return "the reserve is governed by " + answer.governed_by; });
  return answer;
}

void require_positive(double target, const char* what) {
  if (!(target > 0 && target < unlimited))
    throw InvalidInput(
        {{"target", std::string(what) + " is " + to_string(target), "give a finite one above 0"}});
}

// E of a body at which `result`, which grows as E falls, is the target.
Answer softer(const SceneDef& scene, const std::string& body, double target,
              const std::function<double(const Plan&)>& result, std::string governed_by) {
  SceneDef changed = scene;
  double& modulus = material_of(changed, body).youngs_modulus;
  const double before = modulus;
  require_positive(before, "E of the body");
  const double factor = factor_for(
      target,
      [&](double x) {
        modulus = before / x;
        return result(calibrate(changed));
      },
      [&] { return "E of '" + body + "' does not change the " + governed_by; });
  return {before / factor, std::move(governed_by)};
}

std::size_t joint_named(const Plan& plan, const std::string& name) {
  const auto found = std::find_if(plan.joints.begin(), plan.joints.end(),
                                  [&](const PlannedJoint& joint) { return joint.name == name; });
  if (found == plan.joints.end())
    throw InvalidInput({{"target", "there is no joint '" + name + "'", "name one that calibrate lists"}});
  return static_cast<std::size_t>(found - plan.joints.begin());
}

// Of the structures that have a part in `start`: the least ω² of K x = ω² x (M = 1 in Equilibrium's
// unknowns), which is the buckling load of K_g = −1, and Σ c (B x)² of its joints.
Mode slowest(const Plan& plan, const Equilibrium& statics, const Eigen::VectorXd& start) {
  if (statics.is_mechanism())
    throw InvalidInput({{"target", "the structure moves without strain", "hold it"}});
  Eigen::SparseMatrix<double> minus_mass(start.size(), start.size());
  minus_mass.setIdentity();
  minus_mass *= -1;
  const Buckle vibration = buckling(statics, minus_mass, start);
  const Eigen::VectorXd elongation = statics.B * vibration.mode.normalized();
  double damping = 0;
  for (Eigen::Index row = 0; row < elongation.size(); ++row) {
    const PlannedJoint& j = plan.joints[static_cast<std::size_t>(row / 3)];
    damping += j.damping(static_cast<Row>(row % 3)) * elongation[row] * elongation[row];
  }
  const double omega = 1 / std::sqrt(vibration.inverse_factor);
  return {omega / (2 * std::numbers::pi), damping / (2 * omega)};
}

}  // namespace

Answer yield_stress_for(const SceneDef& scene, const std::string& body, double reserve) {
  SceneDef own = scene;
  const double before = material_of(own, body).yield_stress;
  Answer answer = for_reserve(scene, reserve, [&](SceneDef& changed, double factor) {
    scale_strength(material_of(changed, body), factor);
  });
  answer.value *= before;
  return answer;
}

Answer depth_for(const SceneDef& scene, const std::string& body, double reserve) {
  SceneDef own = scene;
  const double before = body_of(own, body).depth;
  Answer answer = for_reserve(
      scene, reserve, [&](SceneDef& changed, double factor) { body_of(changed, body).depth *= factor; });
  answer.value *= before;
  return answer;
}

Answer youngs_modulus_for(const SceneDef& scene, const std::string& body, Point at, double displacement) {
  require_positive(displacement, "the displacement");
  SceneDef own = scene;
  material_of(own, body);                         // throws where there is none
  own.loads.push_back({.body = body, .at = at});  // finds the piece
  const Plan plan = calibrate(own);
  const auto piece = static_cast<std::size_t>(plan.loads.back().piece);
  return softer(
      scene, body, displacement,
      [&](const Plan& changed) { return length(static_check(changed).displacement[piece]); },
      "displacement of " + plan.pieces[piece].name);
}

Answer youngs_modulus_for_rotation(const SceneDef& scene, const std::string& body, const std::string& joint,
                                   double rotation) {
  require_positive(rotation, "the rotation");
  return softer(
      scene, body, rotation,
      [&](const Plan& plan) {
        const std::size_t i = joint_named(plan, joint);
        return std::abs(static_check(plan).joints[i].M) / plan.joints[i].stiffness.M;
      },
      "rotation of " + joint + " under the loads");
}

Answer youngs_modulus_for_rotation_at_yield(const SceneDef& scene, const std::string& body,
                                            const std::string& joint, double rotation) {
  require_positive(rotation, "the rotation");
  return softer(
      scene, body, rotation,
      [&](const Plan& plan) {
        const PlannedJoint& j = plan.joints[joint_named(plan, joint)];
        return std::min(j.M, j.M_reverse) / j.stiffness.M;
      },
      "rotation of " + joint + " at yield");
}

Mode slowest_mode(const Plan& plan) {
  const Equilibrium statics(plan);
  return slowest(plan, statics, any_motion(statics));
}

Mode slowest_mode(const Plan& plan, const std::string& body) {
  const Equilibrium statics(plan);
  Eigen::VectorXd start = Eigen::VectorXd::Zero(statics.B.cols());
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)].name == body && statics.column[i] >= 0)
      start.segment<3>(statics.column[i]) = Eigen::Vector3d(1, 1.1, 1.2);  // no symmetry that a mode lacks
  if (start.isZero(0))
    throw InvalidInput({{"target", "nothing holds '" + body + "'", "join it to what stands still"}});
  return slowest(plan, statics, start);
}

Answer youngs_modulus_for_frequency(const SceneDef& scene, const std::string& body, double frequency) {
  require_positive(frequency, "the frequency");
  return softer(
      scene, body, 1 / frequency, [&](const Plan& plan) { return 1 / slowest_mode(plan, body).frequency; },
      "slowest vibration of the structure of " + body);
}

Answer damping_ratio_for(const SceneDef& scene, const std::string& body, double damping_ratio) {
  require_positive(damping_ratio, "the damping ratio");
  SceneDef changed = scene;
  double& own = material_of(changed, body).damping_ratio;
  const double before = own > 0 ? own : 1;
  const double factor = factor_for(
      damping_ratio,
      [&](double x) {
        own = before * x;
        return slowest_mode(calibrate(changed), body).damping_ratio;
      },
      [&] { return "the damping of '" + body + "' does not change it"; });
  return {before * factor, "slowest vibration of the structure of " + body};
}

Answer pieces_for(const SceneDef& scene, const std::string& body, Point at, double error) {
  if (!(error > 0 && error < 1))
    throw InvalidInput({{"target", "the error is " + to_string(error), "give a share between 0 and 1"}});
  SceneDef changed = scene;
  changed.loads.push_back({.body = body, .at = at});  // finds the piece
  BodyDef& own = body_of(changed, body);
  own.cuts.clear();
  own.automatic = false;
  const auto displacement = [&](int pieces) {
    own.pieces = pieces;
    const Plan plan = calibrate(changed);
    Equilibrium statics(plan);
    const int piece = plan.loads.back().piece, c = statics.column[static_cast<std::size_t>(piece)];
    if (c < 0) throw InvalidInput({{"target", "nothing holds '" + body + "'", "join or support it"}});
    const Point arm = at - plan.pieces[static_cast<std::size_t>(piece)].center;
    const auto [sx, sy, turn] = statics.scale(piece);
    Point largest{};
    for (const LoadCase& load_case : statics.cases()) {
      statics.let_slack(load_case);
      const Eigen::VectorXd x = statics.elastic(load_case).x;
      const Point u = Point{sx * x[c], sy * x[c + 1]} + turn * x[c + 2] * left(arm);
      if (length(u) > length(largest)) largest = u;
    }
    return largest;
  };
  const Point fine = displacement(most_pieces_tried),
              exact = fine + (1.0 / 3) * (fine - displacement(most_pieces_tried / 2));
  if (!(length(exact) > 0))
    throw InvalidInput({{"target", "the point does not move under the loads", "load the body"}});
  for (int n = 1; n <= most_pieces_tried; ++n)
    if (length(displacement(n) - exact) <= error * length(exact))
      return {static_cast<double>(n), "displacement of " + body + " at " + to_string(at)};
  throw InvalidInput({{"target", std::to_string(most_pieces_tried) + " pieces are not enough for it",
                       "give a larger error"}});
}

}  // namespace ductile
