// The law of the three rows of a joint: springs in series with sliders, integrated by Newmark's method.
//
// Bodies move by h v, so velocities belong to the middle of a step and the impulse s = h R of a row to its
// start. With e the elastic strain there, u = h J v what the step adds to it, p what the last step did, and
// m = (u + p)/2 from one middle to the next; k the stiffness and c the damping:
//   R = k (e + (u − p)/4 + δ r + 2γ (m − m₋) + ε (u − u₋))      r = m − (m − 2m₋ + m₌)/6      δ ≥ c/(kh)
// δ = γ = ε = 0 is the average acceleration method: k times the mean (e₋ + 2e + e₊)/4, of second order,
// stable for any ωh = φ, and without loss, of what rings in stiff rows neither.
//   δ is a damper c = δ k h. m of a vibration is sin φ/φ of its rate, r is that but for φ⁴: δ damps by δφ/2
// of critical damping. The factor of δ r against m is between ⅓ and 13/12 at any frequency.
//   γ damps by γφ³/2. Both leave alone what the step does not resolve, whose u changes its sign from step to
// step, so that m = 0. ε = γ/2 + q (2d − q)/4 with d = c/(kh) and q = min(d, 0.1) makes that fall by 8 % a
// step without a damper, and by 18 % beside one of d > 0.1. It adds inertia εφ² to a vibration. (With q = d
// it is Newmark's method with β = (1 + δ)²/4, whose inertia c²/(4k) stays at small steps.)
//   p is along the present axes, u₋ of the same step along its own. Where bodies turn evenly, u = u₋ is what
// they part by along tangents, r(ωh)²/2, and p = −u: m and u − u₋ are 0, and R/k = e + u/2 is the strain in
// the middle. With u' = u less what the last turn made of it, (u₋ − p)/2,
//   R m/k = Δ[½ (e + u/2)² + γ m² + ½ ε u'²] + δ r m + γ (m − m₋)²
// all that is stored is positive, and all that is lost, over a vibration: none grows, at any step. (Newmark,
// J. Eng. Mech. Div. ASCE 85 (1959); Hilber, Hughes & Taylor, Earthquake Eng. Struct. Dyn. 5 (1977).)
//
// A damper heavier than δ = 1 is implicit, R = k (e + u) + (c − kh)(J v + w'), with w' = ½(J₊ − J)v of the
// last step: what the rows of turning bodies change their direction by must not strain the spring, step by
// step. δ = 1, γ = 0 is implicit Euler, which rigid rows have.
//
// In the solver's form, with w = p/h and the trend t = (δ/3 − 2γ) m₋ − δ/6 m₌ − ε u₋:
//   σ = ¼ + 5δ/12 + γ + ε      G = σ h² k      b = (e + t)/(σh) − (¼ − 5δ/12 − γ)/σ w      x = J v + b
//   s = clamp(G x, −hF⁻, hF⁺)
//
// s is the impulse of the internal force R = s/h (tension positive) that the row takes against the relative
// velocity Jv; it is the derivative of a convex potential φ(x), quadratic below the cap and linear (or, with
// hardening, of a lower curvature) above: Huber's function. Where N, Q and M share one yield surface, s is
// the projection of G x onto it in the metric G⁻¹, which is the derivative of a convex potential as well. So
// one step is one convex problem.
//
// The regime of a joint says which rows flow, and which way: bit i is set where row i is beyond its cap, bit
// 3 + i beyond its reverse cap, or all of it is `on_surface`. Within a regime of caps the law is linear.
#pragma once

#include <algorithm>

#include "yield_surface.h"

namespace ductile::dynamics {

/// Rigid rows have G = κ m_eff, and true stiffness is capped there, which bounds the condition of H for any
/// size, any E and any step. Below 1e8 a rigid cantilever of 80 pieces is soft enough to overshoot and flow
/// at 0.999 of its cap when gravity sets in at once; at 1e10 nothing is lost yet in double precision.
inline constexpr double rigid_ratio = 1e9;

/// Axial and shear springs beyond so many m_eff/h² are integrated by implicit Euler: only chains of 500 and
/// more of them have a vibration that the step resolves, and what bodies part by as they turn, r(ωh)²/2, must
/// not ring in them. Where a body is lighter than what it joins, as a truss's gusset, that is what the spring
/// moves: the masses are those of the heaviest bodies that are joined to each.
inline constexpr double stiff_ratio = 1e5;

/// Likewise beyond so many m_eff/h² where steps vary or bodies turn far in one: what parts them then is not
/// what it was in the step before, and springs that no step resolves, ωh ≥ π, would store it. And so rows
/// whose force stops growing as one that they bear with begins to flow: the mean of e₋, 2e and e₊ follows
/// that by e₊ − e = u₋ − 4(e − R/k). They would unload by four times what they were strained too far, the
/// slider would take it up, and could not give it back.
inline constexpr double unresolved_ratio = 10;

/// δ at least of rows that go slack or are driven, which carry w over alone: what they did is not what was
/// before. γ = 0, r = m, u₋ = p and d = δ.
inline constexpr double special_delta = 0.05;

/// γ of springs that the step can integrate: a vibration of 6 Hz at 60 Hz is damped by 0.0010 of critical
/// damping, of 2 Hz by 0.00004.
inline constexpr double third_difference = 0.01;

/// q at most: ε of heavier dampers keeps the frequency of what they damp, within 1 % for 6 Hz at 60 Hz.
inline constexpr double most_detuning = 0.1;

/// What the rows of a joint are made of, axial, shear and rotation.
struct Material {
  Rows stiffness{};                 // N/m, N/m, N m/rad; infinite: rigid; 0: free
  Rows damping_ratio{}, damping{};  // c = 2ζ√(k m_eff) + c₀, N s/m or N m s
  Rows cap{}, cap_reverse{};        // N, N, N m
  Rows hardening{};                 // N/m, N/m, N m/rad
  const YieldSurface* surface = nullptr;
  const RateLaw* rate = nullptr;
  unsigned slackens = 0, driven = 0;  // rows that go slack at a cap of 0, and driven ones, one bit each
  Rows target{}, speed{};             // of driven rows: see Drive

  bool may_slacken(unsigned row) const { return (slackens >> row & 1u) != 0; }
  bool is_driven(unsigned row) const { return (driven >> row & 1u) != 0; }
  /// H of the slider in series with a spring k, 1/hardening = 1/k + 1/H, N/m or N m/rad.
  double slider_modulus(unsigned row, double k) const {
    const double after = std::min(hardening[row], 0.99 * k);
    return after * k / (k - after);
  }
  void drive(unsigned row, double to, double at) {
    driven |= 1u << row;
    target[row] = to;
    speed[row] = at;
  }
};

/// The law of one step's rows.
struct RowLaw {
  Rows G{};                               // kg or kg m²: impulse per unit of relative velocity; 0: free
  Rows cap{};                             // N s or N m s, > 0 or infinite
  Rows cap_reverse{};                     // likewise
  const YieldSurface* surface = nullptr;  // instead of the caps
  double h = 0;                           // s
  double share = 1;                       // of the surface that is left to this step
  Rows raised{};                          // of the caps, by the rate of flow (rate.h)
  Rows after_yield{};  // tangent beyond the cap as a share of G (hardening, rate); 0: perfectly plastic
  Rows spring{};       // k, the stiffness that the step can integrate, ≤ that of the material
  Rows damping{};      // c, N s/m or N m s
  Rows delta{};        // δ
  Rows third{};        // γ
  Rows detuning{};     // ε
  Rows relaxation{};   // bias per strain e, 1/s
  Rows carry{};        // bias per −w, w the rate that the law carries over

  void keep(Tape& tape) {
    tape(G, cap, cap_reverse, h, after_yield, spring, damping, delta, third, detuning, relaxation, carry);
  }

  /// t of a row that did u₋, m₋ and m₌.
  double trend(unsigned i, double u, double m, double m_before) const {
    if (!(third[i] > 0)) return 0;
    return (delta[i] / 3 - 2 * third[i]) * m - delta[i] / 6 * m_before - detuning[i] * u;
  }
  /// No row flows while all |G x| are within these; below 0 where a yield surface decides.
  Rows elastic_range() const;
};

/// How rows are integrated.
struct Integration {
  double delta = 1;                 // δ at least, of axial and shear rows
  double delta_rotation = 1;        // likewise, of rotation rows
  double rigid_from = rigid_ratio;  // m_eff/h²: stiffer springs are rigid
  double stiff_from = stiff_ratio;  // likewise: stiffer axial and shear springs are implicit
  unsigned halts = 0;               // rows, one bit each, whose forces stop growing in the step
};

/// The law of rows of effective masses m_eff in a step of h seconds.
RowLaw make_law(const Material& material, const Rows& m_eff, double h, const Integration& how = {});

/// Says that all rows of a joint flow together: on its yield surface; or, of any joint, as the solve did not
/// end.
inline constexpr unsigned on_surface = 64;

struct Response {
  Rows s;  // impulses
  unsigned regime;
};

/// The impulses that answer x, and the regime that they are in.
Response respond(const RowLaw& law, const Rows& x);

/// The rows that flow in a regime, one bit each.
inline unsigned flowing(unsigned regime) { return regime == on_surface ? 7u : (regime | regime >> 3) & 7u; }

/// Whether a row flows in a regime.
inline bool flows(unsigned regime, unsigned i) { return (flowing(regime) >> i & 1u) != 0; }

/// s of a row that stays in a regime of its caps, whatever x is.
inline double impulse_in(const RowLaw& law, unsigned regime, unsigned i, double x) {
  if (!flows(regime, i)) return law.G[i] * x;
  const double cap = (regime >> i & 1u) != 0 ? law.cap[i] : -law.cap_reverse[i];
  return cap + law.after_yield[i] * (law.G[i] * x - cap);
}

/// ds/dx of a row in a regime; on a yield surface 0 (see YieldSurface::tangent for all of it).
inline double tangent(const RowLaw& law, unsigned regime, unsigned i) {
  if (!flows(regime, i)) return law.G[i];
  return regime == on_surface ? 0 : law.after_yield[i] * law.G[i];
}

}  // namespace ductile::dynamics
