// Elastic statics: what every joint carries, and which yields first.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ductile/design.h"
#include "equilibrium.h"
#include "yield.h"

namespace ductile {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// What is below rounding of the largest force of its kind is 0, so that nothing yields of it.
void drop_rounding(Eigen::VectorXd& forces) {
  for (int row = 0; row < 3; ++row) {
    double largest = 0;
    for (Eigen::Index i = row; i < forces.size(); i += 3) largest = std::max(largest, std::abs(forces[i]));
    for (Eigen::Index i = row; i < forces.size(); i += 3)
      if (std::abs(forces[i]) < 1e-11 * largest) forces[i] = 0;
  }
}

StaticJoint loose_joint() { return {nan, nan, nan, {nan, nan, nan}, unlimited}; }

StaticJoint joint_under(const Yield& yield, const std::array<double, 3>& force) {
  const auto [N, Q, M] = force;
  const double used = yield.usage(force);
  return {.N = N,
          .Q = Q,
          .M = M,
          .usage = {yield.usage(axial, N), yield.usage(shear, Q), yield.usage(rotation, M)},
          .yields_at = used > 0 ? 1 / used : unlimited};
}

StaticCheck check_case(const Plan& plan, const Equilibrium& statics, const std::vector<Yield>& yields,
                       const LoadCase& load_case) {
  const Eigen::VectorXd f = statics.balanced(load_case.gravity + load_case.loads);
  Eigen::VectorXd forces = statics.forces(f);
  drop_rounding(forces);
  StaticCheck result{.time = load_case.time, .loose = statics.loose};
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const Eigen::Index r = 3 * static_cast<Eigen::Index>(i);
    result.joints.push_back(
        statics.held[i] ? joint_under(yields[i], {forces[r], forces[r + 1], forces[r + 2]}) : loose_joint());
    result.reserve = std::min(result.reserve, result.joints.back().yields_at);
  }
  const Eigen::VectorXd x = statics.motions(f);
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const int c = statics.column[i];
    const auto s = c < 0 ? std::array<double, 3>{} : statics.scale(static_cast<int>(i));
    result.displacement.push_back(c < 0 ? Point{} : Point{s[0] * x[c], s[1] * x[c + 1]});
  }
  return result;
}

}  // namespace

StaticCheck static_check(const Plan& plan) {
  const Equilibrium statics(plan);
  std::vector<Yield> yields;
  for (const PlannedJoint& joint : plan.joints) yields.emplace_back(plan, joint);
  StaticCheck worst;
  bool first = true;
  for (const LoadCase& load_case : statics.cases()) {
    StaticCheck now = check_case(plan, statics, yields, load_case);
    if (first || now.reserve < worst.reserve) worst = std::move(now);
    first = false;
  }
  for (std::size_t i = 0; i < plan.joints.size(); ++i)
    if (worst.joints[i].yields_at < unlimited) worst.first_to_yield.push_back(static_cast<int>(i));
  std::stable_sort(worst.first_to_yield.begin(), worst.first_to_yield.end(), [&](int i, int j) {
    return worst.joints[static_cast<std::size_t>(i)].yields_at <
           worst.joints[static_cast<std::size_t>(j)].yields_at;
  });
  return worst;
}

}  // namespace ductile
