#include "deformed.h"

#include <algorithm>
#include <cmath>

#include "buckling.h"

namespace ductile {

using Eigen::VectorXd;

Eigen::SparseMatrix<double> geometric_stiffness(const Plan& plan, const Equilibrium& statics,
                                                const Growth& growth, const Deformed& state) {
  const auto dead = [&](const Plan::Load& load) {
    return growth.loads_grow && load.def.from <= growth.time && load.def.to > growth.time ? state.factor : 0;
  };
  return geometric_stiffness(plan, statics, state.primary, dead);
}

// With y = K x, (1 + K_g K⁻¹) y = f, symmetric in the metric of K⁻¹: K itself, whose rigid rows would drown
// the others in rounding, is never applied. It has as many eigenvalues away from 1 as K_g has to say.
std::optional<VectorXd> solve_tangent(const Equilibrium& statics, const Eigen::SparseMatrix<double>& K_g,
                                      const VectorXd& f) {
  VectorXd x = VectorXd::Zero(f.size()), r = f, z = statics.motions(r), p = r, w = z;  // w = K⁻¹ p
  double rz = r.dot(z);
  const double enough = 1e-24 * rz;
  for (int round = 0; round < 500 && rz > enough; ++round) {
    const VectorXd bent = K_g * w;
    const double curvature = p.dot(w) + w.dot(bent);
    if (!(curvature > 1e-9 * p.dot(w))) return std::nullopt;
    const double step = rz / curvature;
    x += step * w;
    r -= step * (p + bent);
    z = statics.motions(r);
    const double before = rz;
    rz = r.dot(z);
    p = r + rz / before * p;
    w = z + rz / before * w;
  }
  return x;
}

std::optional<Deformed> deformed(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                                 const Deformed& from, double factor) {
  const double more = factor - from.factor;
  const ElasticState bent = statics.imposed(more * growth.elongation);
  Deformed now{factor, from.x + bent.x, from.forces + bent.forces,
               from.primary + statics.forces(more * growth.growing) + bent.forces};
  const Eigen::SparseMatrix<double> K_g = geometric_stiffness(plan, statics, growth, now);
  const VectorXd rest = growth.at(factor) - statics.B.transpose() * from.forces - K_g * now.x;
  const std::optional<VectorXd> step = solve_tangent(statics, K_g, rest);
  if (!step) return std::nullopt;
  now.x += *step;
  now.forces += statics.forces(rest - K_g * *step);
  return now;
}

}  // namespace ductile
