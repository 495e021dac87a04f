#include "deformed.h"

#include <algorithm>
#include <cmath>

namespace ductile {

using Eigen::VectorXd;

namespace {

// The share of a load that the state has.
std::function<double(const Plan::Load&)> dead(const Growth& growth, const Deformed& state) {
  return [&growth, &state](const Plan::Load& load) {
    return growth.loads_grow && load.def.from <= growth.time && load.def.to > growth.time ? state.factor : 0;
  };
}

}  // namespace

GeometricStiffness geometric_stiffness(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                                       const Deformed& state) {
  return geometric_stiffness(plan, statics, state.primary, dead(growth, state));
}

VectorXd carried(const Plan& plan, const Equilibrium& statics, const Growth& growth, const Deformed& state) {
  VectorXd forces = state.forces;
  for (const BentBars& bars : bent_bars(plan, statics, state.primary, dead(growth, state))) {
    Eigen::Vector3d q = state.factor * bars.ground;
    for (const auto& [column, share] : bars.columns) q += state.x[column] * share;
    forces.segment<3>(3 * static_cast<Eigen::Index>(bars.joint)) += bars.carries * q;
  }
  return forces;
}

// With y = K x, (1 + K_g K⁻¹) y = f, symmetric in the metric of K⁻¹: K itself, whose rigid rows would drown
// the others in rounding, is never applied. It has as many eigenvalues away from 1 as K_g has to say.
std::optional<VectorXd> solve_tangent(const Equilibrium& statics, const GeometricStiffness& K_g,
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

Deformed unloaded(const Equilibrium& statics, const LoadCase& load_case) {
  const ElasticState state = statics.prestressed(load_case);
  return {0, state.x, state.forces, state.forces};
}

std::optional<Deformed> deformed(const Plan& plan, const Equilibrium& statics, const Growth& growth,
                                 const Deformed& from, double factor) {
  const double more = factor - from.factor;
  const ElasticState bent = statics.imposed(more * growth.elongation);
  Deformed now{factor, from.x + bent.x, from.forces + bent.forces,
               from.primary + statics.forces(more * growth.growing) + bent.forces};
  const GeometricStiffness K_g = geometric_stiffness(plan, statics, growth, now);
  if (K_g.pushed.size() > 0) return std::nullopt;
  VectorXd rest = growth.at(factor) - statics.B.transpose() * from.forces - K_g * now.x;
  for (const BentBars& bars : bent_bars(plan, statics, now.primary, dead(growth, now)))
    for (const auto& [column, share] : bars.columns)
      rest[column] -= share.dot(bars.form * (factor * bars.ground));  // which moves with the loads
  const std::optional<VectorXd> step = solve_tangent(statics, K_g, rest);
  if (!step) return std::nullopt;
  now.x = K_g.settled(now.x + *step);
  now.forces += statics.forces(rest - K_g * *step);
  return now;
}

}  // namespace ductile
