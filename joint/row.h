// The law of the three rows of a joint: springs in series with sliders, under implicit Euler.
//
// With e the elastic strain at the step's start, k the stiffness, c the damping and h the step:
//   G = h²k + hc      b = hk·e / G      x = Jv + b      s = clamp(G x, −hF⁻, hF⁺)
// s is the impulse of the internal force R = s/h (tension positive) that the row takes against the relative
// velocity Jv; it is the derivative of a convex potential φ(x), quadratic below the cap and linear (or, with
// hardening, of a lower curvature) above: Huber's function. Where N, Q and M share one yield surface, s is
// the projection of G x onto it in the metric G⁻¹, which is the derivative of a convex potential as well. So
// one step is one convex problem.
#pragma once

#include "yield_surface.h"

namespace ductile {

struct RowLaw {
  Rows G{};                               // kg or kg m²: impulse per unit of relative velocity; 0: free
  Rows cap{};                             // N s or N m s, > 0 or infinite
  Rows cap_reverse{};                     // likewise
  const YieldSurface* surface = nullptr;  // instead of the caps
  double h = 0;                           // s
  Rows after_yield{};  // slope beyond the cap as a share of G (hardening); 0: perfectly plastic

  /// No row flows while all |G x| are within these; below 0 where a yield surface has to tell.
  Rows elastic_range() const;
};

/// Says that a joint flows on its yield surface.
inline constexpr unsigned on_surface = 64;

struct Response {
  Rows s;          // impulses
  unsigned piece;  // of the law that x is on: bit i: row i is beyond its cap, bit 3 + i: beyond its reverse
                   // cap (each combination is linear), or on_surface
};

Response respond(const RowLaw& law, const Rows& x);

/// The rows that flow in that piece, one bit each.
inline unsigned flowing(unsigned piece) { return piece == on_surface ? 7u : (piece | piece >> 3) & 7u; }

/// Whether a row flows in that piece.
inline bool flows(unsigned piece, unsigned i) { return (flowing(piece) >> i & 1u) != 0; }

/// ds/dx of a row in that piece; on a yield surface 0 (see YieldSurface::tangent for all of it).
inline double tangent(const RowLaw& law, unsigned piece, unsigned i) {
  if (!flows(piece, i)) return law.G[i];
  return piece == on_surface ? 0 : law.after_yield[i] * law.G[i];
}

}  // namespace ductile
