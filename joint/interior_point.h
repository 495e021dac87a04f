// The regimes of the solution by a primal–dual interior point method: slower than Newton's where few rows
// flow, but a dozen rounds suffice whatever the number of rows that change their regime at once (a struck
// chain, a collapse).
//
//   M (v − v*) + Jᵀ s = 0        J v + b = s/G + z⁺ − z⁻        z⁺ p⁺ = μ,   z⁻ p⁻ = μ,   μ → 0
//
// s are the impulses, z± the plastic slips, p⁺ = F⁺ + ηz⁺ − s and p⁻ = F⁻ + ηz⁻ + s what is left to the caps,
// which hardening raises by η per slip; all p, z > 0. Each round is one system with the pattern of H: the
// tangent of a row is 1/(1/G + z⁺/(p⁺ + ηz⁺) + z⁻/(p⁻ + ηz⁻)). Mehrotra's predictor–corrector.
#pragma once

#include <array>
#include <span>

#include "hessian.h"

namespace ductile::dynamics {

/// One row. Sides: the cap and the reverse cap.
struct Barrier {
  double s, ds, r, slope, hardening;
  double p[2], z[2], dp[2], dz[2], second[2];
  bool bounded[2];
};
using BarrierRows = std::array<Barrier, 3>;

/// Moves the bodies' v next to the solution and writes the regimes that the solution is in; `work` is
/// |v − v*|²_M + |v|²_M at the start. Scratch: `barrier` per joint, g and d per body. Returns factorisations,
/// 0 where no row is bounded and nothing was done. Leaves H factored of those regimes' tangents.
int interior_point(System& system, Hessian& hessian, double work, std::span<BarrierRows> barrier,
                   std::span<Vec3> g, std::span<Vec3> d);

}  // namespace ductile::dynamics
