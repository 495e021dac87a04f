// What a Section knows of itself that does not depend on a direction.
#pragma once

#include <span>
#include <vector>

#include "boundary.h"
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
  struct Weighted {
    Moments<DoubleDouble> sum;
    double scatter = 0;  // √Σ (weight · length of an edge)²
  };
  explicit Data(std::span<const Region> all) : regions(all.begin(), all.end()), boundary(all) {}

  std::vector<Region> regions;
  Boundary boundary;
  Weighted geometric, strength, asymmetry, modulus;  // by 1, h, g, and E (1 where it is not known)
  double N = 0, Nc = 0, Q = 0;                       // N
  bool E_known = false;
  bool one_material = true;  // the same f and E in all regions
  bool f_differ = false;     // f_t ≠ f_c in some region

  /// Fills in what is above from the loops.
  template <class Real>
  void sum();
  struct Bent {
    double EI = 0;         // N m²; m⁴ where no E is known
    double curvature = 0;  // 1/m, at which the first fibre yields
    double farthest = 0;   // fibre, m
  };
  /// Bent about the line at `axis` until a fibre yields; the side toward d in tension.
  template <class Real>
  Bent bend(Vec<Real> d, Real axis) const;
  /// The root of G(s) = target.
  NeutralAxis neutral_axis(Point direction, DoubleDouble target) const;
};

/// Throws std::invalid_argument unless d is finite and not zero.
void require_direction(Point d);

/// Σ ∫ (s' − s) dA along d, weighted as m is; s from the local origin.
inline DoubleDouble first_moment(const Moments<DoubleDouble>& m, const Vec<DoubleDouble>& d, DoubleDouble s) {
  return m.Sx * d.x + m.Sy * d.y - m.A * s;
}

}  // namespace ductile
