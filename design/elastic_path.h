// States of an elastic structure as its loads grow.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "deformed.h"

namespace ductile {

/// Less is what rigid rows, a million times as stiff as others, let through of a load that goes right into a
/// support.
inline constexpr double least_usage = 1e-10;

/// How much of something a joint, or another of so many items, uses in a state; it is used up at 1. Convex in
/// the forces, and 0 without any.
using Usage = std::function<double(std::size_t item, const Deformed& state)>;

/// Of first order, between two factors at which a line goes slack or taut: forces + factor · growing.
struct Stretch {
  double from, to;
  ElasticState fixed, growing;
  Deformed at(double factor) const {
    const Eigen::VectorXd forces = fixed.forces + factor * growing.forces;
    return {factor, fixed.x + factor * growing.x, forces, forces};
  }
};

/// From the factor 0 on. Leaves `statics` as the last of them has it.
std::vector<Stretch> stretches(const Plan& plan, Equilibrium& statics, const LoadCase& load_case);

/// The factor of first order at which each item uses 1; unlimited: none, or only of rounding.
std::vector<double> reached(const std::vector<Stretch>& stretches, std::size_t items, const Usage& usage);

class ElasticPath {
 public:
  /// `statics`: with elastic bars; it is left as the last state has it.
  ElasticPath(const Plan& plan, Equilibrium& statics, const LoadCase& load_case);

  /// The critical load factor; unlimited: none.
  double critical() const { return critical_; }
  /// The motion in which it buckles; empty: none.
  const Eigen::VectorXd& mode() const { return mode_; }
  /// A motion without strain that the loads do not hold; empty: none.
  const Eigen::VectorXd& free_motion() const { return free_; }
  /// The state at a factor; none from the critical one on.
  std::optional<Deformed> at(double factor) const;

  /// The factor at which each item uses 1. The least is exact, to 1e-9; others are interpolated in
  /// factor / usage, which is constant in first order and linear where one mode amplifies. Unlimited: not
  /// below the critical load.
  std::vector<double> reached(std::size_t items, const Usage& usage) const;

 private:
  void find_critical(const Stretch& stretch);
  const Plan& plan_;
  Equilibrium& statics_;
  const LoadCase load_case_;
  Growth growth_;
  std::vector<Stretch> first_order_;
  double critical_ = unlimited;
  Eigen::VectorXd mode_, free_;
};

}  // namespace ductile
