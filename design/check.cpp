// Elastic statics: what every joint carries, and which yields first.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "ductile/design.h"
#include "ductile/plane.h"
#include "elastic_path.h"
#include "yield.h"

namespace ductile {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// m: as far apart as joints and middles of pieces are.
double extent(const Plan& plan) {
  Point low{unlimited, unlimited}, high{-unlimited, -unlimited};
  const auto reach = [&](Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  };
  for (const PlannedJoint& joint : plan.joints) reach(joint.anchor);
  for (const Piece& piece : plan.pieces)
    if (plan.is_dynamic(static_cast<int>(&piece - plan.pieces.data()))) reach(piece.center);
  return length(high - low);
}

// What is below rounding of the largest force, or of its moment across the structure, is 0: so that nothing
// yields of it, and no column in plain compression is told to carry a shear force.
void drop_rounding(Eigen::VectorXd& forces, double extent) {
  const auto all = forces.reshaped(3, forces.size() / 3);
  const double force = all.topRows(2).cwiseAbs().maxCoeff(), moment = all.row(2).cwiseAbs().maxCoeff();
  const double least_force = 1e-11 * std::max(force, extent > 0 ? moment / extent : 0);
  const double least_moment = 1e-11 * std::max(moment, force * extent);
  for (Eigen::Index i = 0; i < forces.size(); ++i)
    if (std::abs(forces[i]) < (i % 3 == rotation ? least_moment : least_force)) forces[i] = 0;
}

StaticJoint loose_joint() { return {nan, nan, nan, {nan, nan, nan}, unlimited}; }

StaticJoint joint_under(const Yield& yield, const std::array<double, 3>& force) {
  const auto [N, Q, M] = force;
  const double used = yield.usage(force);
  return {.N = N,
          .Q = Q,
          .M = M,
          .usage = {yield.usage(axial, N), yield.usage(shear, Q), yield.usage(rotation, M)},
          .yields_at = used > least_usage ? 1 / used : unlimited};
}

// What the joints carry in a state; yields_at for forces that grow in proportion to the loads.
StaticCheck check_state(const Plan& plan, const Equilibrium& statics, const std::vector<Yield>& yields,
                        double time, Eigen::VectorXd forces, const Eigen::VectorXd& x) {
  if (forces.size() > 0) drop_rounding(forces, extent(plan));
  StaticCheck result{.time = time, .loose = statics.loose};
  for (std::size_t i = 0; i < plan.joints.size(); ++i) {
    const Eigen::Index r = 3 * static_cast<Eigen::Index>(i);
    result.joints.push_back(
        statics.held[i] ? joint_under(yields[i], {forces[r], forces[r + 1], forces[r + 2]}) : loose_joint());
    result.reserve = std::min(result.reserve, result.joints.back().yields_at);
  }
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    const int c = statics.column[i];
    const auto s = c < 0 ? std::array<double, 3>{} : statics.scale(static_cast<int>(i));
    result.displacement.push_back(c < 0 ? Point{} : Point{s[0] * x[c], s[1] * x[c + 1]});
    result.turn.push_back(c < 0 ? 0 : s[2] * x[c + 2]);
  }
  return result;
}

// Beyond the critical load.
StaticCheck without_state(const Plan& plan, const Equilibrium& statics, double time) {
  return {.time = time,
          .joints = std::vector<StaticJoint>(plan.joints.size(), loose_joint()),
          .displacement = std::vector<Point>(plan.pieces.size(), {nan, nan}),
          .turn = std::vector<double>(plan.pieces.size(), nan),
          .loose = statics.loose};
}

void yield_at(StaticCheck& check, const std::vector<double>& factors) {
  for (std::size_t i = 0; i < factors.size(); ++i) {
    check.joints[i].yields_at = factors[i];
    check.reserve = std::min(check.reserve, factors[i]);
  }
}

StaticCheck check_case(const Plan& plan, Equilibrium& statics, const std::vector<Yield>& yields,
                       const LoadCase& load_case, Order order) {
  const Usage usage = [&](std::size_t i, const Deformed& state) {
    if (!statics.held[i]) return 0.;
    const Eigen::Index r = 3 * static_cast<Eigen::Index>(i);
    double N = state.forces[r];  // a line that is just going slack carries nothing but rounding
    if (plan.joints[i].carries == Carries::tension) N = std::max(0., N);
    if (plan.joints[i].carries == Carries::compression) N = std::min(0., N);
    return yields[i].usage({N, state.forces[r + 1], state.forces[r + 2]});
  };
  if (order == Order::first) {
    const std::vector<Stretch> path = stretches(plan, statics, load_case);
    const Stretch& now =
        *std::find_if(path.begin(), path.end(), [](const Stretch& stretch) { return stretch.to > 1; });
    const Deformed state = now.at(1);
    StaticCheck result = check_state(plan, statics, yields, load_case.time, state.forces, state.x);
    if (load_case.prestress.isZero(0)) return result;
    result.reserve = unlimited;
    yield_at(result, reached(path, plan.joints.size(), usage));
    return result;
  }

  const ElasticPath path(plan, statics, load_case);
  const std::optional<Deformed> now = path.at(1);
  StaticCheck result = now ? check_state(plan, statics, yields, load_case.time, now->forces, now->x)
                           : without_state(plan, statics, load_case.time);
  result.reserve = path.critical();
  yield_at(result, path.reached(plan.joints.size(), usage));
  return result;
}

}  // namespace

StaticCheck static_check(const Plan& plan, Order order) {
  Equilibrium statics(plan, order == Order::first ? Between::rigid_pieces : Between::elastic_bars);
  std::vector<Yield> yields;
  for (const PlannedJoint& joint : plan.joints) yields.emplace_back(plan, joint);
  StaticCheck worst;
  bool first = true;
  for (const LoadCase& load_case : statics.cases()) {
    StaticCheck now = check_case(plan, statics, yields, load_case, order);
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
