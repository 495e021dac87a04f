// The law of the three rows of a joint: springs in series with sliders, under implicit Euler.
//
// With e the elastic strain at the step's start, k the stiffness, c the damping and h the step:
//   G = h²k + hc      b = hk·e / G      x = Jv + b      s = clamp(G x, −hF⁻, hF⁺)
// s is the impulse of the internal force R = s/h (tension positive) that the row takes against the relative
// velocity Jv; it is the derivative of a convex potential φ(x), quadratic below the cap and linear (or, with
// hardening, of a lower curvature) above: Huber's function. Where N, Q and M share one yield surface, s is
// the projection of G x onto it in the metric G⁻¹, which is the derivative of a convex potential as well. So
// one step is one convex problem.
//
// The regime of a joint says which rows flow, and which way: bit i is set where row i is beyond its cap, bit
// 3 + i beyond its reverse cap, or all of it is `on_surface`. Within a regime of caps the law is linear.
#pragma once

#include "yield_surface.h"

namespace ductile::dynamics {

/// Rigid rows have G = κ m_eff, and true stiffness is capped there, which bounds the condition of H for any
/// size, any E and any step. Below 1e8 a rigid cantilever of 80 pieces is soft enough to overshoot and flow
/// at 0.999 of its cap when gravity sets in at once; at 1e10 nothing is lost yet in double precision.
inline constexpr double rigid_ratio = 1e9;

/// What the rows of a joint are made of, axial, shear and rotation.
struct Material {
  Rows stiffness{};  // N/m, N/m, N m/rad; infinite: rigid; 0: free
  Rows damping_ratio{};
  Rows cap{}, cap_reverse{};  // N, N, N m
  Rows hardening{};           // N/m, N/m, N m/rad
  const YieldSurface* surface = nullptr;
};

/// The law of one step's rows.
struct RowLaw {
  Rows G{};                               // kg or kg m²: impulse per unit of relative velocity; 0: free
  Rows cap{};                             // N s or N m s, > 0 or infinite
  Rows cap_reverse{};                     // likewise
  const YieldSurface* surface = nullptr;  // instead of the caps
  double h = 0;                           // s
  Rows after_yield{};  // tangent beyond the cap as a share of G (hardening); 0: perfectly plastic
  Rows spring{};       // k, the stiffness that the step can integrate, ≤ that of the material
  Rows damping{};      // c, N s/m or N m s
  Rows relaxation{};   // hk/G: bias per strain, 1/s

  /// No row flows while all |G x| are within these; below 0 where a yield surface has to tell.
  Rows elastic_range() const;
};

/// The law of rows of effective masses m_eff in a step of h seconds. Springs stiffer than `rigid_from` times
/// m_eff/h² are taken as rigid.
RowLaw make_law(const Material& material, const Rows& m_eff, double h, double rigid_from = rigid_ratio);

/// Says that all rows of a joint flow together: on its yield surface; or, of any joint, as the solve did not
/// end.
inline constexpr unsigned on_surface = 64;

struct Response {
  Rows s;  // impulses
  unsigned regime;
};

/// The impulses that answer x, and the regime that they are in.
Response respond(const RowLaw& law, const Rows& x);

/// The impulses that the linear law of a regime of caps gives, whether x is in it or not.
Rows respond_in(const RowLaw& law, unsigned regime, const Rows& x);

/// The rows that flow in a regime, one bit each.
inline unsigned flowing(unsigned regime) { return regime == on_surface ? 7u : (regime | regime >> 3) & 7u; }

/// Whether a row flows in a regime.
inline bool flows(unsigned regime, unsigned i) { return (flowing(regime) >> i & 1u) != 0; }

/// ds/dx of a row in a regime; on a yield surface 0 (see YieldSurface::tangent for all of it).
inline double tangent(const RowLaw& law, unsigned regime, unsigned i) {
  if (!flows(regime, i)) return law.G[i];
  return regime == on_surface ? 0 : law.after_yield[i] * law.G[i];
}

}  // namespace ductile::dynamics
