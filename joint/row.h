// The law of the three rows of a joint: springs in series with sliders, under implicit Euler.
//
// With e the elastic strain at the step's start, k the stiffness, c the damping and h the step:
//   G = h²k + hc      b = hk·e / G      x = Jv + b      s = clamp(G x, −hF⁻, hF⁺)
// s is the impulse of the internal force R = s/h (tension positive) that the row takes against the relative
// velocity Jv; it is the derivative of a convex potential φ(x), quadratic below the cap and linear (or, with
// hardening, of a lower curvature) above: Huber's function. mechanics: ∇φ is monotone, so one step is one
// convex problem.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace ductile {

using Rows = std::array<double, 3>;  // axial, shear, rotation

/// An N–M polygon with its shear cap: the yield body of a joint with interaction, in impulses per unit step
/// (N, N m). Convex and with the origin inside. A point (N, Q, M) is inside where gauge(N, M)² + (Q/Q_max)² ≤
/// 1: the section's own reduction f·√(1 − (Q/Q_max)²) of the N–M curve, for Tresca and von Mises alike.
struct YieldSurface {
  struct Facet {
    double n, m;  // n·N + m·M ≤ 1
  };
  std::vector<Facet> facets;
  double shear;  // Q_max, N; infinite: no reduction
};

struct RowLaw {
  Rows G{};            // kg or kg m²: impulse per unit of relative velocity; 0: free
  Rows bias{};         // m/s or rad/s
  Rows cap{};          // N s or N m s, > 0 or infinite
  Rows cap_reverse{};  // likewise
  Rows after_yield{};  // slope beyond the cap as a share of G (hardening); 0: perfectly plastic
};

/// Impulses s(x). The result tells the linear piece of each row's law: bit i that row i is beyond its cap,
/// bit 3 + i that it is beyond its reverse cap.
inline unsigned respond(const RowLaw& law, const Rows& x, Rows& s) {
  unsigned piece = 0;
  for (unsigned i = 0; i < 3; ++i) {
    const double trial = law.G[i] * x[i];
    const double held = std::min(std::max(trial, -law.cap_reverse[i]), law.cap[i]);
    s[i] = held + law.after_yield[i] * (trial - held);
    piece |= (trial > held ? 1u : 0u) << i | (trial < held ? 8u : 0u) << i;
  }
  return piece;
}

/// Whether a row flows in that piece.
inline bool flows(unsigned piece, unsigned i) { return ((piece | piece >> 3) >> i & 1u) != 0; }

/// ds/dx of a row in that piece.
inline double tangent(const RowLaw& law, unsigned piece, unsigned i) {
  return flows(piece, i) ? law.after_yield[i] * law.G[i] : law.G[i];
}

}  // namespace ductile
