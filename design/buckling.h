// How near a structure is to buckling.
#pragma once

#include "equilibrium.h"

namespace ductile {

/// K_g, as B's columns: the second derivatives of the joints' elongations times their forces, and of the
/// places where loads act times the loads (dead loads, all of the plan's together).
Eigen::SparseMatrix<double> geometric_stiffness(const Plan& plan, const Equilibrium& statics,
                                                const Eigen::VectorXd& forces);

/// μ = max −xᵀK_g x / xᵀK x over the structures that have a part in `start`, 0 where that is negative: their
/// inverse buckling load factor. By Lanczos' method in the metric of K.
double buckling(const Equilibrium& statics, const Eigen::SparseMatrix<double>& K_g,
                const Eigen::VectorXd& start);

}  // namespace ductile
