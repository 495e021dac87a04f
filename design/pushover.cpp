// Hinge by hinge to collapse in the deformed state.
//
// Between two events, a joint that yields or unloads, the structure is elastic with the stiffness that
// flowing joints leave it, so that each stage is a problem of second-order elasticity from the stage's start
// on. It ends where the next joint yields. The structure goes where its tangent stiffness stops being
// positive: after a hinge, at once (a mechanism, or what is left of the stiffness buckles under the forces
// that are there), or on the way to the next.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "buckling.h"
#include "deformed.h"
#include "ductile/design.h"
#include "flow.h"

namespace ductile {
namespace {

using Eigen::VectorXd;

constexpr int most_events_per_joint = 20;
constexpr double surface_tolerance = 1e-9;
constexpr double spent = 1000;  // times as far as the last hinge: a support that is displaced meets no more

class Pushing {
 public:
  Pushing(const Plan& plan, const std::vector<Yield>& yields)
      : plan_(plan), statics_(plan), flow_(plan, statics_, yields), freedoms_(statics_.freedoms()) {
    const VectorXd none = VectorXd::Zero(statics_.B.rows());
    state_ = {0, VectorXd::Zero(statics_.B.cols()), none, none};
  }

  /// From the factor 0 as far as `last`; false where the structure goes before.
  bool push(const Growth& growth, double last) {
    state_.factor = 0;
    if (falls_at_once(growth)) return false;
    const std::size_t most = most_events_per_joint * plan_.joints.size() + 100;
    for (std::size_t event = 0; event < most; ++event) {
      statics_.stiffen(flow_.roots());
      if (statics_.freedoms() > freedoms_) {
        statics_.stiffen(flow_.roots(1e-4));  // what flows moves
        if (goes(growth, statics_.motions(growth.growing))) return false;
        continue;
      }
      const auto K_g = geometric_stiffness(plan_, statics_, growth, state_);
      if (const Buckle buckle = buckling(statics_, K_g, any_motion(statics_)); buckle.inverse_factor >= 1) {
        if (goes(growth, buckle.mode)) return false;
        continue;
      }
      const ElasticState bent = statics_.imposed(growth.elongation);
      std::optional<VectorXd> rate = solve_tangent(statics_, K_g, growth.growing - K_g * bent.x);
      if (!rate) {
        goes(growth, statics_.motions(growth.growing));
        return false;
      }
      *rate += bent.x;
      if (flow_.unload(statics_.B * *rate + growth.elongation)) continue;
      switch (stage(growth, last, statics_.forces(growth.growing - K_g * *rate) + bent.forces)) {
        case Ends::at_a_hinge:
          break;
        case Ends::at_the_last:
          return true;
        case Ends::by_buckling:
          return false;
      }
    }
    throw std::runtime_error("second-order limit analysis: hinges form and unload without end");
  }

  const Equilibrium& statics() const { return statics_; }
  const Deformed& state() const { return state_; }
  std::vector<std::array<double, 3>> carried() const {
    std::vector<std::array<double, 3>> all;
    for (Eigen::Index r = 0; r < state_.forces.size(); r += 3)
      all.push_back({state_.forces[r], state_.forces[r + 1], state_.forces[r + 2]});
    return all;
  }
  std::vector<Reached> hinges;
  std::vector<Motion> mechanism;

 private:
  // Whether the least of these loads pushes on a motion that strains nothing, with nothing there to hold it.
  bool falls_at_once(const Growth& growth) {
    if (freedoms_ == 0 || !state_.primary.isZero(0)) return false;
    const VectorXd forces = statics_.forces(growth.growing) + statics_.imposed(growth.elongation).forces;
    const auto K_g = geometric_stiffness(plan_, statics_, growth, {1, {}, forces, forces});
    if (K_g.pushed.size() > 0) mechanism = shape_of(plan_, statics_, K_g.pushed);
    return K_g.pushed.size() > 0;
  }

  enum class Ends { at_a_hinge, at_the_last, by_buckling };

  // Up to the next hinge, to `last`, or to where it buckles. `rates`: of the joints' forces.
  Ends stage(const Growth& growth, double last, const VectorXd& rates) {
    // Joints that have just unloaded are on their planes, and go back.
    std::vector<Flow::Most> leave;
    Flow::Most most = flow_.most_used(state_.forces);
    for (; most.usage > 1 - surface_tolerance; most = flow_.most_used(state_.forces, leave)) {
      if (most.plane.normal.dot(rates.segment<3>(Eigen::Index{3} * most.joint)) > 0)
        return hinge(state_, most);
      leave.push_back(most);
    }

    double low = state_.factor, low_usage = most.usage, high = unlimited;
    double factor = std::min(last, low + reach(rates, leave));
    const bool pushed = growth.growing.isZero(0);  // by supports alone, which hold whatever forms
    if (pushed && low > 0 && factor > spent * low) factor = unlimited;
    if (factor == unlimited && !pushed) factor = low + buckling_reach(growth, rates);
    if (factor == unlimited) {
      state_.factor = unlimited;
      return Ends::at_the_last;
    }
    while (high == unlimited || high - low > 1e-11 * high) {
      const std::optional<Deformed> there = deformed(plan_, statics_, growth, state_, factor);
      if (there) most = flow_.most_used(there->forces, leave);
      if (there && std::abs(most.usage - 1) <= surface_tolerance)
        return buckled(growth, *there) ? buckle(growth, factor) : hinge(*there, most);
      if (there && most.usage < 1 && factor == last) {
        if (buckled(growth, *there)) return buckle(growth, factor);
        state_ = *there;
        return Ends::at_the_last;
      }
      double next = unlimited;
      if (there) next = factor + (1 - most.usage) * (factor - low) / (most.usage - low_usage);
      if (!there || most.usage > 1) {
        high = factor;
      } else {
        if (buckled(growth, *there)) return buckle(growth, factor);
        low = factor;
        low_usage = most.usage;
      }
      if (!(next > low && next < high)) next = high < unlimited ? low + (high - low) / 2 : 2 * factor;
      factor = std::min(next, last);
    }
    return buckle(growth, high);
  }

  // How far until a joint yields, were forces to grow at these rates.
  double reach(const VectorXd& rates, const std::vector<Flow::Most>& leave) const {
    const auto usage = [&](double by) { return flow_.most_used(state_.forces + by * rates, leave).usage; };
    double high = 1;
    while (usage(high) > 1) high /= 16;
    while (usage(high) < 1)
      if ((high *= 4) > 1e12) return unlimited;
    double low = 0;
    while (high - low > 1e-9 * high) (usage((low + high) / 2) > 1 ? high : low) = (low + high) / 2;
    return high;
  }

  // Twice as far as until it buckles, were nothing to yield.
  double buckling_reach(const Growth& growth, const VectorXd& rates) const {
    const auto K_g = geometric_stiffness(plan_, statics_, growth, {1, {}, rates, rates});
    const double inverse = buckling(statics_, K_g, any_motion(statics_)).inverse_factor;
    return inverse > 1e-12 ? 2 / inverse : unlimited;
  }

  Buckle buckle_of(const Growth& growth, const Deformed& state) const {
    return buckling(statics_, geometric_stiffness(plan_, statics_, growth, state), any_motion(statics_));
  }
  bool buckled(const Growth& growth, const Deformed& state) const {
    return buckle_of(growth, state).inverse_factor >= 1;
  }

  // Between the stage's start, which stands, and `high`, which does not.
  Ends buckle(const Growth& growth, double high) {
    double low = state_.factor;
    Deformed last = state_;
    const double least = 1e-9 * high;  // a mechanism goes at once
    while (high - low > 1e-7 * high && high > least) {
      const double middle = (low + high) / 2;
      std::optional<Deformed> there = deformed(plan_, statics_, growth, state_, middle);
      if (there && !buckled(growth, *there)) {
        low = middle;
        last = std::move(*there);
      } else {
        high = middle;
      }
    }
    state_ = std::move(last);
    return goes(growth, buckle_of(growth, state_).mode) ? Ends::by_buckling : Ends::at_a_hinge;
  }

  Ends hinge(const Deformed& state, const Flow::Most& most) {
    state_ = state;
    if (std::none_of(hinges.begin(), hinges.end(), [&](const Reached& r) { return r.joint == most.joint; }))
      hinges.push_back({most.joint, state.factor});
    flow_.add(most.joint, most.plane);
    return Ends::at_a_hinge;
  }

  // Whether it goes in this motion, the way the loads push. Not where a hinge would go backward in it: that
  // one unloads first, as where two form beside each other because the largest moment moves on along a bar.
  // One that yields again at once, time after time, does not keep it from going.
  bool goes(const Growth& growth, const VectorXd& x) {
    if (x.size() == 0) return true;
    const VectorXd forward = x.dot(growth.growing) < 0 ? VectorXd(-x) : x;
    if (state_.factor > let_go_at_) let_go_at_ = state_.factor, let_go_ = 0;
    const bool pushed = growth.growing.isZero(0);  // by supports: which way it goes is not known
    if (!pushed && let_go_++ < plan_.joints.size() && flow_.unload(statics_.B * forward)) return false;
    mechanism = shape_of(plan_, statics_, forward);
    return true;
  }

  const Plan& plan_;
  Equilibrium statics_;
  Flow flow_;
  Eigen::Index freedoms_;
  Deformed state_;
  double let_go_at_ = -1;   // the factor at which goes() last had a hinge unload,
  std::size_t let_go_ = 0;  // and how often it did there
};

}  // namespace

Pushover second_order_limit(const Plan& plan, bool fixed_gravity) {
  for (const PlannedJoint& joint : plan.joints)
    if (joint.carries != Carries::both)
      throw InvalidInput({{"joint '" + joint.name + "'", "may go slack, which --second-order does not follow",
                           "ask for the collapse load without it, or make it carry both ways"}});
  std::vector<Yield> yields;
  for (const PlannedJoint& joint : plan.joints) yields.emplace_back(plan, joint);
  const Equilibrium statics(plan);
  Pushover worst;
  bool loaded = false, first = true;
  for (const LoadCase& load_case : statics.cases()) {
    const VectorXd gravity = statics.balanced(load_case.gravity), loads = statics.balanced(load_case.loads);
    const VectorXd none = VectorXd::Zero(gravity.size());
    const VectorXd growing = fixed_gravity ? loads : VectorXd(gravity + loads);
    if (growing.isZero(0) && load_case.elongation.isZero(0)) continue;
    loaded = true;
    Pushing pushing(plan, yields);
    const VectorXd still = VectorXd::Zero(statics.B.rows());
    if (!load_case.prestress.isZero(0)) {
      if (!pushing.push({none, none, load_case.prestress, load_case.time, false}, 1))
        throw InvalidInput({{"joints", "the lengths of its lines bring the structure down before any load",
                             "give them lengths nearer to those that they are drawn with"}});
      for (Reached& hinge : pushing.hinges) hinge.factor = 0;
    }
    if (fixed_gravity) {
      if (!pushing.push({none, gravity, still, load_case.time, false}, 1))
        throw InvalidInput(
            {{"loads", "cannot be carried, even times 0: gravity alone brings the structure down",
              "let gravity grow with the loads (without --fixed-gravity), or strengthen it"}});
      for (Reached& hinge : pushing.hinges) hinge.factor = 0;
    }
    pushing.push({fixed_gravity ? gravity : none, growing, load_case.elongation, load_case.time}, unlimited);
    if (first || worst.load_factor > pushing.state().factor)
      worst = {pushing.state().factor, pushing.hinges, load_case.time, pushing.mechanism, pushing.carried()};
    first = false;
  }
  if (!loaded)
    throw InvalidInput({{"loads", "are none: there is nothing to multiply",
                         fixed_gravity ? "give the scene loads, or let gravity grow too"
                                       : "give the scene gravity or loads"}});
  return worst;
}

}  // namespace ductile
