// From poses to gaps and their Jacobian J, and J and Jᵀ applied.
//
// A joint's gap is (u, v, θ): the way from anchor A to anchor B along and across the joint's axis, and the
// angle of B against A beyond that at rest. The frame turns at (1 − follow)·ω_a + follow·ω_b. With bodies'
// velocities in their own frames, t the axis and n its left in each of them, r the anchors:
//   u̇ = t_b·v_b − t_a·v_a + (r_b × t_b + follow·v) ω_b − (r_a × t_a − (1 − follow)·v) ω_a
//   v̇ = n_b·v_b − n_a·v_a + (r_b × n_b − follow·u) ω_b − (r_a × n_a + (1 − follow)·u) ω_a
//   θ̇ = ω_b − ω_a
// with r × t the moment of a unit along t. The entries ±v, ∓u take J at the midpoint of the two anchors when
// follow is ½: without them a spin with a plastic set gains energy.
#pragma once

#include "system.h"

namespace ductile::dynamics {

/// The three rows of one body's half of J.
struct JacobianRows {
  Vec3 u, v, w;
};

inline JacobianRows rows_of_a(const Jacobian& J) {
  return {{-J.axis_a.c, -J.axis_a.s, J.au}, {J.axis_a.s, -J.axis_a.c, J.av}, {0, 0, -1}};
}

inline JacobianRows rows_of_b(const Jacobian& J) {
  return {{J.axis_b.c, J.axis_b.s, J.bu}, {-J.axis_b.s, J.axis_b.c, J.bv}, {0, 0, 1}};
}

/// J v, zeros and ones of J left out.
inline Rows relative_velocity(const Joint& j, const Vec3& a, const Vec3& b) {
  const Jacobian& J = j.J;
  return {
      b.x * J.axis_b.c + b.y * J.axis_b.s - (a.x * J.axis_a.c + a.y * J.axis_a.s) + a.w * J.au + b.w * J.bu,
      b.y * J.axis_b.c - b.x * J.axis_b.s - (a.y * J.axis_a.c - a.x * J.axis_a.s) + a.w * J.av + b.w * J.bv,
      b.w - a.w};
}

/// J v + b
inline Rows biased_velocity(const Joint& j, const Vec3& a, const Vec3& b) {
  Rows x = relative_velocity(j, a, b);
  for (unsigned i = 0; i < 3; ++i) x[i] += j.bias[i];
  return x;
}

/// (a, b) += Jᵀ s, likewise.
inline void add_transposed(const Joint& j, const Rows& s, Vec3& a, Vec3& b) {
  const Jacobian& J = j.J;
  a -= {s[0] * J.axis_a.c - s[1] * J.axis_a.s, s[0] * J.axis_a.s + s[1] * J.axis_a.c,
        s[2] - (s[0] * J.au + s[1] * J.av)};
  b += {s[0] * J.axis_b.c - s[1] * J.axis_b.s, s[0] * J.axis_b.s + s[1] * J.axis_b.c,
        s[0] * J.bu + s[1] * J.bv + s[2]};
}

/// 1/(J M⁻¹ Jᵀ) of the rows, each by itself, with J as it is; 0 of a row that nothing moves.
Rows effective_masses(const System& system, const Joint& j);

/// Writes J of the bodies' places; returns the gap.
Rows locate(Joint& joint, const Place& a, const Place& b);
inline Rows locate(Joint& j, const Vector<Place>& places) {
  return locate(j, places[z(j.a)], places[z(j.b)]);
}

/// Writes all gaps into the records, and J, where bodies were put elsewhere.
void locate_all(System& system);

}  // namespace ductile::dynamics
