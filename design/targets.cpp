#include "ductile/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "ductile/plane.h"
#include "equilibrium.h"

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

// "M of wall-beam/0": the joint that yields first, and its row that is used most.
std::string governing(const Plan& plan, const StaticCheck& check) {
  if (check.first_to_yield.empty()) return "nothing: no joint has a limit";
  const auto first = static_cast<std::size_t>(check.first_to_yield.front());
  const auto& usage = check.joints[first].usage;
  const std::array rows{std::pair(usage.N, "N"), std::pair(usage.Q, "Q"), std::pair(usage.M, "M")};
  const auto most = std::max_element(rows.begin(), rows.end(), [](const auto& a, const auto& b) {
    return !(a.first >= b.first);  // NaN, of an unlimited row, is least
  });
  return std::string(most->second) + " of " + plan.joints[first].name;
}

// The factor x with result(x) = target, of a result that grows with x about as a power of it: Newton in
// logarithms, with the power from the last two.
double factor_for(double target, const std::function<double(double)>& result,
                  const std::function<std::string()>& why_not) {
  double x = 1, f = result(x), power = 1;
  for (int i = 0; i < 60 && f > 0 && f < unlimited; ++i) {
    const double missing = target / f;
    if (std::abs(missing - 1) < 1e-10) return x;
    const double step = std::clamp(std::pow(missing, 1 / power), 1.0 / 16, 16.0), next = x * step;
    if (!(next > 1e-12 && next < 1e12)) break;
    const double value = result(next);
    power = std::clamp(std::log(value / f) / std::log(step), 0.05, 10.0);
    x = next;
    f = value;
  }
  throw InvalidInput(
      {{"target", "no number reaches it: " + why_not(), "change what governs, or the target"}});
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

// Of the slowest mode: the least ω² of ω² x = K x (M = 1 in Equilibrium's unknowns), by inverse iteration
// from the structure's own pieces, and Σ c (B x)² of its joints.
Mode slowest(const Plan& plan, const Equilibrium& statics, int column) {
  if (column < 0) throw InvalidInput({{"target", "nothing holds the body", "join or support it"}});
  Eigen::VectorXd x = Eigen::VectorXd::Zero(statics.B.cols());
  for (int i = 0; i < 3; ++i) x[column + i] = 1 + 0.1 * i;  // no symmetry that a mode lacks
  double square = 0;                                        // ω²
  for (int round = 0; round < 10'000; ++round) {
    x.normalize();
    const Eigen::VectorXd y = statics.motions(x);
    const double now = 1 / x.dot(y), change = std::abs(now - square);
    if (!(y.norm() > 0)) break;
    x = y;
    square = now;
    if (change < 1e-13 * now) break;
  }
  x.normalize();
  const Eigen::VectorXd elongation = statics.B * x;
  double damping = 0;
  for (Eigen::Index row = 0; row < elongation.size(); ++row) {
    const PlannedJoint& j = plan.joints[static_cast<std::size_t>(row / 3)];
    const double k = row % 3 == 0 ? j.stiffness.N : row % 3 == 1 ? j.stiffness.Q : j.stiffness.M;
    if (k < unlimited && j.damping_frequency > 0)
      damping +=
          j.damping_ratio * k / (std::numbers::pi * j.damping_frequency) * elongation[row] * elongation[row];
  }
  const double omega = std::sqrt(square);
  return {omega / (2 * std::numbers::pi), damping / (2 * omega)};
}

}  // namespace

Answer yield_stress_for(const SceneDef& scene, const std::string& body, double reserve) {
  SceneDef own = scene;
  const double before = material_of(own, body).yield_stress;
  Answer answer = for_reserve(scene, reserve, [&](SceneDef& changed, double factor) {
    Material& m = material_of(changed, body);
    for (double* stress :
         {&m.yield_stress, &m.yield_stress_compression, &m.shear_yield_stress, &m.ultimate_stress})
      *stress *= factor;
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

Mode slowest_mode(const Plan& plan, const std::string& body) {
  const Equilibrium statics(plan);
  for (std::size_t i = 0; i < plan.pieces.size(); ++i)
    if (plan.bodies[static_cast<std::size_t>(plan.pieces[i].body)].name == body && statics.column[i] >= 0) {
      if (statics.is_mechanism())
        throw InvalidInput({{"target", "the structure moves without strain", "hold it"}});
      return slowest(plan, statics, statics.column[i]);
    }
  throw InvalidInput({{"target", "nothing holds '" + body + "'", "join it to what stands still"}});
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
  constexpr int most = 128;
  SceneDef changed = scene;
  changed.loads.push_back({.body = body, .at = at});  // finds the piece
  BodyDef& own = body_of(changed, body);
  own.cuts.clear();
  own.automatic = false;
  const auto displacement = [&](int pieces) {
    own.pieces = pieces;
    const Plan plan = calibrate(changed);
    const Equilibrium statics(plan);
    const int piece = plan.loads.back().piece, c = statics.column[static_cast<std::size_t>(piece)];
    if (c < 0) throw InvalidInput({{"target", "nothing holds '" + body + "'", "join or support it"}});
    const Point arm = at - plan.pieces[static_cast<std::size_t>(piece)].center;
    const auto [sx, sy, turn] = statics.scale(piece);
    Point largest{};
    for (const LoadCase& load_case : statics.cases()) {
      const Eigen::VectorXd x = statics.motions(statics.balanced(load_case.gravity + load_case.loads));
      const Point u = Point{sx * x[c], sy * x[c + 1]} + turn * x[c + 2] * left(arm);
      if (length(u) > length(largest)) largest = u;
    }
    return largest;
  };
  const Point fine = displacement(most), exact = fine + (1.0 / 3) * (fine - displacement(most / 2));
  if (!(length(exact) > 0))
    throw InvalidInput({{"target", "the point does not move under the loads", "load the body"}});
  for (int n = 1; n <= most; ++n)
    if (length(displacement(n) - exact) <= error * length(exact))
      return {static_cast<double>(n), "displacement of " + body + " at " + to_string(at)};
  throw InvalidInput({{"target", "128 pieces are not enough for it", "give a larger error"}});
}

}  // namespace ductile
