// States of an elastic structure as its loads grow, in the deformed state.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "deformed.h"

namespace ductile {

class ElasticPath {
 public:
  /// `statics`: with elastic bars.
  ElasticPath(const Plan& plan, const Equilibrium& statics, const LoadCase& load_case);

  /// The critical load factor; unlimited: none.
  double critical() const { return critical_; }
  /// The motion in which it buckles; empty: none.
  const Eigen::VectorXd& mode() const { return mode_; }
  /// A motion without strain that the loads do not hold; empty: none.
  const Eigen::VectorXd& free_motion() const { return free_; }
  /// The state at a factor; none from the critical one on.
  std::optional<Deformed> at(double factor) const;

  /// How much of something that grows with its forces, and is used up at 1, a joint uses.
  using Usage = std::function<double(std::size_t joint, const Eigen::Vector3d& forces)>;
  /// Of every joint: the factor at which it uses 1. The least is exact, to 1e-9; others are interpolated in
  /// factor / usage, which is constant in first order and linear where one mode amplifies. Unlimited: not
  /// below the critical load.
  std::vector<double> reached(const Usage& usage) const;

 private:
  const Plan& plan_;
  const Equilibrium& statics_;
  Growth growth_;
  Deformed first_;  // forces of first order at the factor 1
  double critical_ = unlimited;
  Eigen::VectorXd mode_, free_;
};

}  // namespace ductile
