// H = M + Jᵀ D J with D = ds/dx, its factor, and what is known of that factor.
#pragma once

#include <algorithm>
#include <span>

#include "block_ldlt.h"
#include "block_lu.h"
#include "system.h"

namespace ductile::dynamics {

/// What the factor was made of.
enum class Factored {
  nothing,
  tangents,  // of the present poses and of the regimes of some evaluation since the step began
  earlier,   // tangents or secants of an earlier step
  secants,   // of the present poses; F h/|x| for rows that flow
  holding,   // rows that hold, as stiff as κ allows (Projection)
};

class Hessian {
 public:
  /// Finds the pattern, where it is not that of as many bodies before and has all that joins these now, and
  /// each joint's block in it. Allocates.
  void analyse(System& system);
  /// The block of two free bodies in the pattern.
  int block(int a, int b) const { return ldlt_.slot(std::max(a, b), std::min(a, b)); }
  void forget() { factored_ = Factored::nothing; }
  /// Another step: bodies have moved.
  void begin_step();
  Factored factored() const { return factored_; }

  /// Factors the tangents of the joints' regimes; those of rows that flow are secants where these are larger,
  /// if asked for: after a short step of the line search they take it further.
  void factor_tangents(System& system, bool secants);
  /// Factors H for pushes: whatever holds is as stiff as κ allows, so that a push moves the bodies as one
  /// that does not give. With their own stiffness in it, rows took up a share of every push, and a block on a
  /// beam was catapulted.
  void factor_holding(System& system, int changed);
  /// Factors the records' tangents as they are, at the present poses; for velocities with the turn inertias.
  void refactor(const System& system, bool turn_inertias = true);
  /// Likewise; afterwards they count as those of an earlier step.
  void factor_given(const System& system) {
    refactor(system);
    factored_ = Factored::earlier;
  }

  /// Likewise, where row 1 of contact k follows its row 0 by ds₁/dx₀ = follows[k], which is not symmetric.
  void factor_following(const System& system, std::span<const double> follows);
  void solve_following(std::span<Vec3> x) const { lu_.solve(ldlt_, x); }

  /// x ← H⁻¹ x; or its halves: see BlockLdlt.
  void solve(std::span<Vec3> x) const { ldlt_.solve(x); }
  double forward(std::span<Vec3> x) const { return ldlt_.forward(x); }
  void backward(std::span<Vec3> x) const { ldlt_.backward(x); }

  /// Block products of one iteration with the factor, and of a factorisation, for so many joints.
  double iteration_work(std::size_t joints) const {
    return static_cast<double>(ldlt_.solve_work() + 3 * joints);
  }
  double factor_work(std::size_t joints) const {
    return static_cast<double>(ldlt_.factor_work() + 3 * joints);
  }
  void keep(Tape& tape) {
    auto made_of = static_cast<std::uint8_t>(factored_);
    tape(made_of, ldlt_);
    if (made_of > static_cast<std::uint8_t>(Factored::holding)) return tape.refuse();
    factored_ = static_cast<Factored>(made_of);
  }

 private:
  void assemble(const System& system, bool turn_inertias);

  BlockLdlt ldlt_;
  BlockLu lu_;
  Factored factored_ = Factored::nothing;
};

}  // namespace ductile::dynamics
