// What a Section knows of itself that does not depend on a direction.
#pragma once

#include <vector>

#include "ductile/section.h"
#include "integrals.h"

namespace ductile {

/// Where a fully plastic section changes from tension to compression.
struct NeutralAxis {
  DoubleDouble s;  // coordinate along d from the local origin, m
  DoubleDouble F;  // Σ h ∬ |s' − s| dA, N m
  double
      absolute;  // coordinate along d from the origin of the caller's axes, m; middle where it is not unique
  bool cancels;  // double precision did not do
};

// With h = (f_t + f_c)/2 and g = (f_t − f_c)/2 the stress of a fully plastic section, the side above s0 in
// tension, is h sign(s − s0) + g. So with G and F of Cut one falling function G(s0) serves both senses of
// bending and every N:
//   side toward d in tension:      N = C + G,   M_ref =  F + ∫ g (s − s0) dA + (s0 − s_ref) N
//   side toward d in compression:  N = C − G,   M_ref = −F + ∫ g (s − s0) dA + (s0 − s_ref) N
// with C = Σ ∫ g dA.
struct Section::Data {
  std::vector<Region> regions;
  Boundary boundary;
  std::vector<Moments> of_region;  // geometric
  Moments geometric, strength, asymmetry,
      modulus;                  // sums over the regions, weighted by 1, h, g, E (1 if not known)
  double N = 0, Nc = 0, Q = 0;  // N
  bool E_known = false;
  bool one_E = true, one_f = true;  // the same in all regions
  bool f_differ = false;            // f_t ≠ f_c in some region

  /// The root of G(s) = target.
  NeutralAxis neutral_axis(Point direction, DoubleDouble target) const;
};

/// Throws std::invalid_argument unless d is finite and not zero.
void require_direction(Point d);

/// Σ ∫ (s' − s) dA along d, weighted as m is; s from the local origin.
inline DoubleDouble first_moment(const Moments& m, const Vec<DoubleDouble>& d, DoubleDouble s) {
  return m.Sx * d.x + m.Sy * d.y - m.A * s;
}

}  // namespace ductile
