// N, Q and M of a joint within one convex yield surface instead of three caps.
//
// A section under N and M is within its N–M curve, here a convex polygon; shear lowers the stress that is
// left for them to f·√(1 − (Q/Q_max)²), for Tresca and von Mises alike, and with it the whole curve in
// proportion. So the body is
//   g(N, M)² + (Q/Q_max)² ≤ 1,     g the gauge of the polygon: max over its facets of n·N + m·M.
// It is the intersection of one elliptic cylinder per facet.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "ductile/joint_law.h"
#include "tape.h"

namespace ductile::dynamics {

/// One number per row of a joint: axial, shear, rotation.
using Rows = std::array<double, 3>;

/// A symmetric 3×3 matrix.
struct Coupling {
  double nn = 0, qq = 0, mm = 0, nq = 0, nm = 0, qm = 0;
};

inline Rows operator*(const Coupling& D, const Rows& x) {
  return {D.nn * x[0] + D.nq * x[1] + D.nm * x[2], D.nq * x[0] + D.qq * x[1] + D.qm * x[2],
          D.nm * x[0] + D.qm * x[1] + D.mm * x[2]};
}

template <>
inline constexpr bool all_doubles<Coupling> = true;

class YieldSurface {
 public:
  /// Polygon counter-clockwise with the origin inside (N and N m), shear cap in N (> 0, may be infinite).
  /// Throws std::invalid_argument otherwise.
  YieldSurface(std::span<const AxialMoment> polygon, double shear);

  /// s ← the point of the surface nearest to s in the metric diag(1/G), when s is outside; all in impulses of
  /// a step of h.
  bool project(const Rows& G, double h, Rows& s) const;

  /// ds/dx of the projected s of the trial G x, where s was projected: P − P n nᵀ P / nᵀ P n with
  /// P = (G⁻¹ + μ ∇²φ)⁻¹, n = ∇φ.
  Coupling tangent(const Rows& G, double h, const Rows& trial) const;

  /// max over facets of n·N + m·M, and Q/Q_max, to the surface as 1: what is used of it.
  double usage(const Rows& force) const;
  /// The same of impulses in h seconds.
  double usage(const Rows& impulse, double h) const {
    return usage({impulse[0] / h, impulse[1] / h, impulse[2] / h});
  }

  double shear() const { return shear_; }
  std::span<const AxialMoment> polygon() const { return vertices_; }

  /// A facet is n·N + m·M ≤ 1; they follow each other counter-clockwise in (N, M).
  struct Facet {
    double n, m;
  };
  std::span<const Facet> facets() const { return facets_; }

 private:
  struct Point {
    Rows s;
    double mu;    // multiplier of ½(w² + q² − 1)
    bool vertex;  // between facet and facet + 1
    std::size_t facet;
  };
  Point nearest(const Rows& G, double h, const Rows& trial) const;
  std::size_t steepest(double N, double M) const;

  std::vector<AxialMoment> vertices_;  // vertex i lies between facets i and i + 1
  std::vector<Facet> facets_;
  double shear_;
};

}  // namespace ductile::dynamics
