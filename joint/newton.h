// The minimum of f by Newton's method with an exact line search, where the factor of an earlier H serves as
// the preconditioner of conjugate gradients for as long as that is cheaper than to factor anew.
//
// Each iteration is a round: a direction d = −H⁻¹∇f (made conjugate to the last one while the factor stays
// the same), a step along it, and where that crossed into other regimes of the rows, the zero of f' along d.
// With a fresh factor a round is a Newton step, and within one regime it ends at the solution.
#pragma once

#include <cstdint>
#include <span>

#include "hessian.h"
#include "interior_point.h"
#include "objective.h"
#include "pool.h"
#include "warm_start.h"

namespace ductile::dynamics {

struct SolveReport {
  int rounds = 0;  // directions computed
  int factorisations = 0;
  double residual = 0;  // |∇f| against the impulses' norm, both of M⁻¹: `tolerance` is where a solve ends
  bool unsolved = false;  // the tolerance was not reached
};

/// What is chosen, with its reason.
struct NewtonTunables {
  /// |∇f| as a share of the impulses' norm at which a solve ends: root moments good to 1e-8.
  double tolerance = 1e-8;
  /// Likewise with contacts, which are not known as well: root moments good to 1e-7. With 1e-8 a swaying
  /// frame of 2000 joints under load takes three rounds a step instead of two.
  double contact_tolerance = 1e-7;
  /// Likewise, of a structure that stands still under what touches it: what the other tolerances leave would
  /// shake its stiff rows, and it would not come to rest, where nothing is solved any more.
  double standing_tolerance = 1e-9;
  /// Rounds after which a solve in which rows flow is handed to the interior point method: many rows change
  /// their regime against each other, and each round finds out about few of them.
  int flow_rounds = 5;
  /// Likewise, with contacts: most of them come and go alone. With 5 a collapsing frame of 2000 joints takes
  /// half as long again, the worst step of a shot one twice as long; with 20 some gain and some lose.
  int contact_rounds = 12;
  /// Likewise, of one in which none flows.
  int round_bound = 100;
};

/// How a solve ended.
struct Solution {
  Evaluation at;
  bool moved = false;  // any round was needed
};

class Newton {
 public:
  NewtonTunables tunables;
  InteriorPoint interior_point;

  void form(const System& system);

  /// Another velocity changed: v* of a body, in its own frame. All that happens between two solves of a step
  /// is said so, or none of it: the gradient follows.
  void push(System& system, std::size_t body, const Vec3& change);
  /// Bodies were moved: the gradient is not known any more.
  void forget();

  /// From the bodies' v, or from where `prediction` says; `last` is the evaluation that the last solve ended
  /// with.
  Solution solve(System& system, Hessian& hessian, const Evaluation& last, const LinearPrediction* prediction,
                 SolveReport& report);
  /// The next solve is the first of a step.
  void begin_step() {
    first_ = true;
    interior_point.begin_step();
  }
  void keep(Tape& tape) { tape(contraction_, lost_); }

  /// One momentum per body, the gradient's own, for who needs it while that is not known.
  std::span<Vec3> scratch() { return g_; }

 private:
  struct Round;
  double tolerance_of(const System& system) const;
  double target(const System& system, const Evaluation& at) const;
  bool worth_refactoring(const System& system, const Hessian& hessian, const Evaluation& at,
                         const Round& round) const;
  bool hands_over(const System& system, const Evaluation& at, const Round& round) const;
  void preconditioned_gradient(const System& system, const Hessian& hessian, const Evaluation& at,
                               Round& round);
  bool search(System& system, const Evaluation& at_one, double slope0, double slope1, bool& short_step);
  void take_regimes(System& system);
  void gradient_in_regimes(System& system);
  bool start_from_regimes(System& system, Hessian& hessian, Evaluation& at, SolveReport& report);
  void start_from_lower(System& system, Evaluation& at);
  Evaluation solve_by_interior_point(System& system, Hessian& hessian, SolveReport& report);

  Vector<Vec3> g_;                // ∇f at the bodies' v, from a solve to the pushes after it
  Vector<Vec3> d_, z_;            // 0 for bodies whose velocities are prescribed
  Vector<std::uint8_t> regimes_;  // of the joints, in the last solution
  struct Flow {
    std::size_t joint;
    Rows x, s;  // J v + b in the last solution, and the impulses that answer it
  };
  Vector<Flow> flows_;  // of the joints that were on a yield surface in the last solution
  struct Kink {
    std::size_t joint;
    Rows y;  // J d
  };
  Vector<Kink> kinks_;  // joints whose slope the line search asks for at each t
  // Pushes since the last solve, which left |∇f|² = left2_ and of which the pushes made left2_ + pushed2_.
  Vector<std::size_t> pushed_;
  std::size_t pushes_ = 0;
  bool gradient_known_ = false;
  bool stands_ = false;  // as of the last step
  bool first_ = true;    // no solve of this step was done
  double left2_ = 0, pushed2_ = 0;
  /// |∇f|² falls by so many times in a round with a factor of an earlier step.
  double contraction_ = 1e6;
  /// Rounds that the last steps took in vain, as the factor is not of the rows that flow in them.
  double lost_ = 0;
};

}  // namespace ductile::dynamics
