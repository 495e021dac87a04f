#include "elastic_path.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "buckling.h"

namespace ductile {

using Eigen::Index;

std::vector<Stretch> stretches(const Plan& plan, Equilibrium& statics, const LoadCase& load_case) {
  const auto stretch = [&](double from, double to) {
    return Stretch{from, to, statics.prestressed(load_case), statics.elastic(load_case)};
  };
  if (load_case.prestress.isZero(0)) {  // what is slack at one factor is so at all
    statics.let_slack(load_case);
    return {stretch(0, unlimited)};
  }
  constexpr double beyond = 1e-9;  // of a change, on its far side
  std::vector<Stretch> all;
  double from = 0;
  for (std::size_t most = 10 * plan.joints.size() + 10; from < unlimited; --most) {
    if (most == 0)
      throw InvalidInput({{"joints", "ropes or struts go slack and taut again without end as the loads grow",
                           "check their lengths, or what they hold"}});
    const double to = std::max(statics.let_slack(load_case, from + beyond * std::max(1., from)),
                               from + 2 * beyond * std::max(1., from));
    // Where no line has caught yet what the loads move, some do before the loads are worth mentioning.
    if (to == unlimited || statics.bears(load_case.gravity + load_case.loads))
      all.push_back(stretch(all.empty() ? 0 : from, to));
    from = to;
  }
  return all;
}

std::vector<double> reached(const std::vector<Stretch>& stretches, std::size_t items, const Usage& usage) {
  std::vector<double> result(items, unlimited);
  if (stretches.size() == 1 && stretches[0].fixed.forces.isZero(0)) {  // in proportion to the loads
    const Deformed state = stretches[0].at(1);
    double largest = 0;
    for (std::size_t i = 0; i < items; ++i) {
      const double used = usage(i, state);
      result[i] = used > least_usage ? 1 / used : unlimited;
      largest = std::max(largest, used);
    }
    for (double& factor : result)
      if (factor * largest > 1e11) factor = unlimited;  // rounding of what is used most
    return result;
  }
  // A convex function that starts below 1 rises through it once.
  for (std::size_t i = 0; i < items; ++i)
    for (const Stretch& stretch : stretches) {
      const auto uses = [&](double factor) { return usage(i, stretch.at(factor)); };
      double low = stretch.from, high = stretch.to;
      if (!(uses(low) < 1)) {
        result[i] = low;
        break;
      }
      if (high == unlimited)
        for (high = std::max(1., 2 * low); uses(high) < 1 && high < 1 / least_usage;) low = high, high *= 2;
      if (uses(high) < 1) continue;
      while (high - low > 1e-14 * high) (uses((low + high) / 2) < 1 ? low : high) = (low + high) / 2;
      result[i] = high;
      break;
    }
  return result;
}

// Below the critical load μ < 1 (buckling.h), convex in the factor, so a stretch that is stable at both of
// its ends is stable.
ElasticPath::ElasticPath(const Plan& plan, Equilibrium& statics, const LoadCase& load_case)
    : plan_(plan), statics_(statics), load_case_(load_case) {
  const Eigen::VectorXd f = statics.balanced(load_case.gravity + load_case.loads);
  growth_ = {Eigen::VectorXd::Zero(f.size()), f, load_case.elongation, load_case.time};
  first_order_ = stretches(plan, statics, load_case);
  for (std::size_t i = 0; i < first_order_.size() && critical_ == unlimited; ++i)
    find_critical(first_order_[i]);
}

void ElasticPath::find_critical(const Stretch& stretch) {
  const auto& [from, to, fixed, growing] = stretch;
  if (first_order_.size() > 1)
    statics_.let_slack(load_case_, to < unlimited ? (from + to) / 2 : 2 * from + 1);
  struct Look {
    GeometricStiffness K_g;
    Buckle buckle;
  };
  const auto look = [&](const Deformed& state) {
    GeometricStiffness K_g = geometric_stiffness(plan_, statics_, growth_, state);
    Buckle buckle = buckling(statics_, K_g, any_motion(statics_));
    return Look{std::move(K_g), std::move(buckle)};
  };
  const auto buckles_at = [&](double factor, const Look& there) {
    critical_ = factor;
    mode_ = there.buckle.mode;
    free_ = factor == 0 && there.K_g.pushed.size() > 0 ? there.K_g.pushed : there.K_g.adrift;
  };
  const auto mu = [&](const Deformed& state) { return look(state).buckle.inverse_factor; };
  const Deformed loads{1, growing.x, growing.forces, growing.forces};
  if (fixed.forces.isZero(0)) {
    const Look there = look(loads);
    const double of_loads = there.buckle.inverse_factor, factor = of_loads > 1e-12 ? 1 / of_loads : unlimited;
    return buckles_at(factor <= to ? std::max(from, factor) : unlimited, there);
  }
  double low = from, high = to, mu_low = mu(stretch.at(low)), mu_high = 0;
  if (mu_low >= 1) return buckles_at(low, look(stretch.at(low)));
  if (high == unlimited) {
    const double of_loads = mu(loads);
    if (!(of_loads > 1e-12)) return buckles_at(unlimited, look(stretch.at(low)));
    for (high = std::max(2 * low, of_loads < unlimited ? 1 / of_loads : 1);
         (mu_high = mu(stretch.at(high))) < 1; high *= 2)
      low = high, mu_low = mu_high;
  } else if ((mu_high = mu(stretch.at(high))) < 1) {
    return buckles_at(unlimited, look(stretch.at(low)));
  }
  const double least = 1e-9 * high;  // what presses on a mechanism does at once
  for (bool halve = false; high - low > 1e-10 * high && high > least; halve = !halve) {
    // The chord lies above what is convex and meets 1 below the root; halving closes in from the other side.
    const double chord = low + (1 - mu_low) / (mu_high - mu_low) * (high - low);
    const double factor = halve || !(chord > low && chord < high) ? low + (high - low) / 2 : chord;
    const double now = mu(stretch.at(factor));
    (now < 1 ? low : high) = factor;
    (now < 1 ? mu_low : mu_high) = now;
  }
  buckles_at(high > least ? high : 0, look(stretch.at(high)));
}

std::optional<Deformed> ElasticPath::at(double factor) const {
  if (factor >= critical_) return std::nullopt;
  if (first_order_.size() > 1) statics_.let_slack(load_case_, factor);
  std::optional<Deformed> state = deformed(plan_, statics_, growth_, unloaded(statics_, load_case_), factor);
  if (state) state->forces = carried(plan_, statics_, growth_, *state);
  return state;
}

std::vector<double> ElasticPath::reached(std::size_t items, const Usage& usage) const {
  std::vector<double> result(items, unlimited);
  const std::optional<Deformed> none = at(0);
  if (!none) return result;
  const std::vector<double> first_order = ductile::reached(first_order_, items, usage);
  std::vector<double> at_rest;  // what prestress uses
  for (std::size_t i = 0; i < items; ++i) {
    at_rest.push_back(usage(i, *none));
    if (at_rest[i] >= 1) result[i] = 0;
  }
  const double first = *std::min_element(first_order.begin(), first_order.end());
  if (first == unlimited || first == 0) return result;

  // Of each item, factor / (what it uses beyond prestress / what that leaves), and where it was looked at.
  struct Sample {
    double factor;
    std::vector<double> capacity;
  };
  Sample before{0, first_order};
  const auto sample = [&](double factor) -> std::optional<Sample> {
    const std::optional<Deformed> state = at(factor);
    if (!state) return std::nullopt;
    Sample now{factor, {}};
    for (std::size_t i = 0; i < items; ++i) {
      const double more = usage(i, *state) - at_rest[i];
      now.capacity.push_back(more > 0 ? factor * (1 - at_rest[i]) / more : unlimited);
    }
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
