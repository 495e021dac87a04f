// Equilibrium in the deformed state (second-order theory, P–Δ): displacements small against the structure,
// but forces act where it has gone, Bᵀ R + K_g (x, g) = f, g the grounds' motion. K_g is that of the forces
// of first order: what the displacements add to axial forces is of the size of what the theory leaves out,
// and near the critical load would keep it from having a solution.
#pragma once

#include <optional>
#include <vector>

#include "buckling.h"
#include "ductile/design.h"
#include "equilibrium.h"

namespace ductile {

/// Loads that grow with a factor: fixed + factor · growing, as B's columns.
struct Growth {
  Eigen::VectorXd fixed, growing;
  Eigen::VectorXd elongation;  ///< that grows, by joints' rows (LoadCase)
  double time = 0;             ///< s: the plan's loads that act then turn with their pieces
  bool loads_grow = true;      ///< or do not act at all
  Eigen::VectorXd at(double factor) const { return fixed + factor * growing; }
};

struct Deformed {
  double factor = 0;
  Eigen::VectorXd x, forces;  ///< motions, and (N, Q, M) of the joints, R of Bᵀ R + K_g x = f
  Eigen::VectorXd primary;    ///< the forces that loads alone have added, stage by stage: those of K_g
};

/// K_g of a state.
GeometricStiffness geometric_stiffness(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                                       const Deformed& state);

/// What the joints carry, (N, Q, M), along axes that turn with their bodies (a support's do not): the state's
/// forces, and those that axial forces of bent bars have across them.
Eigen::VectorXd carried(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                        const Deformed& state);

/// The state at another factor, with the stiffness that `statics` has now from `from` on. None where there is
/// no stable equilibrium, as far as the loads can tell: what is symmetric may yet buckle to a side.
std::optional<Deformed> deformed(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                                 const Deformed& from, double factor);

/// The state without loads, to start from: what prestress brings, of first order.
Deformed unloaded(const Equilibrium& statics, const LoadCase& load_case);

/// x with (K + K_g) x = f by conjugate gradients; none where some direction has no positive stiffness.
std::optional<Eigen::VectorXd> solve_tangent(const Equilibrium& statics, const GeometricStiffness& K_g,
                                             const Eigen::VectorXd& f);

/// Motions of the pieces, to the scale at which the largest displacement is 1 m.
std::vector<Motion> shape_of(const Plan& plan, const Equilibrium& statics, const Eigen::VectorXd& x);

}  // namespace ductile
