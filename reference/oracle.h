// What capacities should be, by another road and in 113 bits: regions are clipped by the trial line, the
// areas and first moments of the parts come from the shoelace formula, and the plastic neutral axis from
// false position. Shares nothing with section/ but the coordinates as given.
#pragma once

#include <cfloat>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "ductile/section.h"

namespace ductile::oracle {

#if LDBL_MANT_DIG == 113
using Real = long double;
#else
__extension__ typedef __float128 Real;
#endif

inline Real magnitude(Real x) { return x < 0 ? -x : x; }

inline Real root(Real x) {
  Real r = std::sqrt(static_cast<double>(x));
  for (int i = 0; i < 3; ++i) r = (r + x / r) / 2;
  return r;
}

struct Vertex {
  Real s, w;  // along d and across it, from the origin of the section's axes
};
using Polygon = std::vector<Vertex>;

/// The part on one side of s = s0; sign −1: the part below. (Sutherland and Hodgman.)
inline Polygon clip(const Polygon& polygon, Real s0, int sign) {
  Polygon part;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const Real ua = sign * (a.s - s0), ub = sign * (b.s - s0);
    if (ua >= 0) part.push_back(a);
    if ((ua > 0 && ub < 0) || (ua < 0 && ub > 0)) part.push_back({s0, a.w + (b.w - a.w) * (ua / (ua - ub))});
  }
  return part;
}

struct Integrals {
  Real A = 0, S = 0, I = 0;  // ∫ dA, ∫ s dA, ∫ s² dA about s = s0; positive area
};

inline Integrals integrals(const Polygon& polygon, Real s0) {
  Integrals sum;
  if (polygon.empty()) return sum;
  const Real w0 = polygon.front().w;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vertex p = polygon[i], q = polygon[(i + 1) % polygon.size()];
    const Real a = p.s - s0, b = q.s - s0, cross = a * (q.w - w0) - b * (p.w - w0);
    sum.A += cross / 2;
    sum.S += cross * (a + b) / 6;
    sum.I += cross * (a * a + a * b + b * b) / 12;
  }
  if (sum.A < 0) return {-sum.A, -sum.S, -sum.I};
  return sum;
}

class Section {
 public:
  Section(std::span<const Region> regions, Point direction) {
    const Real x = direction.x, y = direction.y, length = root(x * x + y * y);
    const Real dx = x / length, dy = y / length;
    const auto turned = [&](const Ring& ring) {
      Polygon polygon;
      for (const Point p : ring) {
        polygon.push_back({dx * p.x + dy * p.y, dx * p.y - dy * p.x});
        if (parts_.empty() && polygon.size() == 1) low_ = high_ = polygon[0].s;
        low_ = std::min(low_, polygon.back().s);
        high_ = std::max(high_, polygon.back().s);
      }
      return polygon;
    };
    for (const Region& region : regions) {
      const Material& m = region.material;
      const Real ft = m.yield_stress,
                 fc = m.yield_stress_compression > 0 ? m.yield_stress_compression : m.yield_stress;
      const Real E = m.youngs_modulus > 0 ? m.youngs_modulus : 1;
      parts_.push_back({turned(region.outline.outer), 1, ft, fc, E});
      for (const Ring& hole : region.outline.holes) parts_.push_back({turned(hole), -1, ft, fc, E});
    }
  }

  Real low() const { return low_; }
  Real high() const { return high_; }

  /// N and M about `reference` of the fully plastic section with the neutral axis at s0, in tension toward +d
  /// (sense +1) or toward −d (−1). M positive: +d in tension.
  std::pair<Real, Real> forces(Real s0, Real reference, int sense) const {
    Real N = 0, M = 0;
    for (const Part& part : parts_) {
      const Integrals tension = integrals(clip(part.polygon, s0, sense), reference);
      const Integrals compression = integrals(clip(part.polygon, s0, -sense), reference);
      N += part.sign * (part.ft * tension.A - part.fc * compression.A);
      M += part.sign * (part.ft * tension.S - part.fc * compression.S);
    }
    return {N, M};
  }

  /// Where the axial force is N: false position with the Illinois rule, then bisection should that be slow.
  Real neutral_axis(Real N, int sense) const {
    const auto rest = [&](Real s) { return sense * (forces(s, s, sense).first - N); };  // falls with s
    Real a = low_, b = high_, fa = rest(a), fb = rest(b), last = a;
    if (!(fa > 0)) return a;
    if (!(fb < 0)) return b;
    for (int i = 0, kept = 0; i < 300; ++i) {
      const Real s = i < 60 ? a + (b - a) * (fa / (fa - fb)) : (a + b) / 2, f = rest(s);
      if (f == 0 || magnitude(s - last) <= Real(1e-28) * (high_ - low_)) return s;
      last = s;
      if (f > 0) {
        a = s, fa = f;
        if (kept > 0) fb /= 2;
        kept = 1;
      } else {
        b = s, fb = f;
        if (kept < 0) fa /= 2;
        kept = -1;
      }
    }
    return last;
  }

  /// Σ weight · (A, S, I) about s0, weight 1 or E.
  Integrals elastic(Real s0, bool by_modulus) const {
    Integrals sum;
    for (const Part& part : parts_) {
      const Integrals own = integrals(part.polygon, s0);
      const Real weight = part.sign * (by_modulus ? part.E : Real(1));
      sum.A += weight * own.A;
      sum.S += weight * own.S;
      sum.I += weight * own.I;
    }
    return sum;
  }

 private:
  struct Part {
    Polygon polygon;
    int sign;
    Real ft, fc, E;
  };
  std::vector<Part> parts_;
  Real low_ = 0, high_ = 0;
};

}  // namespace ductile::oracle
