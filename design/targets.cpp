#include "ductile/targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "plane.h"

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

double displacement_of(const StaticCheck& check, std::size_t piece) {
  return length(check.displacement[piece]);
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
  SceneDef own = scene;
  const double before = material_of(own, body).youngs_modulus;
  if (!(displacement > 0 && before > 0))
    throw InvalidInput(
        {{"target",
          "a displacement of " + to_string(displacement) + " m from an E of " + to_string(before) + " Pa",
          "give both above 0"}});
  own.loads.push_back({.body = body, .at = at});  // finds the piece
  const auto piece = static_cast<std::size_t>(calibrate(own).loads.back().piece);
  Answer answer;
  const double softer = factor_for(
      displacement,
      [&](double factor) {
        SceneDef changed = scene;
        material_of(changed, body).youngs_modulus = before / factor;
        const Plan plan = calibrate(changed);
        answer.governed_by = "displacement of " + plan.pieces[piece].name;
        return displacement_of(static_check(plan), piece);
      },
      [&] { return "it moves otherwise, or not at all"; });
  answer.value = before / softer;
  return answer;
}

}  // namespace ductile
