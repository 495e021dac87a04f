#include "elastic_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "buckling.h"

namespace ductile {

using Eigen::Index;

ElasticPath::ElasticPath(const Plan& plan, const Equilibrium& statics, const LoadCase& load_case)
    : plan_(plan), statics_(statics) {
  const Eigen::VectorXd f = statics.balanced(load_case.gravity + load_case.loads);
  growth_ = {Eigen::VectorXd::Zero(f.size()), f, load_case.elongation, load_case.time};
  const Eigen::VectorXd first = statics.elastic(load_case).forces;
  first_ = {1, {}, first, first};
  const GeometricStiffness K_g = geometric_stiffness(plan, statics, growth_, first_);
  const Buckle buckle = buckling(statics, K_g, any_motion(statics));
  mode_ = buckle.mode;
  free_ = K_g.pushed.size() > 0 ? K_g.pushed : K_g.adrift;
  if (buckle.inverse_factor > 1e-12) critical_ = 1 / buckle.inverse_factor;
}

std::optional<Deformed> ElasticPath::at(double factor) const {
  if (factor >= critical_) return std::nullopt;
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(statics_.B.rows());
  const Deformed unloaded{0, Eigen::VectorXd::Zero(statics_.B.cols()), none, none};
  std::optional<Deformed> state = deformed(plan_, statics_, growth_, unloaded, factor);
  if (state) state->forces = carried(plan_, statics_, growth_, *state);
  return state;
}

std::vector<double> ElasticPath::reached(const Usage& usage) const {
  std::vector<double> first_order;
  double largest = 0;
  for (Index i = 0; 3 * i < first_.forces.size(); ++i) {
    const double used = usage(static_cast<std::size_t>(i), first_.forces.segment<3>(3 * i));
    first_order.push_back(used > 0 ? 1 / used : unlimited);
    largest = std::max(largest, used);
  }
  for (double& factor : first_order)
    if (factor * largest > 1e11) factor = unlimited;  // rounding of what is used most
  std::vector<double> result(first_order.size(), unlimited);
  const double first = *std::min_element(first_order.begin(), first_order.end());
  if (first == unlimited) return result;

  const auto uses = [&](const Deformed& state) {
    std::vector<double> all;
    for (std::size_t i = 0; i < result.size(); ++i)
      all.push_back(usage(i, state.forces.segment<3>(3 * static_cast<Index>(i))));
    return all;
  };
  // Of each joint, factor / usage there and where it was looked at before.
  struct Sample {
    double factor;
    std::vector<double> capacity;
  };
  Sample before{0, first_order};
  const auto sample = [&](double factor) -> std::optional<Sample> {
    const std::optional<Deformed> state = at(factor);
    if (!state) return std::nullopt;
    Sample now{factor, uses(*state)};
    for (double& used : now.capacity) used = used > 0 ? factor / used : unlimited;
    return now;
  };
  const auto pass = [&](const Sample& now) {
    for (std::size_t i = 0; i < result.size(); ++i) {
      const double old = before.capacity[i], own = now.capacity[i];
      if (result[i] < unlimited || !(own <= now.factor)) continue;
      const double slope = old < unlimited ? (own - old) / (now.factor - before.factor) : 0;
      result[i] = (own - slope * now.factor) / (1 - slope);
    }
    before = now;
  };
  const auto least = [](const Sample& s) { return *std::min_element(s.capacity.begin(), s.capacity.end()); };

  // The first: a fixed point of factor = capacity(factor), by secants.
  double low = 0, high = critical_, factor = std::min(first, 0.9 * critical_);
  double last = 0, capacity_there = first;
  for (int round = 0; round < 60 && (high == unlimited || high - low > 1e-11 * high); ++round) {
    const std::optional<Sample> now = sample(factor);
    const double capacity = now ? least(*now) : 0;
    if (now && std::abs(capacity - factor) < 1e-10 * factor) break;
    (capacity < factor ? high : low) = factor;
    double next = unlimited;
    if (now) {
      const double slope = (capacity - capacity_there) / (factor - last);
      next = (capacity - slope * factor) / (1 - slope);
      last = factor;
      capacity_there = capacity;
    }
    factor = next > low && next < high ? next : high < unlimited ? low + (high - low) / 2 : 2 * low;
  }
  std::vector<double> stations;
  for (const double share : {0.5, 0.75, 0.9, 0.97, 0.995})
    if (critical_ < unlimited) stations.push_back(share * critical_);
  for (const double multiple : {1.0, 2.0, 4.0, 16.0})
    if (multiple * first < critical_) stations.push_back(multiple * first);
  stations.push_back(factor);
  std::sort(stations.begin(), stations.end());
  for (const double station : stations)
    if (station > before.factor)
      if (const std::optional<Sample> now = sample(station)) pass(*now);
  return result;
}

}  // namespace ductile
